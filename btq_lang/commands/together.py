"""Findings of `btq check --target` that say the same: a project of Groot repeats a value hundreds of times."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.diagnostics.model import Change, Diagnostic, Fix, Place, Related
from btq_lang.render import Finding
from btq_lang.util.record import replace
from btq_lang.util.text import counted


def together(findings: Iterable[Finding]) -> list[Finding]:
    """The findings, with one for all of a file that say the same of the target, at the first of their places."""
    groups: dict[tuple[object, ...], list[Finding]] = {}
    for number, each in enumerate(findings):
        found = each.diagnostic
        same = (found.message, found.notes, found.effective_severity) if found.rule in _OF_TARGET else (number,)
        groups.setdefault((each.path, found.rule, *same), []).append(each)
    return [_joined(group) if len(group) > 1 else group[0] for group in groups.values()]


def _joined(group: list[Finding]) -> Finding:
    first, *others = (each.diagnostic for each in group)
    found = replace(
        first,
        message=f"{first.message} (here and at {counted(len(others), 'other place')})",
        related=(*first.related, *(Related(Place(each.span), "here too") for each in others[:_SHOWN])),
        fixes=tuple(_fixes(first, others)),
    )
    return replace(group[0], diagnostic=found)


def _fixes(first: Diagnostic, others: list[Diagnostic]) -> Iterator[Fix]:
    """The fixes that all have, each for all places."""
    for fix in first.fixes:
        changes: list[tuple[Change, ...]] = [fix.changes]
        changes += [one.changes for each in others for one in each.fixes if one.title == fix.title]
        if len(changes) == len(others) + 1:
            yield replace(fix, changes=tuple(change for of_one in changes for change in of_one))


_OF_TARGET: Final = ("target-breaks", "target-differs")
_SHOWN: Final = 3  # of many places
