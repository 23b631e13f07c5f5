"""Text, spans and edits: what every other module counts in.

One invariant: an offset is an index into a Python string.  Lines and columns exist only at the edges (a terminal, an
editor), and `LineIndex` is the only place that turns one into the other, in the unit the reader asked for.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections import namedtuple

from btq_lang.record import Record

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import Literal, NamedTuple, TypeAlias

    class _Ends(NamedTuple):
        start: int
        end: int

    class _Place(NamedTuple):
        line: int
        column: int
else:
    _Ends = namedtuple("_Ends", ("start", "end"))
    _Place = namedtuple("_Place", ("line", "column"))

Encoding: TypeAlias = "Literal['code-points', 'utf-8', 'utf-16']"

# A line ends with these and with nothing else: str.splitlines would also cut at form feeds and U+2028.
LINE_END = re.compile(r"\r\n|\n|\r")


class Span(_Ends):
    """A half-open range of offsets."""

    __slots__ = ()

    def shifted(self, by: int) -> Span:
        return Span(self.start + by, self.end + by)


class Position(_Place):
    """A line and a column, both counted from 0."""

    __slots__ = ()


class Edit(Record):
    """Replace the text at `span` by `text`."""

    span: Span
    text: str


def apply_edits(text: str, edits: Iterable[Edit]) -> str:
    """Apply edits that do not overlap, in any order.

    Raises:
        ValueError: two edits overlap.
    """
    pieces: list[str] = []
    at = 0
    for edit in sorted(edits, key=lambda edit: edit.span):
        if edit.span.start < at:
            raise ValueError(f"edits overlap at offset {edit.span.start}")
        pieces += (text[at : edit.span.start], edit.text)
        at = edit.span.end
    return "".join([*pieces, text[at:]])


def changed(before: str, after: str) -> Span | None:
    """The part of a text that an edit replaced: what is before and behind it is in both; None where they are equal."""
    if before == after:
        return None
    shorter = min(len(before), len(after))
    start = _same(lambda low, high: before[low:high] == after[low:high], shorter)
    size, new_size = len(before), len(after)
    rest = _same(lambda low, high: before[size - high : size - low] == after[new_size - high : new_size - low], shorter)
    return Span(start, size - min(rest, shorter - start))


def _same(is_same: Callable[[int, int], bool], size: int) -> int:
    """How much is the same from the start of something on, found by halving."""
    low, high = 0, size
    while low < high:
        middle = (low + high + 1) // 2
        if is_same(low, middle):
            low = middle
        else:
            high = middle - 1
    return low


class LineIndex:
    """Where the lines of a text begin, to turn offsets into positions and back."""

    __slots__ = ("_starts", "_text")

    def __init__(self, text: str) -> None:
        self._text = text
        self._starts = [0, *[end.end() for end in LINE_END.finditer(text)]]

    def edited(self, text: str, change: Span | None = None) -> LineIndex:
        """The index of the text after an edit; the lines before and behind the change are not looked for again.

        Args:
            change: what `changed` says of the two texts, where that is known.
        """
        change = change or changed(self._text, text)
        return self if change is None else self._replaced(change, text)

    def replaced(self, span: Span, by: str) -> LineIndex:
        """The index of the text with another one at `span`."""
        return self._replaced(span, self._text[: span.start] + by + self._text[span.end :])

    def _replaced(self, change: Span, text: str) -> LineIndex:
        # A \r before the change, or a \n behind it, may be half of a line end that the change makes or breaks.
        first = bisect_left(self._starts, change.start) - 1
        last = bisect_right(self._starts, change.end)
        by = len(text) - len(self._text)
        end = self._starts[last] + by if last < len(self._starts) else len(text)
        begin = self._starts[max(first, 0)]
        after = LineIndex("")
        after._text = text
        between = [match.end() for match in LINE_END.finditer(text, begin, end)]
        after._starts = [*self._starts[: max(first, 0) + 1], *between]
        if last < len(self._starts):
            after._starts[-1:] = [start + by for start in self._starts[last:]]
        return after

    @property
    def text(self) -> str:
        return self._text

    @property
    def line_count(self) -> int:
        return len(self._starts)

    def line(self, line: int) -> str:
        """The text of a line, without its line end."""
        start = self._starts[line]
        end = self._starts[line + 1] if line + 1 < len(self._starts) else len(self._text)
        return self._text[start:end].rstrip("\r\n")

    def position(self, offset: int, encoding: Encoding = "code-points") -> Position:
        """The position of an offset, its column counted in `encoding`; an offset outside the text is clamped."""
        offset = max(0, min(offset, len(self._text)))
        line = bisect_right(self._starts, offset) - 1
        start = self._starts[line]
        if self._text.isascii():  # Python knows that of a text without looking at it
            return Position(line, offset - start)
        return Position(line, _width(self._text[start:offset], encoding))

    def ends(self, span: Span, encoding: Encoding = "code-points") -> tuple[Position, Position]:
        """The positions of both ends of a span; nearly all begin and end in one line."""
        start, end = span
        if self._text.isascii() and 0 <= start <= end <= len(self._text):
            line = bisect_right(self._starts, start)
            if line == len(self._starts) or end < self._starts[line]:
                begin = self._starts[line - 1]
                return Position(line - 1, start - begin), Position(line - 1, end - begin)
        return self.position(start, encoding), self.position(end, encoding)

    def offset(self, position: Position, encoding: Encoding = "code-points") -> int:
        """The offset of a position; what lies beyond a line or the text is clamped to its end, as LSP asks."""
        if position.line < 0:
            return 0
        if position.line >= len(self._starts):
            return len(self._text)
        text = self.line(position.line)
        column = max(0, position.column)
        if encoding != "code-points" and not text.isascii():
            return self._starts[position.line] + _index(text, column, encoding)
        return self._starts[position.line] + min(column, len(text))


def _width(text: str, encoding: Encoding) -> int:
    if encoding == "code-points" or text.isascii():
        return len(text)
    if encoding == "utf-8":
        return len(text.encode("utf-8", "surrogatepass"))
    return len(text) + sum(character > "\uffff" for character in text)


def _index(text: str, column: int, encoding: Encoding) -> int:
    width = 0
    for index, character in enumerate(text):
        if width >= column:
            return index
        width += _width(character, encoding)
    return len(text)
