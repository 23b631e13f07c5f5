"""A measure on both sides: how it differs by run, and whether chance explains that.

One invariant: each run, or what is shuffled in its place, counts once, however many values it has.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from math import sqrt
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

from btq_lang.evidence.compare.chance import LEAST_SHUFFLES
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.compare.chance import Shuffles


class ShuffledUnit(NamedTuple):
    """A unit of the shuffles: a run, a group of runs, or a robot."""

    side: str
    stratum: str
    number: Any


class Values(Record):
    """The values of a unit.

    Attributes:
        number: how many.
        mean: in SI.
        rank: the mean of their ranks among all values of the stratum, or of another score.
        end: the mean of when they end, in µs since the epoch.
    """

    number: int
    mean: float
    rank: float
    end: float


Measure: TypeAlias = Mapping[ShuffledUnit, Values]


class Difference(Record):
    """How the means by unit differ, with the average of several strata.

    Attributes:
        before, after: the average of the means of each side.
        interval: as in `Change`.
    """

    before: float
    after: float
    interval: tuple[float, float] | None


def difference(measure: Measure, sides: tuple[str, str]) -> Difference:
    """The difference of the means by unit, of all strata that both sides have.

    Each stratum has the weight n m / (n + m) for n and m units, the inverse of the variance of its difference.
    The interval is Student's, from the variance within strata and sides.
    """
    means = _means(measure, sides)
    weights = [len(first) * len(second) / (len(first) + len(second)) for first, second in means]
    weight = sum(weights)
    before, after = (
        sum(share * sum(values) / len(values) for share, values in zip(weights, side, strict=True)) / weight
        for side in zip(*means, strict=True)
    )
    freedom = sum(len(values) - 1 for pair in means for values in pair)
    if freedom < _FEW:
        return Difference(before, after, None)
    squares = sum(
        sum((value - sum(values) / len(values)) ** 2 for value in values) for pair in means for values in pair
    )
    reach = _student(freedom) * sqrt(squares / freedom / weight)
    return Difference(before, after, (after - before - reach, after - before + reach))


def probability(
    measure: Measure, units: Sequence[ShuffledUnit], shuffles: Shuffles, is_more: bool, number: int = LEAST_SHUFFLES
) -> float:
    """The p-value of the sum of the ranks of the first side.

    A rank sum takes no notice of how far away the few slowest values are, and so finds a change where a sum of the
    values drowns in their spread.  Where ranks and means differ in opposite directions, there is no such difference: 1.

    Args:
        units: of both sides, in the order of the shuffles.
        is_more: whether the mean of the second side is larger.
        number: of shuffles.
    """
    sides = grouped((unit.stratum, unit.side) for unit in measure)
    ranks = grouped((unit.stratum, values.rank) for unit, values in measure.items() if len({*sides[unit.stratum]}) > 1)
    middles = {stratum: sum(values) / len(values) for stratum, values in ranks.items()}
    scores = [
        values.rank - middles[unit.stratum]
        if (values := measure.get(unit)) is not None and unit.stratum in middles
        else 0.0
        for unit in units
    ]
    first = sum(score for unit, score in zip(units, scores, strict=True) if unit.side == units[0].side)
    return shuffles.probability(scores, number) if (first < 0) == is_more else 1.0


def rest(measure: Measure, parts: Sequence[Measure]) -> Measure:
    """The rest of the sum of each unit's values without those of the parts, and its ranks."""
    sums = {
        unit: values.number * values.mean - sum(part[unit].number * part[unit].mean for part in parts if unit in part)
        for unit, values in measure.items()
    }
    ranks: dict[ShuffledUnit, float] = {}
    for units in grouped((unit.stratum, unit) for unit in sums).values():
        places = grouped((sums[unit], place) for place, unit in enumerate(sorted(units, key=sums.__getitem__)))
        ranks |= {unit: sum(same_places := places[sums[unit]]) / len(same_places) for unit in units}
    return {unit: Values(1, value, ranks[unit], measure[unit].end) for unit, value in sums.items()}


def sizes(measure: Measure, sides: tuple[str, str]) -> list[tuple[int, int]]:
    """How many units each side has in each stratum."""
    numbers = Counter((unit.stratum, unit.side) for unit in measure)
    return [(numbers[stratum, sides[0]], numbers[stratum, sides[1]]) for stratum in {unit.stratum for unit in measure}]


def _means(measure: Measure, sides: tuple[str, str]) -> list[tuple[list[float], list[float]]]:
    """The means of the units of each side, in each stratum that both have."""
    means = grouped(((unit.stratum, unit.side), values.mean) for unit, values in measure.items())
    strata = {stratum: None for stratum, side in means if side == sides[0] and (stratum, sides[1]) in means}
    return [(means[stratum, sides[0]], means[stratum, sides[1]]) for stratum in strata]


def _student(freedom: int) -> float:
    """The 97.5th percentile of Student's distribution, by its expansion (Abramowitz and Stegun, 26.7.5)."""
    z = NormalDist().inv_cdf(0.975)
    return (
        z
        + (z**3 + z) / (4 * freedom)
        + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * freedom**2)
        + (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / (384 * freedom**3)
    )


_FEW: Final = 4  # degrees of freedom: with fewer the expansion is off by more than half a percent
