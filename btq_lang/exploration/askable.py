"""Which clauses of requirements can be asked whether a run can violate them.

One invariant: nothing is explored for that, so an editor may look at every requirement.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.verbs import POOLED
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
    ResolvedRequirement,
    ResolvedSpan,
    Running,
)


def askable_claims(applied: Applied) -> Iterator[ResolvedClaim]:
    """The claims that a single run can violate, without time having a part in that."""
    yield from (claim for claim in applied.requirement.claims if not why_not_asked(applied, claim))


def why_not_asked(applied: Applied, claim: ResolvedClaim) -> str:
    """Why a claim cannot be asked; empty if it can."""
    requirement = applied.requirement
    subject = claim.subject or applied.subject
    if requirement.odds is not None or claim.verb in POOLED:
        return "is about many runs"
    if not _is_scope_askable(requirement, claim, subject):
        return "has a scope"
    if isinstance(subject, ResolvedEachEvent):
        if claim.verb != "followed" or not all(map(_is_of_nodes, (subject.event, claim.event))):
            return _VALUES
        return _TIME if claim.limit is not None else ""
    if not isinstance(subject, NodeTarget | MissionRun):
        return _TIME
    if claim.verb == "tries":
        is_most = claim.limit is not None and claim.limit.relation == "<=" and isinstance(claim.limit.value, Quantity)
        return "" if is_most else "is not about a largest number"
    if claim.verb == "never" and claim.limit is None:
        return "" if claim.condition is not None and _is_of_running(claim.condition) else _VALUES
    if claim.verb == "follows" and claim.limit is None:
        return "" if _is_of_nodes(claim.event) else _VALUES
    if claim.verb == "succeeds" and claim.limit is None:
        return ""
    return _TIME if claim.limit is not None and claim.verb in _WITHOUT_TIME else f"`{claim.head}` is not explored"


def _is_scope_askable(requirement: ResolvedRequirement, claim: ResolvedClaim, subject: object) -> bool:
    """Whether a claim has no scope, or is `never` of the mission while nodes run, or between events of nodes."""
    span = requirement.span
    if span is None and not requirement.scopes:
        return True
    is_of_nodes = span is None or _is_span_askable(span)
    is_while = all(scope.word == "while" and _is_of_running(scope.condition) for scope in requirement.scopes)
    return claim.verb == "never" and isinstance(subject, MissionRun) and is_of_nodes and is_while


def _is_span_askable(span: ResolvedSpan) -> bool:
    """Whether both ends are events of nodes, of which no change of one node is both without an order."""
    pairs = [(first, last) for first in span.first.atoms for last in span.last.atoms]
    return all(map(_is_of_nodes, (span.first, span.last))) and all(
        first.subject != last.subject or (first.happening == "starts") != (last.happening == "starts")
        for first, last in pairs
    )


def _is_of_nodes(event: ResolvedEvent | ResolvedAnyEvent | None) -> bool:
    """Whether an event is that something happens to a node, not that a condition becomes true."""
    return event is not None and all(atom.subject is not None for atom in event.atoms)


def _is_of_running(condition: Condition) -> bool:
    """Whether a condition is only about which nodes run."""
    if isinstance(condition, All | Any):
        return all(map(_is_of_running, condition.conditions))
    return _is_of_running(condition.condition) if isinstance(condition, Negation) else isinstance(condition, Running)


_TIME: Final = "is about time"
_VALUES: Final = "is about values"
_WITHOUT_TIME: Final = frozenset(("never", "follows", "succeeds"))
