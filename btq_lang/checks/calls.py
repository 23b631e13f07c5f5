"""Which tree runs which: the SubTree nodes of a scope as a graph."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property

from btq_lang.symbols import Kind, Use
from btq_lang.workspace import Scope, Workspace


class Calls:
    """The trees of a scope, by name, with the trees that each of them runs as SubTree.

    Attributes:
        has_gaps: a SubTree names a tree that nobody knows, so that what is reached cannot be told.
    """

    def __init__(self, workspace: Workspace, scope: Scope) -> None:
        self._called: dict[str, tuple[str, ...]] = {}
        self._meant: dict[str, list[str]] = {}
        trees = frozenset(scope.names(Kind.TREE))
        for name in scope.names(Kind.TREE):
            definition = scope.find(Kind.TREE, name)
            assert definition is not None, "the scope has just named it"
            uses = workspace.files[definition.path].summary_of(definition.entry).uses
            self._called[name] = tuple(dict.fromkeys(use.name for use in uses if use.kind is Kind.TREE))
            self._meant[name] = [use for use in map(_meant, uses) if use in trees]
        self.has_gaps = not scope.complete or any(
            called not in trees for names in self._called.values() for called in names
        )

    def called_by(self, name: str) -> tuple[str, ...]:
        """The trees that a tree runs, in the order of their SubTrees; none for an unknown tree."""
        return self._called.get(name, ())

    def callers(self, name: str) -> tuple[str, ...]:
        """The other trees that run a tree, or mean to."""
        return (*self._callers.get(name, ()), *self._meant_by.get(name, ()))

    def reached_from(self, name: str) -> frozenset[str]:
        """A tree and all that it runs, directly or not, and those that it means to run: where `SubTree` is missing."""
        if name not in self._reached:
            seen: set[str] = set()
            waiting = [name]
            while waiting:
                tree = waiting.pop()
                if tree not in seen:
                    seen.add(tree)
                    waiting += self.called_by(tree)
                    waiting += self._meant.get(tree, ())
            self._reached[name] = frozenset(seen)
        return self._reached[name]

    def circle(self, name: str) -> tuple[str, ...] | None:
        """The shortest way from a tree back to itself, both ends included; None where there is none, and at all but
        the first tree of those that reach each other: there it is told."""
        knot = self._knots.get(name)
        if knot is None:
            return None
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
        return None

    @cached_property
    def _reached(self) -> dict[str, frozenset[str]]:
        return {}

    @cached_property
    def _callers(self) -> dict[str, list[str]]:
        return _turned(self._called)

    @cached_property
    def _meant_by(self) -> dict[str, list[str]]:
        return _turned(self._meant)

    @cached_property
    def _knots(self) -> dict[str, frozenset[str]]:
        """The strongly connected components that hold a circle, each under the first of its trees (Kosaraju)."""
        finished: list[str] = []
        seen: set[str] = set()
        for start in self._called:
            stack = [(start, iter(self.called_by(start)))] if start not in seen else []
            seen.add(start)
            while stack:
                tree, left = stack[-1]
                further = next((called for called in left if called in self._called and called not in seen), None)
                if further is not None:
                    seen.add(further)
                    stack.append((further, iter(self.called_by(further))))
                else:
                    finished.append(tree)
                    stack.pop()
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


def _meant(use: Use) -> str:
    """What a node's kind may name where it should be a tree: `PickPlace`, `Subtree PickPlace`."""
    node = use.node
    if node is not None and node.label is not None and use.name.casefold() == "subtree":
        return node.label.text
    return use.name if use.kind is Kind.MODEL else ""
