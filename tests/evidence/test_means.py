"""`on average`: hand-made runs, and what they come to.  The mission is that of `test_run_verbs`."""

from __future__ import annotations

from pathlib import Path
from statistics import fmean, stdev

import pytest
from evidence_logs import MAIN, MAIN_XML, Verify, btlog, rows, samples
from in_process import run_btq
from test_run_verbs import BACK, CUT, IDLE_RUN, STOPPED, TWICE, clause

from btq_lang.evidence.student import quantile

FOUR = "0 1R 2R 3R 10 3F 20 3I 3R 32 3S 3I 3R 46 3S 3I 3R 54 3S 2S 1S"  # Move takes 10, 12, 14 and 8 ms
LEVEL = "signal battery : % from {battery_level} level"
FALLING = samples("battery", {-1: 50, 5: 45, 25: 42})
UNSURE = "0 1R 2R 3R 10 3S 50 4R 100 4S 2S 1S"  # Pick takes 50 to 90 ms


@pytest.mark.parametrize(
    ("demand", "runs", "verdict", "text"),
    [
        ("Move takes at most 11 ms on average", FOUR, "satisfied", "mean 11 ms of 4"),
        ("Move takes less than 11 ms on average", FOUR, "violated", "mean 11 ms of 4"),
        ("Move takes at least 11 ms on average", FOUR, "satisfied", "mean 11 ms of 4"),
        ("Move takes between 12 ms and 13 ms on average", FOUR, "violated", "mean 11 ms of 4"),
        ("Move takes between 10 ms and 13 ms on average", FOUR, "satisfied", "mean 11 ms of 4"),
        ("mission takes at most 50 ms on average", f"{FOUR} 60 1R 100 1S", "satisfied", "mean 47 ms of 2"),
        # What is halted, or cut off, has no time of its own.
        ("Move takes at most 9 ms on average", STOPPED, "violated", "mean 10 ms of 1"),
        ("Pick takes at most 9 ms on average", CUT, "never exercised", None),
        ("Move takes at most 9 ms on average", IDLE_RUN, "never exercised", None),
        ("Pick takes at most 9 ms on average", BACK, "unknown", None),
        # Only activations with C.
        ("Move takes at most 13 ms on average\nwhen battery < 44 %", FOUR, "satisfied", "mean 11 ms of 2"),
        ("Move takes at most 9 ms on average\nover last 2 activations", FOUR, "violated", "mean 11 ms of 2"),
        # Of 50 to 90 ms for Pick the mean is between them.
        ("Pick takes at most 90 ms on average", UNSURE, "satisfied", "mean 50 ms to 90 ms of 1"),
        ("Pick takes at most 89 ms on average", UNSURE, "unknown", "mean 50 ms to 90 ms of 1"),
        ("Pick takes at most 49 ms on average", UNSURE, "violated", "mean 50 ms to 90 ms of 1"),
        # s is 2.582 ms, and t of three degrees of freedom with 95 % is 2.353: from 7.96 to 14.04 ms.
        (
            "Move takes at most 14.1 ms on average\nconfidence 95 %",
            FOUR,
            "satisfied",
            "mean 11 ms of 4, at most 14 ms with confidence 95 %",
        ),
        (
            "Move takes at most 14 ms on average\nconfidence 95 %",
            FOUR,
            "undecided",
            "mean 11 ms of 4, 7.96 ms to 14.04 ms with confidence 95 % each",
        ),
        (
            "Move takes at most 7.9 ms on average\nconfidence 95 %",
            FOUR,
            "violated",
            "mean 11 ms of 4, at least 7.96 ms with confidence 95 %",
        ),
        (
            "Pick takes at most 30 ms on average\nconfidence 95 %",
            TWICE,
            "undecided",
            "mean 20 ms of 1, at least 2 are needed",
        ),
        ("Move uses at most 4 % of battery on average", TWICE, "satisfied", "mean 4 % of 2"),
        ("Move uses at most 3.9 % of battery on average", TWICE, "violated", "mean 4 % of 2"),
    ],
)
def test_a_mean(demand: str, runs: str, verdict: str, text: str | None, verify: Verify) -> None:
    found = clause(verify, demand, runs, FALLING, before=LEVEL)
    assert (found["verdict"], found["violated"], found["violations"]) == (verdict, 0, [])
    if text is not None:
        assert (found["pooled"]["text"], found["unit"]) == (text, "activations")
        assert text in verify.text("run.btlog", "--mission", "main.btq", "--signals", "samples.csv")


# As in table 12 of Pearson and Hartley, Biometrika Tables for Statisticians.
PUBLISHED = [
    *[(0.95, 1, 6.314), (0.95, 2, 2.920), (0.95, 5, 2.015), (0.95, 10, 1.812), (0.95, 30, 1.697), (0.95, 120, 1.658)],
    *[(0.975, 1, 12.706), (0.975, 4, 2.776), (0.975, 20, 2.086), (0.99, 3, 4.541), (0.995, 8, 3.355)],
    *[(0.75, 6, 0.718), (0.5, 7, 0.0), (0.25, 6, -0.718), (0.95, 10**6, 1.6449)],
]


@pytest.mark.parametrize(("confidence", "freedom", "value"), PUBLISHED)
def test_quantiles_are_those_of_tables(confidence: float, freedom: int, value: float) -> None:
    assert quantile(confidence, freedom) == pytest.approx(value, abs=6e-4)


def test_logs_and_a_store_come_to_the_same(tmp_path: Path) -> None:
    pytest.importorskip("duckdb")
    demand = "QualityReq rq : reliability\n    Move takes at most 70 ms on average\n    confidence 90 %\n"
    (tmp_path / "main.btq").write_text(demand + MAIN, encoding="utf-8")
    times = [30, 100, 55]
    for number, time in enumerate(times):
        runs = f"{number * 1000} 1R 2R {number * 1000 + time} 2S 3S 1S"
        (tmp_path / f"{number}.btlog").write_bytes(btlog(MAIN_XML, rows(runs)))
    logs = [f"{number}.btlog" for number in range(3)]
    width = 1.8856 * stdev(times) / 3**0.5  # t with two degrees of freedom and 90 %
    low, high = fmean(times) - width, fmean(times) + width
    text = f"mean 61.7 ms of 3, {low:.3g} ms to {high:.3g} ms with confidence 90 % each"
    one = run_btq("verify", *logs, "--mission", "main.btq", cwd=tmp_path)
    assert (text in one[1], "undecided" in one[1]) == (True, True)
    assert run_btq("verify", *logs, "--mission", "main.btq", "--jobs", "2", cwd=tmp_path)[1] == one[1]
    run_btq("verify", *logs, "--mission", "main.btq", "--store", "kept", cwd=tmp_path)
    assert text in run_btq("verify", "--store", "kept", cwd=tmp_path)[1]
