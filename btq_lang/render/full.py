"""`full`: findings with their source lines, in the style of rustc and ruff.

    error[unknown-node]: no node `Rety` is known
      --> lab.btq:3:9
       |
     3 |         Rety (num_attempts = 6)
       |         ^^^^
       |
       = help: replace `Rety` by `Retry` (--fix)

Invariant: a finding is one block, its gutter as wide as its largest line number, with a blank line after it.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.diagnostics.model import Place
from btq_lang.render.cells import printable
from btq_lang.render.colour import Paint, painter
from btq_lang.render.frame import FrameRow, frame
from btq_lang.render.report import Finding, Report, line_index, location, text_of
from btq_lang.render.summary import last_line

_LEAST_ROOM = 20  # lines are not cut below this width


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
        from btq_lang.render.fix_diff import fix_diff  # most findings have no fix

        yield from fix_diff(report, finding, fix, room)


def _place(
    report: Report, finding: Finding, place: Place | None, mark: str, style: str, room: int, paint: Paint
) -> Iterator[FrameRow]:
    at = location(report, finding, place)
    text = text_of(report, finding, at.path)
    if text is None:
        yield FrameRow(None, printable(at.path), "-->")
        return
    yield FrameRow(None, f"{printable(at.path)}:{at.line}:{at.column}", "-->")
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
