"""Round numbers for axes."""

from __future__ import annotations

import pytest

from btq_lang.render.chart import round_values


@pytest.mark.parametrize(
    ("low", "high", "most", "values"),
    [
        (0, 0.58, 9, [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]),
        (0, 35.5, 9, [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0]),
        (-4.25, 17.5, 5, [0.0, 5.0, 10.0, 15.0]),
        (20, 30, 5, [20.0, 25.0, 30.0]),
        (1000, 1040, 6, [1000.0, 1010.0, 1020.0, 1030.0, 1040.0]),
        (0.1, 0.3, 3, [0.1, 0.2, 0.3]),
        (5, 5, 3, [5.0]),
    ],
)
def test_round_values(low: float, high: float, most: int, values: list[float]) -> None:
    assert [*round_values(low, high, most)] == values


@pytest.mark.parametrize(
    ("length", "step", "number"),
    [
        (0.04, 0.005, 9),
        (1, 0.2, 6),
        (9, 2, 5),
        (100, 15, 7),
        (200, 30, 7),
        (3600, 600, 7),
        (86_400, 10_800, 9),
        (4 * 86_400, 43_200, 9),
        (10 * 86_400, 2 * 86_400, 6),
        (400 * 86_400, 50 * 86_400, 9),
    ],
)
def test_times_are_round_in_minutes_hours_and_days(length: float, step: float, number: int) -> None:
    values = round_values(0, length, 9, is_time=True)
    assert (values[1], len(values)) == (step, number)
