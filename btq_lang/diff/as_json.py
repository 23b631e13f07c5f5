"""Comparisons for programs.

The document, format 1; a later btq may add keys but changes none without a new number:

    {"format": 1, "tool": "btq", "version": VERSION,
     "comparisons": [{"old": NAME | null, "new": NAME | null,
                      "changes": [{"what": "added" | "removed" | "moved" | "changed" | "renamed",
                                   "thing": "tree" | "node" | "requirement" | …, "name": NAME, "earlier": NAME | null,
                                   "old": PLACE | null, "new": PLACE | null,
                                   "details": [{"aspect": TEXT, "old": TEXT | null, "new": TEXT | null}],
                                   "below": N, "around": [NAME]}]}],
     "summary": {"added": N, "removed": N, "moved": N, "changed": N, "renamed": N}}

    PLACE = {"path": PATH, "range": {"start": {"line": N, "column": N}, "end": {"line": N, "column": N}}}

Lines and columns count from 1, columns in Unicode code points, and the end is exclusive.  The text is ASCII.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator

from btq_lang.diff import Change, DiskPlace
from btq_lang.diff.comparison import MissionComparison, Side, all_changes
from btq_lang.diff.wording import SIGNS
from btq_lang.util.version import __version__


def render(comparisons: Iterable[MissionComparison]) -> Iterator[str]:
    """The document, in one piece."""
    comparisons = tuple(comparisons)
    counts = {what: sum(change.what == what for change in all_changes(comparisons)) for what in SIGNS}
    document = {
        "format": 1,
        "tool": "btq",
        "version": __version__,
        "comparisons": [
            {
                "old": comparison.old.name,
                "new": comparison.new.name,
                "changes": [_change(comparison, change) for change in comparison.changes],
            }
            for comparison in comparisons
        ],
        "summary": counts,
    }
    yield json.dumps(document, indent=2)


def _change(comparison: MissionComparison, change: Change) -> dict[str, object]:
    return {
        "what": change.what,
        "thing": change.thing,
        "name": change.name,
        "earlier": change.earlier,
        "old": _place(comparison.old, change.old),
        "new": _place(comparison.new, change.new),
        "details": [{"aspect": each.aspect, "old": each.old, "new": each.new} for each in change.details],
        "below": change.below,
        "around": list(change.around),
    }


def _place(side: Side, place: DiskPlace | None) -> dict[str, object] | None:
    if place is None:
        return None
    path, start, end = side.place(place)
    return {
        "path": path,
        "range": {
            "start": {"line": start.line + 1, "column": start.column + 1},
            "end": {"line": end.line + 1, "column": end.column + 1},
        },
    }
