"""A prediction in Markdown, for a comment on a pull request."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.prediction.report import WORST_FIRST, Prediction
from btq_lang.prediction.sentences import cause, heading, result, summary
from btq_lang.render.gfm import code, escaped, table


def render(prediction: Prediction, colour: bool = False) -> str:
    """The table, with what ran above it and how runs ended below it."""
    return "\n".join(_lines(prediction)) + "\n"


def _lines(prediction: Prediction) -> Iterator[str]:
    words = [requirement.word for requirement in prediction.requirements]
    counts = [f"{words.count(word)} {word}" for word in WORST_FIRST if word in words]
    yield f"### {escaped(prediction.tree)}: {', '.join(counts) or 'no requirement to judge'}"
    yield from ("", escaped(heading(prediction)), "")
    clauses = [(requirement, clause) for requirement in prediction.requirements for clause in requirement.clauses]
    clauses.sort(key=lambda pair: WORST_FIRST.index(pair[1].word))
    rows = [
        (
            f"**{clause.word}**" if clause.word == WORST_FIRST[0] else clause.word,
            "<br>".join(filter(None, (f"**{escaped(requirement.id)}**", escaped(requirement.title)))),
            "<br>".join(code(text) for text in (clause.text, clause.path) if text),
            "<br>".join(map(escaped, filter(None, (result(clause, requirement.id, prediction.runs), cause(clause))))),
        )
        for requirement, clause in clauses
    ]
    yield from table(("Prediction", "Requirement", "Clause", "Result"), rows)
    for line in summary(prediction):
        yield from ("", escaped(line))
