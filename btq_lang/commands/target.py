"""`btq check --target`: what the trees of a project will be in another distribution of Nav2."""

from __future__ import annotations

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.util.record import replace
from btq_lang.workspace.loader import read
from btq_lang.workspace.workspace import Workspace


def with_target(workspace: Workspace, target: str) -> Workspace:
    """The same files, to be checked for a distribution too.

    Args:
        target: as a project names its nodes, `nav2-lyrical`.
    """
    files = dict(workspace.files)
    for path in PACKAGED.values():
        files.setdefault(path, file_of(path, read(path)[0] or ""))
    project = replace(workspace.project, moves_to=target.removeprefix("nav2-"))
    return Workspace(files, project, workspace.factory)


def is_for_nav2(workspace: Workspace) -> bool:
    """Whether a project says for which distribution its trees were written."""
    factory = workspace.factory
    named = (*workspace.project.node_files, *(factory.node_files if factory is not None else ()))
    return not set(named).isdisjoint(PACKAGED.values())
