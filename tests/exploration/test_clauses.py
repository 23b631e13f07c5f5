"""Clauses of requirements that can be violated, and those that cannot."""

from __future__ import annotations

import pytest
from exploring import Exploring
from in_process import run_btq

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


@pytest.mark.parametrize(
    ("clause", "can_be_violated"),
    [
        ("mission never node Pick\n    from mission starts until Look succeeds", False),
        ("mission never node Pick\n    from mission starts until Place succeeds", True),
        ("mission never node Look\n    from Look fails until mission succeeds", True),
        ("mission never node Dock\n    from mission starts until Pick succeeds or Place succeeds", False),
        ("mission never node Dock\n    from Dock fails until mission succeeds", False),
        ("mission never node Place\n    from Pick starts until Pick finishes", True),
        ("mission never node Dock\n    from Pick starts until Pick finishes", False),
        ("mission never node Place\n    from Pick succeeds until Pick starts", True),
        ("mission never node Place\n    while node Pick", True),
        ("mission never node Place\n    while node Dock", False),
        ("mission never node Place\n    while not node Pick", True),
        ("mission never node Place\n    while node Pick\n    from mission starts until Look succeeds", False),
    ],
)
def test_whether_nodes_run_within_a_scope(explore: Exploring, clause: str, can_be_violated: bool) -> None:
    explore.mission(MISSION.format(title="What is demanded", clause=clause))
    (answer,) = explore.json()["missions"][0]["clauses"]
    assert answer["answer"] == ("yes" if can_be_violated else "no")
    explore("-o", "case.btq")
    if can_be_violated:
        code, out, _ = run_btq("test", "case.btq", "-k", "rq", cwd=explore.folder)
        assert (code, "held; expected rq satisfied" in out) == (1, True)


@pytest.mark.parametrize(
    ("clause", "why"),
    [
        ("mission succeeds\n    in at least 90 % of runs", "is about many runs"),
        ("mission never node Pick\n    from mission starts until when speed > 1 m/s", "has a scope"),
        ("mission never node Pick\n    while speed > 1 m/s", "has a scope"),
        ("mission never node Pick\n    from Look finishes until Look succeeds", "has a scope"),
        ("Main never node Pick\n    while node Dock", "has a scope"),
        ("Look tries at most 2\n    while node Dock", "has a scope"),
        ("mission takes at most 3 s", "`takes` is not explored"),
        ("mission visits Look, Dock in order", "`visits` is not explored"),
        ("mission never speed > 1 m/s", "is about values"),
        ("each when speed > 1 m/s is followed by Dock starts", "is about values"),
        ("each Look succeeds is followed by Dock starts within 3 s", "is about time"),
        ("Dock succeeds within 3 s", "is about time"),
        ("Look tries at least 1", "is not about a largest number"),
        ("from Look starts to Dock starts takes at most 3 s", "is about time"),
    ],
)
def test_a_clause_that_is_not_asked_is_named(explore: Exploring, clause: str, why: str) -> None:
    explore.mission(f"signal speed : m/s from {{speed}}\n{MISSION.format(title='What is demanded', clause=clause)}")
    text = clause.partition("\n")[0]
    (mission,) = explore.json()["missions"]
    assert (mission["clauses"], mission["not_asked"]) == ([], [{"requirement": "rq", "text": text, "why": why}])
    code, out, _ = explore()
    assert f"  not asked: rq `{text}`: {why}" in out.splitlines()
    assert explore("--strict")[0] == code
    assert "not asked" not in explore("--can", "Dock starts")[1]
    assert explore.json("--can", "Dock starts")["missions"][0]["not_asked"] == []


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
