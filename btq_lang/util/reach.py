"""Reachability in graphs, and their cycles."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from typing import TypeVar

T = TypeVar("T", bound=Hashable)


def reached(starts: Iterable[T], following: Callable[[T], Iterable[T]]) -> Iterator[T]:
    """The starts and all that is reachable from them, each once, the nearest first.

    Args:
        following: returns the successors of a node.
    """
    waiting = [*dict.fromkeys(starts)]
    seen = set(waiting)
    for node in waiting:
        yield node
        for other in following(node):
            if other not in seen:
                seen.add(other)
                waiting.append(other)


def knots(graph: Mapping[T, Iterable[T]]) -> Iterator[set[T]]:
    """The sets of nodes that reach each other, and themselves (Tarjan's strongly connected components).

    Args:
        graph: the successors of each node; a successor that is not a key is ignored.
    """
    numbers: dict[T, int] = {}  # in the order in which they are met
    lowest: dict[T, int] = {}  # the lowest number that each node reaches, while its knot is open
    waiting: list[T] = []  # for their knot to be complete
    left: dict[T, Iterator[T]] = {}
    for start in graph:
        path = [] if start in numbers else [start]
        while path:
            node = path[-1]
            if node not in numbers:
                numbers[node] = lowest[node] = len(numbers)
                waiting.append(node)
                left[node] = iter(graph[node])
            following = next(
                (neighbour for neighbour in left[node] if neighbour in graph and neighbour not in numbers), None
            )
            if following is not None:
                path.append(following)
                continue
            path.pop()
            lowest[node] = min(lowest[neighbour] for neighbour in (node, *graph[node]) if neighbour in lowest)
            if lowest[node] == numbers[node]:
                knot: set[T] = set()
                while node in lowest:
                    neighbour = waiting.pop()
                    knot.add(neighbour)
                    del lowest[neighbour]
                if len(knot) > 1 or node in graph[node]:
                    yield knot
