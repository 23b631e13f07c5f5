"""Which nodes `btq explore` names as the reason that a tree cannot succeed or fail."""

from __future__ import annotations

import pytest
from exploring import Exploring

CHARGING = """
include "skills.btq"

Root Deliver

BehaviorTree Deliver
    ->
        SubTree EnoughBattery
        Drive
"""
SKILLS = """
Action Charge
Action Drive
Condition BatteryAbove

BehaviorTree EnoughBattery
    ?
        BatteryAbove
        ForceSuccess
            ->
                Drive
                Charge
"""


@pytest.mark.parametrize(
    ("tree", "answers"),
    [
        ("->\n    A\n    ForceSuccess B\n        C", []),
        (
            "->\n    ForceSuccess\n        A\n    ForceSuccess Second\n        B",
            [("the mission cannot fail: ForceSuccess::2 never fails, Second never fails", 9)],
        ),
        (
            "->\n" + "    ForceSuccess\n        A\n" * 5,
            [
                (
                    "the mission cannot fail: ForceSuccess::2 never fails, ForceSuccess::4 never fails, "
                    "ForceSuccess::6 never fails, nor do 2 others",
                    9,
                )
            ],
        ),
        (
            "?\n    A\n    ForceFailure\n        B\n    AlwaysSuccess Last",
            [("the mission cannot fail: Last never fails", 12)],
        ),
        ("Inverter\n    ForceFailure\n        A", [("the mission cannot fail: ForceFailure::2 never succeeds", 9)]),
        (
            "->\n    A\n    Inverter\n        AlwaysSuccess",
            [("the mission cannot succeed: Inverter::3 never succeeds", 10)],
        ),
        ("AlwaysSuccess", [("the mission cannot fail", None)]),
    ],
)
def test_the_node_that_is_the_reason(explore: Exploring, tree: str, answers: list[tuple[str, int | None]]) -> None:
    indented = "".join(f"    {line}\n" for line in tree.splitlines())
    explore.mission(f"Action A\nAction B\nAction C\n\nRoot Main\n\nBehaviorTree Main\n{indented}")
    (mission,) = explore.json()["missions"]
    assert [(finding["text"], finding.get("line")) for finding in mission["survey"]["findings"]] == answers


def test_a_tree_that_another_one_calls(explore: Exploring) -> None:
    explore.mission(SKILLS, "skills.btq")
    explore.mission(CHARGING, "deliver.btq")
    code, out, err = explore("--tree", "EnoughBattery")
    assert (code, err) == (1, "")
    assert out.splitlines()[2:] == [
        "  cannot-fail: the tree EnoughBattery, called at deliver.btq:8, cannot fail: ForceSuccess::3 never fails  "
        "(skills.btq:9)"
    ]


def test_a_tree_that_the_mission_calls(explore: Exploring) -> None:
    explore.mission(SKILLS, "skills.btq")
    explore.mission(CHARGING.replace("Drive", "ForceFailure\n            Drive\n        SubTree EnoughBattery"))
    code, out, err = explore()
    assert (code, err) == (1, "")
    assert [line for line in out.splitlines() if "cannot" in line] == [
        "  cannot-succeed: the mission cannot succeed: ForceFailure::9 never succeeds  (mission.btq:9)",
        "  cannot-fail: the tree EnoughBattery, called at mission.btq:8, cannot fail: "
        "EnoughBattery::2/ForceSuccess::5 never fails  (skills.btq:9)",
    ]


def test_a_tree_for_which_the_mission_cannot_fail_is_not_named_again(explore: Exploring) -> None:
    explore.mission(SKILLS, "skills.btq")
    explore.mission(CHARGING.replace("        Drive\n", ""))
    assert [line for line in explore()[1].splitlines() if "cannot" in line] == [
        "  cannot-fail: the mission cannot fail: EnoughBattery::2/ForceSuccess::5 never fails  (skills.btq:9)"
    ]


def test_a_tree_of_which_no_leaf_fails_is_not_named(explore: Exploring) -> None:
    explore.mission(SKILLS + "\nBehaviorTree Nothing\n    AlwaysSuccess\n", "skills.btq")
    explore.mission(CHARGING.replace("EnoughBattery", "Nothing"))
    assert "cannot" not in explore()[1]
