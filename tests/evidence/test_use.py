"""How much was used: values of a level or a counter, and what they come to."""

from __future__ import annotations

import pytest

from btq_lang.evidence.use import fallen, risen


@pytest.mark.parametrize(
    ("levels", "bound", "expected"),
    [
        ([90.0], 30.0, (0.0, 0)),
        ([90.0, 80.0, 70.0], 30.0, (20.0, 0)),
        # Jitter of one percent up and down is no recharge, however often.
        ([90.0, *[89.0, 91.0] * 50, 90.0], 30.0, (0.0, 0)),
        ([90.0, *[89.0, 91.0] * 50, 70.0], 30.0, (20.0, 0)),
        # A recharge is added to what the level fell by, whether it comes at once or in steps.
        ([90.0, 20.0, 95.0, 70.0], 30.0, (95.0, 1)),
        ([90.0, 20.0, *map(float, range(21, 96)), 70.0], 30.0, (95.0, 1)),
        ([90.0, 20.0, 95.0], 30.0, (70.0, 1)),  # it is still rising
        ([90.0, 20.0, 95.0, 30.0, 80.0, 75.0], 30.0, (140.0, 2)),
        # A dip while it charges is part of the recharge, if it is of half the bound at most.
        ([90.0, 20.0, 60.0, 45.0, 95.0, 70.0], 30.0, (95.0, 1)),
        ([90.0, 20.0, 60.0, 44.0, 95.0, 70.0], 30.0, (111.0, 2)),
        # A rise of half the bound is noise, and a larger one a recharge.
        ([50.0, 35.0, 50.0], 30.0, (0.0, 0)),
        ([50.0, 34.0, 50.0], 30.0, (16.0, 1)),
        # With a bound of nothing, or less, each rise counts.
        ([50.0, 49.0, 50.0], 0.0, (1.0, 1)),
        ([50.0, 49.0, 50.0], -4.0, (1.0, 1)),
    ],
)
def test_how_far_a_level_fell(levels: list[float], bound: float, expected: tuple[float, int]) -> None:
    assert fallen(levels, bound) == expected


@pytest.mark.parametrize(
    ("counts", "expected"),
    [
        ([100.0], (0.0, 0)),
        ([100.0, 120.0, 150.0], (50.0, 0)),
        # Where it falls below half its value it was restarted, and counts on from there.
        ([100.0, 150.0, 0.0, 40.0], (90.0, 1)),
        ([100.0, 150.0, 70.0, 110.0], (160.0, 1)),
        ([100.0, 150.0, 0.0, 40.0, 10.0, 20.0], (110.0, 2)),
        # A smaller fall is noise.
        ([100.0, 90.0, 150.0], (50.0, 0)),
        ([100.0, 50.0, 150.0], (50.0, 0)),
        ([100.0, 49.0, 150.0], (150.0, 1)),
        ([0.0, 0.0, 5.0], (5.0, 0)),
    ],
)
def test_how_far_a_counter_rose(counts: list[float], expected: tuple[float, int]) -> None:
    assert risen(counts) == expected
