"""What is wrong with parameter files beyond the examples on the rules' pages."""

from __future__ import annotations

from pathlib import Path

import pytest
from nav2_robot import findings_in, make_robot, shown

HEAD = "bt_navigator:\n  ros__parameters:\n"
QUOTE = "'"
HERE = "$(find-pkg-share my_robot)"
UNLOADED = "bt_navigator does not load the library of `{}`: add `{}`"
DOCKING = "    plugin_lib_names: [opennav_dock_action_bt_node]\n"
POSE = f"    default_nav_to_pose_bt_xml: {HERE}"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    make_robot(tmp_path)
    return tmp_path


def with_nav2(folder: Path, monkeypatch: pytest.MonkeyPatch, *files: str) -> Path:
    """Install Nav2 with some trees of its own."""
    trees = folder / "ros/share/nav2_bt_navigator/behavior_trees"
    trees.mkdir(parents=True)
    for name in files:
        tree = f'<BehaviorTree ID="{name}"><FollowPath path="{{path}}"/></BehaviorTree>'
        (trees / f"{name}.xml").write_text(f'<root BTCPP_format="4">{tree}</root>\n')
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(folder / "ros"))
    return trees


def test_a_file_without_bt_navigator(robot: Path) -> None:
    message = "1:1 warning nav2-parameter this file has no parameters of bt_navigator"
    assert shown(robot, "controller_server: {ros__parameters: {}}\n", "jazzy") == [message]


def test_humble_and_iron_load_only_what_is_named(robot: Path) -> None:
    text = f"{HEAD}{POSE}/trees/navigate.xml\n    plugin_lib_names: [nav2_follow_path_action_bt_node]\n"
    library = "nav2_compute_path_to_pose_action_bt_node"
    missing = f"4:5 error unloaded-node {UNLOADED.format('ComputePathToPose', library)}"
    assert shown(robot, text, "humble") == shown(robot, text, "iron") == [missing]
    without = text.partition("    plugin")[0]
    assert shown(robot, without, "humble") == shown(robot, without, "lyrical") == []
    twice = "Nav2 loads `nav2_follow_path_action_bt_node` by itself in Jazzy, so nodes are registered twice"
    assert shown(robot, text, "jazzy") == [f"4:24 error library-loaded-twice {twice}"]


def test_the_tree_is_shown_beside_a_library(robot: Path) -> None:
    text = f"{HEAD}{POSE}/trees/dock.xml\n"
    ((_, found),) = findings_in(robot, text, "kilted")
    (place,) = [each.place for each in found.related]
    assert text[found.span.start : found.span.end] == "bt_navigator"
    assert place.path == f"{robot}/trees/dock.xml"
    assert Path(place.path).read_text()[place.span.start : place.span.end] == "DockRobot"


def test_a_node_of_nobody(robot: Path) -> None:
    (robot / "trees/own.xml").write_text(
        '<root BTCPP_format="3" main_tree_to_execute="Main"><BehaviorTree ID="Main"><SequenceStar><Own/>'
        '<SubTree ID="Other"/></SequenceStar></BehaviorTree><BehaviorTree ID="Other"><Inverter>'
        "<AlwaysSuccess/></Inverter></BehaviorTree></root>\n"
    )
    text = f"{HEAD}{POSE}/trees/own.xml\n"
    message = "1:1 error unloaded-node no library that bt_navigator loads has a node `Own`"
    assert shown(robot, text, "humble") == [message]
    assert shown(robot, f"{text}    plugin_lib_names: [my_own_bt_node]\n", "humble") == []


def test_a_library_that_is_called_otherwise_now(robot: Path) -> None:
    text = f"{HEAD}    plugin_lib_names: [nav2_path_expiring_timer_condition]\n"
    meant = "did you mean `nav2_path_expiring_timer_condition_bt_node`?"
    message = f"3:24 error unknown-library Nav2 has no library `nav2_path_expiring_timer_condition` in Lyrical; {meant}"
    assert shown(robot, text, "lyrical") == [message]


# ---- where files are ----


def test_a_build_may_install_a_file_elsewhere(robot: Path) -> None:
    assert shown(robot, f"{HEAD}{POSE}/behavior_trees/navigate.xml\n", "jazzy") != []  # two files have this name
    assert shown(robot, f"{HEAD}{POSE}/behavior_trees/dock.xml\n", "jazzy") == [
        f"1:1 error unloaded-node {UNLOADED.format('DockRobot', 'opennav_dock_action_bt_node')}"
    ]


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        ("/home/robot/gone.xml", "this machine has no such file"),
        ("see the launch file", "a relative path counts from the folder in which bt_navigator runs"),
        (
            "$(find-pkg-share yours)/a.xml",
            "neither the workspace nor AMENT_PREFIX_PATH has the package `yours`",
        ),
    ],
)
def test_what_is_not_here(robot: Path, value: str, problem: str) -> None:
    text = f"{HEAD}    default_nav_to_pose_bt_xml: {value}\n"
    message = f"3:33 hint missing-nav2-tree cannot find the tree `{value.strip(QUOTE)}`: {problem}"
    assert shown(robot, text, "jazzy") == shown(robot, text, "lyrical") == [message]


def test_a_relative_path(robot: Path) -> None:
    """Perhaps bt_navigator runs in the folder of the project."""
    for value, severity in (("lost/dock.xml", "warning"), ("dock.xml", "warning"), ("trees/dock.xml", "hint")):
        text = f"{HEAD}    default_nav_to_pose_bt_xml: {value}\n"
        message = (
            f"3:33 {severity} missing-nav2-tree cannot find the tree `{value}`: "
            "a relative path counts from the folder in which bt_navigator runs"
        )
        assert shown(robot, text, "jazzy") == shown(robot, text, "lyrical") == [message]


@pytest.mark.parametrize("distribution", ["jazzy", "lyrical"])
def test_a_package_of_the_workspace_lacks_a_file(robot: Path, distribution: str) -> None:
    def found(name: str) -> list[str]:
        return shown(robot, f"{HEAD}{POSE}/trees/{name}.xml\n", distribution)

    def lacking(name: str, likely: str = "") -> list[str]:
        what = f"cannot find the tree `{HERE}/trees/{name}.xml`: the package in {robot} has no such file{likely}"
        return [f"3:33 warning missing-nav2-tree {what}"]

    assert found("dokc") == lacking("dokc", "; did you mean `dock.xml`?")
    assert found("elsewhere") == lacking("elsewhere")
    (robot / "missions").mkdir()
    (robot / "missions/elsewhere.btq").write_text("BehaviorTree Main\n    AlwaysSuccess\n")  # of which it may be built
    assert [each.split()[1] for each in found("elsewhere")] == ["hint"]


def test_an_empty_value(robot: Path) -> None:
    text = f"{HEAD}    default_nav_to_pose_bt_xml: ''\n"
    message = "3:33 hint missing-nav2-tree this parameter is empty and names no tree; a launch file may set it"
    assert shown(robot, text, "jazzy") == shown(robot, text, "lyrical") == [message]
    folders = shown(robot, f"{HEAD}    bt_search_directories: ['']\n", "lyrical")
    assert folders == ["3:29 hint missing-nav2-tree this item is empty and names no folder; a launch file may set it"]


def test_what_nobody_can_know(robot: Path) -> None:
    assert shown(robot, f"{HEAD}    default_nav_to_pose_bt_xml: $(var trees)/a.xml\n", "jazzy") == []


def test_an_installed_package_lacks_a_file(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    trees = with_nav2(robot, monkeypatch, "navigate_to_pose_w_replanning_and_recovery")
    value = "$(find-pkg-share nav2_bt_navigator)/behavior_trees/gone.xml"
    text = f"{HEAD}    default_nav_through_poses_bt_xml: {value}\n"
    why = f"the package in {trees.parent} has no such file"
    assert shown(robot, text, "jazzy") == [f"3:39 error missing-nav2-tree cannot find the tree `{value}`: {why}"]


def test_nav2s_own_tree_counts_where_none_is_named(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with_nav2(robot, monkeypatch, "navigate_to_pose_w_replanning_and_recovery")
    message = UNLOADED.format("FollowPath", "nav2_follow_path_action_bt_node")
    text = f"{HEAD}    plugin_lib_names: [nav2_spin_action_bt_node]\n"
    assert shown(robot, text, "humble") == [f"3:5 error unloaded-node {message}"]


@pytest.mark.parametrize("distribution", ["humble", "jazzy", "kilted"])
def test_several_trees_and_none_is_the_main_one(robot: Path, distribution: str) -> None:
    text = f"{HEAD}{POSE}/several/two.xml\n"
    why = "nothing says which of 2 trees is the main one"
    assert shown(robot, text, distribution) == [f"3:33 error refused-tree-file bt_navigator refuses `two.xml`: {why}"]
    two = robot / "several/two.xml"
    two.write_text(two.read_text().replace("<root", '<root main_tree_to_execute="One"'))
    assert shown(robot, text, distribution) == []


def test_included_trees_count_before_lyrical(robot: Path) -> None:
    (robot / "trees/more.xml").write_text(
        '<root BTCPP_format="4"><include path="../same/navigate.xml"/><BehaviorTree ID="More"><SubTree ID="Navigate"/>'
        "</BehaviorTree></root>\n"
    )
    text = f"{HEAD}{POSE}/trees/more.xml\n    bt_search_directories: []\n    navigators: [navigate_to_pose]\n"
    found = [each for _, each in findings_in(robot, text, "jazzy") if each.rule == "refused-tree-file"]
    assert [(Path(each.related[0].place.path or "").name, each.notes) for each in found] == [
        ("more.xml", ("write `main_tree_to_execute`",))
    ]
    assert shown(robot, text, "lyrical") == []


# ---- the folders of Lyrical ----


def test_the_file_that_is_named_comes_first(robot: Path) -> None:
    folders = f"    bt_search_directories: [{HERE}/same]\n    navigators: [navigate_to_pose]\n"
    text = f"{HEAD}{POSE}/trees/navigate.xml\n{folders}"
    name = "navigate.xml"
    assert shown(robot, text, "lyrical") == [
        "4:29 warning skipped-tree-file bt_navigator skips `again.xml`: `navigate.xml` has a tree `Navigate` too",
        f"4:29 hint skipped-tree-file bt_navigator skips `same/{name}`: `trees/{name}` has a tree `Navigate` too",
    ]


def test_files_without_trees(robot: Path) -> None:
    (robot / "trees/models.xml").write_text("<root><TreeNodesModel/></root>\n")
    (robot / "trees/torn.xml").write_text('<root><BehaviorTree ID="Torn"></root>\n')
    text = f"{HEAD}{POSE}/trees/navigate.xml\n    bt_search_directories: [{HERE}/trees]\n{DOCKING}"
    assert shown(robot, text, "lyrical") == [
        "4:29 hint skipped-tree-file bt_navigator skips `models.xml`, which has no tree with an ID",
        "4:29 warning skipped-tree-file bt_navigator skips `torn.xml`, which has no tree with an ID",
    ]
    assert shown(robot, text, "kilted") == [
        "4:5 warning nav2-parameter Nav2 does not read `bt_search_directories` in Kilted"
    ]


def test_a_folder_that_is_not_there(robot: Path) -> None:
    text = f"{HEAD}    bt_search_directories: [{HERE}/gone, /nowhere]\n"
    assert [line.partition(": ")[2] for line in shown(robot, text, "lyrical")] == [
        f"the package in {robot} has no such folder",
        "this machine has no such folder",
    ]


def test_a_list_from_humble_is_one_finding(robot: Path) -> None:
    names = [
        f"nav2_{each}_bt_node"
        for each in ("spin_action", "wait_action", "back_up_action", "spin_cancel", "wait_cancel")
    ]
    text = f"{HEAD}    plugin_lib_names: [{', '.join(names)}, my_own_bt_node]\n"
    ((_, found),) = findings_in(robot, text, "jazzy")
    message = "Nav2 loads `nav2_spin_action_bt_node` and 4 more of the named libraries by itself in Jazzy"
    assert found.message == f"{message}, so nodes are registered twice"
    assert [text[each.place.span.start : each.place.span.end] for each in found.related] == names[1:4]


def test_parameters_of_earlier_distributions(robot: Path) -> None:
    text = f"{HEAD}    enable_groot_monitoring: true\n"
    message = "3:5 warning nav2-parameter Nav2 does not read `enable_groot_monitoring` in Humble"
    assert shown(robot, text, "humble") == [message]


def test_a_navigator_that_nav2_does_not_have(robot: Path) -> None:
    def found(name: str) -> list[str]:
        return shown(robot, f"{HEAD}    navigate_to_pose: {{plugin: '{name}'}}\n", "jazzy")

    own = "nav2_bt_navigator::NavigateTo"
    meant = f"did you mean `{own}PoseNavigator`?"
    message = f"3:32 error nav2-parameter Nav2 has no navigator `{own}PoseNavigater`; {meant}"
    assert found(f"{own}PoseNavigater") == [message]
    assert found(f"{own}PoseNavigator") == found("my_package::NavigateToPoseNavigater") == []


def test_libraries_of_ones_own_may_be_named_alike(robot: Path) -> None:
    own = "nav2_skip_action_bt_node, my_spin_action_bt_node, nav2_spin_action_bt_node_v2, libmy_own.so"
    assert shown(robot, f"{HEAD}    plugin_lib_names: [{own}]\n", "jazzy") == []


@pytest.mark.parametrize("distribution", ["humble", "lyrical"])
@pytest.mark.parametrize(
    "value",
    [
        "5",
        "null",
        "[[a], {b: c}]",
        "{a: b}",
        "''",
        '"\\0"',
        '"a\\nb"',
        f"/{'a' * 5_000}",
        "$(find-pkg-share",
        "~",
        "[]",
    ],
)
def test_no_value_is_too_odd(robot: Path, value: str, distribution: str) -> None:
    names = (
        *(
            "default_nav_to_pose_bt_xml",
            "default_nav_through_poses_bt_xml",
            "bt_search_directories",
            "plugin_lib_names",
        ),
        *("navigators", "error_code_names", "error_code_name_prefixes", "goal_blackboard_id", "navigate_to_pose"),
    )
    for name in names:
        rules = {each.rule for _, each in findings_in(robot, f"{HEAD}    {name}: {value}\n", distribution)}
        assert rules <= {"nav2-parameter", "missing-nav2-tree"}


def test_docking_was_a_package_beside_nav2(robot: Path) -> None:
    """In Humble its library is no part of Nav2, but may be there."""
    text = f"{HEAD}{POSE}/trees/dock.xml\n{DOCKING}"
    assert shown(robot, text, "humble") == []
    message = "4:5 error unloaded-node no library that bt_navigator loads has a node `DockRobot`"
    assert shown(robot, text.replace("opennav_dock_action", "nav2_spin_action"), "humble") == [message]
