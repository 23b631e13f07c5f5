"""Pieces of GitHub's Markdown (https://github.github.com/gfm/), in which a cell of a table is one line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence


def table(heading: Sequence[str], rows: Iterable[Sequence[str]], numbers_from: int = 99) -> Iterator[str]:
    """The lines of a table.

    Args:
        numbers_from: the columns from this one on are set to the right.
    """
    yield f"| {' | '.join(heading)} |"
    yield "|" + "|".join("---:" if at >= numbers_from else "---" for at in range(len(heading))) + "|"
    for row in rows:
        yield f"| {' | '.join(row)} |"


def code(text: str) -> str:
    """A code span in a table: a bar would end the cell, and backticks need more of them around."""
    text = " ".join(text.split()).replace("|", "\\|")
    ticks = "`"
    while ticks in text:
        ticks += "`"
    return f"{ticks} {text} {ticks}" if len(ticks) > 1 else f"`{text}`"


def escaped(text: str) -> str:
    """A text as it is, on one line, whatever Markdown and GitHub would read in it."""
    found = "".join(f"\\{character}" if character in "\\`*_[]|~" else character for character in " ".join(text.split()))
    return found.replace("&", "&amp;").replace("<", "&lt;").replace("@", "&#64;")
