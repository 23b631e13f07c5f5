"""How likely a difference at least as large is where nothing has changed.

One invariant: what is shuffled or counted are runs, groups of runs, or robots, never activations: those of one run are
not independent of each other.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from math import comb, exp, lgamma
from operator import itemgetter
from typing import Final


class Shuffles:
    """Random ways to part units into two sides of the same sizes as those that are compared; the seed is fixed."""

    def __init__(self, first: int, second: int, number: int) -> None:
        """
        Args:
            first, second: how many units each side has.
        """
        chance = random.Random(_SEED)
        units, fewer = range(first + second), min(first, second)
        self._first: Final = first
        # The last index is that of a zero, for `itemgetter` gives no tuple for a single one.
        self._sides: Final = [itemgetter(len(units), *chance.sample(units, fewer)) for _ in range(number)]

    def probability(self, scores: Sequence[int]) -> float:
        """The p-value of the difference between the sides, in both directions.

        It ends early once it is certain to be above `LEVEL`.

        Args:
            scores: of the units of the first side, then of the second; their sum is 0.
        """
        observed = abs(sum(scores[: self._first]))
        if not observed:
            return 1.0
        padded = [*scores, 0]
        beyond, enough = 0, LEVEL * (len(self._sides) + 1)
        for number, side in enumerate(self._sides, start=1):
            if abs(sum(side(padded))) >= observed:
                beyond += 1
                if beyond > enough:
                    return beyond / number
        return (beyond + 1) / (len(self._sides) + 1)


def shuffles_for(comparisons: int) -> int:
    """How many shuffles so many comparisons need, for the smallest p-value to be small enough for all of them."""
    return max(_SHUFFLES, round(comparisons / LEVEL))


def fisher(first: tuple[int, int], second: tuple[int, int]) -> float:
    """The p-value of Fisher's exact test, in both directions.

    Args:
        first, second: how often it failed, of how many.
    """
    (failed, n), (other, m) = first, second
    both = failed + other
    possible = range(max(0, both - m), min(both, n) + 1)
    logs = [_log_comb(n, each) + _log_comb(m, both - each) - _log_comb(n + m, both) for each in possible]
    observed = logs[failed - possible[0]] + _ROUNDING
    return min(1.0, sum(exp(each) for each in logs if each <= observed))


def holm(probabilities: Sequence[float]) -> list[float]:
    """The p-values after Holm: each may be compared with `LEVEL`, and one error among all of them is that rare."""
    found = [1.0] * len(probabilities)
    largest = 0.0
    for place, index in enumerate(sorted(range(len(probabilities)), key=probabilities.__getitem__)):
        largest = max(largest, min(1.0, (len(probabilities) - place) * probabilities[index]))
        found[index] = largest
    return found


def is_too_few(first: int, second: int, comparisons: int) -> bool:
    """Whether so few units cannot show any change, among so many comparisons."""
    return comb(first + second, first) < comparisons / LEVEL


def _log_comb(n: int, k: int) -> float:
    return lgamma(n + 1) - lgamma(k + 1) - lgamma(n - k + 1)


LEVEL: Final = 0.05
_SHUFFLES: Final = 10_000
_SEED: Final = 25_010
_ROUNDING: Final = 1e-7  # tables that are as likely as the observed one differ by that much at most
