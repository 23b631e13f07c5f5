"""Text, spans and edits: the units of all other modules.

One invariant: an offset is an index into a Python string.  Lines and columns exist only at the edges (a terminal, an
editor), and only `LineIndex` converts between them, in the encoding that the reader requests.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import accumulate, compress, count
from operator import ne
from typing import Literal, NamedTuple, Protocol, TypeAlias, TypeVar

from btq_lang.util.record import Record

T = TypeVar("T")
Encoding: TypeAlias = "Literal['code-points', 'utf-8', 'utf-16']"

# Only these end a line: str.splitlines would also cut at form feeds and U+2028.
LINE_END = re.compile(r"\r\n|\n|\r")


class Span(NamedTuple):
    """A half-open range of offsets."""

    start: int
    end: int

    def shifted(self, by: int) -> Span:
        start, end = self
        return Span(start + by, end + by)

    def contains(self, other: Span) -> bool:
        return self.start <= other.start and other.end <= self.end

    def touches(self, other: Span) -> bool:
        """Whether they overlap or one ends where the other begins."""
        return self.start <= other.end and other.start <= self.end


class Placed(Protocol):
    """An object with a span, such as a part of a tree."""

    @property
    def start(self) -> int: ...
    @property
    def end(self) -> int: ...


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
    copied = 0
    for edit in sorted(edits, key=lambda edit: edit.span):
        if edit.span.start < copied:
            raise ValueError(f"edits overlap at offset {edit.span.start}")
        pieces += (text[copied : edit.span.start], edit.text)
        copied = edit.span.end
    return "".join([*pieces, text[copied:]])


def alike(first: Sequence[T], second: Sequence[T]) -> int:
    """The length of the common prefix."""
    return next(compress(count(), map(ne, first, second)), min(len(first), len(second)))


def changed(before: str, after: str) -> Span | None:
    """The part of a text that an edit replaced, without a common prefix and suffix; None if the texts are equal."""
    if before == after:
        return None
    shorter = min(len(before), len(after))
    # One of the two is compared in place: copying takes most of the time for a large text.
    start = _same(lambda low, high: after.startswith(before[low:high], low), shorter)
    size, new_size = len(before), len(after)
    ending = _same(lambda low, high: after.endswith(before[size - high : size - low], 0, new_size - low), shorter)
    return Span(start, size - min(ending, shorter - start))


def _same(is_same: Callable[[int, int], bool], size: int) -> int:
    """The length of a common prefix or suffix, found by bisection."""
    low, high = 0, size
    while low < high:
        middle = (low + high + 1) // 2
        if is_same(low, middle):
            low = middle
        else:
            high = middle - 1
    return low


class LineIndex:
    """The index of the lines of a text; converts offsets to positions and back.

    After an edit of a large text most lines are merely shifted; the shift is kept separately and added on look-up,
    because an author types in one place.
    """

    __slots__ = ("_by", "_moved", "_starts", "_text")

    def __init__(self, text: str) -> None:
        self._text = text
        self._starts = [0, *_line_starts(text)]
        self._moved = 0  # from this line on, all begin later than in `_starts`
        self._by = 0  # by this much

    def edited(self, text: str, change: Span | None = None) -> LineIndex:
        """The index of the text after an edit; the lines before and after the change are not searched again.

        Args:
            change: the result of `changed` for the two texts, if known.
        """
        change = change or changed(self._text, text)
        return self if change is None else self._replaced(change, text)

    def replaced(self, span: Span, by: str) -> LineIndex:
        """The index of the text with `span` replaced."""
        return self._replaced(span, self._text[: span.start] + by + self._text[span.end :])

    def _replaced(self, change: Span, text: str) -> LineIndex:
        # A \r before the change, or a \n after it, may be half of a line end that the change creates or splits.
        first = max(self._line_of(change.start - 1), 0)
        last = self._line_of(change.end) + 1
        is_end = last == len(self._starts)
        by = len(text) - len(self._text)
        end = len(text) if is_end else self._start(last) + by
        between = [self._start(first) + start for start in _line_starts(text[self._start(first) : end])]
        if not is_end:
            between.pop()  # the line after it exists already
        after = LineIndex("")
        after._text = text
        after._starts = self._moved_from(last)
        after._starts[first + 1 : last] = between
        after._moved = first + 1 + len(between)
        after._by = self._by + by
        return after

    def _moved_from(self, line: int) -> list[int]:
        """`_starts`, if this were the line from which all are shifted."""
        starts, by = self._starts[:], self._by
        low, high = sorted((self._moved, line))
        if by:
            by = by if low < line else -by
            starts[low:high] = [start + by for start in starts[low:high]]
        return starts

    def _start(self, line: int) -> int:
        return self._starts[line] + self._by if line >= self._moved else self._starts[line]

    def _line_of(self, offset: int) -> int:
        """The line of an offset; -1 before the first one."""
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
        if self._text.isascii():  # a flag of the string: takes no time
            return Position(line, offset - start)
        return Position(line, width_of(self._text[start:offset], encoding))

    def ends(self, span: Span, encoding: Encoding = "code-points") -> tuple[int, int, int, int]:
        """Line and column of both ends of a span; fast if both are in one line, as nearly always."""
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
        """The line of an offset, and the text before it on that line."""
        line = self._line_of(offset)
        return line, self._text[self._start(line) : offset]

    def offset(self, position: Position, encoding: Encoding = "code-points") -> int:
        """The offset of a position; beyond a line or the text it is clamped to the end, as LSP demands."""
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
    """The starts of the lines of a text, except the first; each character of a line end counts."""
    if "\r" in text:
        text = text.replace("\r\n", " \n").replace("\r", "\n")
    *lines, _ = text.split("\n")
    return accumulate([len(line) + 1 for line in lines])


def counted(number: int, one: str, several: str = "") -> str:
    """`1 node`, `2 nodes`; `several` for a plural that does not end in `s`."""
    return f"{number} {one if number == 1 else several or one + 's'}"


def width_of(text: str, encoding: Encoding) -> int:
    """The number of columns of a text: code points, or code units in UTF-8 or UTF-16."""
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
