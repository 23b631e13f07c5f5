"""The program that runs a tree, as far as it is known: its engine, its nodes of Nav2, what it sets before it creates
the tree, and how it ticks.

One invariant: all that run trees without a robot ask here, so that they run them alike.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from btq_lang.catalog.nav2 import ENGINES, assumed_distribution, distribution_among
from btq_lang.catalog.nav2.navigator import NAME, preset_entries
from btq_lang.catalog.versions import VERSION_3, is_before_4
from btq_lang.simulator.blackboard import Board, Unsaid
from btq_lang.simulator.kinds import is_of_nav2
from btq_lang.simulator.versions import Dialect
from btq_lang.util.record import Record
from btq_lang.workspace.engine_version import written_for
from btq_lang.workspace.project_driver import Driver
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


class KnownProgram(Record):
    """What is known of a program.

    Attributes:
        dialect: its engine, and the distribution of its nodes of Nav2.
        is_nav2_assumed: the distribution is not named anywhere.
        preset: the entries of the root blackboard that it sets, to unknown values: those of bt_navigator.
        driver: how it ticks.
    """

    dialect: Dialect
    is_nav2_assumed: bool = False
    preset: tuple[str, ...] = ()
    driver: Driver = Driver()

    def board(self) -> Board:
        """The root blackboard before the tree is created."""
        board = Board(is_old=self.dialect.is_old)
        for key in self.preset:
            board.define(key, Unsaid(NAME, key, ""), "")
        return board


def program_of(workspace: Workspace, path: str, nodes: Iterable[ResolvedNode]) -> KnownProgram:
    """The program that runs some nodes; `path`: of the file from which all are seen that it registers."""
    factory = workspace.factory
    named = distribution_among(workspace.scope(path).node_paths)
    version = _version(workspace, path, named)
    has_nav2 = any(node.children and node.id is not None and is_of_nav2(node.id.text) for node in nodes)
    nav2 = named or (assumed_distribution(is_before_4(version)) if has_nav2 else "")
    dialect = Dialect(ENGINES[nav2] if nav2 and is_before_4(version) else version, nav2)
    preset = tuple(preset_entries(nav2, factory.entries if factory is not None else ())) if nav2 else ()
    return KnownProgram(dialect, bool(nav2) and named is None, preset, _driver(workspace, nav2))


def _version(workspace: Workspace, path: str, nav2: str | None) -> str:
    """The version of the engine: that of the distribution, unless the project names its versions or the files say that
    they are for another one."""
    project = workspace.project
    signs = (workspace.files[each].signs for each in workspace.registered_with(path))
    versions = [written_for(project, nav2, each) for each in signs if each is not None] or [
        written_for(project, nav2, None)
    ]
    if (VERSION_3,) in versions:
        return VERSION_3
    return project.target if project.pinned or nav2 is None else ENGINES[nav2]


def _driver(workspace: Workspace, nav2: str) -> Driver:
    """What the project says; else that of bt_navigator, whose sleep a node can end since Kilted, or the usual one."""
    project, factory = workspace.project, workspace.factory
    if project.simulation is not None and project.simulation.driver is not None:
        return project.simulation.driver
    if not nav2:
        return Driver()
    return Driver("tick_once" if nav2 in _SLEEPS_ON else "tick_while_running", factory.period if factory else 10)


_SLEEPS_ON: Final = ("humble", "iron", "jazzy")
