"""A prediction as a page: each demand with its share as a bar, and how runs ended."""

from __future__ import annotations

from btq_lang.prediction.report import WORST_FIRST, Prediction
from btq_lang.prediction.sentences import cause, heading, result, summary
from btq_lang.render.pages import page


def render(prediction: Prediction, colour: bool = False) -> str:
    """The page, which always has colours."""
    rows = [
        {
            "word": clause.word,
            "style": _STYLES[clause.word],
            "id": requirement.id,
            "title": requirement.title,
            "clause": clause.text,
            "path": clause.path,
            "share": "" if clause.share is None else f"{clause.share * 100:.4g}",
            "result": result(clause, requirement.id, prediction.runs),
            "cause": cause(clause),
        }
        for requirement in prediction.requirements
        for clause in requirement.clauses
    ]
    rows.sort(key=lambda row: WORST_FIRST.index(row["word"]))
    sources = [(each.path, each.source) for each in prediction.sources]
    return page(
        "prediction/page.html.j2",
        title=f"{prediction.tree}: prediction",
        heading=heading(prediction),
        rows=rows,
        summary=[*summary(prediction)],
        sources=sources,
    )


_STYLES = {
    "will miss": "violated",
    "unknown": "unknown",
    "too close to say": "undecided",
    "never run": "never-exercised",
    "will hold": "satisfied",
}
