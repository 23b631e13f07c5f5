"""A prediction for people at a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.prediction.report import WORST_FIRST, Prediction, Word
from btq_lang.prediction.sentences import cause, clause_text, heading, result, summary
from btq_lang.render.cells import cells_of, printable
from btq_lang.render.colour import painter


def render(prediction: Prediction, colour: bool = False) -> str:
    """A line for each clause, the worst first."""
    return "".join(f"{line}\n" for line in _lines(prediction, colour))


def _lines(prediction: Prediction, colour: bool) -> Iterator[str]:
    paint = painter(colour)
    yield printable(heading(prediction))
    yield ""
    rows: list[tuple[Word, list[str]]] = []
    for requirement in sorted(prediction.requirements, key=lambda each: WORST_FIRST.index(each.word)):
        name = requirement.id
        for clause in sorted(requirement.clauses, key=lambda each: WORST_FIRST.index(each.word)):
            texts = (
                name,
                clause_text(clause, requirement),
                result(clause, requirement.id, prediction.runs),
                cause(clause),
            )
            rows.append((clause.word, [printable(text) for text in texts]))
            name = ""  # shown once
    widths = [max((cells_of(row[column]) for _, row in rows), default=0) for column in range(4)]
    for word, row in rows:
        cells = "  ".join(text + " " * (width - cells_of(text)) for text, width in zip(row, widths, strict=True))
        yield f"  {paint(WORD_STYLES[word], word.ljust(_WIDE))}  {cells}".rstrip()
    if not rows:
        yield "  no requirement to judge"
    yield ""
    yield from map(printable, summary(prediction))


WORD_STYLES: Final = {
    "will miss": "error",
    "unknown": "info",
    "too close to say": "warning",
    "never run": "warning",
    "will hold": "hint",
}
_WIDE: Final = max(map(len, WORST_FIRST))
