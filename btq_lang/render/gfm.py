"""Tables and text in GitHub's Markdown (https://github.github.com/gfm/), in which a table cell is one line.

They are apart from any writer: the overview, reports of verdicts and hovers share them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence


def table(heading: Sequence[str], rows: Iterable[Sequence[str]], numbers_from: int = 99) -> Iterator[str]:
    """The lines of a table; columns from `numbers_from` on are right-aligned."""
    yield f"| {' | '.join(heading)} |"
    yield "|" + "|".join("---:" if column >= numbers_from else "---" for column in range(len(heading))) + "|"
    for row in rows:
        yield f"| {' | '.join(row)} |"


def code(text: str) -> str:
    """A code span in a table: escapes bars, which would end the cell, and encloses backticks in more of them."""
    text = " ".join(text.split()).replace("|", "\\|")
    ticks = "`"
    while ticks in text:
        ticks += "`"
    return f"{ticks} {text} {ticks}" if len(ticks) > 1 else f"`{text}`"


def escaped(text: str) -> str:
    """A text, on one line, escaped so that Markdown and GitHub show it verbatim."""
    text = " ".join(text.split())
    marked = "".join(f"\\{character}" if character in "\\`*_[]|~" else character for character in text)
    return marked.replace("&", "&amp;").replace("<", "&lt;").replace("@", "&#64;")
