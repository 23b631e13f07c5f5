"""The creation of Nav2's nodes: the entries that they need for it, the inputs that they read only then, and the action
servers that they call.

An entry that is written after a node has read it once has no effect.

One invariant: it holds what the constructors in the C++ code of each branch do; distributions are named by their first
letters, `hijkl`.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from typing import Final

from btq_lang.catalog.nav2.navigator import ENTRIES

_IN_ALL: Final = {"node": "hijkl"}
_IN_NEW_ONES: Final = {"node": "jkl"}
_IN_THE_NEWEST: Final = {"node": "l"}
_LISTENING: Final = {"node": "hijkl", "bt_loop_duration": "l"}
_MEASURING: Final = {"node": "hijkl", "odom_smoother": "hijkl"}
_LOCATING: Final = {"node": "hijkl", "tf_buffer": "hijkl"}
_LOCATING_IN_OLD_ONES: Final = {"node": "hi", "tf_buffer": "hi"}
_LOCATING_IN_NEW_ONES: Final = {"node": "jkl", "tf_buffer": "jkl"}

# By node, of those that call neither an action nor a service.
CREATED_WITH: Final[Mapping[str, Mapping[str, str]]] = {
    **dict.fromkeys(("ControllerSelector", "GoalCheckerSelector", "GoalUpdater", "IsBatteryCharging"), _LISTENING),
    **dict.fromkeys(("PathHandlerSelector", "PlannerSelector", "ProgressCheckerSelector"), _LISTENING),
    "SmootherSelector": _LISTENING,
    "IsBatteryLow": {"node": "hikl", "bt_loop_duration": "l"},
    **dict.fromkeys(("DistanceController", "RemovePassedGoals", "TransformAvailable", "IsGoalNearby"), _LOCATING),
    "DistanceTraveled": _LOCATING_IN_OLD_ONES,
    "GetCurrentPose": _LOCATING_IN_NEW_ONES,
    "TruncatePathLocal": {"tf_buffer": "hijkl"},
    **dict.fromkeys(("GlobalUpdatedGoal", "IsStuck", "PathExpiringTimer", "PathLongerOnApproach"), _IN_ALL),
    "TimeExpired": {"node": "hi"},
    **dict.fromkeys(("ArePosesNear", "GoalReached"), _IN_NEW_ONES),
    **dict.fromkeys(("IsWithinPathTrackingBounds", "PauseResumeController"), _IN_THE_NEWEST),
    **dict.fromkeys(("CheckStopStatus", "IsStopped", "SpeedController"), _MEASURING),
    "IsPathValid": {"node": "hijk", "server_timeout": "hijk"},
}
# By action, the server that it calls if it is given no other name.
SERVERS: Final[Mapping[str, str]] = {
    "AssistedTeleop": "assisted_teleop",
    "BackUp": "backup",
    "ComputeAndTrackRoute": "compute_and_track_route",
    "ComputePathThroughPoses": "compute_path_through_poses",
    "ComputePathToPose": "compute_path_to_pose",
    "ComputeRoute": "compute_route",
    "DockRobot": "dock_robot",
    "DriveOnHeading": "drive_on_heading",
    "FollowObject": "follow_object",
    "FollowPath": "follow_path",
    "NavigateThroughPoses": "navigate_through_poses",
    "NavigateToPose": "navigate_to_pose",
    "SmoothPath": "smooth_path",
    "Spin": "spin",
    "UndockRobot": "undock_robot",
    "Wait": "wait",
}
_RATES: Final = dict.fromkeys(("max_rate", "max_speed", "min_rate", "min_speed"), "hijkl")
_FRAMES: Final = {"global_frame": "hijkl", "robot_base_frame": "hijkl"}
_TOPIC: Final = {"topic_name": "hij"}

# By node, and for all nodes.
READ_ONCE: Final[Mapping[str, Mapping[str, str]]] = {
    "AreErrorCodesPresent": {"error_codes_to_check": "ijkl"},
    "ArePosesNear": {"global_frame": "jkl"},
    "AssistedTeleop": {"is_recovery": "hi", "time_allowance": "hi"},
    "BackUp": {"backup_dist": "hi", "backup_speed": "hi", "time_allowance": "hi"},
    "ControllerSelector": _TOPIC,
    "DistanceController": {"distance": "hijkl", **_FRAMES},
    "DistanceTraveled": {"distance": "hi", "global_frame": "hi", "robot_base_frame": "hi"},
    "DriveOnHeading": {"dist_to_travel": "hi", "speed": "hi", "time_allowance": "hi"},
    "GetCurrentPose": _FRAMES,
    "GoalCheckerSelector": _TOPIC,
    "GoalReached": {"global_frame": "hi", "robot_base_frame": "hijkl"},
    "IsBatteryCharging": {"battery_topic": "hij"},
    "IsBatteryLow": {"battery_topic": "hi", "is_voltage": "hi", "min_battery": "hi"},
    "IsGoalNearby": _FRAMES,
    "IsPathValid": {"server_timeout": "hi"},
    "PathExpiringTimer": {"seconds": "hi"},
    "PauseResumeController": {"pause_service_name": "l", "resume_service_name": "l"},
    "PlannerSelector": _TOPIC,
    "ProgressCheckerSelector": _TOPIC,
    "RateController": {"hz": "hi"},
    "RecoveryNode": {"number_of_retries": "hi"},
    "RemovePassedGoals": {"global_frame": "hi", "radius": "hi", "robot_base_frame": "hi"},
    "RoundRobin": {"wrap_around": "l"},
    "SmootherSelector": _TOPIC,
    "SpeedController": _RATES,
    "Spin": {"is_recovery": "hi", "spin_dist": "hi", "time_allowance": "hi"},
    "TimeExpired": {"seconds": "hi"},
    "TransformAvailable": {"child": "hi", "parent": "hi"},
    "TruncatePath": {"distance": "hi"},
    "Wait": {"wait_duration": "hi"},
}
# The entries that bt_navigator sets before it creates the tree: all but what is of a goal.
SET_BEFORE: Final = ENTRIES.keys() - {"goal", "goals", "path", "waypoint_statuses"}


def created_with(distribution: str, node: str, ports: Container[str]) -> Iterator[str]:
    """The entries that a node with these ports takes from its blackboard when it is created."""
    if "service_name" in ports:
        return created_by(distribution, "BtServiceNode")
    if "server_name" in ports:
        return created_by(distribution, "BtActionNode" if node in SERVERS else "BtCancelActionNode")
    return (entry for entry, letters in CREATED_WITH.get(node, {}).items() if distribution[0] in letters)


def created_by(distribution: str, base: str) -> Iterator[str]:
    """The entries that the constructor of a class of nodes that call a server takes: one of `cpp_classes.BASES`."""
    yield from ("node", "wait_for_service_timeout")
    if base != "BtCancelActionNode":
        yield "bt_loop_duration"
    if distribution[0] in "hi":  # later ones go on without
        yield "server_timeout"


def is_read_once(distribution: str, node: str, port: str, ports: Container[str]) -> bool:
    """Whether a node with these ports reads an input only when the tree is created."""
    letter = distribution[0]
    if letter in READ_ONCE.get(node, {}).get(port, ""):
        return True
    if port == "service_name":
        return letter in "hij"
    # Nodes of actions read it once; nodes of services, from Kilted on, each time that they start.
    is_of_service = letter in "hij" and "service_name" in ports
    return port == "server_name" or (port == "server_timeout" and ("server_name" in ports or is_of_service))
