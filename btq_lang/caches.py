"""`cache` and `cached_property`, as `functools` has them, and caches that do not grow without end.

Why not `functools`: with what it imports it takes a twentieth of a small check, of which most others need nothing.
Deliberately left out: arguments by keyword and locks.
"""

from __future__ import annotations

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Callable
    from functools import cached_property as cached_property
    from typing import Any, TypeVar

    from typing_extensions import ParamSpec

    P = ParamSpec("P")
    T = TypeVar("T")
    K = TypeVar("K")
    V = TypeVar("V")
else:

    class cached_property:
        """An attribute that is worked out when it is first read; it is kept in the object's `__dict__`."""

        def __init__(self, function):
            self.function = function
            self.__doc__ = function.__doc__

        def __set_name__(self, owner, name):
            self.name = name

        def __get__(self, instance, owner=None):
            if instance is None:
                return self
            value = instance.__dict__[self.name] = self.function(instance)
            return value


def cache(function: Callable[P, T]) -> Callable[P, T]:
    """A function that is worked out once for each of its arguments."""
    return cache_of(None)(function)


def cache_of(limit: int | None) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """The same for so many different arguments; when there are more, it begins anew."""

    def caching(function: Callable[P, T]) -> Callable[P, T]:
        with_all: Callable[..., T] = function
        known: Answered[tuple[Any, ...], T] = Answered(lambda arguments: with_all(*arguments), limit)

        def ask(*arguments: Any) -> Any:
            return known[arguments]

        ask.__doc__ = function.__doc__
        return ask  # type: ignore[return-value]  # it takes what the function takes

    return caching


class Answered(dict["K", "V"]):
    """What a function of one argument has answered; `known[argument]` costs no call, where each word of a file asks."""

    def __init__(self, function: Callable[[K], V], limit: int | None) -> None:
        self.function = function
        self.limit = limit

    def __missing__(self, argument: K) -> V:
        value = self.function(argument)
        if self.limit is not None and len(self) >= self.limit:
            self.clear()
        self[argument] = value
        return value
