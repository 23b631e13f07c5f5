"""What is reached from something, step by step."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator
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
