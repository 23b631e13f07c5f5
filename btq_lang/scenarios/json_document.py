"""Results for programs: a document that `scenarios.schema.json` describes."""

from __future__ import annotations

import json
from typing import Any, Final

from btq_lang.scenarios.results import (
    CoverageReport,
    ExpectationResult,
    MutantResult,
    OutcomePlace,
    ScenarioReport,
    ScenarioResult,
)
from btq_lang.util.record import as_dict

FORMAT: Final = "btq-scenarios"
VERSION: Final = 1


def render(report: ScenarioReport, colour: bool = False) -> str:
    """Write the report as JSON, which has no colours."""
    document: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "scenarios": [_scenario(each) for each in report.scenarios],
    }
    if report.engine:
        document["engine"] = report.engine
    if report.coverage is not None:
        document["coverage"] = coverage_as_data(report.coverage)
    if report.mutants is not None:
        document["mutants"] = {"number": report.mutants.number, "mutants": [*map(_mutant, report.mutants.mutants)]}
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def coverage_as_data(report: CoverageReport) -> dict[str, Any]:
    """What scenarios have met, as in the document."""
    return {
        "nodes": [
            {**as_dict(node.place), "outcomes": [as_dict(each) for each in node.outcomes]} for node in report.nodes
        ],
        "unused": [{**_without_node(place), "tree": place.node} for place in report.unused],
    }


def _scenario(scenario: ScenarioResult) -> dict[str, Any]:
    return {**as_dict(scenario), "expectations": [_expectation(each) for each in scenario.expectations]}


def _mutant(mutant: MutantResult) -> dict[str, Any]:
    what = {"what": mutant.what, "reached": mutant.is_reached, "noticed_by": mutant.noticed_by or None}
    return {**as_dict(mutant.place), **what}


def _without_node(place: OutcomePlace) -> dict[str, Any]:
    return {field: value for field, value in as_dict(place).items() if field != "node"}


def _expectation(expectation: ExpectationResult) -> dict[str, Any]:
    step = expectation.step
    return {**as_dict(expectation), "step": as_dict(step) if step is not None else None}
