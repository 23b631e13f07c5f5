"""What changed in Markdown, for a comment on a pull request."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.evidence.compare.lines import BY_CHANCE, DifferenceLine, by_chance, certain, heading, remarks
from btq_lang.evidence.compare.model import RunComparison
from btq_lang.render.gfm import code, escaped, table


def render(comparisons: Sequence[RunComparison], by: str, sides: tuple[str, str]) -> str:
    """The comparisons of all missions."""
    return "\n\n".join("\n".join(_lines(comparison, sides)) for comparison in comparisons) + "\n"


def _lines(comparison: RunComparison, sides: tuple[str, str]) -> Iterator[str]:
    yield f"### {escaped(heading(comparison, sides))}"
    yield ""
    if changes := certain(comparison):
        yield from _table(changes)
        yield ""
    if quiet := by_chance(comparison):
        yield from (f"<details><summary>{BY_CHANCE.capitalize()}</summary>", "", *_table(quiet), "", "</details>", "")
    yield from (f"* {escaped(line)}" for line in remarks(comparison, sides))


def _table(lines: Sequence[DifferenceLine]) -> Iterator[str]:
    rows = [
        (
            f"**{line.finding}**" if line.is_worse else line.finding,
            code(line.name),
            "<br>".join(escaped(text) for text in (line.text, line.more) if text),
        )
        for line in lines
    ]
    yield from table(("Finding", "Of", "Change"), rows)
