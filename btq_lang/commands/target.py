"""`btq check --target`: the trees of a project in another version of the engine or distribution of Nav2."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from typing import Final

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.nav2 import FILES, PACKAGED
from btq_lang.checks.lookups import distribution
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related
from btq_lang.projects.files import FileGroup
from btq_lang.render import Finding
from btq_lang.util.record import replace
from btq_lang.util.text import counted
from btq_lang.workspace.file import File
from btq_lang.workspace.loader import read
from btq_lang.workspace.workspace import Workspace


def moving(groups: Iterable[FileGroup], target: str) -> tuple[FileGroup, ...]:
    """The groups, to be checked for a target too: a version of the engine, or as a project names its nodes,
    `nav2-lyrical`."""
    return tuple(replace(group, workspace=with_target(group.workspace, target)) for group in groups)


def is_comparable(groups: Iterable[FileGroup], target: str) -> bool:
    """Whether the distribution of some trees is known, if the target is a distribution."""
    requested = ((group.workspace.store, path) for group in groups for path in group.given)
    return target not in PACKAGED or any(store.ask(distribution, path) is not None for store, path in requested)


def with_target(workspace: Workspace, target: str) -> Workspace:
    """The same files; if the target is a distribution, with the nodes of all distributions beside them."""
    project = replace(workspace.project, moves_to=target.removeprefix("nav2-"))
    models = _models() if target in PACKAGED else {}
    return Workspace({**models, **workspace.files}, project, workspace.factory)


@cache
def _models() -> dict[str, File]:
    return {path: file_of(path, read(path)[0] or "") for path in FILES.values()}


def together(findings: Iterable[Finding]) -> list[Finding]:
    """The findings, with equal ones about the target in a file as one at the first of their places: a project of Groot
    repeats a value hundreds of times."""
    groups: dict[tuple[object, ...], list[Finding]] = {}
    for number, finding in enumerate(findings):
        diagnostic = finding.diagnostic
        same = (
            (diagnostic.message, diagnostic.notes, diagnostic.effective_severity)
            if diagnostic.rule in _OF_TARGET
            else (number,)
        )
        groups.setdefault((finding.path, diagnostic.rule, *same), []).append(finding)
    return [_merged_finding(group) if len(group) > 1 else group[0] for group in groups.values()]


def _merged_finding(group: list[Finding]) -> Finding:
    first, *others = (finding.diagnostic for finding in group)
    joined = replace(
        first,
        message=f"{first.message} (here and at {counted(len(others), 'other place')})",
        related=(*first.related, *(Related(Place(other.span), "here too") for other in others[:_SHOWN])),
        fixes=tuple(_fixes(first, others)),
    )
    return replace(group[0], diagnostic=joined)


def _fixes(first: Diagnostic, others: list[Diagnostic]) -> Iterator[Fix]:
    """The fixes that all have, each for all places."""
    for fix in first.fixes:
        changes: list[tuple[FixEdit, ...]] = [fix.changes]
        changes += [one.changes for other in others for one in other.fixes if one.title == fix.title]
        if len(changes) == len(others) + 1:
            yield replace(fix, changes=tuple(change for of_one in changes for change in of_one))


_OF_TARGET: Final = ("target-breaks", "target-differs")
_SHOWN: Final = 3  # of many places
