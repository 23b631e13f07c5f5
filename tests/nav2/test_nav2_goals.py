"""The trees that goals name: in nodes of bt_navigator or of another program, and in parameters."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from in_process import run_btq
from nav2_robot import findings_in, make_robot, shown

HEAD = "bt_navigator:\n  ros__parameters:\n"
HERE = "$(find-pkg-share my_robot)"
MAIN = f"{HEAD}    default_nav_to_pose_bt_xml: {HERE}/trips/trip.xml\n    navigators: [navigate_to_pose]\n"
DOCKING = "    plugin_lib_names: [opennav_dock_action_bt_node]\n"
TREES = f"    bt_search_directories: [{HERE}/trees]\n{DOCKING}"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    make_robot(tmp_path)
    (tmp_path / "trips").mkdir()
    return tmp_path


def write_trip(robot: Path, *goals: str, name: str = "Trip") -> None:
    """Write a tree that sends goals, a line each: the first one in line 4."""
    nodes = "".join(f'<NavigateToPose goal="{{goal}}" behavior_tree="{each}"/>\n' for each in goals)
    text = (
        f'<root BTCPP_format="4">\n<BehaviorTree ID="{name}">\n<Sequence>\n{nodes}</Sequence>\n</BehaviorTree></root>\n'
    )
    (robot / f"trips/{name.lower()}.xml").write_text(text)


def places(robot: Path, text: str, distribution: str) -> list[str]:
    """What is wrong: the file, its line, the severity, the rule and the message, without the unloaded nodes."""
    (robot / "nav2_params.yaml").write_text(text)
    (robot / "btq.toml").write_text(
        f'nodes = ["nav2-{distribution}"]\n[[factory]]\nname = "nav"\nnav2 = "nav2_params.yaml"\n'
    )
    return [re.sub(r":\d+: (\w+)\[([\w-]+)\]", r" \1 \2", each) for each in check(robot, "trips", "nav2_params.yaml")]


def check(folder: Path, *arguments: str) -> list[str]:
    _, out, err = run_btq("check", "--output-format", "concise", *arguments, cwd=folder)
    return [line for line in (*out.splitlines()[:-1], *err.splitlines()) if not line.startswith("btq: ")]


def missing(line: int, severity: str, name: str, why: str, file: str = "trip.xml") -> str:
    return f"trips/{file}:{line} {severity} missing-nav2-tree cannot find the tree `{name}`: {why}"


NONE = "no file in the search directories has a tree"


def test_lyrical_knows_them_by_id(robot: Path) -> None:
    write_trip(robot, "Navigat", "Navigate", "{tree}", "Dock", "", "Nowhere")
    assert places(robot, MAIN + TREES, "lyrical") == [
        f"trips/trip.xml:4 error missing-nav2-tree {NONE} `Navigat`; did you mean `Navigate`?",
        f"trips/trip.xml:9 error missing-nav2-tree {NONE} `Nowhere`",
    ]


def test_a_tree_outside_the_search_directories_is_shown(robot: Path) -> None:
    write_trip(robot, "One")
    more = "; `two.xml` has one, but is in none of them"
    assert places(robot, MAIN + TREES, "lyrical") == [f"trips/trip.xml:4 error missing-nav2-tree {NONE} `One`{more}"]
    text = f"{HEAD}    default_nav_to_pose_bt_xml: One\n    navigators: [navigate_to_pose]\n{TREES}"
    ((_, found),) = findings_in(robot, text, "lyrical")
    (place,) = [each.place for each in found.related]
    assert (found.message, place.path) == (f"{NONE} `One`{more}", f"{robot}/several/two.xml")
    assert (robot / "several/two.xml").read_text()[place.span.start : place.span.end] == '<BehaviorTree ID="One">'


def test_lyrical_reads_the_file_of_a_path_first(robot: Path) -> None:
    """So that it skips the files in the folders that have one of its trees."""
    write_trip(robot, f"{robot}/same/again.xml", f"{robot}/several/two.xml", f"{robot}/gone.xml")
    skipped = "bt_navigator skips `navigate.xml`: `again.xml` has a tree `Navigate` too"
    refused = "`two.xml` keeps bt_navigator from loading any tree: nothing says which of its trees is the main one"
    assert places(robot, MAIN + TREES, "lyrical") == [
        f"trips/trip.xml:4 hint skipped-tree-file {skipped}",
        f"trips/trip.xml:5 error refused-tree-file {refused}",
        missing(6, "hint", f"{robot}/gone.xml", "this machine has no such file"),
    ]


def test_an_id_in_a_skipped_file_is_reported_once(robot: Path) -> None:
    write_trip(robot, "Again")
    (robot / "same/third.xml").write_text((robot / "same/navigate.xml").read_text())
    found = places(robot, f"{MAIN}    bt_search_directories: [{HERE}/same]\n", "lyrical")
    assert {each.split()[2] for each in found} == {"skipped-tree-file"}


@pytest.mark.parametrize("distribution", ["humble", "iron", "jazzy", "kilted"])
def test_earlier_ones_know_them_by_the_path_of_a_file(robot: Path, distribution: str) -> None:
    text = "".join(f"{each}\n" for each in MAIN.splitlines() if "navigators" not in each)
    (robot / "same/navigate.xml").write_text((robot / "same/navigate.xml").read_text().replace("AlwaysSuccess", "Own"))
    goals = (
        *(f"{robot}/same/navigate.xml", "Navigate", "trees/dock.xml", f"{HERE}/trees/dock.xml"),
        *(f"{robot}/several/two.xml", "/opt/robot/share/my_robot/trees/dokc.xml", "/opt/robot/share/yours/trees/a.xml"),
    )
    write_trip(robot, *goals, goals[1])
    is_id = "before Lyrical, a goal names the file of its tree, not the ID"
    lacks = f"the package in {robot} has no such file; did you mean `dock.xml`?"
    refused = "bt_navigator refuses `two.xml`: nothing says which of 2 trees is the main one"
    assert places(robot, text, distribution) == [
        "nav2_params.yaml:1 error unloaded-node no library that bt_navigator loads has a node `Own`",
        missing(5, "warning", goals[1], is_id),
        missing(6, "hint", goals[2], "a relative path counts from the folder in which bt_navigator runs"),
        missing(7, "error", goals[3], "`$(…)` is replaced in parameters only"),
        f"trips/trip.xml:8 error refused-tree-file {refused}",
        missing(9, "warning", goals[5], lacks),
        missing(10, "hint", goals[6], "this machine has no such file"),
        missing(11, "warning", goals[1], is_id),
    ]


def test_a_file_counts_that_a_build_has_installed_elsewhere(robot: Path) -> None:
    write_trip(robot, "/home/robot/install/my_robot/share/my_robot/trees/dock.xml")
    assert shown(robot, MAIN, "kilted") == [
        "1:1 error unloaded-node bt_navigator does not load the library of `DockRobot`: add "
        "`opennav_dock_action_bt_node`"
    ]


def test_the_tree_of_a_goal_may_name_others(robot: Path) -> None:
    write_trip(robot, f"{robot}/trips/next.xml")
    write_trip(robot, f"{robot}/trips/trip.xml", f"{robot}/trips/last.xml", name="Next")
    write_trip(robot, "/nowhere/a.xml", name="Last")
    expected = missing(4, "hint", "/nowhere/a.xml", "this machine has no such file", "last.xml")
    assert places(robot, MAIN, "jazzy") == [expected]


def test_the_docking_server_sends_goals_too(robot: Path) -> None:
    write_trip(robot)
    docking = "docking_server:\n  ros__parameters:\n    navigator_bt_xml: {}\n"

    def found(value: str, distribution: str = "jazzy") -> list[str]:
        return shown(robot, docking.format(value) + MAIN, distribution)

    assert found(f"{HERE}/same/navigate.xml") == found("''") == []
    lacks = f"the package in {robot} has no such file; did you mean `navigate.xml`?"
    name = f"{HERE}/same/navigat.xml"
    assert found(name) == [f"3:23 warning missing-nav2-tree cannot find the tree `{name}`: {lacks}"]
    assert found("Nowhere", "lyrical") == []  # the folders of Nav2 itself are not here
    missed = docking.format("Nowhere") + MAIN + TREES
    assert shown(robot, missed, "lyrical") == [f"3:23 error missing-nav2-tree {NONE} `Nowhere`"]


@pytest.fixture
def project(robot: Path) -> Path:
    """Beside bt_navigator, a program whose trees send goals to it."""
    (robot / "nav2_params.yaml").write_text(f"{HEAD}    default_nav_to_pose_bt_xml: {HERE}/same/navigate.xml\n")
    (robot / "btq.toml").write_text(
        'nodes = ["nav2-jazzy"]\n[[factory]]\nname = "nav"\nnav2 = "nav2_params.yaml"\n'
        '[[factory]]\nname = "missions"\nload = ["trips/*.xml"]\n'
    )
    return robot


def test_another_program_may_send_goals(project: Path) -> None:
    write_trip(project, f"{project}/trees/goal.xml", "Goal")
    (project / "trees/goal.xml").write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="Goal"><SubTree ID="Navigate"/></BehaviorTree></root>\n'
    )
    warning = missing(5, "warning", "Goal", "before Lyrical, a goal names the file of its tree, not the ID")
    warning = warning.replace("5 warning missing-nav2-tree", "5:46: warning[missing-nav2-tree]")
    unknown = "trees/goal.xml:1:61: error[unknown-tree] unknown tree `Navigate`; no file of its factory defines it"
    assert check(project, "trips", "trees/goal.xml") == [unknown, warning]
    trip = project / "trips/trip.xml"
    lines = trip.read_text().splitlines(keepends=True)
    trip.write_text("".join((*lines[:4], "<!-- btq: ignore[missing-nav2-tree] -->\n", *lines[4:])))
    assert check(project, "trips") == []
    write_trip(project, f"{project}/trees/dock.xml")
    assert check(project, "trips", "trees/goal.xml") == []  # no program registers it, so it sees the whole project


def test_of_several_robots_it_is_not_known_which_gets_the_goals(project: Path) -> None:
    write_trip(project, "Goal")
    toml = project / "btq.toml"
    assert len(check(project, "trips")) == 1
    toml.write_text(toml.read_text() + '[[factory]]\nname = "second"\nnav2 = "nav2_params.yaml"\n')
    assert check(project, "trips") == []


def test_a_tree_of_a_goal_is_used(robot: Path) -> None:
    (robot / "trips/two.xml").write_text(
        '<root BTCPP_format="4" main_tree_to_execute="Trip"><BehaviorTree ID="Trip"><NavigateToPose goal="{goal}" '
        'behavior_tree="Goal"/></BehaviorTree>\n<BehaviorTree ID="Goal"><Spin/></BehaviorTree>\n'
        '<BehaviorTree ID="Other"><Spin/></BehaviorTree></root>\n'
    )
    (robot / "btq.toml").write_text('nodes = ["nav2-lyrical"]\n')
    assert [each.partition("]")[0] for each in check(robot, "trips")] == ["trips/two.xml:3:19: warning[unused-tree"]
