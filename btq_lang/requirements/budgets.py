"""Budgets: how long nodes take if all that is demanded of the nodes below them holds, and how likely that is.

One invariant: a node's budget rests on what its children are held to, and where a child has a bound of its own, on that
bound and not on what its own children would need: whoever breaks a bound is told at the node that has it.  A bound that
holds for some activations only (a scope, some instances) is none here.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from math import inf

from btq_lang.record import record, replace
from btq_lang.requirements import Requirements
from btq_lang.requirements.composition import Budget, Gap, compose, port_count, port_seconds, unknown
from btq_lang.requirements.durations import ANY, ZERO, Range, Term, hull
from btq_lang.requirements.model import (
    Applied,
    Bounded,
    Claim,
    Limit,
    SourceNode,
    Table,
    Target,
    Value,
)
from btq_lang.syntax import Node

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

__all__ = ["Budget", "Budgets", "Gap", "Range", "Success", "Term"]


@record
class Success:
    """A node succeeds within so many seconds, at least so likely.

    Attributes:
        parts: the children that this rests on, each with what it adds to the likelihood of missing it.
    """

    seconds: float
    probability: float
    parts: tuple[tuple[SourceNode, float], ...] = ()


class Budgets:
    """The budgets of all nodes that a file sees."""

    def __init__(self, found: Requirements) -> None:
        self._nodes = found.nodes
        self._claims: dict[int, list[tuple[Applied, Claim]]] = {}
        for applied in found.applied:
            if isinstance(applied.subject, Target) and not applied.subject.through and not applied.requirement.scopes:
                for claim in applied.requirement.claims:
                    self._claims.setdefault(id(applied.subject.node), []).append((applied, claim))
        self._composed: dict[int, Budget] = {}
        self._held: dict[int, Budget] = {}
        self._successes: dict[int, Success | None] = {}

    def of(self, node: SourceNode) -> Budget:
        """How long a node takes, if it and all below it are as demanded: what its parent counts with."""
        self._work_out(node)
        return self._held[id(node)]

    def composed(self, node: SourceNode) -> Budget:
        """How long a node takes, if all below it are as demanded: what its own bounds are held against."""
        self._work_out(node)
        return self._composed[id(node)]

    def success(self, node: SourceNode) -> Success | None:
        """How likely a node succeeds, and within which time, if all below it are as demanded; None: nobody says."""
        for root in self._run_by(node):
            self._work_out(root)
            return self._part(root)
        self._work_out(node)
        return self._composed_success(node)

    def _work_out(self, top: SourceNode) -> None:
        """Compose a node, and before it what it rests on: most nodes of a file nobody asks for."""
        waiting = [top] if id(top) not in self._held else []
        while waiting:
            node = waiting[-1]
            missing = [child for child in (*node.children, *self._run_before(node)) if id(child) not in self._held]
            if missing:
                waiting += missing
                continue
            waiting.pop()
            if id(node) not in self._held:
                self._composed[id(node)] = composed = self._compose(node)
                self._held[id(node)] = _with_attributes(node, self._with_claims(node, composed))
                self._successes[id(node)] = self._succeeding(node)

    def _run_before(self, node: SourceNode) -> Iterator[SourceNode]:
        """The root that a SubTree node runs, unless that would be running in a circle."""
        for root in self._run_by(node):
            if self._positions[id(root)] < self._positions[id(node)]:
                yield root

    @cached_property
    def _positions(self) -> dict[int, int]:
        """Of all nodes, so that a circle is cut at the same place, whichever of its nodes is asked for first."""
        return {id(node): position for position, node in enumerate(self._in_order())}

    def _in_order(self) -> Iterator[SourceNode]:
        """Children before their parents, and trees before the SubTree nodes that run them, where there is no circle."""
        done: set[int] = set()
        begun: set[int] = set()
        for start in self._nodes.all:
            waiting = [start] if id(start) not in begun else []
            while waiting:
                node = waiting[-1]
                if id(node) in begun:
                    waiting.pop()
                    if id(node) not in done:
                        done.add(id(node))
                        yield node
                    continue
                begun.add(id(node))
                below = [*node.children, *self._run_by(node)]
                waiting += [child for child in reversed(below) if id(child) not in begun]

    def _run_by(self, node: SourceNode) -> tuple[SourceNode, ...]:
        name = node.node.id
        root = self._nodes.root(name.text) if node.category == "SubTree" and name is not None else None
        return (root,) if root is not None else ()

    def _compose(self, node: SourceNode) -> Budget:
        if node.category == "SubTree":
            for root in self._run_before(node):
                return _as_part(root, self._held[id(root)])
            return unknown(node, "is a tree that runs itself" if self._run_by(node) else "is a tree that nobody knows")
        if node.kind is None and not node.node.children:
            if node.category == "Condition":
                return Budget(ZERO, ZERO, None, False)
            return Budget(ANY, ANY, None, gaps=(Gap(node, "has no `takes` clause"),))
        if node.kind is None:
            return unknown(node, "is a node of which nobody knows how it runs its children")
        parts = {id(child.node): _as_part(child, self._held[id(child)]) for child in node.children}
        xml = unknown(node, "has a child in XML")
        return compose(
            node, [parts.get(id(child), xml) if isinstance(child, Node) else xml for child in node.node.children]
        )

    def _with_claims(self, node: SourceNode, composed: Budget) -> Budget:
        """What a node is held to; of bounds that may be missed now and then the likeliest, and only where no sure one
        says how long it may take."""
        claims = self._claims.get(id(node), ())
        sure = [claim for applied, claim in claims if applied.requirement.odds is None]
        held = _all_narrowed(composed if composed.probability == 1.0 else _opened(composed), sure)
        if held.is_bounded:
            return replace(held, gaps=())
        choices = [_all_narrowed(composed, sure)] if composed.probability < 1.0 else []
        for applied, claim in claims:
            odds = applied.requirement.odds
            if odds is not None and claim.verb == "takes":
                choices.append(replace(_narrowed(held, claim), probability=odds.probability))
        choices = [replace(each, gaps=()) for each in choices if each.is_bounded]
        return max(choices, key=lambda each: each.probability, default=held)

    # ---- the likelihood of success ----

    def _succeeding(self, node: SourceNode) -> Success | None:
        """What a node's own claims say of its success, else what its children's do."""
        found: list[Success] = []
        for applied, claim in self._claims.get(id(node), ()):
            if claim.verb == "succeeds":
                odds = applied.requirement.odds
                high = _range(claim.limit).high if claim.limit is not None else inf
                found.append(Success(high, odds.probability if odds is not None else 1.0))
        if found:
            return max(found, key=lambda each: (each.probability, -each.seconds))
        return self._composed_success(node)

    def _composed_success(self, node: SourceNode) -> Success | None:
        if node.category == "SubTree":
            return next(map(self._part, self._run_before(node)), None)
        budget = self._composed[id(node)]
        if not node.children:
            sure = budget.success is not None and budget.failure is None and budget.success.high < inf
            return Success(budget.success.high, 1.0) if sure and budget.success is not None else None
        if any(pair.key.text in _CHANGING for child in node.children for pair in child.node.attributes):
            return None
        parts = [self._part(child) for child in node.children]
        known = [part for part in parts if part is not None]
        if len(known) < len(node.node.children):
            return None
        return _success_of(node, known)

    def _part(self, node: SourceNode) -> Success | None:
        """A child's success, as a part of its parent's."""
        found = self._successes.get(id(node))
        if found is None:
            return None
        return Success(found.seconds, found.probability, ((node, 1.0 - found.probability),))


def _success_of(node: SourceNode, parts: list[Success]) -> Success | None:
    """By the union bound: what all its parts do is as unlikely to be missed as the sum of what each of them misses."""
    first = parts[0]
    together = tuple(part for each in parts for part in each.parts)
    missed = sum(1.0 - part.probability for part in parts)
    if node.tag in ("Sequence", "AsyncSequence", "SequenceWithMemory"):
        return Success(sum(part.seconds for part in parts), max(0.0, 1.0 - missed), together)
    if node.tag == "Parallel" and port_count(node, "success_count", -1) in (-1, len(parts)):
        return Success(max(part.seconds for part in parts), max(0.0, 1.0 - missed), together)
    if node.tag == "Repeat" and (count := port_count(node, "num_cycles") or 0) > 0:
        each = tuple((child, count * share) for child, share in first.parts)
        return Success(first.seconds * count, max(0.0, 1.0 - count * missed), each)
    if node.tag == "Timeout" and (limit := port_seconds(node, "msec")) is not None:
        return first if first.seconds <= limit or limit == 0 else None
    if node.tag == "Delay" and (delay := port_seconds(node, "delay_msec")) is not None:
        return replace(first, seconds=first.seconds + delay)
    return None


def _as_part(node: SourceNode, budget: Budget) -> Budget:
    """A child's budget as its parent sees it: each outcome is one term."""

    def part(each: Range | None) -> Range | None:
        if each is None:
            return None
        return Range(each.low, each.high, (Term(node, 1, each.high),) if each.high > 0.0 else ())

    return replace(budget, success=part(budget.success), failure=part(budget.failure), skip=part(budget.skip))


def _with_attributes(node: SourceNode, budget: Budget) -> Budget:
    """What a node's pre-conditions add: it may end at once, and with `_while` at any time."""
    keys = {pair.key.text for pair in node.node.attributes}
    if "_failureIf" in keys:
        budget = replace(budget, failure=hull(budget.failure, ZERO))
    if "_successIf" in keys:
        budget = replace(budget, success=hull(budget.success, ZERO))
    if "_skipIf" in keys:
        budget = replace(budget, skip=hull(budget.skip, ZERO))
    if "_while" in keys:
        budget = replace(budget, skip=hull(budget.skip, budget.running if budget.waits else ZERO))
    return budget


def _opened(budget: Budget) -> Budget:
    """A budget without what is only likely."""
    success, failure, skip = (
        ANY if each is not None else None for each in (budget.success, budget.failure, budget.skip)
    )
    return Budget(success, failure, skip, budget.waits, 1.0, budget.gaps, budget.endless)


def _all_narrowed(budget: Budget, claims: list[Claim]) -> Budget:
    for claim in claims:
        budget = _narrowed(budget, claim)
    return budget


def _narrowed(budget: Budget, claim: Claim) -> Budget:
    """A budget, if a claim holds, too.  Where both cannot hold, the claim counts: the other is told at its place."""
    if claim.limit is None or claim.verb not in ("takes", "succeeds"):
        return budget
    allowed = _range(claim.limit)
    if claim.verb == "succeeds":
        return replace(budget, success=_within(budget.success, allowed))
    skip = budget.skip
    if skip is not None and skip.high > allowed.high:
        skip = Range(min(skip.low, allowed.high), allowed.high)
    return replace(
        budget, success=_within(budget.success, allowed), failure=_within(budget.failure, allowed), skip=skip
    )


def _within(each: Range | None, allowed: Range) -> Range | None:
    if each is None:
        return None
    low, high = max(each.low, allowed.low), min(each.high, allowed.high)
    return Range(low, high, each.terms if high == each.high else ()) if low <= high else allowed


def _range(limit: Limit) -> Range:
    """The durations that a bound allows in one situation or another."""
    if limit.relation in ("<=", "<"):
        return Range(0.0, _extreme(limit.value, highest=True))
    if limit.relation in (">=", ">"):
        return Range(max(_extreme(limit.value, highest=False), 0.0), inf)
    upper = limit.upper if limit.upper is not None else limit.value
    low, high = _extreme(limit.value, highest=False), _extreme(upper, highest=True)
    return Range(max(low, 0.0), high) if low <= high else ANY


def _extreme(bounded: Bounded, *, highest: bool) -> float:
    """The highest or lowest value of a bound; of a signal nobody knows it."""
    values = [case.value for case in bounded.cases] if isinstance(bounded, Table) else [bounded]
    numbers = [value.si if isinstance(value, Value) else inf if highest else 0.0 for value in values]
    return max(0.0, max(numbers)) if highest else min(numbers)


_CHANGING: Final = frozenset(("_failureIf", "_successIf", "_skipIf", "_while"))
