"""A prediction for programs: a document that `simulate.schema.json` describes."""

from __future__ import annotations

import json
from typing import Any, Final

from btq_lang.prediction.report import PredictedClause, PredictedRequirement, Prediction
from btq_lang.util.record import as_dict
from btq_lang.workspace.loader import shown

FORMAT: Final = "btq-prediction"
VERSION: Final = 1


def render(prediction: Prediction, colour: bool = False) -> str:
    """Write the prediction as JSON, which has no colours."""
    document: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        **as_dict(prediction),
        "file": shown(prediction.file),
        "sources": [as_dict(each) for each in prediction.sources],
        "ends": [as_dict(each) for each in prediction.ends],
        "guessed": [{"path": path, "runs": number} for path, number in prediction.guessed],
        "requirements": [*map(_requirement, prediction.requirements)],
    }
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _requirement(requirement: PredictedRequirement) -> dict[str, Any]:
    return {**as_dict(requirement), "clauses": [*map(_clause, requirement.clauses)]}


def _clause(clause: PredictedClause) -> dict[str, Any]:
    return {**as_dict(clause), "cause": as_dict(clause.cause) if clause.cause is not None else None}
