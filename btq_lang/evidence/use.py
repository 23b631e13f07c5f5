"""How much of a resource was used between two moments, from the values of a level or a counter in between.

One invariant: neither refilling nor noise counts as use; both the gains of a level and the restarts of a counter differ
from noise by their size.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final


def fallen(levels: Sequence[float], bound: float) -> tuple[float, int]:
    """How far a level fell in all, and how often it was recharged meanwhile.

    Args:
        levels: its values in order; at least one.
        bound: of its use: a rise from a trough to a peak of more than half of it is a recharge, a smaller one noise.
    """
    least = max(bound, 0) / 2
    trough = peak = levels[0]
    is_rising = False
    recharges: list[float] = []
    for level in levels[1:]:
        if is_rising:
            peak = max(peak, level)
            if peak - level > least:
                recharges.append(peak - trough)
                is_rising, trough = False, level
        else:
            trough = min(trough, level)
            if level - trough > least:
                is_rising, peak = True, level
    if is_rising:
        recharges.append(peak - trough)
    return levels[0] - levels[-1] + sum(recharges), len(recharges)


def risen(counts: Sequence[float]) -> tuple[float, int]:
    """How far a counter rose, and how often it was restarted meanwhile: where it falls below half its value.

    After a restart it counts on from there, as in Prometheus' `increase`.
    """
    lost = [before for before, after in pairwise(counts) if after < before * _RESTARTED]
    return counts[-1] - counts[0] + sum(lost), len(lost)


_RESTARTED: Final = 0.5
