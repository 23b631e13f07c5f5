"""What all runs come to together, in a clause that is not about each of them: a failure rate, or a mean.

One invariant: a pool is a few sums, so those of several logs can be added, and an engine can count them.
"""

from __future__ import annotations

from typing import TypeAlias

from btq_lang.evidence.means import Mean
from btq_lang.evidence.rates import PoolBound, Rate
from btq_lang.requirements.model import Quantity, ResolvedClaim

Pool: TypeAlias = Rate | Mean


def pool_of(claim: ResolvedClaim, confidence: float | None) -> Pool | None:
    """The empty pool of a claim; None for one that is judged by itself, or whose bound depends on the situation."""
    limit = claim.limit
    if limit is None or not isinstance(limit.value, Quantity) or not isinstance(limit.upper, Quantity | None):
        return None
    upper = limit.upper.si if limit.upper is not None else None
    if claim.verb == "fails per time" and isinstance(claim.per, Quantity):
        return Rate(PoolBound(limit.relation, limit.value.si, upper, claim.per.si, claim.per.unit), confidence)
    if claim.verb.endswith(" on average"):
        return Mean(PoolBound(limit.relation, limit.value.si, upper, 0.0, limit.value.unit), confidence)
    return None
