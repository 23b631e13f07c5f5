"""Which clauses of requirements can be asked whether a run can violate them.

One invariant: nothing is explored for that, so an editor may look at every requirement.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.requirements.applied import Applied
from btq_lang.requirements.model import (
    All,
    Any,
    Condition,
    MissionRun,
    Negation,
    NodeTarget,
    Quantity,
    ResolvedAnyEvent,
    ResolvedClaim,
    ResolvedEachEvent,
    ResolvedEvent,
    Running,
)


def askable_claims(applied: Applied) -> Iterator[ResolvedClaim]:
    """The claims that a single run can violate, without time having a part in that."""
    requirement = applied.requirement
    if not requirement.scopes and requirement.odds is None and requirement.span is None:
        yield from (claim for claim in requirement.claims if _is_askable(applied, claim))


def _is_askable(applied: Applied, claim: ResolvedClaim) -> bool:
    subject = claim.subject or applied.subject
    if isinstance(subject, ResolvedEachEvent):
        return claim.verb == "followed" and claim.limit is None and all(map(_is_of_nodes, (subject.event, claim.event)))
    if not isinstance(subject, NodeTarget | MissionRun):
        return False
    if claim.verb == "tries":
        return claim.limit is not None and claim.limit.relation == "<=" and isinstance(claim.limit.value, Quantity)
    if claim.limit is not None:
        return False
    if claim.verb == "never":
        return claim.condition is not None and _is_of_running(claim.condition)
    return claim.verb == "succeeds" or (claim.verb == "follows" and _is_of_nodes(claim.event))


def _is_of_nodes(event: ResolvedEvent | ResolvedAnyEvent | None) -> bool:
    """Whether an event is that something happens to a node, not that a condition becomes true."""
    return event is not None and all(atom.subject is not None for atom in event.atoms)


def _is_of_running(condition: Condition) -> bool:
    """Whether a condition is only about which nodes run."""
    if isinstance(condition, All | Any):
        return all(map(_is_of_running, condition.conditions))
    return _is_of_running(condition.condition) if isinstance(condition, Negation) else isinstance(condition, Running)
