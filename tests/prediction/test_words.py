"""How well a share is known: by the number of runs, and by how well the skills were measured."""

from __future__ import annotations

from btq_lang.prediction.words import Uncertainty, interval_of


def rounded(held: int, counted: int, measure: Uncertainty) -> tuple[float, float]:
    low, high = interval_of(held, counted, measure)
    return round(low, 4), round(high, 4)


def test_the_interval_of_declared_skills_is_that_of_the_runs() -> None:
    assert rounded(95, 100, Uncertainty(0)) == (0.8872, 0.9836)  # Clopper and Pearson's
    assert rounded(0, 100, Uncertainty(0)) == (0.0, 0.0362)


def test_the_interval_of_measured_skills_has_their_spread() -> None:
    agreed = Uncertainty(50, ((79, 100), (77, 100), (76, 100), (80, 100)))  # no more than drawing explains
    assert rounded(7800, 10_000, agreed) == rounded(7800, 10_000, Uncertainty(0))
    spread = Uncertainty(50, ((90, 100), (60, 100), (75, 100), (87, 100)))
    assert rounded(7800, 10_000, spread) == (0.4266, 0.967)  # as ten runs would have it


def test_what_no_measurement_has_shown_may_be() -> None:
    """Of 50 runs in which all succeed: at least 0.025 to the power of 1/50."""
    never = Uncertainty(50, ((100, 100), (100, 100)))
    assert rounded(10_000, 10_000, never) == (0.9289, 1.0)
