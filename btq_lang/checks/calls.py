"""Which tree runs which: the SubTree nodes of a scope as a graph."""

from __future__ import annotations

from collections.abc import Iterable, KeysView, Mapping, Set
from functools import cached_property
from typing import TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import TREE_OF_GOAL
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.util.reach import reached
from btq_lang.workspace.queries import Store, hub
from btq_lang.workspace.symbols import Use
from btq_lang.workspace.workspace import Workspace

# The trees that a tree runs, and those that it probably means to run, if `SubTree` is missing, or has run for a goal.
Runs: TypeAlias = "tuple[tuple[str, ...], tuple[str, ...]]"


def calls(store: Store[Workspace], viewpoint: str) -> Calls:
    """Which tree runs which, for all trees in scope; those of the file come first, for a circle is reported at its
    first tree, and included XML may not know that it is in one."""
    view = View(store, viewpoint)
    names = dict.fromkeys((*view.look_up(lookups.own_trees), *view.names(Kind.TREE)))
    return Calls({name: view.ask(_runs, name) for name in names})


def callers(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[str, ...]:
    """The other trees that run a tree, or probably mean to."""
    return store.ask(calls, viewpoint).callers.get(tree, ())


def is_missed(store: Store[Workspace], viewpoint: str, tree: str) -> bool:
    """Whether the mission certainly does not run a tree, neither directly nor through others."""
    return tree in store.ask(_missed, viewpoint)


def is_uncreated(store: Store[Workspace], viewpoint: str, tree: str) -> bool:
    """Whether certainly none of the main trees of a factory runs a tree."""
    return tree in store.ask(_uncreated, viewpoint)


def circle(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[str, ...] | None:
    """The shortest way from a tree back to itself, both ends included; of trees that reach each other only the first
    has one: there it is reported."""
    return store.ask(_circles, viewpoint).get(tree)


def has_gaps(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether a SubTree names an unknown tree, so that it is not known which trees are reached."""
    return not View(store, viewpoint).is_complete or store.ask(calls, viewpoint).has_gaps


@hub
def _circles(store: Store[Workspace], viewpoint: str) -> dict[str, tuple[str, ...]]:
    """All circles: hardly any mission has one, so that after an edit no tree looks for its own again."""
    return store.ask(calls, viewpoint).circles


@hub
def _missed(store: Store[Workspace], viewpoint: str) -> Set[str]:
    view = View(store, viewpoint)
    mains = view.look_up(lookups.main_trees)
    if not mains or view.ask(has_gaps) or not view.is_read:
        return frozenset()
    known = view.ask(calls)
    if not known.names & set(mains):
        return frozenset()  # which is reported
    return known.names - known.reached_from(*mains)


@hub
def _uncreated(store: Store[Workspace], viewpoint: str) -> Set[str]:
    """Those of all trees in scope; an unknown tree matters only if a main tree reaches it."""
    view = View(store, viewpoint)
    mains = view.look_up(lookups.main_trees)
    if not mains or not view.is_complete or not view.is_read:
        return frozenset()
    known = view.ask(calls)
    created = known.reached_from(*mains)
    return known.names - created if known.names >= created else frozenset()


class Calls:
    """The trees of a scope, by name, with the trees that each of them runs as SubTree.

    Attributes:
        has_gaps: whether a SubTree names an unknown tree, so that it is not known which trees are reached.
    """

    def __init__(self, runs: Mapping[str, Runs]) -> None:
        self._called = {name: called for name, (called, _) in runs.items()}
        self._meant = {name: meant for name, (_, meant) in runs.items()}
        self.has_gaps = any(name not in runs for names in self._called.values() for name in names)

    def __eq__(self, other: object) -> bool:
        """Whether both are equal for every tree, in the same order."""
        return isinstance(other, Calls) and (
            (self._called, self._meant, [*self._called]) == (other._called, other._meant, [*other._called])
        )

    __hash__ = None  # type: ignore[assignment]  # it is never hashed

    def called_by(self, name: str) -> tuple[str, ...]:
        """The trees that a tree runs, in the order of their SubTrees; empty for an unknown tree."""
        return self._called.get(name, ())

    @property
    def names(self) -> KeysView[str]:
        """The trees."""
        return self._called.keys()

    @cached_property
    def callers(self) -> dict[str, tuple[str, ...]]:
        """The other trees that run a tree, or probably mean to."""
        meant = _turned(self._meant)
        found = {name: (*callers, *meant.pop(name, ())) for name, callers in self._callers.items()}
        return found | {name: tuple(callers) for name, callers in meant.items()}

    def reached_from(self, *names: str) -> frozenset[str]:
        """Trees and all that they run, directly or not, including those that they probably mean to run."""
        return frozenset(reached(names, lambda name: (*self.called_by(name), *self._meant.get(name, ()))))

    @cached_property
    def circles(self) -> dict[str, tuple[str, ...]]:
        """The shortest way from a tree back to itself, for the first tree of each knot."""
        return {name: self._circle(name, knot) for name, knot in self.knots.items()}

    def _circle(self, name: str, knot: frozenset[str]) -> tuple[str, ...]:
        before: dict[str, str] = {}
        waiting = [name]
        for tree in waiting:
            for called in self.called_by(tree):
                if called == name:
                    way = [name, tree]
                    while way[-1] != name:
                        way.append(before[way[-1]])
                    return tuple(reversed(way))
                if called in knot and called not in before:
                    before[called] = tree
                    waiting.append(called)
        raise AssertionError("each tree of a knot reaches itself")

    @cached_property
    def _callers(self) -> dict[str, list[str]]:
        return _turned(self._called)

    @cached_property
    def callees_first(self) -> tuple[str, ...]:
        """The trees, each after those that it runs, except in circles."""
        called = self._called
        finished: dict[str, None] = {}
        begun: set[str] = set()
        for start in called:
            waiting = [start] if start not in begun else []
            while waiting:
                tree = waiting[-1]
                if tree in begun:
                    waiting.pop()
                    finished[tree] = None
                    continue
                begun.add(tree)
                if called[tree]:
                    waiting += [each for each in called[tree] if each in called and each not in begun]
        return tuple(finished)

    @cached_property
    def knots(self) -> dict[str, frozenset[str]]:
        """The strongly connected components that contain a circle, each under the first of its trees (Kosaraju)."""
        finished = self.callees_first
        place_of = {name: number for number, name in enumerate(finished)}
        if all(place_of.get(called, -1) < place_of[name] for name in finished for called in self._called[name]):
            return {}  # as in nearly all files
        knots: dict[str, frozenset[str]] = {}
        place = {name: number for number, name in enumerate(self._called)}
        left_over = set(finished)
        for start in reversed(finished):
            knot: set[str] = set()
            waiting = [start] if start in left_over else []
            while waiting:
                tree = waiting.pop()
                if tree in left_over:
                    left_over.remove(tree)
                    knot.add(tree)
                    waiting += self._callers.get(tree, ())
            if len(knot) > 1 or (knot and start in self.called_by(start)):
                knots[min(knot, key=place.__getitem__)] = frozenset(knot)
        return knots


def _turned(graph: Mapping[str, Iterable[str]]) -> dict[str, list[str]]:
    turned: dict[str, list[str]] = {}
    for name, called in graph.items():
        for tree in called:
            if tree != name:
                turned.setdefault(tree, []).append(name)
    return turned


def _runs(store: Store[Workspace], viewpoint: str, tree: str) -> Runs:
    view = View(store, viewpoint)
    found = view.definition(Kind.TREE, tree)
    if found is None:
        return (), ()
    uses = found[1].summary.uses
    called = dict.fromkeys([use.name for use in uses if use.kind is Kind.TREE])
    declared = {seen.id.text for seen in view.seen_in(*found).subtrees if seen.id is not None}  # by a model, perhaps
    meant = [name for use in uses for name in (_meant(use), _for_goal(use)) if name and name not in declared]
    trees = {name for name in (*meant, *declared) if name not in called and view.defines(Kind.TREE, name)}
    called.update(dict.fromkeys(sorted(declared & trees)))
    return tuple(called), tuple([name for name in meant if name in trees])


def _meant(use: Use) -> str:
    """The tree that a node's kind may mean: `PickPlace`, `Subtree PickPlace`."""
    node = use.node
    if node is not None and node.label is not None and use.name.casefold() == "subtree":
        return node.label.text
    return use.name if use.kind is Kind.MODEL else ""


def _for_goal(use: Use) -> str:
    """The tree that another program runs for a node."""
    pairs = use.node.attributes if use.node is not None else ()
    return next((pair.value.text for pair in pairs if pair.key.text == TREE_OF_GOAL and pair.value is not None), "")
