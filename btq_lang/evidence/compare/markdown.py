"""What changed in Markdown, for a comment on a pull request."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.evidence.compare.comparison import WORSE, Comparison
from btq_lang.evidence.compare.words import difference, heading, remarks, subject, turn
from btq_lang.render.gfm import code, escaped, table


def render(found: Sequence[Comparison], by: str, sides: tuple[str, str]) -> str:
    """The comparisons of all missions."""
    return "\n\n".join("\n".join(_lines(each, sides)) for each in found) + "\n"


def _lines(comparison: Comparison, sides: tuple[str, str]) -> Iterator[str]:
    yield f"### {escaped(heading(comparison, sides))}"
    yield ""
    rows = [("**newly violated**", code(each.id), escaped(turn(each))) for each in comparison.newly]
    for change in sorted(comparison.changes, key=lambda each: each.finding not in WORSE):
        if change.finding:
            word = f"**{change.finding}**" if change.finding in WORSE else change.finding
            rows.append((word, code(subject(change)), escaped(difference(change))))
    rows += [("no longer violated", code(each.id), escaped(turn(each))) for each in comparison.no_longer]
    if rows:
        yield from table(("Finding", "Of", "Change"), rows)
        yield ""
    yield from (f"* {escaped(line)}" for line in remarks(comparison, sides))
