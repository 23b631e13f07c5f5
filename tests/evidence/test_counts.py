"""`succeeds at least 12 per run` and the like: hand-made runs, and what they come to.  The mission is that of
`test_run_verbs`.
"""

from __future__ import annotations

import pytest
from evidence_logs import Verify
from test_run_verbs import BACK, CUT, IDLE_RUN, STOPPED, TWICE, UNWRITTEN, clause, come_to

TASKS = "0 1R 2R 3R 10 3F 2F 20 2R 3R 30 3S 2S 1S"  # Move fails in the first activation of Task, and then succeeds


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("Move succeeds at least 1 per run", TWICE, "satisfied 0/1"),
        ("Move succeeds at least 2 per run", TWICE, "violated 1/1"),
        ("Move fails at most 1 per run", TWICE, "satisfied 0/1"),
        ("Move fails less than 1 per run", TWICE, "violated 1/1"),
        ("Pick fails at most 0 per run", TWICE, "satisfied 0/1"),
        ("Move finishes between 1 and 2 per run", TWICE, "satisfied 0/1"),
        ("Move finishes at least 3 per run", TWICE, "violated 1/1"),
        ("Move finishes at most 1 per run", TWICE, "violated 1/1"),
        ("Move starts at most 2 per run", TWICE, "satisfied 0/1"),
        ("Move starts at most 1 per run", TWICE, "violated 1/1"),
        # A run that does not complete may have had more, but not fewer.
        ("Move succeeds at least 2 per run", STOPPED, "never exercised 0/0"),
        ("Move succeeds at least 1 per run", "0 1R 2R 3R 10 3S 20 3I 3R 30 3I 2I 1I", "satisfied 0/1"),
        ("Move fails at most 0 per run", STOPPED, "violated 1/1"),
        ("Move succeeds at least 2 per run", CUT, "never exercised 0/0 |1"),
        ("Move fails at most 1 per run", CUT, "never exercised 0/0 |1"),
        ("Move fails at most 0 per run", CUT, "violated 1/1"),
        ("Move finishes at most 1 per run", UNWRITTEN, "satisfied 0/1"),  # what was halted has no result
        # A node that is not active has no failures to count, and lacks the successes.
        ("Move fails at most 3 per run", IDLE_RUN, "never exercised 0/0"),
        ("Move succeeds at least 1 per run", IDLE_RUN, "violated 1/1"),
        ("Move succeeds at least 0 per run", BACK, "unknown 0/0 ?1"),
        # In each activation of another node: results that come in it.
        ("Move succeeds at least 1 per Task", TASKS, "violated 1/2"),
        ("Move fails at most 0 per Task", TASKS, "violated 1/2"),
        ("Move finishes at least 1 per Task", TASKS, "satisfied 0/2"),
        ("Move starts at most 1 per Task", TASKS, "satisfied 0/2"),
        ("Move succeeds at least 1 per Alarm", "0 1R 3R 5R 10 5S 3S 1S", "violated 1/1"),  # after it
        ("Move fails at most 0 per Alarm", "0 1R 3R 5R 10 5S 3F 1F", "satisfied 0/1"),
        ("Move fails at most 0 per Pick", TWICE, "never exercised 0/0"),
        # The uses of a subtree by themselves, and of several runs each.
        ("Grip succeeds at least 1 per run", "0 1R 8S 10 12F 1S", "violated 1/2"),
        ("Move succeeds at least 1 per run\nin at least 50 % of runs", f"{TWICE} 60 1R 3F 1F", "satisfied 1/2"),
        # Only what begins with C.
        ("Move fails at most 0 per run\nwhen node Alarm", "0 1R 3R 10 3F 5R 3R 20 3S 5S 1S", "satisfied 0/1"),
        ("Move fails at most 0 per run\nwhen node Pick", TWICE, "never exercised 0/0"),
    ],
)
def test_results_and_starts(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs) == expected


@pytest.mark.parametrize(
    ("demand", "why", "measured", "bound", "at"),
    [
        ("Move succeeds at least 3 per run", "succeeded 1 time", "1", "3", 0.05),
        ("Move fails at most 0 per run", "failed 1 time", "1", "0", 0.01),
        ("Move finishes less than 2 per Task", "finished 2 times", "2", "2", 0.03),
        ("Move starts at most 1 times per run", "started 2 times", "2", "1 times", 0.02),
    ],
)
def test_what_happened_in_words(demand: str, why: str, measured: str, bound: str, at: float, verify: Verify) -> None:
    found = clause(verify, demand, TWICE)
    (violation,) = found["violations"]
    assert (violation["why"], violation["measured"], violation["bound"], violation["at"]) == (why, measured, bound, at)
    assert found["unit"] == ("activations" if "per Task" in demand else "runs")


def test_a_node_called_run_is_quoted(verify: Verify) -> None:
    mission = """
Root Main
BehaviorTree Main
    ->
        Move
        -> run
            Move
Action Move
"""
    found = verify.clause('Main/run/Move starts at most 1 per "run"', "0 1R 2S 3R 4S 3S 1S", mission=mission, xml=RUN)
    assert (found["verdict"], found["unit"]) == ("satisfied", "activations")


RUN = (
    '<root BTCPP_format="4"><BehaviorTree ID="Main" _fullpath=""><Sequence name="Sequence" _uid="1">'
    '<Move name="Move" _uid="2"/><Sequence name="run" _uid="3"><Move name="Move" _uid="4"/></Sequence></Sequence>'
    "</BehaviorTree></root>"
)
