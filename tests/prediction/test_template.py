"""The table that `btq simulate --template` prints: what is lacking, to be filled in."""

from __future__ import annotations

from btq_lang.prediction.declared import declared_world
from btq_lang.prediction.template import template
from btq_lang.scenarios.mission import ScenarioMission, as_program
from btq_lang.workspace.config import parse_project
from btq_lang.workspace.workspace import Workspace

MISSION = """\
Condition BatteryFull
Condition "Is near"
Action MoveBase
Action Pick

BehaviorTree Main
    ->
        "Is near"
        MoveBase First
        MoveBase Second
        Pick
        R?
            BatteryFull
            Sleep (msec = 5)
"""
TABLE = """\
[simulate.skills]
# Necessary: what a condition answers, as `is = "battery >= 95 %"`, or `fails = "1 per 8 h", for = "2 s"`.
"Is near" = { is = "" }
BatteryFull = { is = "" }
# An action without a line succeeds at once: `takes = "6 s"`, `["12 s", "20 s"]` or
# `{ median = "18 s", p95 = "27 s" }`, `succeeds = "97 %"`.
MoveBase = { takes = "", succeeds = "" }
Pick = { takes = "", succeeds = "" }
"""


def mission() -> ScenarioMission:
    return ScenarioMission(as_program(Workspace.of({"main.btq": MISSION}), "main.btq", "Main"), "main.btq", "Main")


def test_it_names_what_nothing_is_known_of() -> None:
    assert template(mission(), ()) == TABLE
    of_kind = {node.kind: uid for uid, node in mission().tree.nodes.items()}
    have = [of_kind["MoveBase"], of_kind["Pick"], of_kind["Is near"]]
    assert template(mission(), have) == "".join(
        line + "\n" for line in TABLE.splitlines() if "Is near" not in line and "Pick" not in line
    )
    assert template(mission(), of_kind.values()) != ""  # the first drive
    assert template(mission(), mission().tree.nodes) == ""


def test_each_empty_value_is_a_mistake_until_it_is_filled_in() -> None:
    problems = [problem.message for problem in parse_project(TABLE)[1]]
    assert [problem.partition("` must be")[0] for problem in problems] == [
        "`simulate.skills.Is near.is",
        "`simulate.skills.BatteryFull.is",
        "`simulate.skills.MoveBase.takes",
        "`simulate.skills.MoveBase.succeeds",
        "`simulate.skills.Pick.takes",
        "`simulate.skills.Pick.succeeds",
    ]


def test_filled_in_it_says_what_all_skills_do() -> None:
    filled = TABLE.replace('is = ""', 'is = "true"').replace('takes = ""', 'takes = "1 s"')
    project, wrong = parse_project(filled.replace('succeeds = ""', 'succeeds = "9 %"'))
    assert wrong == ()
    assert project.simulation is not None
    world = declared_world(project.simulation, mission())
    assert world.problems == ()
    assert template(mission(), {*world.skills, *world.conditions}) == ""
