"""Budgets: how long nodes take if the nodes below them meet their requirements, and how likely that is.

One invariant: a node's budget depends on what is demanded of its children; if a child has a bound of its own, on that
bound and not on its own children: a violated bound is reported at the node that has it.  A bound that holds for some
activations only (a scope, some instances) does not count here.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import fsum, inf
from typing import Final, TypeAlias

from btq_lang.catalog.verbs import VERBS
from btq_lang.requirements import nodes
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.attach import applied_in
from btq_lang.requirements.budget_parts import UNKNOWN, Budget, mapped, opened, port_count, port_seconds
from btq_lang.requirements.composition import compose
from btq_lang.requirements.durations import ANY, ZERO, DurationTerm, Range, hull
from btq_lang.requirements.model import NodeTarget, ResolvedClaim
from btq_lang.util.record import Record, replace
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.resolved import ResolvedNode, ResolvedTree, tree_named, tree_nodes, trees_called
from btq_lang.workspace.workspace import Workspace


class Success(Record):
    """A node succeeds within a number of seconds, with at least a probability.

    Attributes:
        parts: the children that this depends on, each with what it adds to the probability of failure.
    """

    seconds: float
    probability: float
    parts: tuple[tuple[ResolvedNode, float], ...] = ()


# What other trees see of a tree: how long it takes, and how likely it succeeds, without its nodes.
Outcome: TypeAlias = tuple[Budget, Success | None]


# ---- queries ----


def tree_budgets(store: Store[Workspace], viewpoint: str, path: str, facts: Facts) -> TreeBudgets:
    """The budgets of the nodes of a tree, with all that they depend on."""
    tree = store.ask(tree_nodes, viewpoint, path, facts)
    applied = store.ask(applied_in, viewpoint, path, facts).applied
    return TreeBudgets(tree, applied, {name: store.ask(outcome, viewpoint, name) for name in tree.called})


def outcome(store: Store[Workspace], viewpoint: str, name: str) -> Outcome:
    """What other trees see of the tree with a name."""
    tree = store.ask(tree_named, viewpoint, name)
    if tree is None or tree.root is None or store.ask(_contains_itself, viewpoint, name):
        return _UNKNOWN_TREE
    budgets = store.ask(tree_budgets, viewpoint, tree.path, tree.facts)
    success = budgets.success(tree.root)
    visible = Success(success.seconds, success.probability) if success is not None else None
    return _without_terms(budgets.of(tree.root)), visible


@on_circle(True)
def _contains_itself(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    for other in store.ask(trees_called, viewpoint, name):
        store.ask(_contains_itself, viewpoint, other)
    return False


# ---- all nodes in scope ----


class Budgets:
    """The budgets of all nodes that a file sees, from the store."""

    def __init__(self, store: Store[Workspace], viewpoint: str) -> None:
        self._store: Final = store
        self._viewpoint: Final = viewpoint

    def of(self, node: ResolvedNode) -> Budget:
        """How long a node takes, if it and all below it meet their requirements: what its parent counts with."""
        return self._in_tree(node).of(node)

    def composed(self, node: ResolvedNode) -> Budget:
        """How long a node takes, if all below it meet their requirements: what its own bounds are compared with."""
        root, (budget, _) = self._run_by(node)
        return self._in_tree(node).composed(node) if root is None else _as_part(root, budget)

    def composed_of_known(self, node: ResolvedNode) -> Budget:
        """The same, if nodes without a known bound take no longer than they must: the time of the others alone."""
        return self._in_tree(node).composed_of_known(node)

    def success(self, node: ResolvedNode) -> Success | None:
        """How likely a node succeeds, and within which time, if all below it meet their requirements; None if
        unknown."""
        root, (_, success) = self._run_by(node)
        return self._in_tree(node).composed_success(node) if root is None else _success_as_part(root, success)

    def success_of_known(self, node: ResolvedNode) -> Success | None:
        """The same, if unknown nodes always succeed, at once: an upper bound."""
        return self.success(node) or self._in_tree(node).success_of_known(node)

    def _in_tree(self, node: ResolvedNode) -> TreeBudgets:
        return self._store.ask(tree_budgets, self._viewpoint, node.path, node.facts)

    def _run_by(self, node: ResolvedNode) -> tuple[ResolvedNode | None, Outcome]:
        """The root of the tree that a SubTree node runs, and its outcome."""
        name = node.node.id
        if node.category != "SubTree" or name is None:
            return None, _UNKNOWN_TREE
        tree_outcome = self._store.ask(outcome, self._viewpoint, name.text)
        return self._store.ask(nodes.root, self._viewpoint, name.text), tree_outcome


# ---- one tree ----


class TreeBudgets:
    """The budgets of a tree's nodes, computed on demand: most nodes of a file are never needed.  Those of a SubTree
    node have no terms, for these are in another tree."""

    __slots__ = ("_claims", "_composed", "_held", "_outcomes", "_successes")

    def __init__(self, tree: ResolvedTree, applied: tuple[Applied, ...], outcomes: Mapping[str, Outcome]) -> None:
        self._outcomes = outcomes
        # The claims that count, by the `id` of the node.
        self._claims: dict[int, list[tuple[Applied, ResolvedClaim]]] = {}
        for application in applied:
            subject = application.subject
            if isinstance(subject, NodeTarget) and not subject.through and not application.requirement.scopes:
                for claim in application.requirement.claims:
                    self._claims.setdefault(id(subject.node), []).append((application, claim))
        self._composed: dict[int, Budget] = {}
        self._held: dict[int, Budget] = {}
        self._successes: dict[int, Success | None] = {}

    def of(self, node: ResolvedNode) -> Budget:
        """How long a node takes, if it and all below it meet their requirements."""
        self._work_out(node)
        return self._held[id(node)]

    def composed(self, node: ResolvedNode) -> Budget:
        """How long a node takes, if all below it meet their requirements."""
        self._work_out(node)
        return self._composed[id(node)]

    def success(self, node: ResolvedNode) -> Success | None:
        """A node's success by its own claims, else by its children's success."""
        self._work_out(node)
        return self._successes[id(node)]

    def composed_of_known(self, node: ResolvedNode) -> Budget:
        """As for all budgets."""
        composed = self.composed(node)
        if node.category == "SubTree" or node.behavior is None or not node.children or _is_sure(composed):
            return composed if _is_sure(composed) else _shortest(composed)
        parts = {id(child.node): _as_part(child, self._known_budget(child)) for child in node.children}
        budget = compose(node, [parts.get(id(child), _shortest(UNKNOWN)) for child in node.node.children])
        return budget if budget.is_bounded else _shortest(composed)

    def success_of_known(self, node: ResolvedNode) -> Success | None:
        """As for all budgets."""
        success = self.composed_success(node)
        if success is not None or node.category == "SubTree" or not node.children or _may_be_passed(node):
            return success
        parts = [self.success(child) or self.success_of_known(child) for child in node.children]
        if not any(parts):
            return None
        as_parts = [_success_as_part(child, part) for child, part in zip(node.children, parts, strict=True)]
        return _success_of(node, [part or _SURE for part in as_parts])

    def composed_success(self, node: ResolvedNode) -> Success | None:
        """A node's success as far as it follows from its children's."""
        if node.category == "SubTree":
            return self._outcome_of(node)[1]
        budget = self.composed(node)
        if not node.children:
            sure = budget.success is not None and budget.failure is None and budget.success.high < inf
            return Success(budget.success.high, 1.0) if sure and budget.success is not None else None
        if _may_be_passed(node):
            return None
        parts = [_success_as_part(child, self._successes[id(child)]) for child in node.children]
        known_parts = [part for part in parts if part is not None]
        if len(known_parts) < len(node.node.children):
            return None
        return _success_of(node, known_parts)

    def _work_out(self, top: ResolvedNode) -> None:
        """Compose a node, after those that it depends on."""
        missing = [top] if id(top) not in self._held else []
        for node in missing:  # each before the nodes below it
            missing += [child for child in node.children if id(child) not in self._held]
        for node in reversed(missing):
            composed = self._composed[id(node)] = self._compose(node)
            claims = self._claims.get(id(node), [])
            held = _with_claims(composed, claims) if claims or composed.probability < 1.0 else composed
            self._held[id(node)] = _with_attributes(node, held) if node.node.attributes else held
            self._successes[id(node)] = self._succeeding(node)

    def _outcome_of(self, node: ResolvedNode) -> Outcome:
        """The outcome of the tree that a SubTree node runs."""
        name = node.node.id
        return self._outcomes[name.text] if name is not None else _UNKNOWN_TREE

    def _compose(self, node: ResolvedNode) -> Budget:
        if node.category == "SubTree":
            return self._outcome_of(node)[0]
        if node.behavior is None and not node.node.children:
            return _CONDITION if node.category == "Condition" else _NO_CLAUSE
        if node.behavior is None:
            return UNKNOWN
        if not node.node.children:
            return compose(node, ())
        parts = {id(child.node): _as_part(child, self._held[id(child)]) for child in node.children}
        return compose(node, [parts.get(id(child), UNKNOWN) for child in node.node.children])

    def _known_budget(self, node: ResolvedNode) -> Budget:
        held = self.of(node)
        if _is_sure(held):
            return held
        sure = [claim for applied, claim in self._claims.get(id(node), ()) if applied.requirement.odds is None]
        budget = _all_narrowed(self.composed_of_known(node), sure)
        return budget if budget.is_bounded else _shortest(budget)

    def _succeeding(self, node: ResolvedNode) -> Success | None:
        successes: list[Success] = []
        for applied, claim in self._claims.get(id(node), ()):
            if VERBS[claim.verb].limits == "success":
                odds = applied.requirement.odds
                successes.append(Success(_range(claim).high, odds.probability if odds is not None else 1.0))
        if successes:
            return max(successes, key=lambda each: (each.probability, -each.seconds))
        return self.composed_success(node)


def _may_be_passed(node: ResolvedNode) -> bool:
    """Whether a node's children may have another outcome than the node."""
    return any(pair.key.text in _CHANGING for child in node.children for pair in child.node.attributes)


def _success_of(node: ResolvedNode, parts: list[Success]) -> Success | None:
    """By the union bound: the probability that one of the parts misses is at most the sum of theirs."""
    first = parts[0]
    together = tuple(share for part in parts for share in part.parts)
    missed = fsum([1.0 - part.probability for part in parts])
    if node.flow == "sequence" and not (node.behavior is not None and node.behavior.reactive):
        return Success(fsum([part.seconds for part in parts]), max(0.0, 1.0 - missed), together)
    if node.flow == "parallel" and port_count(node, "successes") in (-1, len(parts)):
        return Success(max(part.seconds for part in parts), max(0.0, 1.0 - missed), together)
    if node.flow == "repeat" and (count := port_count(node, "count") or 0) > 0:
        repeated = tuple((child, count * share) for child, share in first.parts)
        return Success(first.seconds * count, max(0.0, 1.0 - count * missed), repeated)
    if node.flow == "timeout" and (limit := port_seconds(node)) is not None:
        return first if first.seconds <= limit or limit == 0 else None
    if node.flow == "delay" and (delay := port_seconds(node)) is not None:
        return replace(first, seconds=first.seconds + delay)
    return None


def _success_as_part(node: ResolvedNode, success: Success | None) -> Success | None:
    """A child's success, as a part of its parent's."""
    if success is None:
        return None
    return Success(success.seconds, success.probability, ((node, 1.0 - success.probability),))


def _is_sure(budget: Budget) -> bool:
    """Whether it has a certain bound."""
    return budget.is_bounded and budget.probability == 1.0


def _shortest(budget: Budget) -> Budget:
    """The shortest time that a budget allows, for each outcome."""
    shortest = mapped(budget, lambda each: Range(each.low, each.low) if each is not None else None)
    return replace(shortest, probability=1.0, endless=False)


def _as_part(node: ResolvedNode, budget: Budget) -> Budget:
    """A child's budget as its parent sees it: each outcome is one term."""

    def part(duration: Range | None) -> Range | None:
        if duration is None or (duration.high == 0.0 and not duration.terms):
            return duration
        terms = (DurationTerm(node, 1, duration.high),) if duration.high > 0.0 else ()
        return Range(duration.low, duration.high, terms)

    return mapped(budget, part)


def _without_terms(budget: Budget) -> Budget:
    """A budget as another tree sees it: without terms."""
    return mapped(budget, lambda each: Range(each.low, each.high) if each is not None and each.terms else each)


def _with_claims(composed: Budget, claims: list[tuple[Applied, ResolvedClaim]]) -> Budget:
    """What is demanded of a node; of bounds with odds the likeliest, and only if there is no certain bound."""
    sure = [claim for applied, claim in claims if applied.requirement.odds is None]
    without_odds = replace(opened(composed), probability=1.0)
    held = _all_narrowed(composed if composed.probability == 1.0 else without_odds, sure)
    if held.is_bounded:
        return held
    choices = [_all_narrowed(composed, sure)] if composed.probability < 1.0 else []
    for applied, claim in claims:
        odds = applied.requirement.odds
        if odds is not None and VERBS[claim.verb].limits == "completion":
            choices.append(replace(_narrowed(held, claim), probability=odds.probability))
    choices = [each for each in choices if each.is_bounded]
    return max(choices, key=lambda each: each.probability, default=held)


def _with_attributes(node: ResolvedNode, budget: Budget) -> Budget:
    """What a node's pre-conditions add: it may end at once, and with `_while` at any time."""
    keys = {pair.key.text for pair in node.node.attributes}
    for key, outcome in (("_failureIf", "failure"), ("_successIf", "success"), ("_skipIf", "skip")):
        if key in keys:
            budget = replace(budget, **{outcome: hull(getattr(budget, outcome), ZERO)})
    if "_while" in keys:
        budget = replace(budget, skip=hull(budget.skip, budget.running if budget.waits else ZERO))
    return budget


def _all_narrowed(budget: Budget, claims: list[ResolvedClaim]) -> Budget:
    for claim in claims:
        budget = _narrowed(budget, claim)
    return budget


def _narrowed(budget: Budget, claim: ResolvedClaim) -> Budget:
    """A budget, if a claim holds too.  If both cannot hold, the claim counts: the conflict is reported elsewhere."""
    limits = VERBS[claim.verb].limits
    if claim.limit is None or not limits:
        return budget
    allowed = _range(claim)
    success = _within(budget.success, allowed)
    if limits == "success":
        return replace(budget, success=success)
    skip = budget.skip
    if skip is not None and skip.high > allowed.high:
        skip = Range(min(skip.low, allowed.high), allowed.high)
    return replace(budget, success=success, failure=_within(budget.failure, allowed), skip=skip)


def _within(duration: Range | None, allowed: Range) -> Range | None:
    if duration is None:
        return None
    low, high = max(duration.low, allowed.low), min(duration.high, allowed.high)
    return Range(low, high, duration.terms if high == duration.high else ()) if low <= high else allowed


def _range(claim: ResolvedClaim) -> Range:
    """The durations that a claim's bound allows in any situation."""
    least = max(claim.lowest[0], 0.0) if claim.lowest is not None else 0.0
    most = max(claim.highest[0], 0.0) if claim.highest is not None else inf
    return Range(least, most) if least <= most else ANY


_CONDITION: Final = Budget(ZERO, ZERO, None, False)
_NO_CLAUSE: Final = Budget(ANY, ANY)
_SURE: Final = Success(0.0, 1.0)
_CHANGING: Final = frozenset(("_failureIf", "_successIf", "_skipIf", "_while"))
_UNKNOWN_TREE: Final[Outcome] = (UNKNOWN, None)  # or one that contains itself
