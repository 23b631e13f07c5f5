"""Durations: ranges of seconds, how they add up, and what the longest one is made of.

One invariant: the result of an operation contains every duration that its operands allow.  `None` is the range of what
cannot happen; infinity is the end of a range without a bound.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import inf
from typing import Final

from btq_lang.util.record import Record, replace
from btq_lang.workspace.resolved import ResolvedNode


class DurationTerm(Record):
    """A node's share of a duration: `times` runs of at most `seconds` each."""

    node: ResolvedNode
    times: int
    seconds: float


class Range(Record):
    """From `low` to `high` seconds.

    Attributes:
        terms: what `high` is the sum of.
    """

    low: float
    high: float
    terms: tuple[DurationTerm, ...] = ()


ZERO: Final = Range(0.0, 0.0)
ANY: Final = Range(0.0, inf)


def plus(first: Range | None, second: Range | None) -> Range | None:
    """One after the other."""
    if first is None or second is None:
        return None
    return Range(first.low + second.low, first.high + second.high, first.terms + second.terms)


def hull(*ranges: Range | None) -> Range | None:
    """The one or the other."""
    longest: Range | None = None
    low = inf
    for each in ranges:
        if each is not None:
            low = min(low, each.low)
            if longest is None or each.high > longest.high:
                longest = each
    if longest is None or longest.low == low:
        return longest
    return Range(low, longest.high, longest.terms)


def times(count: int, each: Range | None) -> Range | None:
    """So many of the same, one after the other."""
    if count == 0:
        return ZERO
    if each is None:
        return None
    terms = tuple(replace(term, times=term.times * count) for term in each.terms)
    return Range(each.low * count, each.high * count, terms)


def cut(each: Range | None, at: float) -> Range | None:
    """The part that takes no longer than this."""
    if each is None or each.low > at:
        return None
    if each.high <= at:
        return each
    return Range(each.low, at, tuple(replace(term, seconds=at) for term in each.terms[:1]))


def from_zero(each: Range | None) -> Range | None:
    """The same and anything shorter: it can be interrupted."""
    return replace(each, low=0.0) if each is not None else None


def without_end(each: Range | None) -> Range | None:
    """The same and anything longer."""
    return Range(each.low, inf) if each is not None else None


def total(ranges: Iterable[Range | None]) -> Range | None:
    """All of them, one after the other."""
    result: Range | None = ZERO
    for each in ranges:
        result = plus(result, each)
    return result


def together(terms: Iterable[DurationTerm]) -> tuple[DurationTerm, ...]:
    """Terms with equal ones merged."""
    found: dict[tuple[int, float], DurationTerm] = {}
    for term in terms:
        key = id(term.node), term.seconds
        same = found.get(key)
        found[key] = term if same is None else replace(same, times=same.times + term.times)
    return tuple(found.values())
