"""How likely a difference at least as large is where nothing has changed.

One invariant: what is shuffled or counted are runs, groups of runs, or robots, never activations: those of one run are
not independent of each other.  What differs without a change, such as robots, may divide them into strata.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Sequence
from itertools import chain, compress, islice
from math import comb, erfc, exp, lgamma, log, log1p, prod, sqrt
from operator import mul
from typing import Final, TypeAlias

from btq_lang.util.grouping import grouped

Failures: TypeAlias = tuple[tuple[int, int], tuple[int, int]]  # of each side, how many, of how many
Exposed: TypeAlias = tuple[int, float]  # how many failures, in how long


class Shuffles:
    """Random divisions of the units of each stratum into two sides of the same sizes as the compared ones.

    The seed is fixed.
    """

    def __init__(self, first: Sequence[Hashable], second: Sequence[Hashable]) -> None:
        """
        Args:
            first, second: the stratum of each unit of a side.
        """
        self._first: Final = len(first)
        units = grouped((stratum, index) for index, stratum in enumerate((*first, *second)))
        sizes = Counter(first)
        self._strata: Final = [(indices, sizes[stratum]) for stratum, indices in units.items()]
        self._to_draw: Final = self._draws(len(first) + len(second))
        self._drawn: Final[list[bytearray]] = []  # only as many as a difference has needed

    def probability(self, scores: Sequence[float], most: int) -> float:
        """The p-value of the difference between the sums of the sides, in both directions.

        It is the share of shuffles with such a difference; no more are drawn than it takes to know that it is common.
        If none has it, it is the tail of the normal distribution that a sum over shuffles tends to (Lehmann,
        *Nonparametrics*, appendix 4).  That happens by chance once in as many comparisons as there are shuffles, so the
        precision of the tail changes little.

        Args:
            scores: of the units of the first side, then of the second; their sum in each stratum is 0.
            most: how many shuffles are drawn.
        """
        observed = abs(sum(scores[: self._first])) * (1 - _ROUNDING)
        if not observed:
            return 1.0
        beyond = 0
        for number, side in enumerate(islice(chain(self._drawn, self._draw()), most), start=1):
            if abs(sum(compress(scores, side))) >= observed:
                beyond += 1
                if beyond == _COMMON:
                    return beyond / number
        least = 1 / (most + 1)
        return (beyond + 1) * least if beyond else min(least, max(self._tail(observed, scores), self._rarest()))

    def _tail(self, observed: float, scores: Sequence[float]) -> float:
        """The p-value by the normal distribution, from the variance of a sum over shuffles."""
        variance = 0.0
        for units, size in self._strata:
            number = len(units)
            squares = sum(scores[unit] ** 2 for unit in units)
            variance += squares * size * (number - size) / (number * max(number - 1, 1))
        return erfc(observed / sqrt(2 * variance))

    def _rarest(self) -> float:
        """The p-value of a difference that no other division of the units has, but for the exchange of the sides."""
        return _extremes(sizes := [(size, len(units) - size) for units, size in self._strata]) / _ways(sizes)

    def _draw(self) -> Iterator[bytearray]:
        for side in self._to_draw:
            self._drawn.append(side)
            yield side

    def _draws(self, number: int) -> Iterator[bytearray]:
        chance = random.Random(_SEED)
        while True:
            side = bytearray(number)
            for units, size in self._strata:
                for unit in chance.sample(units, size):
                    side[unit] = 1
            yield side


def shuffles_for(comparisons: int) -> int:
    """How many shuffles so many comparisons need, for a p-value that is small enough for all of them to be known."""
    return max(LEAST_SHUFFLES, round(2 * comparisons / LEVEL))


def exact(strata: Iterable[Failures]) -> float:
    """The p-value, in both directions, of as many failures where the odds of the sides are the same in every stratum.

    It is the exact conditional test of Agresti, *Categorical Data Analysis*, section 6.4, and of R's
    `mantelhaen.test(exact = TRUE)`: how likely each number of failures on the first side is, given those of both
    sides in each stratum.  Of one stratum that is Fisher's exact test.
    """
    return _both_ways((failed, *_given_runs(failed + other, n, m)) for (failed, n), (other, m) in strata)


def exact_rates(strata: Iterable[tuple[Exposed, Exposed]]) -> float:
    """The p-value, in both directions, of as many failures in two exposures where the rates of the sides are the same.

    It is the exact conditional test of two Poisson counts (Przyborowski and Wilenski, *Biometrika* 31, 1940): given the
    failures of both sides, those of the first are binomial, with its share of the exposure; as R's `poisson.test`.  Of
    several strata it is the test of their sum.
    """
    return _both_ways(
        (failed, *_given_exposures(failed + other, first / (first + second)))
        for (failed, first), (other, second) in strata
    )


def expected_rates(strata: Iterable[tuple[Exposed, Exposed]]) -> float:
    """How many failures the first side has on average, as `expected`."""
    return sum((failed + other) * first / (first + second) for (failed, first), (other, second) in strata)


def _given_runs(both: int, n: int, m: int) -> tuple[int, list[float]]:
    """As `_likely`, of the failures in the first n of n + m runs."""
    possible = range(max(0, both - m), min(both, n) + 1)
    logs = (_log_comb(n, number) + _log_comb(m, both - number) - _log_comb(n + m, both) for number in possible)
    return _likely(possible[0], map(exp, logs))


def _given_exposures(both: int, share: float) -> tuple[int, list[float]]:
    """As `_likely`, of the failures in the first exposure, which has a share of both."""
    hit, miss = log(share), log1p(-share)
    return _likely(0, (exp(_log_comb(both, k) + k * hit + (both - k) * miss) for k in range(both + 1)))


def _both_ways(strata: Iterable[tuple[int, int, Sequence[float]]]) -> float:
    """The p-value of a sum: how likely the numbers are that are at most as likely as it.

    Args:
        strata: of each the number observed, the least number, and how likely each one from that on is.
    """
    first, chances, observed = 0, [1.0], 0
    for number, least, own in strata:
        first, chances = _likely(first + least, _of_sums(chances, own))
        observed += number
    if observed not in range(first, first + len(chances)):
        return _RARE
    limit = chances[observed - first] * (1 + _ALIKE)
    return min(1.0, sum(chance for chance in chances if chance <= limit))


def expected(strata: Iterable[Failures]) -> float:
    """How many failures the first side has on average, given those of both sides in each stratum."""
    return sum(n * (failed + other) / (n + m) for (failed, n), (other, m) in strata)


def holm(probabilities: Sequence[float]) -> list[float]:
    """The p-values after Holm: each may be compared with `LEVEL`, and one error among all of them is that rare."""
    adjusted = [1.0] * len(probabilities)
    largest = 0.0
    for place, index in enumerate(sorted(range(len(probabilities)), key=probabilities.__getitem__)):
        largest = max(largest, min(1.0, (len(probabilities) - place) * probabilities[index]))
        adjusted[index] = largest
    return adjusted


def is_too_few(sizes: Sequence[tuple[int, int]], comparisons: int) -> bool:
    """Whether so few units cannot show any change, among so many comparisons.

    Args:
        sizes: how many units each side has in each stratum.
    """
    return _ways(sizes) < _extremes(sizes) * comparisons / LEVEL


def _ways(sizes: Sequence[tuple[int, int]]) -> int:
    """In how many ways units can be divided."""
    return prod(comb(first + second, first) for first, second in sizes)


def _extremes(sizes: Sequence[tuple[int, int]]) -> int:
    """How many of these ways differ most: sides of the same size can be exchanged, and then differ as much."""
    return 2 if all(first == second for first, second in sizes) else 1


def _likely(first: int, chances: Iterable[float]) -> tuple[int, list[float]]:
    """The numbers from `first` on that are not too rare to count: the least of them, and how likely each is."""
    kept = [(number, chance) for number, chance in enumerate(chances, first) if chance >= _RARE]
    return kept[0][0], [chance for _, chance in kept]


def _of_sums(first: Sequence[float], second: Sequence[float]) -> list[float]:
    """How likely each sum of two independent numbers is, from how likely each number is."""
    edge = [0.0] * (len(second) - 1)
    padded, mirrored = [*edge, *first, *edge], second[::-1]
    return [sum(map(mul, padded[place : place + len(second)], mirrored)) for place in range(len(first) + len(edge))]


def _log_comb(n: int, k: int) -> float:
    return lgamma(n + 1) - lgamma(k + 1) - lgamma(n - k + 1)


LEVEL: Final = 0.05
LEAST_SHUFFLES: Final = 10_000
_COMMON: Final = 500  # shuffles with such a difference are enough to know how common it is, to 9 %
_SEED: Final = 25_010
_RARE: Final = 1e-20  # of numbers that are rarer, all together are as well
_ALIKE: Final = 1e-7  # tables that are as likely as the observed one differ by that much at most
_ROUNDING: Final = 1e-9
