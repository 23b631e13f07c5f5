"""Which part of a text was made of which part of another, to show on the other what was found in the first.

One invariant: pieces are in order and do not overlap in the text that was made.  It knows offsets only.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

from btq_lang.util.text import Span

if TYPE_CHECKING:
    # Start and end in the text that was made, start and end in the one it was made of.
    Piece: TypeAlias = tuple[int, int, int, int]


class Places:
    """Pieces of a text that was made, each with what it was made of; found when they are first asked for, for most
    files have nothing wrong with them.

    Args:
        marks, lines: whatever `located` makes the pieces of.
    """

    def __init__(
        self,
        marks: Sequence[Any] = (),
        lines: Sequence[str] = (),
        located: Callable[[Sequence[Any], Sequence[str]], Sequence[Piece]] | None = None,
    ) -> None:
        self._marks = marks
        self._lines = lines
        self._located = located

    @cached_property
    def pieces(self) -> Sequence[Piece]:
        """In the order of the text that was made; they do not overlap in it."""
        return self._located(self._marks, self._lines) if self._located else ()

    def made(self, offset: int) -> int | None:
        """Where in the text that was made an offset of the original is: in the shortest piece around it, or that ends
        there; None: nothing was made of what stands there."""
        around = [piece for piece in self.pieces if piece[2] <= offset <= piece[3]]
        if not around:
            return None
        start, end, original_start, original_end = min(around, key=lambda piece: (piece[3] - piece[2], -piece[2]))
        return start + offset - original_start if end - start == original_end - original_start else start

    def __reduce__(self) -> tuple[object, ...]:
        return Places, (self.pieces, (), _as_they_are)

    def origin(self, span: Span) -> Span:
        """The span of the original that a span stands for: from the first piece in it to the last.

        A part of a piece is a part of the original, if both are as long; a span that meets no piece stands for the
        nearest one before it, or the start.
        """
        pieces = self.pieces
        first = bisect_right(pieces, span.start, key=_end)
        if first < len(pieces) and pieces[first][0] == pieces[first][1] == span.start:
            return Span(*pieces[first][2:])
        last = bisect_left(pieces, max(span.end, span.start + 1), key=_begin) - 1
        if last < first:
            before = max(first - 1, 0)
            return Span(*pieces[before][2:]) if pieces else Span(0, 0)
        start = _within(pieces[first], max(span.start, pieces[first][0]))
        end = _within(pieces[last], min(span.end, pieces[last][1]), at_end=True)
        if end < start:  # attributes stand in another order than in the original
            return Span(*pieces[first][2:])
        return Span(start, end)


def _as_they_are(pieces: Sequence[Piece], _: Sequence[str]) -> Sequence[Piece]:
    return pieces


def _within(piece: Piece, at: int, at_end: bool = False) -> int:
    """Where an offset in a piece is in the original."""
    start, end, original_start, original_end = piece
    if end - start == original_end - original_start:
        return original_start + at - start
    return original_end if at_end else original_start


def _begin(piece: Piece) -> int:
    return piece[0]


def _end(piece: Piece) -> int:
    return piece[1]
