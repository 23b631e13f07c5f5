"""CSV, a line for each clause at each node that it holds for (RFC 4180, lines end with CR LF).

The columns, which later versions add to but do not change: requirement, title, mission, clause, path, word, unit, held,
counted, unknown, share, low, high, worst, worst_run, cause, result.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.prediction.report import Prediction
from btq_lang.prediction.sentences import cause, result
from btq_lang.render.spreadsheet import table
from btq_lang.workspace.loader import shown


def render(prediction: Prediction, colour: bool = False) -> str:
    """The prediction, with a heading."""
    return table(_COLUMNS, _rows(prediction))


def _rows(prediction: Prediction) -> Iterator[dict[str, str | float]]:
    for requirement in prediction.requirements:
        for clause in requirement.clauses:
            low, high = clause.interval or ("", "")
            yield {
                "requirement": requirement.id,
                "title": requirement.title,
                "mission": shown(prediction.file),
                "clause": clause.text,
                **{name: getattr(clause, name) for name in _AS_THEY_ARE},
                "share": clause.share if clause.share is not None else "",
                "low": low,
                "high": high,
                "worst": clause.worst,
                "worst_run": clause.worst_run if clause.worst_run is not None else "",
                "cause": cause(clause),
                "result": result(clause, requirement.id, prediction.runs),
            }


_AS_THEY_ARE: Final = ("path", "word", "unit", "held", "counted", "unknown")
_COLUMNS: Final = (
    *("requirement", "title", "mission", "clause", *_AS_THEY_ARE),
    *("share", "low", "high", "worst", "worst_run", "cause", "result"),
)
