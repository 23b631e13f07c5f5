"""`fails at most m per 200 h`: hand-made runs, and what they come to.  The mission is that of `test_run_verbs`."""

from __future__ import annotations

from pathlib import Path

import pytest
from evidence_logs import MAIN, MAIN_XML, Verify, btlog, rows, samples
from in_process import run_btq
from test_run_verbs import BACK, CUT, FRESH, IDLE_RUN, TWICE, clause

from btq_lang.catalog.units import parse_unit
from btq_lang.evidence.amounts import Amounts
from btq_lang.evidence.poisson import lower_number, upper_number
from btq_lang.evidence.rates import PoolBound, Rate
from btq_lang.evidence.verdicts import Verdict

LONG = "0 1R 2R 3R 100 3S 2S 1S"  # 100 ms without a failure
BOTH = f"{TWICE} 60 1R 2R 3R 160 3S 2S 1S"  # 150 ms, of which Move runs 120, with one failure


@pytest.mark.parametrize(
    ("demand", "runs", "verdict", "text"),
    [
        ("Move fails at most 1 per 50 ms", TWICE, "satisfied", "1 in 50 ms"),
        ("Move fails less than 1 per 50 ms", TWICE, "violated", "1 in 50 ms"),
        ("Move fails at most 1 per 51 ms", TWICE, "unknown", "1 in 50 ms, 1 ms more are needed"),
        ("Move fails at most 1 per 75 ms", BOTH, "satisfied", "1 in 150 ms"),
        ("Move fails at most 0.4 per 75 ms", BOTH, "unknown", "1 in 150 ms, 37.5 ms more are needed"),
        ("Move fails at most 0.5 per 75 ms", BOTH, "satisfied", "1 in 150 ms"),
        ("mission fails at most 1e-6 per 10 ms", LONG, "unknown", "0 in 100 ms, 10000000 ms more are needed"),
        ("Move fails between 1 and 2 per 75 ms", BOTH, "violated", "1 in 150 ms"),
        ("Move fails at least 1 per 150 ms", BOTH, "satisfied", "1 in 150 ms"),
        ("Move fails at most 1 per 120 ms of Move", BOTH, "satisfied", "1 in 120 ms"),
        ("Move fails at most 0 per 20 ms of Pick", TWICE, "violated", "1 in 20 ms"),
        ("mission fails at most 0 per 50 ms", BOTH, "satisfied", "0 in 150 ms"),
        ("mission fails at most 0 per 50 ms", "0 1R 2R 100 2F 1F", "violated", "1 in 100 ms"),
        # What the log cuts off was exposed until then; the clock must not be set back.
        ("Move fails at most 1 per 50 ms", CUT, "satisfied", "1 in 50 ms"),
        ("Move fails at most 1 per 50 ms", f"{IDLE_RUN} 60 1R 110 1S", "never exercised", None),
        ("Move fails at most 1 per 10 ms", BACK, "unknown", None),
        # Only time with C, and only the failures in it.
        ("Move fails at most 1 per 20 ms\nwhile low", TWICE, "satisfied", "1 in 20 ms"),  # low from 5 to 25
        ("Move fails at most 0 per 20 ms\nwhile not low", TWICE, "satisfied", "0 in 30 ms"),
        ("Move fails at most 0 per 10 ms of Move\nwhen low", TWICE, "satisfied", "0 in 10 ms"),
        # Of the uses of a subtree, all failures in the time of the runs.
        ("Grip fails at most 2 per 20 ms", "0 1R 8F 12F 20 1S", "satisfied", "2 in 20 ms"),
        # With a confidence: Garwood's limits of 0 are up to 2.996 with 95 %, of 1 from 0.0513 to 4.744.
        (
            "Move fails at most 3 per 100 ms\nconfidence 95 %",
            LONG,
            "satisfied",
            "0 in 100 ms, at most 3 per 100 ms with confidence 95 %",
        ),
        (
            "Move fails at most 1 per 50 ms\nconfidence 95 %",
            LONG,
            "undecided",
            "0 in 100 ms, 49.8 ms more without another decide it",
        ),
        (
            "Move fails at most 0.1 per 1 s\nconfidence 95 %",
            BOTH,
            "violated",
            "1 in 150 ms, at least 0.342 per 1 s with confidence 95 %",
        ),
        ("Move fails at most 0 per 1 s\nconfidence 95 %", LONG, "undecided", "0 in 100 ms"),
        ("Move fails at most 0 per 50 ms\nover last 1 runs", f"{TWICE} 60 1R 160 1S", "satisfied", "0 in 100 ms"),
    ],
)
def test_a_failure_rate(demand: str, runs: str, verdict: str, text: str | None, verify: Verify) -> None:
    found = clause(verify, demand, runs, samples("battery", {-1: 50, 5: 10, 25: 50}))
    assert (found["verdict"], found["violated"], found["violations"]) == (verdict, 0, [])
    if text is not None:
        assert (found["pooled"]["text"], found["unit"]) == (text, "runs")
        assert text in verify.text("run.btlog", "--mission", "main.btq", "--signals", "samples.csv")


def test_time_that_may_not_count_counts_both_ways(verify: Verify) -> None:
    """Low is known from -1 to 9 only, and Move fails at 10."""
    csv = samples("battery", {-1: 10})
    found = clause(verify, "Move fails at most 1 per 5 ms\nwhile low", TWICE, csv, before=FRESH)
    assert (found["verdict"], found["pooled"]["text"]) == ("satisfied", "0 to 1 in 9 ms to 50 ms")
    found = clause(verify, "Move fails at most 0 per 5 ms\nwhile low", TWICE, csv, before=FRESH)
    assert (found["verdict"], found["why"]) == ("unknown", "0 to 1 in 9 ms to 50 ms")


# One-sided 95 % and 97.5 % limits, as in table 40 of Pearson and Hartley, Biometrika Tables for Statisticians.
PUBLISHED = [
    *[(0, 0.0, 2.996, 0.0, 3.689), (1, 0.0513, 4.744, 0.0253, 5.572), (2, 0.355, 6.296, 0.242, 7.225)],
    *[(3, 0.818, 7.754, 0.619, 8.767), (5, 1.970, 10.51, 1.62, 11.67), (10, 5.425, 16.96, 4.80, 18.39)],
    (50, 38.96, 63.29, 37.11, 65.92),
]


@pytest.mark.parametrize(("number", "low", "high", "lower", "higher"), PUBLISHED)
def test_limits_are_those_of_tables(number: int, low: float, high: float, lower: float, higher: float) -> None:
    found = [lower_number(number, 0.95), upper_number(number, 0.95)]
    found += [lower_number(number, 0.975), upper_number(number, 0.975)]
    assert found == [pytest.approx(each, rel=6e-3) for each in (low, high, lower, higher)]


def test_the_time_that_is_missing_decides() -> None:
    second = parse_unit("s")
    assert second is not None

    def verdict(seconds: float) -> tuple[Verdict, float | None]:
        rate = Rate(PoolBound("<=", 1.0, None, 200.0, second), 0.95)
        rate.add(Amounts(2, 2, round(seconds * 1e6), round(seconds * 1e6)))
        return rate.verdict(), rate.shown().more

    now, missing = verdict(300.0)
    assert now == "undecided"
    assert missing == pytest.approx(6.2958 * 200 - 300, rel=1e-4)
    assert missing is not None
    assert (verdict(300 + missing - 0.01)[0], verdict(300 + missing + 0.01)[0]) == ("undecided", "satisfied")


def test_logs_and_a_store_come_to_the_same(tmp_path: Path) -> None:
    pytest.importorskip("duckdb")
    demand = "QualityReq rq : reliability\n    Move fails at most 1 per 50 ms\n    confidence 90 %\n"
    (tmp_path / "main.btq").write_text(demand + MAIN, encoding="utf-8")
    for number, runs in enumerate(("0 1R 2R 30 2F 1F", "0 1R 2R 100 2S 3S 1S")):
        log = btlog(MAIN_XML, rows(runs.replace("0 1R", f"{number * 1000} 1R", 1).replace("100 2S", "1100 2S")))
        (tmp_path / f"{number}.btlog").write_bytes(log)
    one = run_btq("verify", "0.btlog", "1.btlog", "--mission", "main.btq", cwd=tmp_path)
    assert "undecided" in one[1]
    text = "1 in 130 ms, 64.5 ms more without another decide it"
    assert text in one[1]
    jobs = run_btq("verify", "0.btlog", "1.btlog", "--mission", "main.btq", "--jobs", "2", cwd=tmp_path)
    assert jobs[1] == one[1]
    run_btq("verify", "0.btlog", "1.btlog", "--mission", "main.btq", "--store", "kept", cwd=tmp_path)
    assert text in run_btq("verify", "--store", "kept", cwd=tmp_path)[1]
