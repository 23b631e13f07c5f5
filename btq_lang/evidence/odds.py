"""Confidence limits of a probability for k of n, and how many more runs would decide.

One invariant: limits hold with the requested confidence, or a higher one: those of Clopper and Pearson, one-sided, for
a single look at the data; those of a confidence sequence, both together, at every look at growing data, however often.
SciPy has the former in `scipy.stats.beta`, but takes a second to import.
"""

from __future__ import annotations

from collections.abc import Callable
from math import exp, inf, lgamma, log, log1p
from typing import Final, Literal, TypeAlias

Limits: TypeAlias = Literal["one look", "window", "every look"]  # `window`: of the last runs, and for one look


def lower_limit(k: int, n: int, confidence: float, limits: Limits = "one look") -> float:
    """The lower limit of the probability: with this confidence it is larger.

    Args:
        k: how many of the n counted hold.
        confidence: a fraction of one; of the one side, or at every look of both.
    """
    if k <= 0:
        return 0.0
    if limits == "every look":
        return _lower_at_every_look(k, n, confidence)
    return root(lambda p: beta_cdf(p, k, n - k + 1) - (1 - confidence))


def upper_limit(k: int, n: int, confidence: float, limits: Limits = "one look") -> float:
    """The upper limit of the probability: with this confidence it is smaller."""
    return 1.0 - lower_limit(n - k, n, confidence, limits)


def runs_to_decide(k: int, n: int, confidence: float, probability: float, limits: Limits = "one look") -> int | None:
    """How many more, all of which hold, raise the lower limit to a probability; None: no number does."""
    if probability >= 1.0:
        return None

    def decides(more: int) -> bool:
        return lower_limit(k + more, n + more, confidence, limits) >= probability

    high = 1
    while not decides(high):
        high *= 2
        if high > _MOST_RUNS:
            return None
    low = high // 2
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if decides(middle) else (middle, high)
    return high


def beta_cdf(x: float, a: float, b: float) -> float:
    """The regularised incomplete beta function I_x(a, b), by its continued fraction (DLMF 8.17.22)."""
    if x <= 0.0 or x >= 1.0:
        return min(max(x, 0.0), 1.0)
    if x > (a + 1) / (a + b + 2):  # where the other tail converges faster
        return 1.0 - beta_cdf(1 - x, b, a)
    front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log1p(-x)) / a
    c, d = 1.0, 1.0 / _nonzero(1 - (a + b) * x / (a + 1))
    fraction = d
    for m in range(1, _MOST_TERMS):
        step = inf
        for term in (
            m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
            -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)),
        ):
            d = 1.0 / _nonzero(1 + term * d)
            c = _nonzero(1 + term / c)
            step = c * d
            fraction *= step
        if abs(step - 1) < _PRECISION:
            break
    return front * fraction


def _lower_at_every_look(k: int, n: int, confidence: float) -> float:
    """Where the data become 1 / (1 - confidence) times less likely than under a uniform mixture of all probabilities.

    Under the true probability this ratio is a martingale that starts at 1, and by Ville's inequality it ever grows so
    large at most as often as the confidence leaves.
    """
    least = lgamma(k + 1) + lgamma(n - k + 1) - lgamma(n + 2) + log1p(-confidence)
    return root(lambda p: k * log(p) + (n - k) * log1p(-p) - least if p * n < k else inf)


def root(function: Callable[[float], float]) -> float:
    """The root of an increasing function on [0, 1]."""
    low, high = 0.0, 1.0
    while (middle := (low + high) / 2) not in (low, high):
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return high


def _nonzero(value: float) -> float:
    return value if abs(value) > _TINY else _TINY


_PRECISION: Final = 1e-15
_TINY: Final = 1e-300
_MOST_TERMS: Final = 100_000
_MOST_RUNS: Final = 10**9
