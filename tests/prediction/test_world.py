"""Signals of the world: straight lines between turns, and when they reach what they are compared with."""

from __future__ import annotations

from btq_lang.prediction.world import Course, CourseSettings, crossings
from btq_lang.simulator.timers import NEVER

CHARGE, DRIVE = 4, 7


def course() -> Course:
    rates = ((frozenset((CHARGE,)), 1.0), (frozenset((DRIVE,)), -0.5))
    made = Course(CourseSettings("battery", "level", 60.0, -0.1, rates, 0.0, 100.0))
    made.thresholds.add(20.0)
    made.begin()
    return made


def test_rates_of_running_nodes_count_instead_and_add_up() -> None:
    settings = course().settings
    assert [settings.rate_with(running) for running in ((), (CHARGE,), (DRIVE, 9), (CHARGE, DRIVE))] == [
        -0.1,
        1.0,
        -0.5,
        0.5,
    ]
    assert not settings.is_constant
    assert CourseSettings("mode", "", "idle").is_constant


def test_a_value_is_calculated_and_stays_between_its_limits() -> None:
    battery = course()
    assert battery.at(10_000) == 59.0
    battery.turn(10_000, 1.0)
    assert (battery.at(20_000), battery.at(1_000_000)) == (69.0, 100.0)
    battery.turn(1_000_000, -0.5)
    assert battery.at(1_010_000) == 95.0
    assert battery.pieces == [(0, 60.0, -0.0001), (10_000, 59.0, 0.001), (1_000_000, 100.0, -0.0005)]


def test_the_next_crossing_is_the_first_moment_at_which_a_comparison_may_change() -> None:
    battery = course()
    assert battery.next_crossing(0) == 400_000  # 20 %, or just above it
    assert battery.next_crossing(400_000) == 400_001
    assert battery.next_crossing(400_001) == 600_000  # 0 %
    assert battery.next_crossing(700_000) == NEVER
    battery.turn(300_000, 0.0)
    assert battery.next_crossing(300_000) == NEVER
    battery.is_polled = True
    assert battery.next_crossing(300_000) == NEVER
    battery.turn(300_000, 1.0)
    assert battery.next_crossing(300_000) == 300_001


def test_crossings_in_the_past_are_to_the_microsecond() -> None:
    battery = course()
    battery.turn(10_000, 1.0)
    assert crossings(battery.pieces, (59.5, 61.0), 20_000) == [
        (59.5, 5_000_000),
        (59.5, 5_000_001),
        (59.5, 10_500_000),
        (59.5, 10_500_001),
        (61.0, 12_000_000),
        (61.0, 12_000_001),
    ]
