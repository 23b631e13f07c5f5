"""Which tree runs which: the SubTree nodes of a scope as a graph."""

from __future__ import annotations

from functools import cached_property

from btq_lang.symbols import Kind
from btq_lang.workspace import Scope, Workspace


class Calls:
    """The trees of a scope, by name, with the trees that each of them runs as SubTree."""

    def __init__(self, workspace: Workspace, scope: Scope) -> None:
        self._called: dict[str, tuple[str, ...]] = {}
        for name in scope.names(Kind.TREE):
            definition = scope.find(Kind.TREE, name)
            assert definition is not None, "the scope has just named it"
            uses = workspace.files[definition.path].summary_of(definition.entry).uses
            self._called[name] = tuple(dict.fromkeys(use.name for use in uses if use.kind is Kind.TREE))

    def called_by(self, name: str) -> tuple[str, ...]:
        """The trees that a tree runs, in the order of their SubTrees; none for an unknown tree."""
        return self._called.get(name, ())

    def callers(self, name: str) -> tuple[str, ...]:
        """The other trees that run a tree."""
        return self._callers.get(name, ())

    def reached_from(self, name: str) -> frozenset[str]:
        """A tree and all that it runs, directly or not."""
        if name not in self._reached:
            seen: set[str] = set()
            waiting = [name]
            while waiting:
                tree = waiting.pop()
                if tree not in seen:
                    seen.add(tree)
                    waiting += self.called_by(tree)
            self._reached[name] = frozenset(seen)
        return self._reached[name]

    def way(self, start: str, end: str) -> tuple[str, ...] | None:
        """The shortest way from a tree to another, both included; None where there is none or no circle holds them."""
        if start not in self._in_circles or end not in self._in_circles:
            return None
        ways: list[tuple[str, ...]] = [(start,)]
        seen = {start}
        for way in ways:
            if way[-1] == end:
                return way
            for called in self.called_by(way[-1]):
                if called not in seen:
                    seen.add(called)
                    ways.append((*way, called))
        return None

    @cached_property
    def _reached(self) -> dict[str, frozenset[str]]:
        return {}

    @cached_property
    def _callers(self) -> dict[str, tuple[str, ...]]:
        callers: dict[str, list[str]] = {}
        for name, called in self._called.items():
            for tree in called:
                if tree != name:
                    callers.setdefault(tree, []).append(name)
        return {name: tuple(trees) for name, trees in callers.items()}

    @cached_property
    def _in_circles(self) -> frozenset[str]:
        """The trees in circles, and those on a way from one circle to another: what is left when trees that call
        nothing, and trees that nothing calls, are taken away again and again."""
        left = {name: {tree for tree in called if tree in self._called} for name, called in self._called.items()}
        left = _without_ends(left)
        turned: dict[str, set[str]] = {name: set() for name in left}
        for name, called in left.items():
            for tree in called:
                turned[tree].add(name)
        return frozenset(_without_ends(turned))


def _without_ends(graph: dict[str, set[str]]) -> dict[str, set[str]]:
    turned: dict[str, list[str]] = {}
    for name, called in graph.items():
        for tree in called:
            turned.setdefault(tree, []).append(name)
    left = {name: set(called) for name, called in graph.items()}
    ends = [name for name, called in left.items() if not called]
    while ends:
        end = ends.pop()
        del left[end]
        for name in turned.get(end, ()):
            left[name].discard(end)
            if not left[name]:
                ends.append(name)
    return left
