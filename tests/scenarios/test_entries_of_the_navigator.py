"""Entries that bt_navigator sets before the first tick: they exist, and their values are unknown."""

from __future__ import annotations

from pathlib import Path

import pytest
from nav2_scenarios import ran

SCRIPT = '<ScriptCondition code="{} == 3"/>'
PASSED = ("passed", "succeeds", "")
WHY = "nothing says what bt_navigator writes into {{{0}}}; write `given {{{0}}} = …`"


@pytest.mark.parametrize(
    ("distribution", "key", "is_set"),
    [
        ("jazzy", "goal", True),
        ("jazzy", "goals", True),
        ("jazzy", "number_recoveries", True),
        ("jazzy", "cancel_timeout", True),
        ("jazzy", "path", False),
        ("lyrical", "path", True),
        ("jazzy", "waypoint_statuses", False),
        ("kilted", "waypoint_statuses", True),
        ("jazzy", "follow_path_error_code", False),  # until the first goal has ended
    ],
)
def test_what_is_set(tmp_path: Path, distribution: str, key: str, is_set: bool) -> None:
    outcome, ended, why = ran(tmp_path, SCRIPT.format(key), "expect mission succeeds", nodes=distribution)
    if is_set:
        assert (outcome, ended, why) == ("unknown", "", f"ScriptCondition::1 reads {{{key}}}, and {WHY.format(key)}")
    else:
        assert (outcome, ended) == ("failed", "throws")
        assert "Variable not found" in why


def test_a_given_value_counts(tmp_path: Path) -> None:
    steps = "given {goal} = 3", "expect mission succeeds", "expect finally {goal} == 3"
    assert ran(tmp_path, SCRIPT.format("goal"), *steps) == PASSED


def test_an_expectation_that_needs_one(tmp_path: Path) -> None:
    assert ran(tmp_path, "<Wait/>", "when {goal} == 3: mission halts", "expect mission succeeds") == (
        "unknown",
        "",
        f"a condition after `when` reads `{{goal}}`, and {WHY.format('goal')}",
    )


def test_a_condition_of_version_3(tmp_path: Path) -> None:
    condition = '<InitialPoseReceived name="Localized"/>'
    why = f"Localized reads {{initial_pose_received}}, and {WHY.format('initial_pose_received')}"
    assert ran(tmp_path, condition, "expect mission succeeds", nodes="humble") == ("unknown", "", why)
    given = "given {initial_pose_received} = true"
    assert ran(tmp_path, condition, given, "expect mission succeeds", nodes="humble") == PASSED


def with_parameters(folder: Path, parameters: str, distribution: str = "jazzy") -> None:
    """A project whose bt_navigator has these parameters."""
    factory = f'[[factory]]\nname = "navigation"\nnodes = ["nav2-{distribution}"]\nnav2 = "nav2.yaml"\n'
    (folder / "btq.toml").write_text(factory, encoding="utf-8")
    tree = f"default_nav_to_pose_bt_xml: {folder.as_posix()}/main.xml"
    (folder / "nav2.yaml").write_text(
        f"bt_navigator:\n  ros__parameters:\n    {parameters}\n    {tree}\n", encoding="utf-8"
    )


def test_a_renamed_entry(tmp_path: Path) -> None:
    with_parameters(tmp_path, "goal_blackboard_id: target")
    why = f"ScriptCondition::1 reads {{target}}, and {WHY.format('target')}"
    assert ran(tmp_path, SCRIPT.format("target"), "expect mission succeeds") == ("unknown", "", why)


@pytest.mark.parametrize(
    ("distribution", "parameters", "settings", "takes"),
    [
        ("jazzy", "bt_loop_duration: 100", "", 300),
        ("jazzy", "transform_tolerance: 0.1", "", 210),
        ("humble", "bt_loop_duration: 100", "", 300),
        ("kilted", "bt_loop_duration: 100", "", 300),
        ("jazzy", "bt_loop_duration: 100", 'driver = { tick_once = "40 ms" }', 240),
        ("jazzy", "bt_loop_duration: 100", 'driver = { tick_while_running = "70 ms" }', 210),
    ],
)
def test_how_it_ticks(tmp_path: Path, distribution: str, parameters: str, settings: str, takes: int) -> None:
    with_parameters(tmp_path, parameters, distribution)
    with (tmp_path / "btq.toml").open("a", encoding="utf-8") as file:
        file.write(f"[simulate]\n{settings}\n")
    steps = "given Wait takes 205 ms", f"expect mission takes between {takes} ms and {takes} ms"
    assert ran(tmp_path, "<Wait/>", *steps, nodes=distribution) == PASSED
