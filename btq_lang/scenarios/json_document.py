"""Results for programs: a document that `scenarios.schema.json` describes."""

from __future__ import annotations

import json
from typing import Any, Final

from btq_lang.scenarios.results import ExpectationResult, ScenarioReport, ScenarioResult
from btq_lang.util.record import as_dict

FORMAT: Final = "btq-scenarios"
VERSION: Final = 1


def render(report: ScenarioReport, colour: bool = False) -> str:
    """Write the report as JSON, which has no colours."""
    document = {"format": FORMAT, "version": VERSION, "scenarios": [_scenario(each) for each in report.scenarios]}
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _scenario(scenario: ScenarioResult) -> dict[str, Any]:
    return {**as_dict(scenario), "expectations": [_expectation(each) for each in scenario.expectations]}


def _expectation(expectation: ExpectationResult) -> dict[str, Any]:
    step = expectation.step
    return {**as_dict(expectation), "step": as_dict(step) if step is not None else None}
