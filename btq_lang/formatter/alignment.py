"""Keeps trailing comments on consecutive lines aligned if they were.

One invariant: aligning again changes nothing, because the column is always two blanks after the longest code of the
lines.
"""

from __future__ import annotations

from collections.abc import Sequence

from btq_lang.util.record import Record
from btq_lang.util.text import LineIndex


class Gap(Record):
    """The blanks between code and the comments after it.

    Attributes:
        at: where they begin in the new text, whose line ends are `\n`.
        comment: where the first comment begins in the old text.
    """

    at: int
    comment: int


def paddings(old: str, new: str, gaps: Sequence[Gap]) -> list[int]:
    """How many more blanks each gap needs; the gaps are in the order of the new text, one a line at most."""
    found = [0] * len(gaps)
    lines = LineIndex(old)
    columns = [_column(old, gap.comment, lines.position(gap.comment).column) for gap in gaps]
    ends = [gap.at - new.rfind("\n", 0, gap.at) for gap in gaps]
    first = 0  # of the gaps aligned with the current one
    for index in range(1, len(gaps) + 1):
        if (
            index < len(gaps)
            and columns[index] == columns[first]
            and new.count("\n", gaps[index - 1].at, gaps[index].at) == 1
        ):
            continue
        longest = max(ends[first:index])
        found[first:index] = [longest - end for end in ends[first:index]]
        first = index
    return found


def _column(text: str, at: int, length: int) -> int:
    """The column of a place `length` after the start of its line; a tab goes to the next multiple of four columns, as
    for comment lines.
    """
    return len(text[at - length : at].lstrip("\ufeff").expandtabs(4))
