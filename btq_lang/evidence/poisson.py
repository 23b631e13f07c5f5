"""Exact confidence limits of the mean of a Poisson distribution, from one number that was seen.

Those of F. Garwood, Fiducial limits for the Poisson distribution, Biometrika 28 (1936), each one-sided: the mean with
which that number or more (or fewer) has the probability that the confidence leaves.  SciPy has them as quantiles of
chi-squared.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import exp, fsum, lgamma, log


@lru_cache(100)
def lower_number(number: int, confidence: float) -> float:
    """The lower limit of the mean: with this confidence, a fraction of one, it is larger."""
    if number <= 0:
        return 0.0
    return _root(lambda mean: 1 - _at_most(number - 1, mean) - (1 - confidence), float(number))


@lru_cache(100)
def upper_number(number: int, confidence: float) -> float:
    """The upper limit of the mean: with this confidence, a fraction of one, it is smaller."""
    return _root(lambda mean: (1 - confidence) - _at_most(number, mean), float(number) + 1)


def _at_most(number: int, mean: float) -> float:
    """The probability of at most so many; as a sum of terms, of which those far below the mean are negligible."""
    if mean <= 0:
        return 1.0
    first = max(0, int(mean - 40 * mean**0.5 - 40)) if number > mean else max(0, int(number - 40 * mean**0.5 - 40))
    return min(fsum(exp(k * log(mean) - mean - lgamma(k + 1)) for k in range(first, number + 1)), 1.0)


def _root(function: Callable[[float], float], guess: float) -> float:
    """The root of an increasing function of a positive number."""
    low, high = 0.0, guess
    while function(high) < 0:
        low, high = high, high * 2
    while (middle := (low + high) / 2) not in (low, high):
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return high
