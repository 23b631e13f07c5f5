"""The needs.json of sphinx-needs, which its `needimport` and `needs_external_needs` read, and `btq check` too.

A requirement is a need of type `req`, a hazard one of type `hazard`.  The content of a requirement is a list of its
clauses and of the scenarios that verify it, its tags are its qualities, its links what it refines and mitigates, and
its status is the worst verdict.
"""

from __future__ import annotations

import json

from btq_lang.trace.overview import HazardRow, Overview, RequirementRow
from btq_lang.trace.wording import shown_scenario
from btq_lang.util.version import __version__


def render(overview: Overview) -> str:
    """The requirements as needs of the only version, in their order."""
    needs = {requirement.name: _need(requirement) for requirement in overview.requirements}
    needs |= {hazard.name: _hazard(hazard) for hazard in overview.hazards}
    version = {"creator": {"program": "btq", "version": __version__}, "needs": needs, "needs_amount": len(needs)}
    return json.dumps({"current_version": "", "project": "btq", "versions": {"": version}}, indent=1) + "\n"


def _need(requirement: RequirementRow) -> dict[str, object]:
    scenarios = (f"* ``{shown_scenario(each)}``, {each.at}" for each in requirement.scenarios)
    return {
        "id": requirement.name,
        "type": "req",
        "title": requirement.title or requirement.name,
        "content": "\n".join((*(f"* ``{clause}``" for clause in requirement.clauses), *scenarios)),
        "status": requirement.verdict,
        "tags": [requirement.quality, *requirement.further_qualities] if requirement.quality is not None else [],
        "links": [*requirement.refines, *requirement.mitigates],
        "docname": requirement.at.path,
        "lineno": requirement.at.line,
    }


def _hazard(hazard: HazardRow) -> dict[str, object]:
    texts = [f"severity {hazard.severity}"] if hazard.severity else []
    return {
        "id": hazard.name,
        "type": "hazard",
        "title": hazard.title or hazard.name,
        "content": "\n".join(f"* {text}" for text in (*texts, *hazard.sources, *hazard.reasons)),
        "status": None,
        "tags": [],
        "links": [],
        "docname": hazard.at.path,
        "lineno": hazard.at.line,
    }
