"""What is reached from something, step by step, and what reaches itself."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from typing import TypeVar

T = TypeVar("T", bound=Hashable)


def reached(starts: Iterable[T], following: Callable[[T], Iterable[T]]) -> Iterator[T]:
    """Some things and all that follows them, directly or not: each once, the nearest first."""
    waiting = [*dict.fromkeys(starts)]
    seen = set(waiting)
    for each in waiting:
        yield each
        for other in following(each):
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
            each = path[-1]
            if each not in numbers:
                numbers[each] = lowest[each] = len(numbers)
                waiting.append(each)
                left[each] = iter(graph[each])
            following = next((other for other in left[each] if other in graph and other not in numbers), None)
            if following is not None:
                path.append(following)
                continue
            path.pop()
            lowest[each] = min(lowest[other] for other in (each, *graph[each]) if other in lowest)
            if lowest[each] == numbers[each]:
                knot: set[T] = set()
                while each in lowest:
                    other = waiting.pop()
                    knot.add(other)
                    del lowest[other]
                if len(knot) > 1 or each in graph[each]:
                    yield knot
