"""Text, spans and edits: what every other module counts in.

One invariant: an offset is an index into a Python string.  Lines and columns exist only at the edges (a terminal, an
editor), and `LineIndex` is the only place that turns one into the other, in the unit the reader asked for.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator
from itertools import accumulate
from typing import Literal, NamedTuple, TypeAlias

from btq_lang.util.record import Record

Encoding: TypeAlias = "Literal['code-points', 'utf-8', 'utf-16']"

# A line ends with these and with nothing else: str.splitlines would also cut at form feeds and U+2028.
LINE_END = re.compile(r"\r\n|\n|\r")


class Span(NamedTuple):
    """A half-open range of offsets."""

    start: int
    end: int

    def shifted(self, by: int) -> Span:
        start, end = self
        return Span(start + by, end + by)


class Position(NamedTuple):
    """A line and a column, both counted from 0."""

    line: int
    column: int


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
    # One of the two is compared where it stands: of a large text the copies take most of the time.
    start = _same(lambda low, high: after.startswith(before[low:high], low), shorter)
    size, new_size = len(before), len(after)
    rest = _same(lambda low, high: after.endswith(before[size - high : size - low], 0, new_size - low), shorter)
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
    """Where the lines of a text begin, to turn offsets into positions and back.

    After an edit of a large text most lines only begin elsewhere; what moves them is kept beside them, and added when
    one is asked for: an author types in one place.
    """

    __slots__ = ("_by", "_moved", "_starts", "_text")

    def __init__(self, text: str) -> None:
        self._text = text
        self._starts = [0, *_line_starts(text)]
        self._moved = 0  # from this line on all begin further behind than `_starts` says,
        self._by = 0  # by this

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
        first = max(self._line_of(change.start - 1), 0)
        last = self._line_of(change.end) + 1
        is_end = last == len(self._starts)
        by = len(text) - len(self._text)
        end = len(text) if is_end else self._start(last) + by
        between = [self._start(first) + start for start in _line_starts(text[self._start(first) : end])]
        if not is_end:
            between.pop()  # behind it is the line that is there already
        after = LineIndex("")
        after._text = text
        after._starts = self._moved_from(last)
        after._starts[first + 1 : last] = between
        after._moved = first + 1 + len(between)
        after._by = self._by + by
        return after

    def _moved_from(self, line: int) -> list[int]:
        """As `_starts`, were this the line from which on all begin further behind."""
        starts, by = self._starts[:], self._by
        low, high = sorted((self._moved, line))
        if by:
            by = by if low < line else -by
            starts[low:high] = [start + by for start in starts[low:high]]
        return starts

    def _start(self, line: int) -> int:
        return self._starts[line] + self._by if line >= self._moved else self._starts[line]

    def _line_of(self, offset: int) -> int:
        """The line that an offset is in; -1 before the first one."""
        starts, moved = self._starts, self._moved
        if moved < len(starts) and starts[moved] + self._by <= offset:
            return bisect_right(starts, offset - self._by, moved) - 1
        return bisect_right(starts, offset, 0, moved) - 1

    @property
    def text(self) -> str:
        return self._text

    @property
    def line_count(self) -> int:
        return len(self._starts)

    def line(self, line: int) -> str:
        """The text of a line, without its line end."""
        end = self._start(line + 1) if line + 1 < len(self._starts) else len(self._text)
        return self._text[self._start(line) : end].rstrip("\r\n")

    def position(self, offset: int, encoding: Encoding = "code-points") -> Position:
        """The position of an offset, its column counted in `encoding`; an offset outside the text is clamped."""
        offset = max(0, min(offset, len(self._text)))
        line = self._line_of(offset)
        start = self._start(line)
        if self._text.isascii():  # Python knows that of a text without looking at it
            return Position(line, offset - start)
        return Position(line, width_of(self._text[start:offset], encoding))

    def ends(self, span: Span, encoding: Encoding = "code-points") -> tuple[int, int, int, int]:
        """Line and column of both ends of a span; nearly all begin and end in one line."""
        start, end = span
        if self._text.isascii() and 0 <= start <= end <= len(self._text):
            starts, moved, by = self._starts, self._moved, self._by
            if moved < len(starts) and starts[moved] + by <= start:
                line = bisect_right(starts, start - by, moved)
                begin = starts[line - 1] + by
            else:
                line = bisect_right(starts, start, 0, moved)
                begin = starts[line - 1]
            if line == len(starts) or end < self._start(line):
                return line - 1, start - begin, line - 1, end - begin
        return *self.position(start, encoding), *self.position(end, encoding)

    def place(self, offset: int) -> tuple[int, str]:
        """The line that an offset is in, and what stands before it there."""
        line = self._line_of(offset)
        return line, self._text[self._start(line) : offset]

    def offset(self, position: Position, encoding: Encoding = "code-points") -> int:
        """The offset of a position; what lies beyond a line or the text is clamped to its end, as LSP asks."""
        if position.line < 0:
            return 0
        if position.line >= len(self._starts):
            return len(self._text)
        text = self.line(position.line)
        column = max(0, position.column)
        if encoding != "code-points" and not text.isascii():
            return self._start(position.line) + _index(text, column, encoding)
        return self._start(position.line) + min(column, len(text))


def _line_starts(text: str) -> Iterator[int]:
    """Where the lines of a text begin, without its first; each character of a line end counts."""
    if "\r" in text:
        text = text.replace("\r\n", " \n").replace("\r", "\n")
    *lines, _ = text.split("\n")
    return accumulate([len(line) + 1 for line in lines])


def width_of(text: str, encoding: Encoding) -> int:
    """How many columns a text takes: characters, or the units that it has in UTF-8 or UTF-16."""
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
        width += width_of(character, encoding)
    return len(text)
