"""bt_navigator by distribution of ROS 2: the entries that it sets before the first tick, and its parameters.

One invariant: it holds what the C++ code of each branch does; distributions are named by their first letters, `hijkl`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, TypeAlias

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


def outside_entries(
    distribution: str, codes: tuple[str, ...] | None = None, renamed: Mapping[str, str] | None = None
) -> tuple[OutsideEntry, ...]:
    """The entries of the root blackboard that bt_navigator sets (`output`), reads (`input`), or both.

    Args:
        codes: the names or prefixes of error codes; None for those that it collects if none are named.
        renamed: other names of entries.
    """
    letter = distribution[0]
    codes = ERROR_CODES[letter] if codes is None else codes
    found: dict[str, Direction] = {}
    for name, of in ENTRIES.items():
        if letter in of:
            found[name] = "inout" if name in READ else "output"
        elif name in READ:
            found[name] = "input"
    found = {(renamed or {}).get(name, name): direction for name, direction in found.items()}
    if letter in "kl":
        codes = tuple(f"{prefix}_error_{part}" for prefix in codes for part in ("code", "msg"))
    return (*found.items(), *((code, "inout") for code in codes))
