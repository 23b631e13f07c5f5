"""A fix as the rows of a small diff.

Invariant: a diff is shown only where it says more than the fix's title, and is never longer than `_MOST` rows.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

from btq_lang.diagnostics.model import Fix
from btq_lang.render.cells import cut, printable
from btq_lang.render.frame import FrameRow
from btq_lang.render.report import Finding, Report, clamped, line_index, text_of
from btq_lang.util.text import Edit, LineIndex, Position, alike, apply_edits

_MOST = 12


def fix_diff(report: Report, finding: Finding, fix: Fix, room: int) -> list[FrameRow]:
    """The lines that a fix removes and adds; empty for a single replacement of exactly the marked span."""
    if _title_says_it(finding, fix):
        return []
    rows: list[FrameRow] = []
    for path in dict.fromkeys(change.place.path or finding.path for change in fix.changes):
        if path != finding.path:
            rows.append(FrameRow(None, printable(path), ":::"))
        text = text_of(report, finding, path)
        if text is None:
            continue
        changes = (change for change in fix.changes if (change.place.path or finding.path) == path)
        edits = sorted((Edit(clamped(c.place.span, text), c.text) for c in changes), key=lambda edit: edit.span)
        if any(edit.span.end > following.span.start for edit, following in pairwise(edits)):
            return []  # such a fix cannot be applied, so there is nothing to show
        rows += _hunks(text, edits, room)
    if len(rows) > _MOST:
        rows[_MOST - 1 :] = [FrameRow(None, f"... {len(rows) - _MOST + 1} more lines")]
    return rows


def _title_says_it(finding: Finding, fix: Fix) -> bool:
    if len(fix.changes) != 1:
        return False
    place, text = fix.changes[0].place, fix.changes[0].text
    replaced = finding.text[slice(*clamped(place.span, finding.text))]
    return (
        place.path in (None, finding.path)
        and place.span == finding.diagnostic.span
        and not any(end in text or end in replaced for end in "\r\n")
    )


def _hunks(text: str, edits: list[Edit], room: int) -> list[FrameRow]:
    lines = line_index(text)
    rows: list[FrameRow] = []
    shift = 0  # how many lines earlier hunks have added
    hunk: list[Edit] = []
    for edit, following in zip(edits, [*edits[1:], None], strict=True):
        hunk.append(edit)
        if following and lines.position(following.span.start).line <= lines.position(edit.span.end).line:
            continue
        first, last = lines.position(hunk[0].span.start).line, lines.position(edit.span.end).line
        old = [lines.line(number) for number in range(first, last + 1)]
        new = _lines(_edited(text, lines, hunk, first, last))
        same = alike(old, new)
        rest = alike(old[same:][::-1], new[same:][::-1])
        rows += _rows(old[same : len(old) - rest], first + same + 1, "-", room)
        rows += _rows(new[same : len(new) - rest], first + same + 1 + shift, "+", room)
        shift += len(new) - len(old)
        hunk = []
    return rows


def _edited(text: str, lines: LineIndex, edits: Iterable[Edit], first: int, last: int) -> str:
    """The lines from `first` to `last` after the edits, which are within them."""
    start = lines.offset(Position(first, 0))
    end = lines.offset(Position(last, len(text)))
    return apply_edits(text[start:end], (Edit(edit.span.shifted(-start), edit.text) for edit in edits))


def _lines(text: str) -> list[str]:
    lines = LineIndex(text)
    return [lines.line(number) for number in range(lines.line_count)]


def _rows(lines: list[str], number: int, bar: str, room: int) -> list[FrameRow]:
    return [FrameRow(number + at, cut(line, 0, room), bar) for at, line in enumerate(lines)]
