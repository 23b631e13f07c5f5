"""Limits of a probability, against SciPy's, and against what they promise."""

from __future__ import annotations

import random
from bisect import bisect_left
from fractions import Fraction
from math import comb, log, log1p

import pytest

from btq_lang.evidence.odds import Limits, beta_cdf, lower_limit, runs_to_decide, upper_limit
from btq_lang.evidence.wording import share

# scipy.stats.beta.ppf of SciPy 1.17.1: (k, n, confidence, lower limit, upper limit).
GRID = (
    (0, 1, 0.95, 0, 0.95),
    (1, 1, 0.95, 0.05, 1),
    (0, 2, 0.95, 0, 0.776393202250021),
    (1, 2, 0.95, 0.0253205655191036, 0.974679434480896),
    (2, 2, 0.95, 0.223606797749979, 1),
    (0, 5, 0.95, 0, 0.450719728346941),
    (1, 5, 0.95, 0.0102062183130115, 0.657408318001139),
    (2, 5, 0.95, 0.0764403914123289, 0.810744622562229),
    (4, 5, 0.95, 0.342591681998861, 0.989793781686989),
    (5, 5, 0.95, 0.549280271653059, 1),
    (0, 20, 0.8, 0, 0.0773191654094117),
    (0, 20, 0.95, 0, 0.139108340668265),
    (0, 20, 0.999, 0, 0.292054215615862),
    (1, 20, 0.8, 0.0110951670949684, 0.14243234710049),
    (1, 20, 0.95, 0.00256137877653028, 0.216106164206847),
    (1, 20, 0.999, 5.00237654488942e-05, 0.377581873108363),
    (6, 20, 0.8, 0.201279501227103, 0.418377774447011),
    (6, 20, 0.95, 0.139553749002386, 0.507818406614793),
    (6, 20, 0.999, 0.0616348049184916, 0.662837957233974),
    (10, 20, 0.8, 0.383968178198432, 0.616031821801568),
    (10, 20, 0.95, 0.301953911286494, 0.698046088713506),
    (10, 20, 0.999, 0.177460580406361, 0.822539419593639),
    (19, 20, 0.8, 0.85756765289951, 0.988904832905032),
    (19, 20, 0.95, 0.783893835793153, 0.99743862122347),
    (19, 20, 0.999, 0.622418126891637, 0.999949976234551),
    (20, 20, 0.8, 0.922680834590588, 1),
    (20, 20, 0.95, 0.860891659331735, 1),
    (20, 20, 0.999, 0.707945784384138, 1),
    (0, 100, 0.95, 0, 0.0295130496070399),
    (1, 100, 0.95, 0.000512801416262293, 0.0465598114535389),
    (33, 100, 0.95, 0.252303477040625, 0.415454267013524),
    (50, 100, 0.95, 0.413621714630912, 0.586378285369088),
    (99, 100, 0.95, 0.953440188546461, 0.999487198583738),
    (100, 100, 0.95, 0.97048695039296, 1),
    (0, 1000, 0.8, 0, 0.00160814346177623),
    (0, 1000, 0.95, 0, 0.00299124954509529),
    (0, 1000, 0.999, 0, 0.00688395157906623),
    (1, 1000, 0.8, 0.000223118656643693, 0.00299132404713301),
    (1, 1000, 0.95, 5.12919789090179e-05, 0.00473499357549978),
    (1, 1000, 0.999, 1.00049983308324e-06, 0.00919549763538759),
    (333, 1000, 0.8, 0.320101461411225, 0.346176895610524),
    (333, 1000, 0.95, 0.308373901193985, 0.358357362347329),
    (333, 1000, 0.999, 0.287694429062874, 0.380570033831685),
    (500, 1000, 0.8, 0.486198890039526, 0.513801109960474),
    (500, 1000, 0.95, 0.473517731235691, 0.526482268764309),
    (500, 1000, 0.999, 0.450771053984782, 0.549228946015218),
    (999, 1000, 0.8, 0.997008675952867, 0.999776881343356),
    (999, 1000, 0.95, 0.9952650064245, 0.999948708021091),
    (999, 1000, 0.999, 0.990804502364612, 0.999998999500167),
    (1000, 1000, 0.8, 0.998391856538224, 1),
    (1000, 1000, 0.95, 0.997008750454905, 1),
    (1000, 1000, 0.999, 0.993116048420934, 1),
    (0, 100000, 0.95, 0, 2.99568740194279e-05),
    (1, 100000, 0.95, 5.12932812325426e-07, 4.74377571738605e-05),
    (33333, 100000, 0.95, 0.330876595270368, 0.335790546602371),
    (50000, 100000, 0.95, 0.497394282260284, 0.502605717739717),
    (99999, 100000, 0.95, 0.999952562242826, 0.999999487067188),
    (100000, 100000, 0.95, 0.999970043125981, 1),
)


@pytest.mark.parametrize(("k", "n", "confidence", "low", "high"), GRID)
def test_limits_are_scipys(k: int, n: int, confidence: float, low: float, high: float) -> None:
    assert lower_limit(k, n, confidence) == pytest.approx(low, abs=1e-12)
    assert upper_limit(k, n, confidence) == pytest.approx(high, abs=1e-12)


@pytest.mark.parametrize("n", [1, 2, 7, 20, 60])
def test_the_lower_limit_is_where_so_many_successes_become_that_unlikely(n: int) -> None:
    for k in range(1, n + 1):
        p = lower_limit(k, n, 0.95)
        assert sum(comb(n, i) * p**i * (1 - p) ** (n - i) for i in range(k, n + 1)) == pytest.approx(0.05, abs=1e-9)


@pytest.mark.parametrize("p", [0.5, 0.9, 0.99])
def test_the_limits_cover_what_they_promise(p: float) -> None:
    """Of 2000 simulated series 95 % or more have the probability above their lower limit, and below the upper."""
    chance = random.Random(25)
    limits = [(lower_limit(k, 50, 0.95), upper_limit(k, 50, 0.95)) for k in range(51)]
    below = above = 0
    for _ in range(2000):
        lower, upper = limits[sum(chance.random() < p for _ in range(50))]
        below += lower <= p
        above += upper >= p
    assert min(below, above) >= 0.95 * 2000 - 3 * (2000 * 0.95 * 0.05) ** 0.5


def covered(p: float, runs: int, limits: Limits) -> list[range]:
    """Of how many that hold, by the number of runs, the limits are on both sides of the probability."""
    found = []
    for n in range(1, runs + 1):
        low = bisect_left(range(n + 1), p, key=lambda k: upper_limit(k, n, 0.95, limits))
        high = bisect_left(range(n + 1), p, key=lambda k: lower_limit(k, n, 0.95, limits))
        found.append(range(low, high))
    return found


def series_missed(p: float, runs: int, limits: Limits) -> int:
    """How many of 10 000 simulated series have the probability outside their limits after any of their runs."""
    chance = random.Random(31)
    fits = covered(p, runs, limits)
    missed = 0
    for _ in range(10_000):
        k = 0
        for inside in fits:
            k += chance.random() < p
            if k not in inside:
                missed += 1
                break
    return missed


@pytest.mark.parametrize(("p", "missed"), [(0.5, 347), (0.9, 290), (0.99, 174)])
def test_limits_at_every_look_keep_their_promise_at_every_look(p: float, missed: int) -> None:
    assert series_missed(p, 400, "every look") == missed <= 500


def test_limits_of_one_look_do_not() -> None:
    assert series_missed(0.9, 150, "one look") == 3370


@pytest.mark.parametrize(("k", "n"), [(0, 1), (1, 1), (3, 4), (19, 20), (197, 200), (500, 1000), (99_990, 100_000)])
def test_limits_at_every_look_are_where_a_mixture_is_twenty_times_as_likely(k: int, n: int) -> None:
    mixture = Fraction(1, (n + 1) * comb(n, k))
    for limit in (lower_limit(k, n, 0.95, "every look"), upper_limit(k, n, 0.95, "every look")):
        if 0.0 < limit < 1.0:
            of_limit = k * log(limit) + (n - k) * log1p(-limit)
            assert log(mixture.numerator) - log(mixture.denominator) - of_limit == pytest.approx(log(20), abs=1e-6)
    assert lower_limit(k, n, 0.95, "every look") < max(lower_limit(k, n, 0.95), 1e-9)
    assert runs_to_decide(0, 0, 0.95, 0.95, "every look") == 158


@pytest.mark.parametrize(
    ("k", "n", "probability", "more"),
    [
        (200, 200, 0.99, 99),
        (0, 0, 0.99, 299),
        (186, 200, 0.9, 15),
        (0, 0, 0.5, 5),
        (199, 200, 0.99, 273),
        (5, 5, 1.0, None),
    ],
)
def test_how_many_more_decide(k: int, n: int, probability: float, more: int | None) -> None:
    assert runs_to_decide(k, n, 0.95, probability) == more
    if more is not None:
        assert lower_limit(k + more, n + more, 0.95) >= probability > lower_limit(k + more - 1, n + more - 1, 0.95)
    if k == n and more:
        assert n + more == -(-log(0.05) // log(probability))


def test_the_ends_of_the_distribution() -> None:
    assert (beta_cdf(0.0, 2, 3), beta_cdf(1.0, 2, 3)) == (0.0, 1.0)
    assert (lower_limit(0, 9, 0.95), upper_limit(9, 9, 0.95)) == (0.0, 1.0)


@pytest.mark.parametrize(
    ("probability", "shown"),
    [(0.96157, "96.2 %"), (0.99967, "99.97 %"), (0.9999999, "99.99999 %"), (1.0, "100 %"), (0.0, "0 %")],
)
def test_only_what_is_certain_is_100_percent(probability: float, shown: str) -> None:
    assert share(probability) == shown
