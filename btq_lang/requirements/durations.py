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
    """Both, one after the other."""
    if first is None or second is None:
        return None
    return Range(first.low + second.low, first.high + second.high, first.terms + second.terms)


def hull(*ranges: Range | None) -> Range | None:
    """The smallest range that contains all of these."""
    longest: Range | None = None
    low = inf
    for duration in ranges:
        if duration is not None:
            low = min(low, duration.low)
            if longest is None or duration.high > longest.high:
                longest = duration
    if longest is None or longest.low == low:
        return longest
    return Range(low, longest.high, longest.terms)


def times(count: int, duration: Range | None) -> Range | None:
    """A duration repeated `count` times, one after the other."""
    if count == 0:
        return ZERO
    if duration is None:
        return None
    terms = tuple(replace(term, times=term.times * count) for term in duration.terms)
    return Range(duration.low * count, duration.high * count, terms)


def cut(duration: Range | None, limit: float) -> Range | None:
    """The part that takes no longer than `limit` seconds."""
    if duration is None or duration.low > limit:
        return None
    if duration.high <= limit:
        return duration
    return Range(duration.low, limit, tuple(replace(term, seconds=limit) for term in duration.terms[:1]))


def from_zero(duration: Range | None) -> Range | None:
    """The same and anything shorter: it can be interrupted."""
    return replace(duration, low=0.0) if duration is not None else None


def without_end(duration: Range | None) -> Range | None:
    """The same and anything longer."""
    return Range(duration.low, inf) if duration is not None else None


def total(ranges: Iterable[Range | None]) -> Range | None:
    """All of them, one after the other."""
    result: Range | None = ZERO
    for duration in ranges:
        result = plus(result, duration)
    return result


def together(terms: Iterable[DurationTerm]) -> tuple[DurationTerm, ...]:
    """Terms with equal ones merged."""
    merged: dict[tuple[int, float], DurationTerm] = {}
    for term in terms:
        key = id(term.node), term.seconds
        same = merged.get(key)
        merged[key] = term if same is None else replace(same, times=same.times + term.times)
    return tuple(merged.values())
