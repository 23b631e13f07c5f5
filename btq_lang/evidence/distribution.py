"""How measured values are distributed, counted in equal steps.

One invariant: the number of steps is bounded: their width doubles when there are too many, and the bound is always an
edge.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from math import floor
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.verdicts import Histogram

if TYPE_CHECKING:
    from btq_lang.evidence.conditions import Measure
    from btq_lang.requirements.model import Quantity


class Distribution:
    """The values measured for a clause."""

    def __init__(self) -> None:
        self._counts: Counter[int] = Counter()  # by how many steps above the bound
        self._last: Measure | None = None
        self._origin = 0.0
        self._step = 0.0

    def add(self, measure: Measure) -> None:
        """Count a value."""
        if self._last is None:
            self._origin = measure.bound.si
            self._step = abs(measure.bound.si) / _FINEST or 1.0 / _FINEST
        self._last = measure
        step = floor((measure.si - self._origin) / self._step)
        self._counts[step] += 1
        if self._counts[step] == 1:
            self._fit()

    def add_all(self, other: Distribution) -> None:
        """Count the values of other logs; where they had another bound, each as the middle of its step."""
        if self._last is None:
            self._origin, self._step = other._origin, other._step
        self._last = other._last or self._last
        while self._step < other._step:
            self._double()
        for step, number in other._counts.items():
            middle = other._origin + (step + 0.5) * other._step
            into = floor((middle - self._origin) / self._step)
            self._counts[into] += number
        self._fit()

    def _fit(self) -> None:
        while self._counts and max(self._counts) - min(self._counts) >= _MOST_STEPS:
            self._double()

    def _double(self) -> None:
        doubled: Counter[int] = Counter()
        for step, number in self._counts.items():
            doubled[step // 2] += number
        self._counts = doubled
        self._step *= 2

    def histogram(self, marks: Mapping[str, Quantity]) -> Histogram | None:
        """The histogram; None where nothing was measured.

        Args:
            marks: the bounds and a goal, by what each is; without a bound, that of the last measure is one.
        """
        if self._last is None:
            return None
        bound = {} if any(kind.endswith("bound") for kind in marks) else {"bound": self._last.bound}
        low, high = min(self._counts), max(self._counts)
        return Histogram(
            low=self._origin + low * self._step,
            step=self._step,
            counts=tuple(self._counts[step] for step in range(low, high + 1)),
            marks={**bound, **marks},
            unit=self._last.unit,
        )


_FINEST: Final = 64  # steps from 0 to the bound
_MOST_STEPS: Final = 48
