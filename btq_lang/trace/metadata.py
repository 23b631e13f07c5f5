"""The parts of an overview that demand nothing: hazards, and where requirements are from, what they belong to, and who
has approved them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from btq_lang.requirements.approval import ApprovalState
from btq_lang.requirements.model import ResolvedRequirement
from btq_lang.requirements.verifying import other_ways
from btq_lang.syntax.tree import Because, Hazard, HazardSeverity, Source
from btq_lang.trace.overview import ApprovalRow, At, HazardRow, RequirementRow, VerificationRow
from btq_lang.util.record import replace


def metadata_fields(
    requirement: ResolvedRequirement, approval: ApprovalState, scenarios: Sequence[VerificationRow]
) -> dict[str, Any]:
    """The fields of a requirement's row for these clauses; scenarios: those that verify it."""
    ways = other_ways(requirement, {scenario.id for scenario in scenarios})
    return {
        "sources": tuple(map(_folded, requirement.sources)),
        "refines": requirement.refines,
        "mitigates": requirement.mitigates,
        "priority": requirement.priority or "",
        "verification": (*(VerificationRow(way.method, way.id or "") for way in ways), *scenarios),
        "approvals": tuple(ApprovalRow(each.by, each.on, each.fingerprint or "") for each in requirement.approvals),
        "state": approval.state,
        "fingerprint": approval.fingerprint,
    }


def hazard_row(key: str, name: str, hazard: Hazard, location: At) -> HazardRow:
    """The row of a hazard, without the requirements that mitigate it."""
    severities = [
        clause.tag.text for clause in hazard.clauses if isinstance(clause, HazardSeverity) and clause.tag is not None
    ]
    texts = [clause for clause in hazard.clauses if isinstance(clause, Source | Because) and clause.text is not None]
    return HazardRow(
        key,
        name,
        _folded(hazard.text.text) if hazard.text is not None else "",
        severities[0] if severities else "",
        tuple(_folded(clause.text.text) for clause in texts if isinstance(clause, Source) and clause.text is not None),
        tuple(_folded(clause.text.text) for clause in texts if isinstance(clause, Because) and clause.text is not None),
        location,
        (),
    )


def mitigated(hazard: HazardRow, requirements: Iterable[RequirementRow]) -> HazardRow:
    """A hazard with the requirements that mitigate it."""
    return replace(hazard, requirements=tuple(row.key for row in requirements if hazard.name in row.mitigates))


def _folded(text: str) -> str:
    return " ".join(text.split())
