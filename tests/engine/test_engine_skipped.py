"""A node that skips itself, with guards around it: the tree does what it does without them.

Nothing in a file says that a leaf may return SKIPPED, so no leaf is known not to.
"""

from __future__ import annotations

from typing import Any

import pytest
from engine_loader import Engine
from test_engine_enforcement import BATTERY, ENERGY, PEOPLE, SPEED, Parts, assert_unchanged, guarded, plain, run

from btq_lang.catalog.versions import at_least

SIGNALS = BATTERY + SPEED + ENERGY + PEOPLE

# Clauses that nothing breaks, of each verb that is enforced.
CLAUSES = {
    "takes": "takes at most 1 h",
    "takes_table": "takes at most 1 h if near else 2 h",
    "succeeds": "succeeds within 1 h",
    "needs": "needs battery >= 20 %",
    "needs_when": "needs battery >= 20 %\n    when near",
    "keeps": "keeps speed <= 1 m/s",
    "keeps_when": "keeps speed <= 1 m/s\n    when near",
    "never": "never near",
    "leaves": "leaves battery >= 9 %",
    "leaves_when": "leaves battery >= 90 %\n    when near",
    "uses": "uses at most 5 Wh of energy",
    "tries": "tries at most 9",
    "tries_per": "tries at most 9 per Main",
    "counts": "succeeds at most 9 per run",
    "follows": "follows First succeeds",
    "follows_start": "follows First starts",
    "several": "takes at most 1 h\n    Move needs not near\n    Move keeps speed <= 1 m/s\n    Move tries at most 9",
}

FALLBACK = """
    ->
        First
        ?
            {}
            Plan_B
"""
ALL_SKIPPED = """
    ->
        First
        ?
            -> Only
                {}
            Plan_B
"""
AT_ONCE = """
    ->
        First
        All||
            {}
            Wait
"""
AGAIN = """
    ->
        First
        Repeat (num_cycles = 3)
            ?
                {}
                Plan_B
"""
SKIPPED: Parts = {"Move": ["SKIPPED"]}
ONCE = ["RUNNING", "SUCCESS"]
FIRST_SKIPPED: Parts = {"Move": [["SKIPPED"], ["SKIPPED"], ONCE], "Wait": ["RUNNING"] * 6 + ["SUCCESS"]}
IN_BETWEEN: Parts = {"Move": [ONCE, ["SKIPPED"], ["SKIPPED"]]}


def mission(clause: str, tree: str, node: str = "Move", action: str = "fail") -> str:
    body = tree.replace("{}", node)
    return f"{SIGNALS}QualityReq r\n    Move {clause}\n    on violation {action}\nRoot Main\nBehaviorTree Main{body}"


def assert_same(engine: Engine, text: str, parts: Parts, **what: Any) -> None:
    names = [name for name in ("Move", "Plan_B", "Wait", "Only") if name in text]
    assert_unchanged(engine, text, parts, names, **what)


TREES = {
    "fallback": (FALLBACK, SKIPPED),
    "all skipped": (ALL_SKIPPED, SKIPPED),
    "at once": (AT_ONCE, FIRST_SKIPPED),
    "again": (AGAIN, FIRST_SKIPPED),
    "in between": (AGAIN, IN_BETWEEN),
}
# The guard of `follows` lets only one start pass.
IN_TREES = [
    (tree, verb)
    for tree in TREES
    for verb in CLAUSES
    if tree in ("fallback", "all skipped") or not verb.startswith("follows")
]


@pytest.mark.parametrize("action", ["fail", "halt"])
@pytest.mark.parametrize(("tree", "verb"), IN_TREES)
def test_a_leaf_that_skips_itself(engine: Engine, tree: str, verb: str, action: str) -> None:
    shape, parts = TREES[tree]
    assert_same(engine, mission(CLAUSES[verb], shape, action=action), parts)


@pytest.mark.parametrize("verb", CLAUSES)
@pytest.mark.parametrize("node", ["Action Move", 'Move (_skipIf = "@off == 1")', 'Move (_onSuccess = "x := 1")'])
def test_however_the_leaf_is_written(engine: Engine, node: str, verb: str) -> None:
    for off in (0, 1):
        assert_same(engine, mission(CLAUSES[verb], FALLBACK, node), SKIPPED, blackboard={"off": off})


@pytest.mark.parametrize(
    ("clause", "parts"),
    [
        ("leaves battery >= 90 %", {"Move": ["SKIPPED"]}),
        ("tries at most 1", FIRST_SKIPPED),
        ("follows First succeeds", FIRST_SKIPPED),
    ],
)
def test_guards_that_take_it_for_a_start(engine: Engine, clause: str, parts: Parts) -> None:
    text = mission(clause, AT_ONCE)
    plain_run = run(engine, plain(text), parts)
    assert (plain_run.status, run(engine, guarded(text), parts).status) == ("SUCCESS", "FAILURE")


@pytest.mark.parametrize("verb", CLAUSES)
def test_a_leaf_that_skips_itself_while_it_runs(engine: Engine, verb: str) -> None:
    text = mission(CLAUSES[verb], FALLBACK)
    parts: Parts = {"Move": ["RUNNING", "SKIPPED"]}
    if at_least(engine.version, "4.7") or verb in ("takes", "succeeds", "keeps", "never"):
        assert_same(engine, text, parts)
    else:  # up to 4.6, any Sequence around it takes that for a success
        assert run(engine, guarded(text), parts).statuses("Plan_B") == []


@pytest.mark.parametrize("clause", ["takes at most 1 h", "tries at most 2"])
@pytest.mark.parametrize("action", ["fail", "halt"])
def test_a_mission_that_skips_itself(engine: Engine, clause: str, action: str) -> None:
    tree = "Root Main\nBehaviorTree Main\n    -> Only\n        Move\n"
    text = f"QualityReq r\n    Move {clause}\n    on violation {action}\n{tree}"
    assert run(engine, guarded(text), SKIPPED).status == "SKIPPED"
