"""What the rules about demands share: which claims hold for which nodes, where to tell of them, and in which words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import inf
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.verbs import VERBS
from btq_lang.diagnostics.model import Diagnostic, Place
from btq_lang.requirements.memory import Asker
from btq_lang.requirements.model import Applied, Bounded, Claim, Signal, SourceNode, Span, Table, Value
from btq_lang.syntax.tree import Model, Tree
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.btcpp.judging import Judge
    from btq_lang.checks.swallowing import WaysUp
    from btq_lang.checks.view import View
    from btq_lang.checks.writers import Entries
    from btq_lang.requirements.budgets import Budgets
    from btq_lang.requirements.durations import Term
    from btq_lang.requirements.memory import Question
    from btq_lang.requirements.resolved import Requirements
    from btq_lang.requirements.trees import TreeNodes
    from btq_lang.syntax.tree import Port

Found: TypeAlias = tuple[Place, Diagnostic]


Guard: TypeAlias = tuple[tuple[Signal, ...], Place]


class Demanded(Asker):
    """What is demanded in a file.  Rules look at one tree after the other; what they want to know of other trees, they
    ask, and it is noted.

    Attributes:
        files: those whose names the file can use.
        budgets: how long the nodes take if they all hold.
        tree: the tree that is looked at.
        claims: all that hold for nodes of it and can be told of in this file: what is applied, the claim, the node (of
            a span the one that takes as long), and where to tell of it.
        hard: all that are to be enforced, for whichever node of it; the place is None where nothing in this file speaks
            of it; and why the engine does not hold it, if it does not.
        noted: what was asked of other trees.
        ways_up, ways_up_before: what is found out of the ways from trees to the mission's root, and what was.
        renewing: by the `id` of a tree and the name of an entry, the `id`s of the nodes that write it there, and of
            those with such a node in them, or in a tree that they run.
        turned: the trees of whose callers others were known then: what was found of a way through one holds no more.
        ends_at: of SubTree nodes on these ways, what a failure below them ends at.
    """

    tree: TreeNodes
    claims: tuple[tuple[Applied, Claim, SourceNode, Place], ...]
    hard: tuple[tuple[Applied, Claim, SourceNode, Place | None, str | None], ...]

    def __init__(self, view: View) -> None:
        assert view.requirements is not None, "the rules are asked only where there are requirements"
        assert view.budgets is not None, "there are budgets where there are requirements"
        self.view = view
        self.files = [view.workspace.files[path] for path in view.workspace.scope(view.path).paths]
        self.requirements: Requirements = view.requirements
        self.budgets: Budgets = view.budgets
        self.noted: dict[Question, object] = {}
        self.news: dict[object, frozenset[object]] = {}
        self._answers: dict[Question, object] = {}
        self.ways_up: dict[str | None, WaysUp] = {}
        mission = self.requirements.mission
        of_ways = Callers(self.requirements.nodes.callers_by_tree, mission.tree if mission is not None else None)
        self.ways_up_before: dict[str | None, WaysUp] = view.resolved.ways_up[0]
        self.turned: frozenset[str | None] = of_ways.turned_since(view.resolved.ways_up[1])
        self.ends_at: dict[SourceNode, Any] = {}
        self.renewing: dict[tuple[int, str], tuple[set[int], set[int]]] = {}
        self._ports: dict[str, tuple[Port, ...]] | None = None
        self._entries: list[Entries] | None = None
        view.resolved.ways_up = self.ways_up, of_ways

    def look_at(self, tree: TreeNodes) -> None:
        """What follows is about the nodes of this tree."""
        self.tree = tree
        self.claims = tuple(_claims(self.view, self.requirements.in_tree(tree), self.budgets))
        for _, _, node, _ in self.claims:
            if node.category == "SubTree":
                self.ask((_root, node))  # budgets of it name the root
        self.hard = tuple(_hard_claims(self))

    def ask(self, question: Question) -> Any:
        """What is so outside of the tree: a function, called with this and with what it is asked about."""
        answer = self.noted[question] = self.answer(question)
        return answer

    def answer(self, question: Question) -> Any:
        """What the answer is now."""
        if question not in self._answers:
            what, about = question
            self._answers[question] = what(self, about)
        return self._answers[question]

    @property
    def entries(self) -> list[Entries]:
        """The entries that nodes name, for each tree in scope."""
        if self._entries is None:
            from btq_lang.checks.writers import entries_of  # few missions have a signal

            noted, self.noted = self.noted, {}
            table = self.view.resolved.table("entries", self)
            trees = self.requirements.nodes.trees
            self._entries = table.all(trees, [None] * len(trees), lambda at: entries_of(self, trees[at]))
            self.noted = noted
        return self._entries

    @property
    def ports(self) -> dict[str, tuple[Port, ...]]:
        """Those that the trees and models in scope declare, by their names; of a tree that has none, a model's."""
        if self._ports is None:
            self._ports = {}
            for kind in (Kind.MODEL, Kind.TREE):
                counting: dict[str, object] = {}  # of several of one name the first one
                for file in self.files:
                    for symbol in file.names.symbols[kind]:
                        counting.setdefault(symbol.name, symbol.target)
                for name, target in counting.items():
                    if isinstance(target, (Tree, Model)) and target.ports:
                        self._ports[name] = target.ports
        return self._ports


class Callers(Record):
    """Which SubTree nodes run each tree, and the mission's tree, which is looked at no further."""

    by_tree: dict[str, tuple[SourceNode, ...]]
    mission: str | None

    def turned_since(self, before: Callers | None) -> frozenset[str | None]:
        """The trees of which others were said then."""
        known = before.by_tree if before is not None else {}
        if known is self.by_tree and before is not None and before.mission == self.mission:
            return frozenset()
        names = [*known, *(self.by_tree.keys() - known.keys())]
        turned = [name for name in names if known.get(name) is not self.by_tree.get(name)]
        was = before.mission if before is not None else None
        return frozenset((*turned, *((was, self.mission) if was != self.mission else ())))


def _hard_claims(
    demanded: Demanded,
) -> Iterator[tuple[Applied, Claim, SourceNode, Place | None, str | None]]:
    in_tree = demanded.requirements.in_tree(demanded.tree)
    held = [applied for applied in in_tree if applied.requirement.action in ("fail", "halt")]
    if not held:
        return
    judge = judge_of(demanded)
    for applied in held:
        for claim in applied.requirement.claims:
            node = _node(applied, claim, demanded.budgets) or applied.nodes[0]
            place = told_at(demanded.view, applied, claim)
            if place is None and node.path == demanded.view.path:
                place = node.place
            yield applied, claim, node, place, judge.why_not(applied, claim)


def _root(demanded: Demanded, node: SourceNode) -> SourceNode | None:
    return demanded.requirements.nodes.run_by(node)


def judge_of(demanded: Demanded) -> Judge:
    """Who judges what is written if all files are written as one.  `demanded` must not hold it, for it is held by it:
    both would stay until Python looks for garbage."""
    from btq_lang.btcpp.judging import Judge  # few missions have a claim that is to be enforced

    is_shared = bool(demanded.ask((_is_included, demanded.view.path)))
    return Judge(_Looks(demanded), files=None, is_shared=is_shared)


class _Looks:
    """As of a judge; what is so in other trees is noted.  No functions within a function: compiled ones
    hold each other."""

    def __init__(self, demanded: Demanded) -> None:
        self._demanded: Final = demanded

    def waits(self, node: SourceNode) -> bool:
        return self._demanded.budgets.composed(node).waits

    def is_skipped(self, node: SourceNode) -> bool:
        demanded = self._demanded
        ask = demanded.answer if node.item is demanded.tree.item else demanded.ask
        return bool(ask((_is_skipped, node)))

    def of_span(self, span: Span) -> SourceNode | None:
        from btq_lang.requirements.spans import node_of

        return node_of(span, self._demanded.budgets)

    def begins(self) -> bool:
        return bool(self._demanded.ask((_begins, "")))

    def mission(self) -> SourceNode | None:
        mission: SourceNode | None = self._demanded.ask((_mission, ""))
        return mission


def _is_skipped(demanded: Demanded, node: SourceNode) -> bool | None:
    """None: the node is gone."""
    nodes = demanded.requirements.nodes
    return demanded.budgets.composed(node).skip is not None if nodes.has(node.item) else None


def _is_included(demanded: Demanded, path: str) -> int:
    return int(path in demanded.view.workspace.included_files)


def _begins(demanded: Demanded, _: str) -> int:
    return int(demanded.requirements.mission is not None)


def _mission(demanded: Demanded, _: str) -> SourceNode | None:
    return demanded.requirements.mission


def _claims(
    view: View, held: Iterable[Applied], budgets: Budgets
) -> Iterator[tuple[Applied, Claim, SourceNode, Place]]:
    for applied in held:
        for claim in applied.requirement.claims:
            node = _node(applied, claim, budgets)
            place = told_at(view, applied, claim) if node is not None else None
            if node is not None and place is not None:
                yield applied, claim, node, place


def _node(applied: Applied, claim: Claim, budgets: Budgets) -> SourceNode | None:
    """The node that a claim is about; of a span the one that takes as long."""
    if isinstance(applied.subject, Span) and VERBS[claim.verb].limits == "completion":
        from btq_lang.requirements.spans import node_of  # few claims speak of a way between two nodes

        return node_of(applied.subject, budgets)
    return applied.node


def told_at(view: View, applied: Applied, claim: Claim) -> Place | None:
    """The claim, or the reference that gave it its values or brought it into this file."""
    if claim.place.path == view.path and not (applied.arguments and applied.how != "subject"):
        return claim.place
    return next((place for place in (applied.place, claim.place) if place.path == view.path), None)


def is_enforced(applied: Applied) -> bool:
    """Whether the robot is to do something about it, and not only to say so."""
    return applied.requirement.action in ("fail", "halt") and applied.requirement.odds is None


def highest(claim: Claim) -> tuple[float, str] | None:
    """The longest that a claim allows in any situation, in SI and as typed; None: it sets no upper limit."""
    limit = claim.limit
    if limit is None or limit.relation in (">=", ">"):
        return None
    bounded = limit.value if limit.upper is None else limit.upper
    return max(values(bounded), key=lambda each: each[0], default=None)


def lowest(claim: Claim) -> tuple[float, str] | None:
    """The least that a claim asks for in any situation, in SI and as typed; None: it sets no lower limit."""
    limit = claim.limit
    if limit is None or limit.relation in ("<=", "<"):
        return None
    return min(values(limit.value), key=lambda each: each[0], default=None)


def values(bounded: Bounded) -> list[tuple[float, str]]:
    """The values of a bound, in SI and as typed; none where one of them is a signal's."""
    simple = [case.value for case in bounded.cases] if isinstance(bounded, Table) else [bounded]
    found = [(value.si, value.text) for value in simple if isinstance(value, Value)]
    return found if len(found) == len(simple) else []


def seconds(value: float) -> str:
    """A duration as people say it: `250 ms`, `45 s`, `2.5 min`."""
    if value == inf:
        return "forever"
    if 0.0 < value < 1.0:
        return f"{value * 1000:.4g} ms"
    for size, unit in ((3600.0, "h"), (60.0, "min")):
        if value >= 2 * size:
            return f"{value / size:.4g} {unit}"
    return f"{value:.4g} s"


def summed(terms: tuple[Term, ...]) -> str:
    """What a duration is the sum of: `A` 20 s + 3 × `B` 5 s."""
    parts = (
        f"{f'{term.times} × ' if term.times > 1 else ''}{term.node.shown} {seconds(term.seconds)}" for term in terms
    )
    return " + ".join(parts)
