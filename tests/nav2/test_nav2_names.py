"""Names of parameters that are misspelt, and values of another type than bt_navigator reads."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq
from nav2_robot import make_robot, shown

from btq_lang.catalog.nav2 import DISTRIBUTIONS

HEAD = "bt_navigator:\n  ros__parameters:\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    make_robot(tmp_path)
    return tmp_path


def found(robot: Path, *lines: str, distribution: str = "jazzy") -> list[str]:
    """What is wrong with parameters, each with its line among them."""
    below = "".join(f"    {line}\n" for line in lines)
    rest = [each.replace("nav2-parameter ", "") for each in shown(robot, HEAD + below, distribution)]
    return [f"{int(line) - 2}:{message}" for line, _, message in (each.partition(":") for each in rest)]


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("default_nav_to_pose_bt_xnl", "default_nav_to_pose_bt_xml"),
        ("plugin_lib_name", "plugin_lib_names"),
        ("Bt_loop_duration", "bt_loop_duration"),
        ("error_codes_names", "error_code_names"),
        ("navigators_", "navigators"),
        ("goal_blackboard_ids", "goal_blackboard_id"),
    ],
)
def test_a_name_that_is_nearly_one(robot: Path, name: str, meant: str) -> None:
    message = f"1:5 warning Nav2 has no parameter `{name}`; did you mean `{meant}`?"
    assert found(robot, f"{name}: x") == [message]


DEFAULT_TREES = "`default_nav_through_poses_bt_xml` or `default_nav_to_pose_bt_xml`"


@pytest.mark.parametrize(
    ("name", "distribution", "meant"),
    [
        ("default_bt_xml", "humble", DEFAULT_TREES),
        ("bt_xml", "lyrical", f"`always_reload_bt_xml`, {DEFAULT_TREES}"),
        ("bt_serch_directories", "jazzy", ""),  # which has none
        ("planner_id", "jazzy", ""),
        ("odom_frame", "iron", ""),
        ("bond_heartbeat_period", "humble", ""),
        ("server_timeout", "kilted", "`default_server_timeout`"),
        ("groot_port", "kilted", "`navigate_through_poses.groot_server_port` or `navigate_to_pose.groot_server_port`"),
        ("ComputePathToPose.server_timeout", "jazzy", ""),
    ],
)
def test_a_name_that_nothing_reads(robot: Path, name: str, distribution: str, meant: str) -> None:
    likely = f"; did you mean {meant}?" if meant else ""
    message = f"Nav2 has no parameter `{name}` in {distribution.capitalize()}{likely}"
    assert found(robot, f"{name}: x", distribution=distribution) == [f"1:5 warning {message}"]
    own = (f"{name}: x", "plugin_lib_names: [my_nodes]")
    assert found(robot, *own, distribution=distribution) == [f"1:5 hint {message}"]
    for all_nodes in ("/**", "/*"):
        text = f"bt_navigator:\n  ros__parameters: {{}}\n{all_nodes}:\n  ros__parameters:\n    {name}: x\n"
        assert shown(robot, text, distribution) == []


@pytest.mark.parametrize(
    ("name", "distribution", "readers"),
    [
        ("bond_timeout", "humble", "lifecycle_manager reads it"),
        ("autostart", "lyrical", "lifecycle_manager reads it"),
        ("controller_frequency", "humble", "controller_server reads it"),
        ("controller_frequency", "jazzy", "controller_server and docking_server read it"),
        (
            "enable_stamped_cmd_vel",
            "jazzy",
            "behavior_server, collision_monitor, controller_server, docking_server and velocity_smoother read it",
        ),
        ("controller.k_phi", "kilted", "docking_server reads it"),
    ],
)
def test_a_name_that_another_node_of_nav2_reads(robot: Path, name: str, distribution: str, readers: str) -> None:
    message = f"bt_navigator does not read `{name}`: {readers}"
    assert found(robot, f"{name}: x", distribution=distribution) == [f"1:5 warning {message}"]
    own = (f"{name}: x", "plugin_lib_names: [my_nodes]")
    assert found(robot, *own, distribution=distribution) == [f"1:5 hint {message}"]


def test_a_name_that_other_nodes_read_in_another_distribution(robot: Path) -> None:
    message = "Nav2 has no parameter `enable_stamped_cmd_vel` in Humble"
    assert found(robot, "enable_stamped_cmd_vel: true", distribution="humble") == [f"1:5 warning {message}"]


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_what_all_nodes_and_some_of_a_tree_read(robot: Path, distribution: str) -> None:
    lines = (
        "use_sim_time: true",
        "goal_reached_tol: 0.3",
        "goal_updater_topic: x",
        "start_type_description_service: true",
    )
    qos = "qos_overrides: {/parameter_events: {publisher: {depth: 10}}}"
    assert found(robot, *lines, qos, "bond_disable_heartbeat_timeout: true", distribution=distribution) == []


def test_a_section_is_reported_once(robot: Path) -> None:
    assert found(robot, "my_planner:", "  plugin: a/B", "  tolerance: 0.5") == [
        "1:5 warning Nav2 has no parameter `my_planner` in Jazzy"
    ]


def test_what_is_read_one_level_up(robot: Path) -> None:
    assert found(robot, "navigate_to_pose:", "  error_code_names: [a]", "  goal_blackboard_id: g") == [
        "3:7 warning Nav2 does not read `navigate_to_pose.goal_blackboard_id` in Jazzy",
        "2:7 warning Nav2 does not read `error_code_names` below `navigate_to_pose`: write it one level up",
    ]


def test_what_own_code_reads(tmp_path: Path) -> None:
    """Its C++ is at hand, or only its library is known to be loaded."""
    (tmp_path / "n.cpp").write_text(
        '#include "behaviortree_cpp/bt_factory.h"\n'
        "class Say : public BT::SyncActionNode {\n"
        "  static BT::PortsList providedPorts() { return {}; }\n"
        '  BT::NodeStatus tick() override { node_->get_parameter("own_volume", v_); return BT::NodeStatus::SUCCESS; }\n'
        "};\n"
        'BT_REGISTER_NODES(factory) { factory.registerNodeType<Say>("Say"); }\n'
    )
    (tmp_path / "btq.toml").write_text('nodes = ["nav2-jazzy", "*.cpp"]\n\n[[factory]]\nname = "r"\nnav2 = "p.yaml"\n')
    (tmp_path / "p.yaml").write_text(f"{HEAD}    plugin_lib_names: [say]\n    own_volume: 1\n    own_pitch: 2\n")
    _, out, _ = run_btq("check", "--output-format", "concise", cwd=tmp_path)
    assert out.splitlines()[:-1] == [
        "p.yaml:5:5: hint[nav2-parameter] Nav2 has no parameter `own_pitch` in Jazzy",
    ]


def test_a_name_below_a_navigator(robot: Path) -> None:
    assert found(robot, "navigate_to_pose:", "  enable_groot_monitorin: true", "  groot_serverport: 1", "  own: 1") == [
        "2:7 warning Nav2 has no parameter `navigate_to_pose.enable_groot_monitorin`; did you mean "
        "`navigate_to_pose.enable_groot_monitoring`?",
        "3:7 warning Nav2 has no parameter `navigate_to_pose.groot_serverport`; did you mean "
        "`navigate_to_pose.groot_server_port`?",
        "4:7 warning Nav2 has no parameter `navigate_to_pose.own` in Jazzy",
    ]
    pose = "did you mean `navigate_to_pose`?"
    assert found(robot, "navigate_to_pos:", "  groot_server_port: 1667") == [
        f"1:5 warning Nav2 has no parameter `navigate_to_pos`; {pose}"
    ]
    assert found(robot, "navigate_to_pos.groot_server_port: 1667") == [
        "1:5 warning Nav2 has no parameter `navigate_to_pos.groot_server_port`; did you mean "
        "`navigate_to_pose.groot_server_port`?"
    ]
    assert found(robot, "navigators: [mine]", "mine: {plugin: my_robot/Mine, groot_server_port: 1, own: 2}") == []


@pytest.mark.parametrize(
    ("parameter", "wanted"),
    [
        *((f"bt_loop_duration: {value}", "an integer") for value in ("10.0", "'10'", "ten", "true", "[10]", "1e1")),
        *(
            (f"transform_tolerance: {value}", "a number with a decimal point")
            for value in ("1", "'0.1'", "x", "{a: b}")
        ),
        *((f"always_reload_bt_xml: {value}", "a boolean") for value in ("1", "'true'", "maybe")),
        *((f"plugin_lib_names: {value}", "a list of strings") for value in ("nav2_spin_action_bt_node", "1")),
        ("navigate_to_pose: {groot_server_port: 1667.0}", "an integer"),
        *((f"bt_loop_duration: {value}", "") for value in ("10", "-1", "0x0A", "$(var loop)", "", "~")),
        *((f"transform_tolerance: {value}", "") for value in ("0.1", ".5", "1.", "1e-3", "-.inf", "$(var x)")),
        *((f"always_reload_bt_xml: {value}", "") for value in ("true", "False", "yes", "off")),
        *((f"plugin_lib_names: {value}", "") for value in ("[]", "", "$(var libraries)")),
        ("default_cancel_timeout: 20.0", "an integer"),
    ],
)
def test_a_value_of_another_type(robot: Path, parameter: str, wanted: str) -> None:
    name = "navigate_to_pose.groot_server_port" if "groot" in parameter else parameter.partition(":")[0]
    messages = [each.partition(" ")[2] for each in found(robot, parameter)]
    assert messages == ([f"error `{name}` must be {wanted}"] if wanted else [])


def test_a_type_of_what_is_not_read_does_not_matter(robot: Path) -> None:
    assert found(robot, "default_cancel_timeout: 20.0", distribution="humble") == [
        "1:5 warning Nav2 does not read `default_cancel_timeout` in Humble"
    ]


def test_parameters_that_no_distribution_reads_any_more(robot: Path) -> None:
    names = ("enable_groot_monitoring", "groot_zmq_publisher_port", "groot_zmq_server_port", "default_bt_xml_filename")
    for distribution in ("humble", "jazzy", "lyrical"):
        assert found(robot, *(f"{name}: 1" for name in names), distribution=distribution) == [
            f"{line}:5 warning Nav2 does not read `{name}` in {distribution.capitalize()}"
            for line, name in enumerate(names, 1)
        ]


@pytest.mark.parametrize("distribution", ["kilted", "lyrical"])
def test_a_parameter_that_is_read_without_the_point(robot: Path, distribution: str) -> None:
    """With the value that counts anyway, as in Nav2's own file, nothing is lost."""
    below = "navigate_to_pose:"
    message = f"2:7 warning Nav2 does not read `navigate_to_pose.search_window` in {distribution.capitalize()}"
    assert found(robot, below, "  search_window: 3.0", distribution=distribution) == [message]
    assert found(robot, below, "  search_window: 2.0", distribution=distribution) == []


def test_what_later_distributions_added(robot: Path) -> None:
    names = ("filter_duration: 0.3", "allow_navigator_preemption: true", "navigator_preemption_timeout: 500")
    assert found(robot, *names, distribution="lyrical") == []
    assert [each.partition("`")[2] for each in found(robot, *names, distribution="kilted")] == [
        f"{name.partition(':')[0]}` in Kilted" for name in names[1:]
    ]


def test_a_misspelt_node(robot: Path) -> None:
    text = "bt_navigater:\n  ros__parameters: {error_code_names: [a]}\n"
    message = "1:1 warning nav2-parameter unknown key `bt_navigater`; did you mean `bt_navigator`?"
    assert shown(robot, text) == shown(robot, text, "kilted") == [message]
    other = "bt_navigator_2:\n  ros__parameters: {}\n"
    assert shown(robot, f"{HEAD}    error_code_names: [a]\n{other}", "jazzy") == []


@pytest.mark.parametrize("name", ["ros_parameters", "ros__parameter", "ros__paramters", "Ros__parameters"])
def test_a_misspelt_key_above_the_parameters(robot: Path, name: str) -> None:
    text = f"robot:\n  bt_navigator:\n    {name}: {{error_code_names: [a]}}\n"
    message = f"3:5 error nav2-parameter unknown key `{name}`; did you mean `ros__parameters`?"
    assert shown(robot, text) == shown(robot, text, "kilted") == [message]


def test_such_a_file_needs_no_distribution(robot: Path) -> None:
    (robot / "a.yaml").write_text("bt_navigator: {ros_parameters: {}}\n")
    (robot / "b.yaml").write_text("controller_server: {ros__parameters: {}}\n")
    _, out, _ = run_btq("check", "--output-format", "concise", "a.yaml", "b.yaml", cwd=robot)
    assert [each.partition("] ")[2] for each in out.splitlines()[:-1]] == [
        "unknown key `ros_parameters`; did you mean `ros__parameters`?",
        "this file has no parameters of bt_navigator",
    ]
