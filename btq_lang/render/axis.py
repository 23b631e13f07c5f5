"""Round numbers for the axis of a drawing."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from math import ceil, floor, log10
from typing import Final


def round_values(low: float, high: float, most: int, *, is_time: bool = False) -> tuple[float, ...]:
    """The multiples of a round step from one value to another, with the smallest step of which there are few enough.

        >>> round_values(0, 35.5, 8)
        (0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0)
        >>> round_values(0, 200, 6, is_time=True)
        (0.0, 60.0, 120.0, 180.0)

    Args:
        most: how many there may be, at least 2.
        is_time: the values are seconds; then steps of more than a second are round in minutes and hours.
    """
    if not high > low:
        return (float(low),)
    for step in _steps((high - low) / most, is_time):
        first, last = ceil(low / step - _NEAR), floor(high / step + _NEAR)
        if last - first < most:
            return tuple(float(f"{place * step:.12g}") for place in range(first, last + 1))
    raise AssertionError("steps grow without end")


def _steps(least: float, is_time: bool) -> Iterator[float]:
    """The round steps, from the largest that is not above a value."""
    unit = 1.0
    if is_time and least > 1:
        yield from (each for each in _TIMES if each >= least)
        unit = _DAY
    for exponent in count(floor(log10(max(least / unit, 1.0 if unit == _DAY else 0.0)))):
        yield from (each * 10.0**exponent * unit for each in (1, 2, 5))


_DAY: Final = 86_400.0  # s
_TIMES: Final = (2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10_800, 21_600, 43_200)  # s
_NEAR: Final = 1e-9  # of a step: what a division may round off
