"""The parameters of bt_navigator, and the distribution that they are for."""

from __future__ import annotations

import pytest

from btq_lang.nav2.parameters import Parameters, read_parameters


def parameters(*lines: str, around: str = "bt_navigator") -> Parameters:
    below = "".join(f"    {line}\n" for line in lines)
    return read_parameters(f"{around}:\n  ros__parameters:\n{below}")


@pytest.mark.parametrize(
    "text",
    [
        "bt_navigator: {ros__parameters: {a: 1}}",
        "/bt_navigator: {ros__parameters: {a: 1}}",
        "/robot/bt_navigator: {ros__parameters: {a: 1}}",
        "<robot_namespace>: {bt_navigator: {ros__parameters: {a: 1}}}",
        "/**: {ros__parameters: {a: 1}}",
        "bt_navigator: {ros__parameters: {a: 1}}\n/**: {ros__parameters: {a: 2}}",
        "controller_server: {ros__parameters: {a: 2}}\nbt_navigator: {ros__parameters: {a: 1}}",
        "all: &all {ros__parameters: {a: 1}}\nbt_navigator: *all",
    ],
)
def test_where_they_are(text: str) -> None:
    found = read_parameters(text).text("a")
    assert found is not None
    assert (found.text, text[found.span.start : found.span.end]) == ("1", "1")


@pytest.mark.parametrize(
    "text", ["", "a: 1", "- bt_navigator", "bt_navigator: 1", "controller_server: {ros__parameters: {}}"]
)
def test_where_there_are_none(text: str) -> None:
    found = read_parameters(text)
    assert (found.place, found.values) == (None, {})


def test_below_a_navigator() -> None:
    nested = parameters("navigate_to_pose:", "  goal_blackboard_id: target")
    dotted = parameters("navigate_to_pose.goal_blackboard_id: target")
    for each in (nested, dotted):
        found = each.text("navigate_to_pose.goal_blackboard_id")
        assert found is not None
        assert found.text == "target"
        assert dict(each.entries("lyrical"))["target"] == "output"
        assert "goal" not in dict(each.entries("lyrical"))
        assert dict(each.entries("kilted"))["goal"] == "output"


def test_entries_of_named_codes() -> None:
    assert dict(parameters("error_code_names: [mine]").entries("jazzy"))["mine"] == "inout"
    assert "follow_path_error_code" not in dict(parameters("error_code_names: [mine]").entries("jazzy"))
    assert dict(parameters("error_code_name_prefixes: [mine]").entries("kilted"))["mine_error_msg"] == "inout"


OLD = "plugin_lib_names: [nav2_follow_path_action_bt_node, nav2_is_path_valid_condition_bt_node]"
NEW_CLASS = 'navigate_to_pose: {plugin: "nav2_bt_navigator::NavigateToPoseNavigator"}'


@pytest.mark.parametrize(
    ("lines", "distribution"),
    [
        ((), None),
        ((OLD,), None),  # Humble or Iron
        ((OLD, "navigators: [navigate_to_pose]"), "iron"),
        (("navigate_to_pose: {plugin: nav2_bt_navigator/NavigateToPoseNavigator}",), "iron"),
        ((NEW_CLASS, "error_code_names: [a]"), "jazzy"),
        ((NEW_CLASS, "error_code_name_prefixes: [a]"), None),  # Kilted or Lyrical
        (("error_code_name_prefixes: [a]", "service_introspection_mode: disabled"), "kilted"),
        (("error_code_name_prefixes: [a, follow_object]",), "lyrical"),
        (("bt_search_directories: [/a]",), "lyrical"),
        (("default_nav_to_pose_bt_xml: Navigate",), "lyrical"),
        (("default_nav_to_pose_bt_xml: /a/b",), None),
        (("default_nav_to_pose_bt_xml: see the launch file",), None),
        (("navigators: [mine]", "mine: {plugin: my_robot/Mine}"), None),
        (("enable_groot_monitoring: true", "bt_search_directories: [/a]"), "lyrical"),
        (("plugin_lib_names: [validate_path_action_bt_node]",), "lyrical"),  # which loads it by itself, too
        (("error_code_names: [a]", "bt_search_directories: [/a]"), None),  # of none
    ],
)
def test_which_distribution(lines: tuple[str, ...], distribution: str | None) -> None:
    assert parameters(*lines).distribution == distribution


def test_humble_has_parameters_of_two_more_nodes() -> None:
    more = "bt_navigator_navigate_to_pose_rclcpp_node: {ros__parameters: {use_sim_time: true}}\n"
    assert read_parameters(f"{more}bt_navigator: {{ros__parameters: {{{OLD}}}}}").distribution == "humble"


def test_aliases_are_not_followed_without_end() -> None:
    lines = ["a0: &a0 {b: 1}", *(f"a{at}: &a{at} {{x: *a{at - 1}, y: *a{at - 1}}}" for at in range(1, 45))]
    assert read_parameters("\n".join(lines)).place is None
