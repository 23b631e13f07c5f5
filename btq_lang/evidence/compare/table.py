"""What changed, for people at a terminal: what is newly violated, then what got worse, then the rest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.evidence.compare.comparison import WORSE, Comparison
from btq_lang.evidence.compare.words import difference, heading, remarks, subject, turn
from btq_lang.render.cells import cells_of, printable


def render(found: Sequence[Comparison], by: str, sides: tuple[str, str]) -> str:
    """The comparisons of all missions."""
    return "\n".join("".join(f"{printable(line)}\n" for line in _lines(each, sides)) for each in found)


def _lines(comparison: Comparison, sides: tuple[str, str]) -> Iterator[str]:
    yield heading(comparison, sides)
    rows = [("newly violated", f"{each.id}  {each.title}".rstrip(), turn(each)) for each in comparison.newly]
    changes = sorted((each for each in comparison.changes if each.finding), key=lambda each: each.finding not in WORSE)
    rows += [(each.finding, subject(each), difference(each)) for each in changes]
    rows += [("no longer violated", f"{each.id}  {each.title}".rstrip(), turn(each)) for each in comparison.no_longer]
    if rows:
        yield ""
    left, middle = (max(cells_of(row[column]) for row in rows) if rows else 0 for column in (0, 1))
    for word, about, change in rows:
        blanks = " " * (middle - cells_of(about))
        yield f"  {word:{left}}  {about}{blanks}  {change}"
    if notes := [*remarks(comparison, sides)]:
        yield from ("", *notes)
