"""`btq check --target`: the trees of a project in another version of the engine or distribution of Nav2."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.nav2 import FILES, PACKAGED
from btq_lang.checks.lookups import distribution
from btq_lang.util.record import replace
from btq_lang.workspace.file import File
from btq_lang.workspace.loader import read
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from collections.abc import Iterable

    from btq_lang.commands.files import Group


def moving(groups: Iterable[Group], target: str) -> tuple[Group, ...]:
    """The groups, to be checked for a target too.

    Args:
        target: a version of the engine, or as a project names its nodes: `nav2-lyrical`.
    """
    return tuple(replace(group, workspace=with_target(group.workspace, target)) for group in groups)


def is_comparable(groups: Iterable[Group], target: str) -> bool:
    """Whether it is known what some trees are for, if the target is a distribution."""
    given = ((group.workspace.store, path) for group in groups for path in group.given)
    return target not in PACKAGED or any(distribution(store, path) is not None for store, path in given)


def with_target(workspace: Workspace, target: str) -> Workspace:
    """The same files; if the target is a distribution, with the nodes of all distributions beside them."""
    project = replace(workspace.project, moves_to=target.removeprefix("nav2-"))
    models = _models() if target in PACKAGED else {}
    return Workspace({**models, **workspace.files}, project, workspace.factory)


@cache
def _models() -> dict[str, File]:
    return {path: file_of(path, read(path)[0] or "") for path in FILES.values()}
