"""`full`: findings with their source lines, in the style of rustc and ruff.

    error[unknown-node]: no node `Rety` is known
      --> lab.btq:3:9
       |
     3 |         Rety (num_attempts = 6)
       |         ^^^^
       |
       = help: replace `Rety` by `Retry` (--fix)

Invariant: a finding is one block, its gutter as wide as its largest line number, with a blank line after it.  A fix is
shown as a diff only where that says more than its title.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from btq_lang.diagnostics.model import Fix, Place
from btq_lang.render.cells import cut, printable
from btq_lang.render.colour import Paint, painter
from btq_lang.render.frame import FrameRow, frame
from btq_lang.render.report import Finding, Report, clamped, line_index, location, text_of
from btq_lang.render.summary import last_line
from btq_lang.util.text import Edit, LineIndex, Position, alike, apply_edits

_LEAST_ROOM = 20  # lines are not cut below this width
_MOST_ROWS = 12  # of the diff of a fix


def render(report: Report, *, colour: bool = False, width: int = 120) -> Iterator[str]:
    """Every finding as a block, then the summary."""
    paint = painter(colour)
    for finding in report.findings:
        rows = list(_rows(report, finding, width, paint))
        gutter = max(len(str(row.number or "")) for row in rows)
        yield _header(finding, paint)
        for row in rows:
            yield _line(row, gutter, paint)
        yield "\n"
    yield last_line(report)


def _header(finding: Finding, paint: Paint) -> str:
    severity = finding.diagnostic.effective_severity.value
    title = paint(severity, f"{severity}[{finding.diagnostic.rule}]")
    return title + paint("message", f": {printable(finding.diagnostic.message)}") + "\n"


def _rows(report: Report, finding: Finding, width: int, paint: Paint) -> Iterator[FrameRow]:
    diagnostic = finding.diagnostic
    # To the left of a line are its number and ` | `; a cut line has a sign on each side.
    room = max(_LEAST_ROOM, width - len(str(line_index(finding.text).line_count)) - 5)
    severity = diagnostic.effective_severity.value
    yield from _place(report, finding, None, "^", severity, room, paint)
    if diagnostic.notes or diagnostic.related or diagnostic.fixes:
        yield FrameRow(None, "")
    for note in diagnostic.notes:
        yield from _remark("note", note)
    for related in diagnostic.related:
        yield FrameRow(None, printable(related.message), "note:")
        yield from _place(report, finding, related.place, "-", "gutter", room, paint)
    if diagnostic.related and diagnostic.fixes:
        yield FrameRow(None, "")
    for fix in diagnostic.fixes:
        yield from _remark("help", fix.title + (" (--fix)" if fix.safe else ""))
        yield from _fix_diff(report, finding, fix, room)


def _place(
    report: Report, finding: Finding, place: Place | None, mark: str, style: str, room: int, paint: Paint
) -> Iterator[FrameRow]:
    where = location(report, finding, place)
    text = text_of(report, finding, where.path)
    if text is None:
        yield FrameRow(None, printable(where.path), "-->")
        return
    yield FrameRow(None, f"{printable(where.path)}:{where.line}:{where.column}", "-->")
    yield FrameRow(None, "")
    span = finding.diagnostic.span if place is None else place.span
    yield from frame(text, span, mark=mark, room=room, paint=lambda marks: paint(style, marks))


def _remark(kind: str, text: str) -> Iterator[FrameRow]:
    """A note or a help; further lines are aligned with its first."""
    first, *others = text.split("\n")
    yield FrameRow(None, f"{kind}: {printable(first)}", "=")
    for line in others:
        yield FrameRow(None, " " * (len(kind) + 2) + printable(line), " ")


def _line(row: FrameRow, gutter: int, paint: Paint) -> str:
    """The printed form of a row; `note:` begins a part of its own at the left edge, `-->` points out of the gutter."""
    if row.bar == "note:":
        return paint("message", "note") + f": {row.body}\n"
    if row.bar in ("-->", ":::"):
        return f"{' ' * gutter}{paint('gutter', row.bar)} {row.body}\n"
    number = str(row.number or "")
    if row.bar in "-+":
        changed = paint(row.bar, f"{row.bar} {row.body}".rstrip())
        return f"{paint('gutter', number.rjust(gutter))} {changed}\n"
    left = paint("gutter", f"{number.rjust(gutter)} {row.bar}")
    return f"{left} {row.body}".rstrip() + "\n"


# ---- a fix as the rows of a small diff ----


def _fix_diff(report: Report, finding: Finding, fix: Fix, room: int) -> list[FrameRow]:
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
    if len(rows) > _MOST_ROWS:
        rows[_MOST_ROWS - 1 :] = [FrameRow(None, f"... {len(rows) - _MOST_ROWS + 1} more lines")]
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
        new = _lines_in(_edited(text, lines, hunk, first, last))
        alike_start = alike(old, new)
        alike_end = alike(old[alike_start:][::-1], new[alike_start:][::-1])
        rows += _diff_rows(old[alike_start : len(old) - alike_end], first + alike_start + 1, "-", room)
        rows += _diff_rows(new[alike_start : len(new) - alike_end], first + alike_start + 1 + shift, "+", room)
        shift += len(new) - len(old)
        hunk = []
    return rows


def _edited(text: str, lines: LineIndex, edits: Iterable[Edit], first: int, last: int) -> str:
    """The lines from `first` to `last` after the edits, which are within them."""
    start = lines.offset(Position(first, 0))
    end = lines.offset(Position(last, len(text)))
    return apply_edits(text[start:end], (Edit(edit.span.shifted(-start), edit.text) for edit in edits))


def _lines_in(text: str) -> list[str]:
    lines = LineIndex(text)
    return [lines.line(number) for number in range(lines.line_count)]


def _diff_rows(lines: list[str], number: int, bar: str, room: int) -> list[FrameRow]:
    return [FrameRow(number + index, cut(line, 0, room), bar) for index, line in enumerate(lines)]
