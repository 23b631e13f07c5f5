"""How long something takes, as probabilities of times on a grid, and how far these may be from the true ones.

One invariant: there are at most so many points, and each true duration is at most `error` from its own,
but for a probability `strays`.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from itertools import accumulate
from typing import Final

from btq_lang.prediction.declared import quantile, share_within
from btq_lang.util.record import Record
from btq_lang.workspace.project_simulation import Spread

MOST: Final = 512  # points of a sum
_MOST_MIXED: Final = 4096  # of one of several, which has those of all
_MOST_OF_SKILL: Final = 4096


class Times(Record):
    """A distribution of durations.

    Attributes:
        points: in milliseconds, ascending.
        masses: of the points; they add up to 1.
        error: how far a duration may be from its point, in milliseconds.
        strays: the probability of durations that are farther from their points.
    """

    points: tuple[int, ...]
    masses: tuple[float, ...]
    error: int = 0
    strays: float = 0.0

    @property
    def mean(self) -> float:
        """The mean, in milliseconds."""
        return sum(point * mass for point, mass in zip(self.points, self.masses, strict=True))

    def percentile(self, share: float) -> int:
        """The first point within which so large a share of the durations is, in milliseconds."""
        sums = [*accumulate(self.masses)]
        return self.points[min(bisect_left(sums, share - _ROUNDING), len(sums) - 1)]

    def below(self, limit: int) -> float:
        """The probability of durations that are shorter than a limit, in milliseconds; the whole number 0 or 1 if that
        is certain.
        """
        number = bisect_left(self.points, limit)
        if not self.doubt(limit) and number in (0, len(self.points)):
            return int(number > 0)
        return min(sum(self.masses[:number]), 1.0)

    def doubt(self, limit: int) -> float:
        """How wrong that may be."""
        first, last = (bisect_left(self.points, limit + error) for error in (-self.error, self.error))
        return sum(self.masses[first:last]) + self.strays

    def cut(self, limit: int) -> Times:
        """The distribution of those that are shorter than a limit; there must be some."""
        number = bisect_left(self.points, limit)
        share = sum(self.masses[:number])
        masses = tuple([mass / share for mass in self.masses[:number]])
        return Times(self.points[:number], masses, self.error, self.strays / share)


def at(milliseconds: int) -> Times:
    """One duration."""
    return Times((milliseconds,), (1.0,))


def of_skill(takes: Spread | Mapping[int, float], period: int) -> Times:
    """How long a skill takes if its program notices its end at the next of the ticks after its start.

    Args:
        period: between two ticks, in milliseconds.
    """
    if isinstance(takes, Mapping):
        return _gathered(((_ticked(time, period), mass) for time, mass in takes.items()), 0)
    if takes.kind == "fixed" or takes.high == takes.low:
        return at(_ticked(round(takes.low * 1000), period))
    tail = _TAIL if takes.kind == "lognormal" else 0.0
    first, last = (_ticked(round(quantile(takes, share) * 1000), period) // period for share in (tail, 1 - tail))
    ticks = -(-(last - first + 1) // _MOST_OF_SKILL)  # in a cell
    points = {}
    before = 0.0
    for number in range(first, last + 1, ticks):
        until = min(number + ticks - 1, last)
        share = 1.0 if until == last else share_within(takes, (until * period + 0.5) / 1000)
        points[(number + until) // 2 * period] = share - before
        before = share
    return _gathered(points.items(), ticks // 2 * period, 2 * tail)


def _ticked(time: int, period: int) -> int:
    """The first multiple of the period that is not before a time."""
    return -(-time // period) * period


def mixed(parts: Sequence[tuple[float, Times]]) -> Times:
    """One of several distributions, by their weights."""
    if len(parts) == 1:
        return parts[0][1]
    total = sum(weight for weight, _ in parts)
    pairs = (
        (point, weight / total * mass)
        for weight, times in parts
        for point, mass in zip(times.points, times.masses, strict=True)
    )
    strays = sum(weight / total * times.strays for weight, times in parts)
    return coarsened(_gathered(pairs, max(times.error for _, times in parts), strays), most=_MOST_MIXED)


def added(first: Times, second: Times) -> Times:
    """One duration after the other, which does not depend on it."""
    if len(first.points) > len(second.points):
        first, second = second, first
    error, strays = first.error + second.error, first.strays + second.strays
    if len(first.points) == 1:
        points = tuple(point + first.points[0] for point in second.points)
        return Times(points, second.masses, error, strays)
    if len(first.points) * len(second.points) <= _FEW:
        pairs = (
            (one + other, mass * its)
            for one, mass in zip(first.points, first.masses, strict=True)
            for other, its in zip(second.points, second.masses, strict=True)
        )
        return coarsened(_gathered(pairs, error, strays))
    span = sum(times.points[-1] - times.points[0] for times in (first, second))
    step = -(-span // (MOST - 2))
    one, other = (coarsened(times, step) for times in (first, second))
    masses = _product(_row(one, step), _row(other, step))
    start = one.points[0] + other.points[0]
    pairs = ((start + place * step, mass) for place, mass in enumerate(masses))
    return _gathered(pairs, one.error + other.error, strays)


def _row(times: Times, step: int) -> Sequence[int]:
    """The masses at each step from the first point, as whole numbers."""
    row = [0] * ((times.points[-1] - times.points[0]) // step + 1)
    for point, mass in zip(times.points, times.masses, strict=True):
        row[(point - times.points[0]) // step] += round(mass * _UNIT)
    return row


def _product(first: Sequence[int], second: Sequence[int]) -> Sequence[float]:
    """The coefficients of the product of two polynomials, whose coefficients are at most `_UNIT` in sum.

    Source: L. Kronecker's substitution: one multiplication of two large whole numbers, which Python does fast.
    """
    size = (len(first) + len(second) - 1) * _BYTES
    digits = (_joined(first) * _joined(second)).to_bytes(size, "little")
    coefficients = [int.from_bytes(digits[place : place + _BYTES], "little") for place in range(0, size, _BYTES)]
    return [each / _UNIT / _UNIT for each in coefficients]


def _joined(row: Sequence[int]) -> int:
    return int.from_bytes(b"".join([each.to_bytes(_BYTES, "little") for each in row]), "little")


def coarsened(times: Times, step: int = 0, most: int = MOST) -> Times:
    """The same on a grid, counted from the first point; `step`: 0: as is needed to have at most so many points."""
    if not step:
        if len(times.points) <= most:
            return times
        step = -(-(times.points[-1] - times.points[0]) // (most - 1))
    first = times.points[0]
    near = [first + (point - first + step // 2) // step * step for point in times.points]
    moved = max(abs(point - its) for point, its in zip(times.points, near, strict=True))
    return _gathered(zip(near, times.masses, strict=True), times.error + moved, times.strays)


def _gathered(pairs: Iterable[tuple[int, float]], error: int, strays: float = 0.0) -> Times:
    """The distribution of points in any order, whose masses add up to about 1."""
    masses: dict[int, float] = {}
    for point, mass in pairs:
        masses[point] = masses.get(point, 0.0) + mass
    least = sum(masses.values()) * _ROUNDING
    points = sorted(point for point, mass in masses.items() if mass > least)
    total = sum(masses[point] for point in points)
    return Times(tuple(points), tuple([masses[point] / total for point in points]), error, strays)


def of_masses(masses: Mapping[int, float], error: int, strays: float = 0.0) -> Times:
    """The distribution of durations in milliseconds, whose masses are in proportion to its own."""
    return coarsened(_gathered(masses.items(), error, strays))


_FEW: Final = 4096
_TAIL: Final = 1e-6
_ROUNDING: Final = 1e-12  # of sums of some thousand numbers
_UNIT: Final = 1 << 60
_BYTES: Final = 16  # 120 bits of a product of two sums of at most `_UNIT`, and some to spare
