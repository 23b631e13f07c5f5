"""What is reached from something, step by step, and what reaches itself."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from typing import TypeVar

T = TypeVar("T", bound=Hashable)


def reached(starts: Iterable[T], following: Callable[[T], Iterable[T]]) -> Iterator[T]:
    """Some things and all that follows them, directly or not: each once, the nearest first."""
    waiting = [*dict.fromkeys(starts)]
    seen = set(waiting)
    for thing in waiting:
        yield thing
        for other in following(thing):
            if other not in seen:
                seen.add(other)
                waiting.append(other)


def knots(graph: Mapping[T, Iterable[T]]) -> Iterator[set[T]]:
    """All that reach themselves, those together that reach each other (Tarjan's strongly connected components).

    Args:
        graph: what follows each; what is not a key of it is ignored.
    """
    numbers: dict[T, int] = {}  # in the order in which they are met
    lowest: dict[T, int] = {}  # that each is known to reach, while its knot is open
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
