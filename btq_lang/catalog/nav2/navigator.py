"""bt_navigator by distribution of ROS 2: the entries that it sets before the first tick, and its parameters.

One invariant: it holds what the C++ code of each branch does; distributions are named by their first letters, `hijkl`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Direction

    OutsideEntry: TypeAlias = tuple[str, Direction]

# The entries of the root blackboard that both navigators set, with the distributions that do.  `goal` is of
# NavigateToPose, `goals` and `waypoint_statuses` are of NavigateThroughPoses; a tree may be for either.
ENTRIES: Final[Mapping[str, str]] = {
    "node": "hijkl",
    "server_timeout": "hijkl",
    "cancel_timeout": "jkl",
    "bt_loop_duration": "hijkl",
    "wait_for_service_timeout": "hijkl",
    "tf_buffer": "hijkl",
    "odom_smoother": "hijkl",
    "initial_pose_received": "hijkl",
    "number_recoveries": "hijkl",
    "goal": "hijkl",
    "goals": "hijkl",
    "waypoint_statuses": "kl",
    "path": "l",
}
# What it takes from the blackboard for feedback and for the result, besides error codes.
READ: Final = frozenset(("goals", "path", "number_recoveries", "waypoint_statuses"))
# The parameters that rename entries.
RENAMED: Final[Mapping[str, str]] = {
    "goal_blackboard_id": "goal",
    "goals_blackboard_id": "goals",
    "path_blackboard_id": "path",
    "waypoint_statuses_blackboard_id": "waypoint_statuses",
}

_PREFIXES: Final = (
    *("assisted_teleop", "backup", "compute_path", "dock_robot", "drive_on_heading", "follow_path"),
    *("nav_thru_poses", "nav_to_pose", "spin", "undock_robot", "wait"),
)
# The error codes that it collects if its parameters name none: entries, or what they begin with.
ERROR_CODES: Final[Mapping[str, tuple[str, ...]]] = {
    "h": (),
    "i": ("follow_path_error_code", "compute_path_error_code"),
    "j": ("follow_path_error_code", "compute_path_error_code"),
    "k": _PREFIXES,
    "l": (*_PREFIXES, "follow_object"),
}

# The actions whose error codes a condition looks for, which no other action has.
HELPED: Final[Mapping[str, tuple[str, ...]]] = {
    "WouldAControllerRecoveryHelp": ("FollowPath",),
    "WouldAPlannerRecoveryHelp": ("ComputePathToPose", "ComputePathThroughPoses"),
    "WouldARouteRecoveryHelp": ("ComputeRoute", "ComputeAndTrackRoute"),
    "WouldASmootherRecoveryHelp": ("SmoothPath",),
}
# The outputs of nodes that it collects through their entries, and the parameter that names these.
COLLECTED: Final = frozenset(("error_code_id", "error_msg"))
COLLECTING: Final[Mapping[str, str]] = {
    **dict.fromkeys("ij", "error_code_names"),
    **dict.fromkeys("kl", "error_code_name_prefixes"),
}
# What the parameters of nav2_bringup add to these, from which many projects start.
OF_BRINGUP: Final = tuple(f"{prefix}_error_{part}" for prefix in ("route", "smoother") for part in ("code", "msg"))


def outside_entries(
    distribution: str, codes: tuple[str, ...] | None = None, renamed: Mapping[str, str] | None = None
) -> tuple[OutsideEntry, ...]:
    """The entries of the root blackboard that bt_navigator sets (`output`), reads (`input`), or both; error codes last.

    Args:
        codes: the names or prefixes of error codes; None for those that it collects if none are named.
        renamed: other names of entries.
    """
    letter = distribution[0]
    codes = ERROR_CODES[letter] if codes is None else codes
    entries: dict[str, Direction] = {}
    for name, letters in ENTRIES.items():
        if letter in letters:
            entries[name] = "inout" if name in READ else "output"
        elif name in READ:
            entries[name] = "input"
    entries = {(renamed or {}).get(name, name): direction for name, direction in entries.items()}
    if letter in "kl":
        codes = tuple(f"{prefix}_error_{part}" for prefix in codes for part in ("code", "msg"))
    return (*entries.items(), *((code, "inout") for code in codes))


def preset_entries(distribution: str, outside: Sequence[OutsideEntry] = ()) -> Iterator[str]:
    """The entries that have a value before the first tick of the first goal: an error code gets one after a goal.

    Args:
        outside: what `outside_entries` returns for the parameters; empty: for none.
    """
    letter = distribution[0]
    count = sum(letter in letters or name in READ for name, letters in ENTRIES.items())
    entries = outside or outside_entries(distribution)
    return (name for name, direction in entries[:count] if direction != "input")


class NavigatorParameter(Record):
    """A parameter of bt_navigator.

    Attributes:
        of: the distributions that read it.
        instead: what to do where it is not read, for a message.
        refused_in: the distributions that do not start with it.
        type: of its value, where YAML may easily say another one.
        default: the value that counts where it is not read, so that it may as well be in a file.
    """

    of: str
    instead: str = ""
    refused_in: str = ""
    type: str = ""
    default: str = ""


_OF_ALL: Final = (
    *("default_nav_to_pose_bt_xml", "default_nav_through_poses_bt_xml"),
    *("global_frame", "robot_base_frame", "odom_topic", "use_sim_time"),
)
INTEGER: Final = "integer"
DOUBLE: Final = "number with a decimal point"
BOOLEAN: Final = "boolean"
STRINGS: Final = "list of strings"

# By name; `*` is a navigator.
PARAMETERS: Final[Mapping[str, NavigatorParameter]] = {
    "default_bt_xml_filename": NavigatorParameter(
        "", "write `default_nav_to_pose_bt_xml`"
    ),  # of distributions before these
    "enable_groot_monitoring": NavigatorParameter("", "write it below each navigator, from Jazzy on"),
    "groot_zmq_publisher_port": NavigatorParameter("", "write `navigate_to_pose.groot_server_port`, from Jazzy on"),
    "groot_zmq_server_port": NavigatorParameter("", "write `navigate_to_pose.groot_server_port`, from Jazzy on"),
    "navigators": NavigatorParameter("ijkl", type=STRINGS),
    "*.plugin": NavigatorParameter("ijkl"),
    "error_code_names": NavigatorParameter(
        "ij", "write `error_code_name_prefixes`, without `_error_code`", "kl", STRINGS
    ),
    "error_code_name_prefixes": NavigatorParameter("kl", "write `error_code_names`, with `_error_code`", type=STRINGS),
    "bt_search_directories": NavigatorParameter(
        "l", "there each tree is loaded from one file and what that includes", type=STRINGS
    ),
    "goal_blackboard_id": NavigatorParameter("hijk", "write `navigate_to_pose.goal_blackboard_id`"),
    "goals_blackboard_id": NavigatorParameter("hijk", "write `navigate_through_poses.goals_blackboard_id`"),
    "path_blackboard_id": NavigatorParameter(
        "hijk", "write it below each navigator: `navigate_to_pose.path_blackboard_id`"
    ),
    "waypoint_statuses_blackboard_id": NavigatorParameter(
        "k", "write `navigate_through_poses.waypoint_statuses_blackboard_id` in Lyrical"
    ),
    "*.goal_blackboard_id": NavigatorParameter("l", "write `goal_blackboard_id` without the navigator"),
    "*.goals_blackboard_id": NavigatorParameter("l", "write `goals_blackboard_id` without the navigator"),
    "*.path_blackboard_id": NavigatorParameter("l", "write `path_blackboard_id` without the navigator"),
    "*.waypoint_statuses_blackboard_id": NavigatorParameter("l", "write it without the navigator in Kilted"),
    "*.tracking_feedback_blackboard_id": NavigatorParameter("l"),
    "*.enable_groot_monitoring": NavigatorParameter("jkl", type=BOOLEAN),
    "*.groot_server_port": NavigatorParameter("jkl", type=INTEGER),
    # Lyrical reads it without the point after the navigator.
    "*.search_window": NavigatorParameter(
        "", "Lyrical reads `navigate_to_posesearch_window`, without a point", default="2.0"
    ),
    "default_cancel_timeout": NavigatorParameter("jkl", type=INTEGER),
    "bt_log_idle_transitions": NavigatorParameter("l", type=BOOLEAN),
    "action_server_result_timeout": NavigatorParameter("ij", type=DOUBLE),
    "filter_duration": NavigatorParameter("kl", type=DOUBLE),
    "allow_navigator_preemption": NavigatorParameter("l", type=BOOLEAN),
    "navigator_preemption_timeout": NavigatorParameter("l", type=INTEGER),
    "service_introspection_mode": NavigatorParameter("k", "write `introspection_mode` in Lyrical"),
    "introspection_mode": NavigatorParameter("l", "write `service_introspection_mode` in Kilted"),
    **{name: NavigatorParameter("hijkl") for name in _OF_ALL},
    **{
        name: NavigatorParameter("hijkl", type=INTEGER)
        for name in ("bt_loop_duration", "default_server_timeout", "wait_for_service_timeout")
    },
    "always_reload_bt_xml": NavigatorParameter("hijkl", type=BOOLEAN),
    "transform_tolerance": NavigatorParameter("hijkl", type=DOUBLE),
    "plugin_lib_names": NavigatorParameter("hijkl", type=STRINGS),
}
# What other code of bt_navigator reads, with the distributions in which it does: some nodes of trees, and the classes
# that all nodes of Nav2 or of ROS 2 are made of.
OTHER_PARAMETERS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("goal_reached_tol", "goal_updater_topic", "bond_disable_heartbeat_timeout"), "hijkl"),
    "goals_updater_topic": "kl",
    "bond_heartbeat_period": "ijkl",
    **dict.fromkeys(("autostart_node", "strict_param_loading", "warn_on_missing_params"), "jkl"),
    "allow_parameter_qos_overrides": "l",
    **dict.fromkeys(("qos_overrides", "start_type_description_service"), "hijkl"),
}
# The navigators: the parameter that names a tree, the file in nav2_bt_navigator that counts without it, and the class,
# which Iron writes with `/` and later ones with `::`.
NAVIGATORS: Final[Mapping[str, tuple[str, str, str]]] = {
    "navigate_to_pose": (
        *("default_nav_to_pose_bt_xml", "navigate_to_pose_w_replanning_and_recovery.xml"),
        "NavigateToPoseNavigator",
    ),
    "navigate_through_poses": (
        *("default_nav_through_poses_bt_xml", "navigate_through_poses_w_replanning_and_recovery.xml"),
        "NavigateThroughPosesNavigator",
    ),
}
# The servers that send goals to it, and the parameter of each that names the tree for them.
SENDERS: Final = {"docking_server": "navigator_bt_xml"}
NAME: Final = "bt_navigator"
OWN_PACKAGE: Final = "nav2_bt_navigator"  # with its trees in the folder `behavior_trees`
