"""Failure rates and means on both sides of a store: what `btq compare` finds, and what `btq report` draws."""

from __future__ import annotations

import json
import re
from fractions import Fraction
from math import comb
from pathlib import Path
from typing import Any

import pytest
from evidence_logs import MAIN, MAIN_XML, START, btlog, rows
from in_process import run_btq
from json_schema import violations
from test_compare import SCHEMA

from btq_lang.evidence.compare.chance import exact_rates, expected_rates
from btq_lang.evidence.compare.rates import compared_rates

RATE = 'QualityReq rare : reliability "Fails seldom"\n    Move fails at most 1 per 1 s\n'
MEAN = 'QualityReq quick "Quick"\n    Move takes at most 20 ms on average\n'
DAY = 86_400_000_000  # µs


@pytest.mark.parametrize(
    ("first", "second", "p"),
    [
        # The example of R's `?poisson.test`: breast cancer with and without fluoroscopies (Rothman and Greenland,
        # Modern Epidemiology), of which R 4.3 prints 0.07967.
        ((11, 800.0), (21, 3011.0), 0.07967),
        ((0, 10.0), (0, 20.0), 1.0),
        ((5, 10.0), (5, 10.0), 1.0),
        ((0, 10.0), (5, 10.0), 2 / 2**5),
    ],
)
def test_two_poisson_counts(first: tuple[int, float], second: tuple[int, float], p: float) -> None:
    assert exact_rates([(first, second)]) == pytest.approx(p, abs=6e-6)


@pytest.mark.parametrize(("failed", "other", "share"), [(3, 9, 2), (9, 3, 2), (0, 7, 3), (12, 1, 5), (4, 4, 7)])
def test_it_is_the_sum_of_what_is_no_more_likely(failed: int, other: int, share: int) -> None:
    """The first side has one part in `share` of the time."""
    both, hit = failed + other, Fraction(1, share)
    chances = [comb(both, k) * hit**k * (1 - hit) ** (both - k) for k in range(both + 1)]
    p = sum(chance for chance in chances if chance <= chances[failed])
    assert exact_rates([((failed, 1.0), (other, share - 1.0))]) == pytest.approx(float(p), rel=1e-9)


def test_the_sum_of_two_robots() -> None:
    """Given 2 and 1 failures, with a half and a quarter of the time: none at all has the chance 1/4 · 3/4."""
    strata = [((0, 1.0), (2, 1.0)), ((0, 1.0), (1, 3.0))]
    chances = [0.25 * 0.75, 0.5 * 0.75 + 0.25 * 0.25, 0.25 * 0.75 + 0.5 * 0.25, 0.25 * 0.25]
    assert exact_rates(strata) == pytest.approx(sum(chance for chance in chances if chance <= chances[0]))
    assert expected_rates(strata) == 1.25


def row(side: str, least: int, seconds: float, **others: Any) -> dict[str, Any]:
    of = {"requirement": "r", "clause": "c", "node": "n", "stratum": "", "runs": 9}
    return {**of, "side": side, "least": least, "most": least, "seconds": seconds, "longest": seconds, **others}


def test_what_may_not_count_counts_for_a_smaller_difference() -> None:
    (sure,) = compared_rates([row("a", 1, 10.0), row("b", 9, 10.0)], ("a", "b"))
    assert (sure.failures, sure.seconds, sure.runs) == ((1, 9), (10.0, 10.0), (9, 9))
    assert sure.p == pytest.approx(2 * 11 / 2**10)
    (perhaps,) = compared_rates([row("a", 1, 10.0), row("b", 4, 10.0, most=9)], ("a", "b"))
    assert perhaps.p == pytest.approx(2 * 6 / 2**5)  # as 1 and 4
    (either,) = compared_rates([row("a", 1, 10.0, most=7), row("b", 4, 10.0)], ("a", "b"))
    assert either.p == 1.0
    assert compared_rates([row("a", 0, 10.0), row("b", 0, 10.0)], ("a", "b")) == []
    assert compared_rates([row("a", 1, 10.0)], ("a", "b")) == []
    assert compared_rates([row("a", 1, 0.0), row("b", 1, 10.0)], ("a", "b")) == []


def test_a_robot_that_fails_more_often_and_ran_more_explains_nothing() -> None:
    """Each fails as often with both labels, but r2 ran v2 more."""
    robots = [("r1", "a", 1, 90.0), ("r1", "b", 0, 10.0), ("r2", "a", 5, 10.0), ("r2", "b", 45, 90.0)]
    counts = [row(side, number, seconds, stratum=robot) for robot, side, number, seconds in robots]
    (rate,) = compared_rates(counts, ("a", "b"))
    assert rate.p > 0.9
    assert exact_rates([((6, 100.0), (45, 100.0))]) < 1e-6


def kept(folder: Path, label: str, requirements: str, failing: int, lasting: int, day: int, runs: int = 20) -> None:
    """Runs of which the first ones fail, and the others take 300 ms more than the ms of Move."""
    text, time = [], 0
    for number in range(runs):
        end = time + lasting + number % 3
        if number < failing:
            text.append(f"{time} 1R 2R {end} 2F 1F")
        else:
            end += 300
            text.append(f"{time} 1R 2R {end - 300} 2S 3R {end} 3S 1S")
        text.append(f"{end + 1} 2I 3I 1I")
        time = end + 2
    (folder / "main.btq").write_text(requirements + MAIN, encoding="utf-8")
    (folder / f"{label}.btlog").write_bytes(btlog(MAIN_XML, rows(" ".join(text)), START + day * DAY))
    code, _, messages = run_btq("verify", f"{label}.btlog", "--store", "kept", "--label", label, cwd=folder)
    assert (code < 2, messages) == (True, "")


def compared(folder: Path) -> list[str]:
    return run_btq("compare", "kept", "v1", "v2", cwd=folder)[1].splitlines()


def test_a_rate_that_got_worse(tmp_path: Path) -> None:
    for label, failing, day in (("v1", 1, 0), ("v2", 14, 1)):
        kept(tmp_path, label, RATE, failing, 10, day)
    lines = compared(tmp_path)
    assert lines[2] == "  newly violated  rare Fails seldom  was satisfied; 1 in 5.92 s → 14 in 2.02 s, p < 0.0001"
    code, out, _ = run_btq("compare", "kept", "v1", "v2", "--format", "json", cwd=tmp_path)
    document = json.loads(out)
    assert ([*violations(document, SCHEMA)], code) == ([], 1)
    (rate,) = [change for change in document["missions"][0]["changes"] if change["what"] == "rate"]
    names = ("requirement", "clause", "node", "unit", "failed", "exposures", "period", "finding", "counts")
    assert {name: rate[name] for name in names} == {
        "requirement": "rare",
        "clause": "Move fails at most 1 per 1 s",
        "node": "Move",
        "unit": "s",
        "failed": [1, 14],
        "exposures": [5.919, 2.019],
        "period": 1.0,
        "finding": "less reliable",
        "counts": [20, 20],
    }
    assert rate["p_alone"] == pytest.approx(exact_rates([((1, 5.919), (14, 2.019))]))


def test_a_rate_that_both_sides_violate(tmp_path: Path) -> None:
    for label, failing, day in (("v1", 2, 0), ("v2", 14, 1)):
        kept(tmp_path, label, RATE.replace("1 per 1 s", "0.1 per 1 s"), failing, 10, day)
    assert [line for line in compared(tmp_path) if "fails at most" in line] == [
        "  less reliable  rare: Move fails at most 0.1 per 1 s at Move"
        "  2 in 5.62 s → 14 in 2.02 s, 0.356 → 6.93 per 1 s, p < 0.0001"
    ]


def test_a_violation_that_chance_may_explain(tmp_path: Path) -> None:
    for label, failing, day in (("v1", 2, 0), ("v2", 3, 1)):
        kept(tmp_path, label, RATE.replace("1 per 1 s", "0.4 per 1 s"), failing, 10, day)
    assert compared(tmp_path)[2:4] == [
        "what differs most where chance may explain it:",
        "  newly violated  rare Fails seldom  was satisfied; 2 in 5.62 s → 3 in 5.32 s, p = 1",
    ]


def test_a_mean_that_got_worse(tmp_path: Path) -> None:
    for label, lasting, day in (("v1", 10, 0), ("v2", 30, 1)):
        kept(tmp_path, label, MEAN, 0, lasting, day)
    lines = compared(tmp_path)
    assert lines[2] == (
        "  newly violated  quick Quick  was satisfied; mean 10.9 ms of 20 → mean 30.9 ms of 20, p < 0.0001"
    )
    assert lines[3].startswith("  slower          Move         mean 10.9 ms → 30.9 ms (+20 ms,")
    assert lines[4].strip() == "and 1 node above it: Sequence, and in requirement quick"


def test_a_mean_that_chance_may_explain(tmp_path: Path) -> None:
    for label, lasting, day in (("v1", 19, 0), ("v2", 20, 1)):
        kept(tmp_path, label, MEAN.replace("20 ms", "20.2 ms"), 0, lasting, day, runs=3)
    assert compared(tmp_path)[2:4] == [
        "what differs most where chance may explain it:",
        "  newly violated  quick Quick  was satisfied; mean 20 ms of 3 → mean 21 ms of 3, p = 1",
    ]


def drawings(folder: Path) -> list[str]:
    code, page, messages = run_btq("report", "kept", cwd=folder)
    assert (code < 2, messages) == (True, "")
    return re.findall(r'aria-label="([^"]*bound[^"]*)"', page)


def test_what_a_report_draws(tmp_path: Path) -> None:
    for label, failing, lasting, day in (("v1", 1, 10, 0), ("v2", 14, 30, 1)):
        kept(tmp_path, label, RATE + MEAN, failing, lasting, day)
    rate, mean = drawings(tmp_path)
    assert rate.startswith("failures per 1 s of each hour from 0.169 to 5.79; bound 1; v1 begins")
    assert mean.startswith("the mean of each run from 10 ms to 31 ms, between 10 ms and 32 ms; bound 20 ms; v1 begins")
    page = run_btq("report", "kept", cwd=tmp_path)[1]
    assert "always 0 %" not in page  # as if a rate or a mean were no violation
    assert re.findall(r"<title>([^<]*: rate [^<]*)</title>", page) == [
        "2026-11-20 21:00: rate 0.169",
        "2026-11-21 21:00: rate 5.79",
    ]


def test_means_of_many_runs_are_drawn_by_step(tmp_path: Path) -> None:
    for day in range(4):
        kept(tmp_path, f"v{day}", MEAN, 0, 10 + 5 * day, day)
    (mean,) = drawings(tmp_path)
    assert mean.startswith("the mean of each day from 10.9 ms to 25.9 ms; bound 20 ms; v0 begins")
