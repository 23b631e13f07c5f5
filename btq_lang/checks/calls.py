"""Which tree runs which: the SubTree nodes of a scope as a graph."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from itertools import chain
from typing import TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import TREE_OF_GOAL
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.util.reach import knots, reached
from btq_lang.workspace import inputs
from btq_lang.workspace.inputs import of_scope
from btq_lang.workspace.queries import Store, hub
from btq_lang.workspace.symbols import Use
from btq_lang.workspace.workspace import Workspace

# The trees that a tree runs, and those that it probably means to run, if `SubTree` is missing, or has run for a goal.
Runs: TypeAlias = "tuple[tuple[str, ...], tuple[str, ...]]"


@hub
@of_scope
def callers(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[str, ...]:
    """The other trees that run a tree, or probably mean to."""
    return store.ask(_callers, viewpoint).get(tree, ())


@hub
def is_main(store: Store[Workspace], viewpoint: str, tree: str) -> bool:
    """Whether a program may create a tree itself."""
    return tree in store.ask(lookups.main_trees, viewpoint)


def runs(store: Store[Workspace], viewpoint: str, tree: str, other: str) -> bool:
    """Whether a tree runs another one, directly or through others, or probably means to."""
    return other in _run_from((tree,), dict(store.ask(_graph, viewpoint)))


def is_missed(store: Store[Workspace], viewpoint: str, tree: str) -> bool:
    """Whether the mission certainly does not run a tree, neither directly nor through others."""
    return tree in store.ask(_missed, viewpoint)


def is_uncreated(store: Store[Workspace], viewpoint: str, tree: str) -> bool:
    """Whether certainly none of the main trees of a factory runs a tree."""
    return tree in store.ask(_uncreated, viewpoint)


def circle(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[str, ...] | None:
    """The shortest way from a tree back to itself, both ends included.  Of the trees of a circle only the first has
    one, as it is reported there."""
    return store.ask(_circles, viewpoint).get(tree)


def has_gaps(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether a SubTree names no tree or an unknown one, so that the reached trees are unknown."""
    view = View(store, viewpoint)
    graph = dict(view.ask(_graph))
    return not view.ask(inputs.is_complete) or any(name not in graph for called, _ in graph.values() for name in called)


def has_meant(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether a node probably means to run a tree, or has it run for a goal."""
    return any(meant for _, (_, meant) in store.ask(_graph, viewpoint))


@of_scope
def _graph(store: Store[Workspace], viewpoint: str) -> tuple[tuple[str, Runs], ...]:
    """All trees in scope."""
    view = View(store, viewpoint)
    return tuple([(name, view.ask(_runs, name)) for name in view.ask(inputs.names, Kind.TREE)])


@hub
@of_scope
def _callers(store: Store[Workspace], viewpoint: str) -> dict[str, tuple[str, ...]]:
    graph = store.ask(_graph, viewpoint)
    probable = [(name, names) for name, (_, names) in graph]
    return _turned((*[(name, called) for name, (called, _) in graph], *probable))


@hub
def _circles(store: Store[Workspace], viewpoint: str) -> dict[str, tuple[str, ...]]:
    """All circles.  Hardly any mission has one, so after an edit no tree looks for its own again.

    The trees of the file come first, for included XML may not see that it is in a circle.
    """
    graph = {name: called for name, (called, _) in store.ask(_graph, viewpoint)}
    names = dict.fromkeys((*store.ask(lookups.own_trees, viewpoint), *graph))
    places = {name: place for place, name in enumerate(names)}
    circles: dict[str, tuple[str, ...]] = {}
    for knot in knots(graph):
        first = min(knot, key=places.__getitem__)
        circles[first] = _way_back(first, {name: [called for called in graph[name] if called in knot] for name in knot})
    return circles


@hub
def _missed(store: Store[Workspace], viewpoint: str) -> Set[str]:
    view = View(store, viewpoint)
    mains = view.ask(lookups.main_trees)
    if not mains or view.ask(has_gaps) or not view.is_read:
        return frozenset()
    graph = dict(view.ask(_graph))
    if graph.keys().isdisjoint(mains):
        return frozenset()  # which is reported
    return graph.keys() - _run_from(mains, graph)


@hub
def _uncreated(store: Store[Workspace], viewpoint: str) -> Set[str]:
    """The trees in scope that no main tree runs; empty if a main tree reaches an unknown one."""
    view = View(store, viewpoint)
    mains = view.ask(lookups.main_trees)
    if not mains or not view.ask(inputs.is_complete) or not view.is_read:
        return frozenset()
    graph = dict(view.ask(_graph))
    created = _run_from(mains, graph)
    return graph.keys() - created if graph.keys() >= created else frozenset()


def _run_from(mains: tuple[str, ...], graph: Mapping[str, Runs]) -> Set[str]:
    """Trees and all that they run, directly or not, including those that they probably mean to run."""
    return {*reached(mains, lambda name: chain(*graph.get(name, ())))}


def _way_back(start: str, graph: Mapping[str, Iterable[str]]) -> tuple[str, ...]:
    """The shortest way from a tree to itself, both ends included."""
    predecessors: dict[str, str] = {}
    for tree in reached([start], graph.__getitem__):
        for called in graph[tree]:
            predecessors.setdefault(called, tree)
    way = [start, predecessors[start]]
    while way[-1] != start:
        way.append(predecessors[way[-1]])
    return tuple(reversed(way))


def _turned(graph: Iterable[tuple[str, Iterable[str]]]) -> dict[str, tuple[str, ...]]:
    """The other trees that run each tree."""
    turned: dict[str, list[str]] = {}
    for name, called in graph:
        for tree in called:
            if tree != name:
                turned.setdefault(tree, []).append(name)
    return {tree: tuple(names) for tree, names in turned.items()}


@of_scope
def _runs(store: Store[Workspace], viewpoint: str, tree: str) -> Runs:
    view = View(store, viewpoint)
    definition = view.ask(inputs.definition, Kind.TREE, tree)
    if definition is None:
        return (), ()
    uses = definition[1].summary.uses
    called = dict.fromkeys([use.name for use in uses if use.kind is Kind.TREE])
    subtrees = view.seen_in(*definition).subtrees
    declared = {resolved.id.text for resolved in subtrees if resolved.id is not None}  # by a model, perhaps
    meant_trees = [name for use in uses for name in (_meant_tree(use), _for_goal(use)) if name and name not in declared]
    trees = {
        name
        for name in (*meant_trees, *declared)
        if name not in called and view.ask(lookups.is_defined, Kind.TREE, name)
    }
    called.update(dict.fromkeys(sorted(declared & trees)))
    called.update(dict.fromkeys("" for resolved in subtrees if resolved.id is None))
    return tuple(called), tuple([name for name in meant_trees if name in trees])


def _meant_tree(use: Use) -> str:
    """The tree that a node's kind may mean: `PickPlace`, `Subtree PickPlace`."""
    node = use.node
    if node is not None and node.label is not None and use.name.casefold() == "subtree":
        return node.label.text
    return use.name if use.kind is Kind.MODEL else ""


def _for_goal(use: Use) -> str:
    """The tree that another program runs for a node."""
    pairs = use.node.attributes if use.node is not None else ()
    return next((pair.value.text for pair in pairs if pair.key.text == TREE_OF_GOAL and pair.value is not None), "")
