"""Comparisons for a pull request: Markdown as GitHub and GitLab read it.

One invariant: text of a mission is never markup: names and values are in code spans.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from btq_lang.diff.changes import TITLES, Change, section
from btq_lang.diff.comparison import MissionComparison
from btq_lang.diff.wording import headline, lines, summary


def render(comparisons: Iterable[MissionComparison]) -> Iterator[str]:
    """The lines of the document."""
    comparisons = tuple(each for each in comparisons if each.changes)
    if not comparisons:
        yield "The missions are the same."
    for number, comparison in enumerate(comparisons):
        if number:
            yield ""
        yield f"### {code(comparison.title)}"
        yield ""
        yield f"{summary(comparison.changes)}."
        for thing, title in TITLES.items():
            changes = [change for change in comparison.changes if section(change) == thing]
            if changes:
                yield ""
                yield f"#### {title}"
                yield ""
                for change in changes:
                    yield from _change(comparison, change)


def code(text: str) -> str:
    """A code span for a text, whatever is in it (CommonMark 6.1)."""
    ticks = "`" * (max(map(len, re.findall("`+", text)), default=0) + 1)
    blank = " " if text.startswith("`") or text.endswith("`") else ""
    return f"{ticks}{blank}{text}{blank}{ticks}"


def _change(comparison: MissionComparison, change: Change) -> Iterator[str]:
    thing, name, happened = headline(change, code)
    what, _, more = happened.partition(" ")
    parts = [thing, code(name) if name else "", f"**{what}**", more, f"({code(comparison.line(change))})"]
    yield f"- {' '.join(word for word in parts if word)}"
    for sign, text in lines(change):
        yield f"  - {_WORDS[sign]}{code(text)}"


_WORDS = {"+": "added ", "-": "removed ", "~": ""}
