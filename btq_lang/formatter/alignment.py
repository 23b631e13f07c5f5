"""Keeps trailing comments on consecutive lines aligned if they were.

One invariant: aligning again changes nothing, because the column is always two blanks after the longest code of the
lines.
"""

from __future__ import annotations

from collections.abc import Iterable

from btq_lang.formatter.layout import PhysicalLine
from btq_lang.util.text import LineIndex


def align(old: str, rows: Iterable[PhysicalLine]) -> None:
    """Align the comments of rows that follow each other with those that were in the same column of the old text."""
    lines = LineIndex(old)
    run: list[PhysicalLine] = []
    shared = -1  # the column of its comments
    for row in (*rows, PhysicalLine("")):
        column = _column(old, row.at, lines.position(row.at).column) if row.comment else -1
        if column != shared or "\n" in row.code or any("\n" in above.comment for above in run[-1:]):
            ends = [len(aligned.code) - aligned.code.rfind("\n") for aligned in run]
            for aligned, end in zip(run, ends, strict=True):
                aligned.code += " " * (max(ends) - end)
            run, shared = [], column
        if row.comment:
            run.append(row)


def _column(text: str, offset: int, length: int) -> int:
    """The column of a place `length` after the start of its line; a tab goes to the next multiple of four columns, as
    for comment lines.
    """
    return len(text[offset - length : offset].lstrip("\ufeff").expandtabs(4))
