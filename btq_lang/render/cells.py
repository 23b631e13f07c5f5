"""Characters on a terminal: which are safe to print, how many cells each takes, and columns of a table that fit it.

Invariant: the result contains no control character of the input: no escape sequence, no line end, no reordering of the
text (Trojan Source, CVE-2021-42574).  Cells are counted by code point, using Unicode's East Asian Width; emoji joined
by U+200D count as their parts, because terminals disagree on them.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from functools import lru_cache

TAB = 4

_BIDI = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
_REPLACEMENT = "\ufffd"
_NARROWEST = 8  # cells of a column


def printable(text: str) -> str:
    """The text with a visible sign (`␛`, `�`) for each character that a terminal would interpret or could not
    encode.
    """
    return text if text.isprintable() else "".join(map(_sign, text))


def cut(line: str, left: int, room: int) -> str:
    """The cells from `left` on, at most `room` of them, with `…` where text was cut off.

    A leading `…` adds one cell, before the cell `left`.
    """
    pieces, columns = laid_out(line)
    if not left and columns[-1] <= room:
        return "".join(pieces)
    first = bisect_left(columns, left)
    if first >= len(columns):
        return "…"
    last = max(first, bisect_right(columns, left + room) - 1)
    blanks = " " * (columns[first] - left)  # part of a wide character, or of a tab, was cut off
    return ("…" if left else "") + blanks + "".join(pieces[first:last]) + ("…" if last < len(pieces) else "")


@lru_cache(16)  # a frame needs a line several times, and hostile files have everything on one long line
def laid_out(line: str) -> tuple[Sequence[str], Sequence[int]]:
    """The printed form of each character of a line and the cell where it begins, and as a last cell the end of the
    line.
    """
    if line.isascii() and line.isprintable():
        return line, range(len(line) + 1)
    pieces: list[str] = []
    columns = [0]
    for character in line:
        width = TAB - columns[-1] % TAB if character == "\t" else _width(character)
        pieces.append(" " * width if character == "\t" else _sign(character))
        columns.append(columns[-1] + width)
    return pieces, columns


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
            end = _fitting(word, room)
            lines.append(word[:end])
            word = word[end:]
        lines.append(word)
    return [" " * indent + line for line in lines]


def _fitting(word: str, room: int) -> int:
    """How many characters of a word fit on a line."""
    fits = 1
    while fits < len(word) and cells_of(word[: fits + 1]) <= room:
        fits += 1
    mark_index = max(word.rfind(mark, 0, fits) for mark in ".-/")
    return mark_index + 1 if mark_index > 0 else fits


def _sign(character: str) -> str:
    if character.isprintable():
        return character
    if character < " ":
        return chr(0x2400 + ord(character))
    if character == "\x7f":
        return "␡"
    from unicodedata import category

    kind = category(character)
    # A C1 control, a lone surrogate, a line or paragraph separator, a noncharacter that XML refuses.
    if kind in ("Cc", "Cs", "Zl", "Zp") or character in _BIDI or character in "\ufffe\uffff":
        return _REPLACEMENT
    return character


def _width(character: str) -> int:
    if character.isascii():
        return 1
    from unicodedata import category, east_asian_width

    if east_asian_width(character) in "WF":
        return 2
    if _sign(character) == _REPLACEMENT or character == "\xad":
        return 1  # a soft hyphen is a format character, yet terminals print it
    # The vowels and finals of Hangul join the syllable before them.
    return 0 if category(character) in ("Mn", "Me", "Cf") or "\u1160" <= character <= "\u11ff" else 1
