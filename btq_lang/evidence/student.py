"""Quantiles of Student's t distribution.

With x = n / (n + t²), the regularised incomplete beta function I_x(n/2, 1/2) is the probability of more than t on
either side (Abramowitz and Stegun 26.7.1; DLMF 8.17).  SciPy has them as `scipy.stats.t.ppf`.
"""

from __future__ import annotations

from functools import lru_cache
from math import sqrt

from btq_lang.evidence.odds import beta_cdf, root


@lru_cache(100)
def quantile(confidence: float, freedom: int) -> float:
    """The value that is not exceeded with this probability, with so many degrees of freedom."""
    if confidence < 0.5:
        return -quantile(1 - confidence, freedom)
    x = root(lambda x: beta_cdf(x, freedom / 2, 0.5) - 2 * (1 - confidence))
    return sqrt(freedom * (1 - x) / x) if x > 0 else float("inf")
