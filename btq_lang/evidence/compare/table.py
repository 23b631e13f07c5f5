"""What changed, for people at a terminal, then what may be chance."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from btq_lang.evidence.compare.lines import BY_CHANCE, DifferenceLine, by_chance, certain, heading, remarks
from btq_lang.evidence.compare.model import RunComparison
from btq_lang.render.cells import cells_of, printable


def render(comparisons: Sequence[RunComparison], by: str, sides: tuple[str, str]) -> str:
    """The comparisons of all missions."""
    return "\n".join(
        "".join(f"{printable(line)}\n" for line in _lines(comparison, sides)) for comparison in comparisons
    )


def _lines(comparison: RunComparison, sides: tuple[str, str]) -> Iterator[str]:
    yield heading(comparison, sides)
    if changes := certain(comparison):
        yield from ("", *_columns(changes))
    if quiet := by_chance(comparison):
        yield from ("", f"{BY_CHANCE}:", *_columns(quiet))
    if notes := [*remarks(comparison, sides)]:
        yield from ("", *notes)


def _columns(lines: Sequence[DifferenceLine]) -> Iterator[str]:
    """The lines, with what belongs to each below it."""
    finding_width = max(cells_of(line.finding) for line in lines)
    name_width = max((width for line in lines if (width := cells_of(line.name)) <= _WIDEST), default=0)
    for line in lines:
        finding = f"{line.finding:{finding_width}}  " if finding_width else ""
        start = f"  {finding}{line.name}{' ' * (name_width - cells_of(line.name))}  "
        yield f"{start}{line.text}"
        if line.more:
            yield " " * cells_of(start) + line.more


_WIDEST: Final = 60  # cells of a name that others are aligned with
