"""The inputs that nodes of Nav2 read only when the tree is created: an entry that is written later has no effect.

One invariant: it holds what the C++ code of each branch does; distributions are named by their first letters, `hijkl`.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Final

from btq_lang.catalog.nav2.navigator import ENTRIES

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
