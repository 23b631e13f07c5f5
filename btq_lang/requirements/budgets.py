"""Budgets: how long nodes take if all that is demanded of the nodes below them holds, and how likely that is.

One invariant: a node's budget rests on what its children are held to, and where a child has a bound of its own, on that
bound and not on what its own children would need: whoever breaks a bound is told at the node that has it.  A bound that
holds for some activations only (a scope, some instances) is none here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import fsum, inf
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.verbs import VERBS
from btq_lang.requirements.composition import Budget, compose, port_count, port_seconds, unknown
from btq_lang.requirements.durations import ANY, ZERO, Range, Term, hull
from btq_lang.requirements.memory import Memory, is_same
from btq_lang.requirements.model import Applied, Bounded, Claim, Limit, SourceNode, Table, Target, Value
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from btq_lang.requirements.resolved import Requirements
    from btq_lang.requirements.trees import TreeNodes

__all__ = ["Budget", "Budgets", "Gap", "Range", "Success", "Term"]


class Success(Record):
    """A node succeeds within so many seconds, at least so likely.

    Attributes:
        parts: the children that this rests on, each with what it adds to the likelihood of missing it.
    """

    seconds: float
    probability: float
    parts: tuple[tuple[SourceNode, float], ...] = ()


class Gap(Record):
    """Why no bound can be said: the node, and the reason in words to stand behind its name."""

    node: SourceNode
    reason: str


class _TreeBudgets:
    """The budgets of one tree's nodes, as far as anybody has asked for them.

    Attributes:
        applied: what holds for its nodes.
        claims: the claims that count, by the node.
        composed, held, successes: by the node; of a SubTree node they say nothing of what they are made of, for that
            is in another tree.
        asked: what was asked of other trees, by their names: the root that was run, and the answer.
    """

    __slots__ = ("applied", "asked", "claims", "composed", "held", "successes", "tree")

    def __init__(self, tree: TreeNodes, applied: tuple[Applied, ...]) -> None:
        self.tree = tree
        self.applied = applied
        self.claims: dict[int, list[tuple[Applied, Claim]]] = {}
        for each in applied:
            if isinstance(each.subject, Target) and not each.subject.through and not each.requirement.scopes:
                for claim in each.requirement.claims:
                    self.claims.setdefault(id(each.subject.node), []).append((each, claim))
        self.composed: dict[int, Budget] = {}
        self.held: dict[int, Budget] = {}
        self.successes: dict[int, Success | None] = {}
        self.asked: dict[str, tuple[SourceNode | None, object]] = {}


class Budgets:
    """The budgets of all nodes that a file sees."""

    def __init__(self, found: Requirements, memory: Memory | None = None) -> None:
        """memory: that of the requirements; budgets that come out as before are taken from it."""
        self._found = found
        self._nodes = found.nodes
        self._trees: dict[int, _TreeBudgets] = {}
        if memory is not None:
            self._take_over(memory)
            memory.budgets = self._trees, memory.turn

    def of(self, node: SourceNode) -> Budget:
        """How long a node takes, if it and all below it are as demanded: what its parent counts with."""
        return self._work_out(node).held[id(node)]

    def composed(self, node: SourceNode) -> Budget:
        """How long a node takes, if all below it are as demanded: what its own bounds are held against."""
        found = self._work_out(node)
        root = self._run_before(node)
        return found.composed[id(node)] if root is None else _as_part(root, self.of(root))

    def composed_of_known(self, node: SourceNode) -> Budget:
        """The same, if what nobody knows a bound of takes no longer than it must: what the others may take alone."""
        return self._compose_known(self._work_out(node), node)

    def success(self, node: SourceNode) -> Success | None:
        """How likely a node succeeds, and within which time, if all below it are as demanded; None: nobody says."""
        root = self._nodes.run_by(node)
        if root is not None:
            return _success_as_part(root, self._work_out(root).successes[id(root)])
        return self._composed_success(self._work_out(node), node)

    def success_of_known(self, node: SourceNode) -> Success | None:
        """The same, if that of which nobody says it always succeeds, at once: no more is ensured."""
        found = self.success(node)
        if found is not None or node.category == "SubTree" or not node.children or _may_be_passed(node):
            return found
        successes = self._work_out(node).successes
        parts = [successes[id(child)] or self.success_of_known(child) for child in node.children]
        if not any(parts):
            return None
        known = [_success_as_part(child, part) for child, part in zip(node.children, parts, strict=True)]
        return _success_of(node, [part or _SURE for part in known])

    def gaps(self, node: SourceNode) -> tuple[Gap, ...]:
        """Why no bound can be said of a node, if all below it are as demanded; the first reasons, if there are many."""
        found: dict[Gap, None] = {}
        seen: set[int] = set()  # a tree may be run from many places
        waiting = [node]
        while waiting and len(found) < _MOST_GAPS:
            at = waiting.pop()
            if id(at) in seen:
                continue
            seen.add(id(at))
            composed = self.composed(at)
            if composed.is_bounded:
                continue
            if composed.reason:
                found[Gap(at, composed.reason)] = None
            root = self._run_before(at)
            below = at.children if root is None else [root]
            waiting += [child for child in reversed(below) if not self.of(child).is_bounded]
        return tuple(found)

    def in_tree(self, tree: TreeNodes) -> object:
        """What all answers about the nodes of a tree are taken from: the same object as long as they stay the same."""
        return self._in(tree)

    def _take_over(self, memory: Memory) -> None:
        """What would come out the same: a tree with what holds for its nodes, and with the trees that it runs."""
        before, turn = memory.budgets
        if not before:
            return
        from heapq import heappop, heappush  # only an edit needs them

        nodes, by_tree = self._nodes, self._found.by_tree
        trees = nodes.in_order
        places: Sequence[int] = range(len(trees))
        if turn == memory.turn - 1 and memory.touched is not None and nodes.others is not None:
            # Those of all other trees would come out the same, and of as many there are few others.
            self._trees.update(before)
            touched = {id(tree.item) for pair in nodes.others for tree in pair}.union(memory.touched)
            for item in touched:
                self._trees.pop(item, None)
            found = [nodes.place(item) for item in touched]
            places = sorted([at for at in found if at is not None])
        waiting: list[int] = []  # places in that order, of trees whose budgets may come out otherwise
        for at in places:
            tree = trees[at]
            item = id(tree.item)
            known = before.get(item)
            if known is not None and known.tree is tree:
                applied = by_tree.get(item, ())
                if applied is known.applied or is_same(applied, known.applied):
                    self._trees[item] = known
                    continue
            waiting.append(at)
        if nodes.is_ordered_as_before:
            callers = [node for name in nodes.renamed for node in nodes.callers(name)]
            waiting = sorted({*waiting, *(nodes.position(node.item) for node in callers)})
        else:
            waiting = [*range(len(trees))]
        others: set[str | None] = set()
        seen = set(waiting)
        while waiting:  # each behind those that it runs
            at = heappop(waiting)
            tree = trees[at]
            known = self._trees.get(id(tree.item))
            if known is not None and self._says_the_same(known, others):
                continue
            self._trees.pop(id(tree.item), None)
            others.add(tree.name)
            for caller in nodes.callers(tree.name):
                above = nodes.position(caller.item)
                if above > at and above not in seen:
                    seen.add(above)
                    heappush(waiting, above)

    def _says_the_same(self, known: _TreeBudgets, others: set[str | None]) -> bool:
        """Whether all is so that was asked for the budgets of a tree.

        Args:
            others: the trees whose budgets are made anew.
        """
        for name, (root_before, outcome) in known.asked.items():
            root = self._nodes.root(name)
            if root is not None and self._nodes.position(root.item) >= self._nodes.position(known.tree.item):
                root = None
            is_same_root = root is root_before and root is not None and name not in others
            if not is_same_root and self._outcome(known.tree, name) != outcome:
                return False
        return True

    def _in(self, tree: TreeNodes) -> _TreeBudgets:
        found = self._trees.get(id(tree.item))
        if found is None:
            found = self._trees[id(tree.item)] = _TreeBudgets(tree, self._found.in_tree(tree))
        return found

    def _work_out(self, top: SourceNode) -> _TreeBudgets:
        """Compose a node, and before it what it rests on: most nodes of a file nobody asks for."""
        found = self._in(self._nodes.within(top.item))
        waiting = [top] if id(top) not in found.held else []
        while waiting:
            node = waiting[-1]
            at = found if node.item is top.item else self._in(self._nodes.within(node.item))
            missing = [child for child in node.children if id(child) not in at.held] if node.children else []
            root = self._run_before(node) if node.category == "SubTree" else None
            if root is not None and id(root) not in self._in(self._nodes.within(root.item)).held:
                missing.append(root)
            if missing:
                waiting += missing
                continue
            waiting.pop()
            if id(node) not in at.held:
                composed = at.composed[id(node)] = self._compose(at, node)
                claims = at.claims.get(id(node), [])
                held = _with_claims(composed, claims) if claims or composed.probability < 1.0 else composed
                at.held[id(node)] = _with_attributes(node, held) if node.node.attributes else held
                at.successes[id(node)] = self._succeeding(at, node)
        return found

    def _run_before(self, node: SourceNode) -> SourceNode | None:
        """The root that a SubTree node runs, unless that would be running in a circle."""
        root = self._nodes.run_by(node) if node.category == "SubTree" else None
        if root is None:
            return None
        return root if self._nodes.position(root.item) < self._nodes.position(node.item) else None

    def _outcome(self, tree: TreeNodes, name: str) -> object:
        """What a tree learns of one that it runs: all but what that is made of."""
        root = self._nodes.root(name)
        if root is None or self._nodes.position(root.item) >= self._nodes.position(tree.item):
            return root is None
        budgets = self._work_out(root)
        success = budgets.successes[id(root)]
        return _without_terms(budgets.held[id(root)]), success and (success.seconds, success.probability)

    def _compose(self, at: _TreeBudgets, node: SourceNode) -> Budget:
        if node.category == "SubTree":
            root = self._run_before(node)
            if node.node.id is not None:
                name = node.node.id.text
                at.asked[name] = root, self._outcome(at.tree, name)
            if root is not None:
                return _without_terms(self._in(self._nodes.within(root.item)).held[id(root)])
            is_known = self._nodes.run_by(node) is not None
            return unknown("is a tree that contains itself" if is_known else "is an unknown tree")
        if node.kind is None and not node.node.children:
            return _CONDITION if node.category == "Condition" else _NO_CLAUSE
        if node.kind is None:
            return unknown("is a custom control or decorator node")
        if not node.node.children:
            return compose(node, ())
        parts = {id(child.node): _as_part(child, at.held[id(child)]) for child in node.children}
        return compose(node, [parts.get(id(child), _XML) for child in node.node.children])

    def _compose_known(self, at: _TreeBudgets, node: SourceNode) -> Budget:
        composed = at.composed[id(node)]
        if node.category == "SubTree" or node.kind is None or not node.children or _is_sure(composed):
            return composed if _is_sure(composed) else _shortest(composed)
        parts = {id(child.node): _as_part(child, self._known(at, child)) for child in node.children}
        found = compose(node, [parts.get(id(child), _shortest(_XML)) for child in node.node.children])
        return found if found.is_bounded else _shortest(composed)

    def _known(self, at: _TreeBudgets, node: SourceNode) -> Budget:
        held = at.held[id(node)]
        if _is_sure(held):
            return held
        sure = [claim for applied, claim in at.claims.get(id(node), ()) if applied.requirement.odds is None]
        found = _all_narrowed(self._compose_known(at, node), sure)
        return found if found.is_bounded else _shortest(found)

    # ---- the likelihood of success ----

    def _succeeding(self, at: _TreeBudgets, node: SourceNode) -> Success | None:
        """What a node's own claims say of its success, else what its children's do."""
        found: list[Success] = []
        for applied, claim in at.claims.get(id(node), ()):
            if VERBS[claim.verb].limits == "success":
                odds = applied.requirement.odds
                high = _range(claim.limit).high if claim.limit is not None else inf
                found.append(Success(high, odds.probability if odds is not None else 1.0))
        if found:
            return max(found, key=lambda each: (each.probability, -each.seconds))
        return self._composed_success(at, node)

    def _composed_success(self, at: _TreeBudgets, node: SourceNode) -> Success | None:
        if node.category == "SubTree":
            root = self._run_before(node)
            found = self._in(self._nodes.within(root.item)).successes[id(root)] if root is not None else None
            return Success(found.seconds, found.probability) if found is not None else None
        budget = at.composed[id(node)]
        if not node.children:
            sure = budget.success is not None and budget.failure is None and budget.success.high < inf
            return Success(budget.success.high, 1.0) if sure and budget.success is not None else None
        if _may_be_passed(node):
            return None
        parts = [_success_as_part(child, at.successes[id(child)]) for child in node.children]
        known = [part for part in parts if part is not None]
        if len(known) < len(node.node.children):
            return None
        return _success_of(node, known)


def _may_be_passed(node: SourceNode) -> bool:
    """Whether the outcome of one of a node's children may be another than that of what it does."""
    return any(pair.key.text in _CHANGING for child in node.children for pair in child.node.attributes)


def _success_of(node: SourceNode, parts: list[Success]) -> Success | None:
    """By the union bound: what all its parts do is as unlikely to be missed as the sum of what each of them misses."""
    first = parts[0]
    together = tuple(part for each in parts for part in each.parts)
    missed = fsum([1.0 - part.probability for part in parts])
    if node.tag in ("Sequence", "AsyncSequence", "SequenceWithMemory"):
        return Success(fsum([part.seconds for part in parts]), max(0.0, 1.0 - missed), together)
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


def _success_as_part(node: SourceNode, found: Success | None) -> Success | None:
    """A child's success, as a part of its parent's."""
    return Success(found.seconds, found.probability, ((node, 1.0 - found.probability),)) if found is not None else None


def _is_sure(budget: Budget) -> bool:
    """Whether it has a bound that is not only likely."""
    return budget.is_bounded and budget.probability == 1.0


def _shortest(budget: Budget) -> Budget:
    """The shortest time that a budget allows, for each outcome."""
    found = _with_ranges(budget, lambda each: Range(each.low, each.low) if each is not None else None)
    return replace(found, probability=1.0, endless=False)


def _as_part(node: SourceNode, budget: Budget) -> Budget:
    """A child's budget as its parent sees it: each outcome is one term."""

    def part(each: Range | None) -> Range | None:
        if each is None or (each.high == 0.0 and not each.terms):
            return each
        return Range(each.low, each.high, (Term(node, 1, each.high),) if each.high > 0.0 else ())

    return _with_ranges(budget, part)


def _without_terms(budget: Budget) -> Budget:
    """A budget as another tree sees it: where it comes from is not said."""
    return _with_ranges(budget, lambda each: Range(each.low, each.high) if each is not None and each.terms else each)


def _with_ranges(budget: Budget, change: Callable[[Range | None], Range | None]) -> Budget:
    """change: what is not there, is not there afterwards either."""
    success = change(budget.success)
    failure = success if budget.failure is budget.success else change(budget.failure)
    skip = change(budget.skip) if budget.skip is not None else None
    return Budget(success, failure, skip, budget.waits, budget.probability, "", budget.endless)


def _with_claims(composed: Budget, claims: list[tuple[Applied, Claim]]) -> Budget:
    """What a node is held to; of bounds that may be missed now and then the likeliest, and only where no sure one
    says how long it may take."""
    sure = [claim for applied, claim in claims if applied.requirement.odds is None]
    held = _all_narrowed(composed if composed.probability == 1.0 else _opened(composed), sure)
    if held.is_bounded:
        return held
    choices = [_all_narrowed(composed, sure)] if composed.probability < 1.0 else []
    for applied, claim in claims:
        odds = applied.requirement.odds
        if odds is not None and VERBS[claim.verb].limits == "completion":
            choices.append(replace(_narrowed(held, claim), probability=odds.probability))
    choices = [each for each in choices if each.is_bounded]
    return max(choices, key=lambda each: each.probability, default=held)


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
    return Budget(success, failure, skip, budget.waits, 1.0, budget.reason, budget.endless)


def _all_narrowed(budget: Budget, claims: list[Claim]) -> Budget:
    for claim in claims:
        budget = _narrowed(budget, claim)
    return budget


def _narrowed(budget: Budget, claim: Claim) -> Budget:
    """A budget, if a claim holds, too.  Where both cannot hold, the claim counts: the other is told at its place."""
    limits = VERBS[claim.verb].limits
    if claim.limit is None or not limits:
        return budget
    allowed = _range(claim.limit)
    if limits == "success":
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


_MOST_GAPS: Final = 5
_CONDITION: Final = Budget(ZERO, ZERO, None, False)
_NO_CLAUSE: Final = Budget(ANY, ANY, None, reason="has no `takes` clause")
_SURE: Final = Success(0.0, 1.0)
_XML: Final = unknown("has a child in XML")
_CHANGING: Final = frozenset(("_failureIf", "_successIf", "_skipIf", "_while"))
