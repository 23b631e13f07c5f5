"""Which part of a text was made of which part of another, to show on the other what was found in the first.

One invariant: pieces are in order and do not overlap in the text that was made.  It knows offsets only.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right

from btq_lang.text import Span

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Final


class Places:
    """Pieces, each with its start and end in the text that was made and in the one it was made of."""

    def __init__(self, pieces: Sequence[tuple[int, int, int, int]]) -> None:
        self.pieces: Final = pieces

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


def _within(piece: tuple[int, int, int, int], at: int, at_end: bool = False) -> int:
    """Where an offset in a piece is in the original."""
    start, end, original_start, original_end = piece
    if end - start == original_end - original_start:
        return original_start + at - start
    return original_end if at_end else original_start


def _begin(piece: tuple[int, int, int, int]) -> int:
    return piece[0]


def _end(piece: tuple[int, int, int, int]) -> int:
    return piece[1]
