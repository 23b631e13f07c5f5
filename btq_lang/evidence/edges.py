"""The bound of a clause that may be moved: an editor judges a changed bound by the measures that were kept.

One invariant: only a bound for which every judgement is decided by one measure, whatever the bound, has an edge: a
constant on one side, not of a sum, and not of a count whose starts may be unknown.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from btq_lang.catalog.verbs import POOLED, VERBS, words
from btq_lang.evidence.conditions import MIRRORED, OPPOSITE
from btq_lang.requirements.model import (
    Aggregate,
    Compare,
    DurationSum,
    Limit,
    Quantity,
    ResolvedClaim,
    ResolvedEachEvent,
    ResolvedRequirement,
    SignalRead,
    Subject,
)
from btq_lang.util.record import Record, replace


class Edge(Record):
    """The bound of a clause.

    Attributes:
        is_upper: it bounds the measure from above.
        is_strict: a measure equal to it violates it.
        moved: gives the claim with another value in its place.
    """

    value: Quantity
    is_upper: bool
    is_strict: bool
    moved: Callable[[Quantity], ResolvedClaim]

    def across(self, si: float) -> float:
        """A number that is larger the further a value is on the wrong side."""
        return si if self.is_upper else -si

    def is_broken_by(self, si: float) -> bool:
        """Whether a measure violates the bound."""
        measure, bound = self.across(si), self.across(self.value.si)
        return measure > bound or (self.is_strict and measure == bound)

    @property
    def extremes(self) -> tuple[ResolvedClaim, ResolvedClaim]:
        """The claim with a bound that every measure keeps, and with one that none keeps."""
        far = (_FAR, -_FAR) if self.is_upper else (-_FAR, _FAR)
        within, beyond = (self.moved(replace(self.value, si=si)) for si in far)
        return within, beyond


def edge_of(claim: ResolvedClaim, subject: Subject | None, requirement: ResolvedRequirement) -> Edge | None:
    """The bound of a claim at a subject; None if it has none that may be moved."""
    if requirement.window is not None:
        return None  # it holds other judgements for another bound
    if isinstance(subject, DurationSum):
        return None  # parts of a sum may be unknown
    if isinstance(subject, ResolvedEachEvent) and any(scope.word == "while" for scope in requirement.scopes):
        return None  # until the deadline
    if claim.limit is not None:
        if claim.verb in POOLED:
            return None  # all runs decide together
        if VERBS[claim.verb].operand == "count" and requirement.scopes:
            return None  # starts may be unknown
        if claim.signal is not None and claim.signal.behaviour == "level":
            return None  # what is a recharge depends on the bound
        return _edge_of_limit(claim, claim.limit)
    return _edge_of_condition(claim)


def key_of(requirement: ResolvedRequirement, claim: ResolvedClaim, edge: Edge | None) -> str:
    """What a clause demands apart from its bound and its odds: judgements of equal keys count the same."""
    text = claim.text.replace(edge.value.text, "…", 1) if edge is not None else claim.text
    parts = [text, *(scope.text for scope in (*requirement.scopes, *requirement.assumptions))]
    parts += [requirement.span.text] if requirement.span is not None else []
    parts += [requirement.window.text] if requirement.window is not None else []
    of_runs = requirement.odds is not None and requirement.odds.experiments == "runs"
    return " ".join([*parts, "of runs"] if of_runs else parts)


def _edge_of_limit(claim: ResolvedClaim, limit: Limit) -> Edge | None:
    if not isinstance(limit.value, Quantity) or limit.upper is not None:
        return None
    is_upper, is_strict = limit.relation in ("<=", "<"), limit.relation in ("<", ">")
    return Edge(limit.value, is_upper, is_strict, lambda value: replace(claim, limit=replace(limit, value=value)))


def _edge_of_condition(claim: ResolvedClaim) -> Edge | None:
    condition = claim.condition
    if not isinstance(condition, Compare) or len(condition.operators) != 1:
        return None
    (sign,), (left, right) = condition.operators, condition.operands
    is_mirrored = isinstance(left, Quantity)
    value, measured = (left, right) if is_mirrored else (right, left)
    if sign not in MIRRORED or not isinstance(value, Quantity) or not isinstance(measured, SignalRead | Aggregate):
        return None
    sign = MIRRORED[sign] if is_mirrored else sign
    if claim.verb == "never":
        sign = OPPOSITE[sign]

    def moved(other: Quantity) -> ResolvedClaim:
        operands = (other, measured) if is_mirrored else (measured, other)
        return replace(claim, condition=replace(condition, operands=operands))

    return Edge(value, sign in ("<=", "<"), sign in ("<", ">"), moved)


_FAR: Final = 1e15  # further than any measure, and exact when a number of starts is added
WHILE_IT_RUNS: Final = words(enforced="guard") & words(operands=("condition",))  # the first violation decides
