"""What a clause does not count, and where it was not exercised, is in its line."""

from __future__ import annotations

import json

import pytest
from evidence_logs import MAIN, MAIN_XML, Verify, btlog, rows

GOOD = "1R 2R 5 2S 3R 3S 1S 2I 3I 1I "
FAILS = "1R 2R 5 2S 3R 3F 1F 2I 3I 1I "
HALTED = "1R 2R 5 2S 3R 3I 1I "
SIGNAL = "signal battery : % from {battery}\n"
SAMPLES = "t,battery\n1700000000,50\n"


@pytest.mark.parametrize(
    ("runs", "left_out"),
    [
        (GOOD, ""),
        (GOOD + FAILS, ", 1 that failed was not counted"),
        (GOOD + FAILS * 2, ", 2 that failed were not counted"),
        (GOOD + HALTED, ", 1 that was halted was not counted"),
        (GOOD + FAILS + HALTED * 2, ", 1 that failed and 2 that were halted were not counted"),
    ],
)
def test_leaves_says_what_did_not_succeed(runs: str, left_out: str, verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(
        f"{SIGNAL}QualityReq rq : safety\n    mission leaves battery >= 20 %\n{MAIN}"
    )
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(runs)))
    (verify.folder / "battery.csv").write_text(SAMPLES)
    text = verify.text("run.btlog", "--mission", "main.btq", "--signals", "battery.csv")
    (line,) = (line for line in text.splitlines() if "satisfied" in line)
    assert line.endswith(f"  held so far in 1 activation, worst 50 % in run 1{left_out}")
    document = json.loads(verify.text("run.btlog", "--signals", "battery.csv", "--format", "json"))
    ((clause,),) = [each["clauses"] for each in document["requirements"]]
    assert (clause["failed"], clause["halted"]) == (runs.count("1F"), runs.count("3I 1I") - runs.count("2I 3I"))


def test_a_node_that_some_run_did_not_reach_says_so_among_several(verify: Verify) -> None:
    mission = "QualityReq all : safety\n    every Move succeeds\nQualityReq one : safety\n    Pick succeeds\n"
    tree = "Root Main\nBehaviorTree Main\n    ->\n        Action Move P1\n        Action Move P2\n        Action Pick\n"
    (verify.folder / "main.btq").write_text(mission + tree)
    log = "1R 2R 5 2F 1F 2I 1I 10 1R 2R 15 2S 3R 20 3S 4R 4S 1S 2I 3I 4I 1I"
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(mission + tree), rows(log)))
    lines = verify.text("run.btlog", "--mission", "main.btq").splitlines()
    assert [line.rpartition("  ")[2] for line in lines if "every Move" in line or "Pick succeeds" in line] == [
        "1 of 2 activations",
        "held so far in 1 activation, not started in 1 run",
        "held so far in 1 activation",
    ]
