"""A frame: the lines of a file around a span, with the span marked.

Rows hold the parts left and right of the gutter; the caller that joins the frames of a diagnostic aligns the numbers.
Invariant: a mark is below what it marks, whatever tabs and wide characters come before it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

from btq_lang.render.cells import cut, laid_out
from btq_lang.render.report import clamped, line_index
from btq_lang.util.record import Record
from btq_lang.util.text import LineIndex, Position, Span

_CONTEXT = 1  # lines shown above and below: the line above has the parent or the opening bracket
_HEAD, _TAIL = 4, 2  # lines of a long span that are shown at its start and its end
_MARGIN = "  "  # where the line along a span over several lines is drawn


class FrameRow(Record):
    """One line of a block: number, bar and body of `12 | body`.

    Attributes:
        bar: `|`; `-`, `+` in a diff; `=`, or a blank, before a remark; `-->`, `:::` before a path; `note:` before a
            message that begins a part of the block.
    """

    number: int | None
    body: str
    bar: str = "|"


def frame(text: str, span: Span, *, mark: str, room: int, paint: Callable[[str], str]) -> list[FrameRow]:
    """The rows that show a span.

    Args:
        mark: what to print below each cell of the span: `^` for the finding, `-` for related places.
        room: the maximal number of cells of a line.
        paint: colours the marks.
    """
    lines = line_index(text)
    span = clamped(span, text)
    start, end = lines.position(span.start), lines.position(span.end)
    if span.end > span.start and end.column == 0:  # the line end at its end belongs to the line before
        end = Position(end.line - 1, len(_line(lines, end.line - 1)) + 1)
    several = end.line > start.line
    margin = _MARGIN if several else ""
    view = _view(lines, start, 1 if several else end.column - start.column, room - len(margin))
    marked = _several(view, start, end, mark, paint) if several else _single(view, start, end, mark, paint)
    above = range(max(0, start.line - _CONTEXT), start.line)
    below = range(end.line + 1, min(end.line + 1 + _CONTEXT, lines.line_count))
    return [*_context(view, above, margin), *marked, *_context(view, below, margin)]


class _View(Record):
    """The visible part of the lines: `room` cells from `left` on, the same for all lines of a frame."""

    lines: LineIndex
    left: int
    room: int

    def line(self, number: int) -> str:
        return cut(_line(self.lines, number), self.left, self.room)

    def cell(self, position: Position) -> int:
        """The visible cell of a position, one to the right if there is a sign for a cut on the left."""
        return _cell(_line(self.lines, position.line), position.column) - self.left + (1 if self.left else 0)


def _view(lines: LineIndex, start: Position, columns: int, room: int) -> _View:
    """The view that puts the span, or its beginning, in the middle of a line that is too long."""
    line = _line(lines, start.line)
    first, last = _cell(line, start.column), _cell(line, start.column + columns)
    total = max(_cell(line, len(line)), last)
    if total <= room:
        return _View(lines, 0, room)
    return _View(lines, max(0, min(first - (room - min(last - first, room)) // 2, total - room)), room)


def _single(view: _View, start: Position, end: Position, mark: str, paint: Callable[[str], str]) -> list[FrameRow]:
    first, last = view.cell(start), view.cell(end)
    if first == last and first > 0 and start < end:
        first -= 1  # a combining character is drawn in the cell before
    marks = mark * max(1, min(last, view.room + 1) - first)
    return [FrameRow(start.line + 1, view.line(start.line)), FrameRow(None, " " * first + paint(marks))]


def _several(view: _View, start: Position, end: Position, mark: str, paint: Callable[[str], str]) -> list[FrameRow]:
    """A span over several lines, as rustc draws it: `/` or `____^` where it begins, `|____^` where it ends."""
    if _line(view.lines, start.line)[: start.column].strip():
        rows = [
            FrameRow(start.line + 1, _MARGIN + view.line(start.line)),
            FrameRow(None, " " + paint("_" * (1 + view.cell(start)) + mark)),
        ]
    else:
        rows = [FrameRow(start.line + 1, f"{paint('/')} {view.line(start.line)}")]
    skipped = range(start.line + _HEAD, end.line - _TAIL + 1)
    if len(skipped) < 2:
        skipped = range(0)
    for number in range(start.line + 1, end.line + 1):
        if number not in skipped:
            rows.append(FrameRow(number + 1, f"{paint('|')} {view.line(number)}"))
        elif number == skipped.start:
            rows.append(FrameRow(None, f"{paint('|')} ..."))
    last = view.cell(Position(end.line, end.column - 1))
    return [*rows, FrameRow(None, paint("|" + "_" * (1 + max(0, min(last, view.room))) + mark))]


def _context(view: _View, numbers: range, margin: str) -> list[FrameRow]:
    return [FrameRow(number + 1, margin + view.line(number)) for number in numbers if _line(view.lines, number).strip()]


@lru_cache(16)  # as for `laid_out`; the hash of a line is computed once
def _line(lines: LineIndex, number: int) -> str:
    return lines.line(number)


def _cell(line: str, column: int) -> int:
    """The cell where a column begins; a line end counts as one cell wide."""
    columns = laid_out(line)[1]
    return columns[min(column, len(line))] + max(0, column - len(line))
