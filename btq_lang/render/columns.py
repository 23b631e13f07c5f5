"""Columns of a table that fits a terminal: their widths, and cells broken into lines."""

from __future__ import annotations

from typing import Final

from btq_lang.render.cells import laid_out


def cells_of(text: str) -> int:
    """How many cells a text takes."""
    return laid_out(text)[1][-1]


def narrowed(widths: list[int], room: int) -> list[int]:
    """Shrink the widest columns until all fit."""
    widths = list(widths)
    while sum(widths) > room and max(widths) > _NARROWEST:
        widths[widths.index(max(widths))] -= 1
    return widths


def broken(text: str, room: int) -> list[str]:
    """A text in lines, broken at blanks, and long words at `.`, `-`, `/` or, where there is none, anywhere; all lines
    are indented like the first.
    """
    words = text.lstrip(" ")
    indent = len(text) - len(words)
    room -= indent
    lines: list[str] = []
    for word in words.split(" "):
        if lines and cells_of(lines[-1]) + 1 + cells_of(word) <= room:
            lines[-1] += f" {word}"
            continue
        while cells_of(word) > room:
            at = _fitting(word, room)
            lines.append(word[:at])
            word = word[at:]
        lines.append(word)
    return [" " * indent + line for line in lines]


def _fitting(word: str, room: int) -> int:
    """How many characters of a word fit on a line."""
    fits = 1
    while fits < len(word) and cells_of(word[: fits + 1]) <= room:
        fits += 1
    at = max(word.rfind(mark, 0, fits) for mark in ".-/")
    return at + 1 if at > 0 else fits


_NARROWEST: Final = 8
