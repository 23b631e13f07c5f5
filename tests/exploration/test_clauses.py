"""Clauses of requirements that can be violated, and those that cannot."""

from __future__ import annotations

import pytest
from exploring import Exploring

MISSION = """
QualityReq rq : reliability "{title}"
    {clause}

Action Look
Action Pick
Action Place
Action Dock

BehaviorTree Main
    ->
        Retry (num_attempts = 3)
            Look
        ParallelAll
            Pick
            Place
        Fallback
            Dock
            AlwaysSuccess
"""


@pytest.mark.parametrize(
    ("clause", "can_be_violated"),
    [
        ("mission succeeds", True),
        ("Dock succeeds", True),
        ("Look tries at most 3", False),
        ("Look tries at most 2", True),
        ("Look tries at most 1 per Main", True),
        ("mission never node Pick and node Place", True),
        ("mission never node Pick and node Dock", False),
        ("Pick follows Look succeeds", False),
        ("Pick follows Dock starts", True),
        ("Place follows Look succeeds or Pick starts", False),
        ("each Look succeeds is followed by Dock starts", True),
        ("each Pick succeeds is followed by mission succeeds", True),
        ("each Dock starts is followed by mission succeeds", False),
        ("each Dock starts is followed by mission fails", True),
    ],
)
def test_whether_a_clause_can_be_violated(explore: Exploring, clause: str, can_be_violated: bool) -> None:
    explore.mission(MISSION.format(title="What is demanded", clause=clause))
    (answer,) = explore.json()["missions"][0]["clauses"]
    assert (answer["text"], answer["answer"]) == (clause, "yes" if can_be_violated else "no")
    assert bool(answer["witness"]) == can_be_violated


@pytest.mark.parametrize(
    "clause", ["takes at most 3 s", "mission succeeds\n    in at least 90 % of runs", "Dock succeeds within 3 s"]
)
def test_clauses_that_a_run_without_time_does_not_violate(explore: Exploring, clause: str) -> None:
    explore.mission(MISSION.format(title="What is demanded", clause=clause))
    assert explore.json()["missions"][0]["clauses"] == []


def test_the_run_in_which_a_clause_is_violated(explore: Exploring) -> None:
    explore.mission(MISSION.format(title="What is demanded", clause="Look tries at most 2"))
    code, out, _ = explore()
    assert code == 1
    assert out.splitlines()[1:5] == [
        "  rq `Look tries at most 2` can be violated: yes, in 3 ticks",
        "    tick 1",
        "      Look::3 fails  (mission.btq:13)",
        "    tick 2",
    ]
