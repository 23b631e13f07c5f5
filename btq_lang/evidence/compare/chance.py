"""How likely a difference at least as large is where nothing has changed.

One invariant: what is shuffled or counted are runs, groups of runs, or robots, never activations: those of one run are
not independent of each other.  What differs without a change, such as robots, may part them in strata.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Sequence
from itertools import chain
from math import comb, exp, lgamma, prod
from operator import itemgetter, mul
from typing import Any, Final, TypeAlias

from btq_lang.util.grouping import grouped

Failures: TypeAlias = tuple[tuple[int, int], tuple[int, int]]  # of each side, how many, of how many


class Shuffles:
    """Random ways to part the units of each stratum into two sides of the same sizes as those that are compared.

    The seed is fixed.
    """

    def __init__(self, first: Sequence[Hashable], second: Sequence[Hashable], number: int) -> None:
        """
        Args:
            first, second: the stratum of each unit of a side.
        """
        chance = random.Random(_SEED)
        strata = grouped((stratum, index) for index, stratum in enumerate((*first, *second)))
        fewer = Counter(first if len(first) <= len(second) else second)
        parted = [(units, fewer[stratum]) for stratum, units in strata.items() if 0 < fewer[stratum] < len(units)]
        self._first: Final = len(first)
        self._number: Final = number
        # That of a zero, twice, for `itemgetter` gives no tuple for a single index.
        zero = len(first) + len(second)
        self._to_draw: Final = (
            itemgetter(zero, zero, *(at for units, size in parted for at in chance.sample(units, size)))
            for _ in range(number)
        )
        self._drawn: Final[list[itemgetter[Any]]] = []  # only as many as a difference has needed

    def probability(self, scores: Sequence[int]) -> float:
        """The p-value of the difference between the sides, in both directions.

        It ends early once it is certain to be above `LEVEL`.

        Args:
            scores: of the units of the first side, then of the second; their sum in each stratum is 0.
        """
        observed = abs(sum(scores[: self._first]))
        if not observed:
            return 1.0
        padded = [*scores, 0]
        beyond, enough = 0, LEVEL * (self._number + 1)
        for number, side in enumerate(chain(self._drawn, self._draw()), start=1):
            if abs(sum(side(padded))) >= observed:
                beyond += 1
                if beyond > enough:
                    return beyond / number
        return (beyond + 1) / (self._number + 1)

    def _draw(self) -> Iterator[itemgetter[Any]]:
        for side in self._to_draw:
            self._drawn.append(side)
            yield side


def shuffles_for(comparisons: int) -> int:
    """How many shuffles so many comparisons need, for the smallest p-value to be small enough for all of them."""
    return max(_SHUFFLES, round(comparisons / LEVEL))


def least(comparisons: int, shuffled: int) -> float:
    """The least p-value of a shuffled measure, after Holm, that so many comparisons allow, so many of them shuffled."""
    return min(1.0, shuffled / (shuffles_for(comparisons) + 1))


def exact(strata: Iterable[Failures]) -> float:
    """The p-value, in both directions, of as many failures where the odds of the sides are the same in every stratum.

    It is the exact conditional test of Agresti, *Categorical Data Analysis*, section 6.4, and of R's
    `mantelhaen.test(exact = TRUE)`: how likely each number of failures on the first side is, given those of both
    sides in each stratum.  Of one stratum that is Fisher's exact test.
    """
    first, chances, observed = 0, [1.0], 0
    for (failed, n), (other, m) in strata:
        both = failed + other
        possible = range(max(0, both - m), min(both, n) + 1)
        logs = [_log_comb(n, each) + _log_comb(m, both - each) - _log_comb(n + m, both) for each in possible]
        least, own = _likely(possible[0], map(exp, logs))
        first, chances = _likely(first + least, _of_sums(chances, own))
        observed += failed
    if observed not in range(first, first + len(chances)):
        return _RARE
    limit = chances[observed - first] * (1 + _ROUNDING)
    return min(1.0, sum(each for each in chances if each <= limit))


def expected(strata: Iterable[Failures]) -> float:
    """How many failures the first side has on average, given those of both sides in each stratum."""
    return sum(n * (failed + other) / (n + m) for (failed, n), (other, m) in strata)


def holm(probabilities: Sequence[float]) -> list[float]:
    """The p-values after Holm: each may be compared with `LEVEL`, and one error among all of them is that rare."""
    found = [1.0] * len(probabilities)
    largest = 0.0
    for place, index in enumerate(sorted(range(len(probabilities)), key=probabilities.__getitem__)):
        largest = max(largest, min(1.0, (len(probabilities) - place) * probabilities[index]))
        found[index] = largest
    return found


def is_too_few(sizes: Sequence[tuple[int, int]], comparisons: int) -> bool:
    """Whether so few units cannot show any change, among so many comparisons.

    Args:
        sizes: how many units each side has in each stratum.
    """
    # Sides of the same size can be exchanged, and then differ as much.
    extremes = 2 if all(first == second for first, second in sizes) else 1
    return prod(comb(first + second, first) for first, second in sizes) < extremes * comparisons / LEVEL


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
_SHUFFLES: Final = 10_000
_SEED: Final = 25_010
_RARE: Final = 1e-20  # of numbers that are rarer, all together are as well
_ROUNDING: Final = 1e-7  # tables that are as likely as the observed one differ by that much at most
