"""What changed in Markdown, for a comment on a pull request."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.evidence.compare.lines import BY_CHANCE, DifferenceLine, by_chance, certain, heading, remarks
from btq_lang.evidence.compare.model import RunComparison
from btq_lang.render.gfm import code, escaped, table


def render(found: Sequence[RunComparison], by: str, sides: tuple[str, str]) -> str:
    """The comparisons of all missions."""
    return "\n\n".join("\n".join(_lines(each, sides)) for each in found) + "\n"


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
            f"**{each.finding}**" if each.is_worse else each.finding,
            code(each.name),
            "<br>".join(escaped(text) for text in (each.text, each.more) if text),
        )
        for each in lines
    ]
    yield from table(("Finding", "Of", "Change"), rows)
