"""The entries without which Nav2's nodes cannot be created, and the action servers that they call.

One invariant: it holds what the constructors in the C++ code of each branch do; distributions are named by their first
letters, `hijkl`.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from typing import Final

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


def created_with(distribution: str, node: str, ports: Container[str]) -> Iterator[str]:
    """The entries that a node with these ports takes from its blackboard when it is created."""
    letter = distribution[0]
    calls_action, calls_service = ("server_name" in ports, "service_name" in ports)
    if not calls_action and not calls_service:
        yield from (entry for entry, of in CREATED_WITH.get(node, {}).items() if letter in of)
        return
    yield from ("node", "wait_for_service_timeout")
    if calls_service or node in SERVERS:  # and does not cancel
        yield "bt_loop_duration"
    if letter in "hi":  # later ones go on without
        yield "server_timeout"
