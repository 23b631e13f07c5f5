"""What nodes did: outcomes, times, ticks, retries, where failures began; and what of it explains a violation."""

from __future__ import annotations

from typing import Any

import pytest
from evidence_logs import START, Verify, btlog, rows

RETRY = """
Root Main
QualityReq works : reliability
    mission succeeds
QualityReq swift : reliability
    mission takes at most 50 ms
BehaviorTree Main
    RetryUntilSuccessful (num_attempts = 3)
        -> Errand
            Action Move Drive
            Action Pick Grip
Action Move
Action Pick
"""
DRIVES_TWICE = "0 1R 2R 3R 30 3S 32 4R 42 4F 2F 3I 4I 2I 43 2R 3R 63 3S 64 4F 2F 1F 3I 4I 2I 1I"


def judged(verify: Verify, runs: str, mission: str = RETRY) -> dict[str, Any]:
    """What `btq verify` writes about a log."""
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(mission), rows(runs)))
    found = verify.json("run.btlog", "--mission", "main.btq")
    assert verify.errors == ""
    return found


def test_the_nodes_of_a_mission(verify: Verify) -> None:
    (mission,) = judged(verify, DRIVES_TWICE)["missions"]
    nodes = {each["path"]: tuple(each.values())[2:] for each in mission["nodes"]}
    # runs, succeeded, failed, halted, interrupted, failures_began, p50, p95, bounded, longest, tick_p95, tick_worst
    assert nodes == {
        "RetryUntilSuccessful::1": (1, 0, 1, 0, 0, 0, 0.064, 0.064, 0, None, None, None),
        "Errand": (1, 0, 2, 0, 0, 0, 0.021, 0.042, 0, None, None, None),
        "Drive": (1, 2, 0, 0, 0, 0, 0.02, 0.03, 0, None, 0.0, 0.0),
        "Grip": (1, 0, 2, 0, 0, 1, None, None, 2, 0.012, None, None),
    }
    assert mission["outcomes"] == {"failed": 1}
    assert mission["retries"] == {"total": 1, "most": 1, "run": 1}
    assert mission["recoveries"] == {"total": 0, "most": 0, "run": None}


def test_where_a_failure_began_and_where_the_time_went(verify: Verify) -> None:
    works, swift = (
        each["clauses"][0]["violations"][0]["chain"] for each in judged(verify, DRIVES_TWICE)["requirements"]
    )
    drive = {
        "kind": "part",
        "path": "Drive",
        "text": "Drive ran 50 ms of it in 2 starts",
        "seconds": 0.05,
        "activations": 2,
        "failed": 0,
    }
    grip = {
        "kind": "part",
        "path": "Grip",
        "text": "Grip ran 10 ms of it in 2 starts, 2 of them failed",
        "seconds": 0.01,
        "activations": 2,
        "failed": 2,
    }
    errand = {**drive, "path": "Errand", "text": "Errand ran 63 ms of it in 2 starts, 2 of them failed"}
    assert swift == [drive, grip, {**errand, "seconds": 0.063, "failed": 2}]
    assert works == [
        {
            **grip,
            "kind": "origin",
            "text": "it began at Grip, 2 of its 2 starts failed",
        },
        *swift,
    ]


def test_the_sums_of_one_activation_are_not_those_of_the_next(verify: Verify) -> None:
    """Each time that Errand ends, what ran below it is counted afresh, though its parent takes its sums over."""
    mission = RETRY.replace("mission takes at most 50 ms", "Errand takes at most 25 ms")
    violations = judged(verify, "0 1R 2R 3R 30 3S 4F 2F 2I 31 2R 3R 61 3S 4S 2S 1S", mission)["requirements"][1][
        "clauses"
    ][0]["violations"]
    assert [[link["text"] for link in each["chain"]] for each in violations] == [["Drive ran 30 ms of it"]] * 2


def test_a_node_that_fails_although_its_last_child_did_not(verify: Verify) -> None:
    mission = RETRY.replace("    RetryUntilSuccessful (num_attempts = 3)", "    Timeout (msec = 20)")
    requirement = judged(verify, "0 1R 2R 3R 20 3I 2I 1F 1I", mission)["requirements"][0]
    (violation,) = requirement["clauses"][0]["violations"]
    assert violation["chain"][0] == {
        "kind": "origin",
        "path": "Timeout::1",
        "text": "its last child Errand was halted",
        "seconds": 0.02,
        "activations": 1,
        "failed": 1,
    }


def test_what_a_node_halts_as_it_ends_is_not_where_its_failure_began(verify: Verify) -> None:
    mission = RETRY.replace(
        "    RetryUntilSuccessful (num_attempts = 3)\n        -> Errand", "    Inverter\n        R-> Errand"
    )
    found = judged(verify, "0 1R 2R 3S 4R 10 3F 4I 2F 1S 1I", mission)
    (mission_,) = found["missions"]
    assert [each["failures_began"] for each in mission_["nodes"]] == [0, 0, 0, 0]
    (violation,) = judged_errand(verify, mission, "0 1R 2R 3S 4R 10 3F 4I 2F 1S 1I")
    assert violation["chain"][0]["text"] == "it began at Drive, 1 of its 2 starts failed"


@pytest.mark.parametrize("node", ["TryCatch", "All||"])
def test_the_success_of_a_child_does_not_hide_the_failure_of_one_before(verify: Verify, node: str) -> None:
    mission = RETRY.replace("-> Errand", f"{node} Errand")
    (violation,) = judged_errand(verify, mission, "0 1R 2R 3R 4R 10 3F 30 4S 2F 2I 3I 4I 31 2R 3R 40 3S 2S 1S 1I")
    assert violation["chain"][0]["text"] == "it began at Drive"


def judged_errand(verify: Verify, mission: str, runs: str) -> list[dict[str, Any]]:
    requirement = judged(verify, runs, mission.replace("mission succeeds", "Errand succeeds"))["requirements"][0]
    found: list[dict[str, Any]] = requirement["clauses"][0]["violations"]
    return found


def test_a_tick_is_timed_only_between_rows_of_one_tick(verify: Verify) -> None:
    """Drive completes at once in the first run, and Grip takes 4 ms; in the others the row before Grip's may be of
    another tick.
    """
    runs = "0 1R 2R 10 3S 14 4R 20 4S 2S 1S 1I 30 1R 2R 3R 40 3S 3I 45 4S 2S 1S 50 1R 2R 3R 60 3S 64 4R 70 4S 2S 1S"
    (mission,) = judged(verify, runs)["missions"]
    ticks = {each["path"]: (each["tick_p95"], each["tick_worst"]) for each in mission["nodes"]}
    assert ticks == {
        "RetryUntilSuccessful::1": (None, None),
        "Errand": (None, None),
        "Drive": (0.01, 0.01),
        "Grip": (0.004, 0.004),
    }


def test_a_sample_is_explained_by_its_age_and_by_who_ran(verify: Verify) -> None:
    mission = RETRY.replace("QualityReq works", "signal battery : % from {battery} level\nQualityReq works").replace(
        "mission succeeds", "Grip needs battery >= 50 %"
    )
    (verify.folder / "samples.csv").write_text(f"t,battery\n{(START + 20_000) / 1e6:.6f},40\n", encoding="utf-8")
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(
        btlog(verify.build(mission), rows("0 1R 2R 3R 30 3F 2F 40 2R 3S 45 4R 50 4S 2S 1S"))
    )
    found = verify.json("run.btlog", "--mission", "main.btq", "--signals", "samples.csv")
    (violation,) = found["requirements"][0]["clauses"][0]["violations"]
    assert [(each["kind"], each["path"], each["text"], each["seconds"]) for each in violation["chain"]] == [
        ("sample", "", "sampled 20 ms before", 0.02),
        ("failure", "Drive", "Drive had failed before in this run", 0.03),
    ]


def test_recoveries_of_nav2(verify: Verify) -> None:
    mission = """
Root Main
QualityReq works : reliability
    mission succeeds
BehaviorTree Main
    RecoveryNode (number_of_retries = 2)
        Action Move Drive
        Action Pick Clear
Action Move
Action Pick
TreeNodesModel
    Control RecoveryNode
        input number_of_retries : int
"""
    (found,) = judged(verify, "0 1R 2R 5 2F 3R 8 3S 2R 11 2F 3S 2R 15 2S 1S 1I 20 1R 2R 25 2S 1S", mission)["missions"]
    assert found["retries"] == {"total": 2, "most": 2, "run": 1}
    assert found["recoveries"] == {"total": 2, "most": 2, "run": 1}


def test_in_how_many_runs_a_context_held(verify: Verify) -> None:
    mission = f"""signal battery : % from {{battery_level}}
context low : battery < 20 %
context moving : node Drive
context reversing : node Grip and node Drive
context fair : not low
{RETRY}"""
    runs = DRIVES_TWICE + " 100 1R 2R 3R 130 3S 4R 140 4S 2S 1S"
    (verify.folder / "battery.csv").write_text(f"t,battery\n{START / 1e6 + 0.11},30\n{START / 1e6 + 0.12},10\n")
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(mission), rows(runs)))
    named = ("run.btlog", "--mission", "main.btq", "--signals", "battery.csv")
    (found,) = verify.json(*named)["missions"]
    assert [tuple(each.values()) for each in found["contexts"]] == [
        ("low", 1, 1),  # runs in which it held, and others in which that is unknown
        ("moving", 2, 0),
        ("reversing", 0, 0),
        ("fair", 1, 1),
    ]
    assert "nodes: exercised 4 of 4 · contexts 3 of 4 · slowest" in verify.text(*named)
