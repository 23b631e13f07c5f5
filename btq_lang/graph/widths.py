"""Estimates the width of a text without a font: it needs no other program, and is the same everywhere.

One invariant: the estimate is at least what the usual sans-serif fonts need.  The table has the advance widths of
DejaVu Sans, the widest of the fonts that browsers use for `sans-serif`, in thousandths of the font's size, rounded up.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final


@lru_cache(maxsize=4096)  # many boxes have the same kinds and clauses
def width(text: str, size: int, bold: bool = False) -> int:
    """The width of a line, in the unit of `size`, the font size."""
    total = sum(_width(character) for character in text)
    return -(-total * size * (_BOLD if bold else 100) // 100_000)


def wrapped(text: str, size: int, room: int, most: int) -> tuple[str, ...]:
    """A text in lines of at most `room`, broken at blanks, but not between a number and its unit; `…` if it needs more
    than `most` lines.  Runs of blanks become one.
    """
    lines: list[str] = []
    for word in _NUMBER.sub("\u00a0", " ".join(text.split())).split(" "):
        if lines and width(f"{lines[-1]} {word}", size) <= room:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    if len(lines) > most:
        lines = [*lines[: most - 1], f"{lines[most - 1]} …"]
    return tuple(shortened(line, size, room).replace("\u00a0", " ") for line in lines)


def shortened(text: str, size: int, room: int) -> str:
    """A line, cut off with `…` if it is wider than `room`."""
    if width(text, size) <= room:
        return text
    text = text.removesuffix(" …")
    while text and width(f"{text}…", size) > room:
        text = text[:-1]
    return f"{text.rstrip()}…"


@lru_cache(maxsize=1024)
def _width(character: str) -> int:
    size = _WIDTHS.get(character)
    if size is not None:
        return size
    from unicodedata import category, east_asian_width

    if east_asian_width(character) in "WF":
        return 1100
    return 0 if category(character) in ("Mn", "Me", "Cf") else 850


_BY_WIDTH: Final = {
    280: "'ijl",
    320: " .,",
    340: ":;/\\|",
    365: "-f",
    400: "()I[]Jt!",
    415: "r",
    460: '"',
    530: "*_`s?z",
    555: "cL",
    595: "kvxyFT",
    620: "aeoPY",
    640: "bdghnpquESZ0123456789{}$",
    690: "ABKVXCR",
    790: "DGHNOQU&",
    840: "+<=>~#w^→⇉",
    870: "M",
    1000: "mW%@…—",
}
_WIDTHS: Final = {character: size for size, characters in _BY_WIDTH.items() for character in characters}
_NUMBER: Final = re.compile(r"(?<=\d) (?=\S+)")
_BOLD: Final = 114  # percent of the regular font's width
