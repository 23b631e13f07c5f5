"""Maps parts of a generated text to the parts of the original, to show on the original what was found in the generated
text.

One invariant: pieces are in order and do not overlap in the generated text, and a piece that has the same length in
both is the same text.  Only offsets are known here.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import accumulate
from operator import itemgetter
from typing import TYPE_CHECKING, Any, TypeAlias

from btq_lang.util.text import Span

if TYPE_CHECKING:
    # Start and end in the generated text, start and end in the original.
    Piece: TypeAlias = tuple[int, int, int, int]


class OriginMap:
    """Pieces of a generated text, each with its origin; computed on first use, and only those of the lines that are
    asked for, because most lines have no diagnostics to map.

    Args:
        marks: from which `located` computes pieces, at least one from each; in the order of the text, each with the
            index of its line first.
        lines: of the generated text; empty if marks have no lines.
        located: computes the pieces of some marks, given these and the offsets at which lines begin.
    """

    def __init__(
        self,
        marks: Sequence[Any] = (),
        lines: Sequence[str] = (),
        located: Callable[[Sequence[Any], Sequence[int]], Sequence[Piece]] | None = None,
    ) -> None:
        self._marks = marks
        self._lines = lines
        self._located = located

    @cached_property
    def pieces(self) -> Sequence[Piece]:
        """The pieces, in the order of the generated text."""
        return self._located(self._marks, self._starts) if self._located else ()

    @cached_property
    def _starts(self) -> Sequence[int]:
        return [0, *accumulate(map(len, self._lines))]

    def _near(self, span: Span) -> Sequence[Piece]:
        """The pieces in the lines of a span of the generated text, and the last one before them."""
        if not self._lines or self._located is None:
            return self.pieces
        line = itemgetter(0)
        first = bisect_left(self._marks, bisect_right(self._starts, span.start) - 1, key=line)
        end = bisect_right(self._marks, bisect_right(self._starts, span.end) - 1, lo=first, key=line)
        return self._located(self._marks[max(first - 1, 0) : end], self._starts)

    def made(self, offset: int, exact: bool = True) -> int | None:
        """The offset in the generated text for one of the original, in the shortest piece that contains it or ends
        there; None: there is no such piece.

        Args:
            exact: only in pieces that are the same in both texts; of others the offset is their start.
        """
        around = [piece for piece in self.pieces if piece[2] <= offset <= piece[3] and (_is_same(piece) or not exact)]
        if not around:
            return None
        piece = min(around, key=lambda piece: (piece[3] - piece[2], -piece[2]))
        return piece[0] + offset - piece[2] if _is_same(piece) else piece[0]

    def containing(self, span: Span) -> Sequence[Piece]:
        """The pieces around a span of the generated text: more than one only if some are empty."""
        pieces = self._near(span)
        first = bisect_left(pieces, span.end, key=_END)
        return pieces[first : bisect_right(pieces, span.start, lo=first, key=_BEGIN)]

    def __reduce__(self) -> tuple[object, ...]:
        return OriginMap, (self.pieces, (), _as_they_are)

    def origin(self, span: Span) -> Span:
        """The span of the original for a span of the generated text: from the first piece in it to the last.

        A part of a piece maps to a part of the original if both have the same length; a span without a piece maps to
        the nearest one before it, or to the start.
        """
        pieces = self._near(span)
        first = bisect_right(pieces, span.start, key=_END)
        if first < len(pieces) and pieces[first][0] == pieces[first][1] == span.start:
            return Span(*pieces[first][2:])
        last = bisect_left(pieces, max(span.end, span.start + 1), key=_BEGIN) - 1
        if last < first:
            before = max(first - 1, 0)
            return Span(*pieces[before][2:]) if pieces else Span(0, 0)
        start = _within(pieces[first], max(span.start, pieces[first][0]))
        end = _within(pieces[last], min(span.end, pieces[last][1]), at_end=True)
        if end < start:  # attributes are in another order than in the original
            return Span(*pieces[first][2:])
        return Span(start, end)


def _as_they_are(pieces: Sequence[Piece], _: Sequence[int]) -> Sequence[Piece]:
    return pieces


def _within(piece: Piece, offset: int, at_end: bool = False) -> int:
    """The offset in the original for one in a piece."""
    if _is_same(piece):
        return piece[2] + offset - piece[0]
    return piece[3] if at_end else piece[2]


def _is_same(piece: Piece) -> bool:
    """Whether both texts have the piece: pieces that differ have different lengths."""
    start, end, original_start, original_end = piece
    return end - start == original_end - original_start


_BEGIN, _END = itemgetter(0), itemgetter(1)
