"""The changes of Nav2's releases for trees that were written for an earlier one: one row a change.

Nodes and ports that a release removes follow from the files of nodes beside this module; the rows here say what
replaces them, and what a tree that still loads means from then on.  Determined in the sources of the branches and, for
the nodes that need no ROS, by running them.
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.versions import ANY, BehaviorChange

# The names after a release that renamed a node, or a port of one.
RENAMED: Final = {("lyrical", "IsPathValid"): "ValidatePath", ("lyrical", "IsStopped"): "CheckStopStatus"}
RENAMED_PORTS: Final = {("lyrical", "TruncatePathLocal", "robot_frame"): "robot_base_frame"}
# What to write instead of a node that a release does not have.
INSTEAD: Final = {("kilted", "ClearCostmapAroundPose"): "ClearCostmapAroundRobot or ClearEntireCostmap"}

_ENTRY: Final = r"\{.+\}"
_FRAME: Final = "has the frame that bt_navigator is configured with, no longer `{}`"
_MOVES: Final = ("AssistedTeleop", "BackUp", "DriveOnHeading", "Spin", "Wait")
_CLEARS: Final = ("ClearEntireCostmap", "ClearCostmapExceptRegion", "ClearCostmapAroundRobot", "ClearCostmapAroundPose")


def _read_again(since: str, nodes: tuple[str, ...], *ports: str) -> tuple[BehaviorChange, ...]:
    effect = "reads the entry in `{}` at each start, no longer only when the tree is created"
    instead = "write the value itself if the entry changes meanwhile and must not count"
    return tuple(BehaviorChange(since, nodes, effect.format(port), instead, port, _ENTRY) for port in ports)


CHANGES: Final = (
    # Iron
    *(
        BehaviorChange(
            "iron",
            ("TransformAvailable",),
            f"without `{port}` is refused when the tree is created; Humble ended the process of bt_navigator",
            "write both frames",
            port,
            None,
            breaks=True,
        )
        for port in ("child", "parent")
    ),
    # Jazzy: BehaviorTree.CPP 4
    BehaviorChange(
        "jazzy",
        ("RecoveryNode",),
        "tries again once with a negative `number_of_retries`, and no longer without end",
        "write a large number",
        "number_of_retries",
        r"-\d+",
    ),
    BehaviorChange(
        "jazzy",
        ("Wait",),
        "waits for parts of seconds too; before, it dropped them",
        "write the time that is meant",
        "wait_duration",
        r"\d*\.\d*[1-9]\d*",
    ),
    *_read_again("jazzy", ("RateController",), "hz"),
    *_read_again("jazzy", ("RecoveryNode",), "number_of_retries"),
    *_read_again("jazzy", ("TimeExpired", "PathExpiringTimer"), "seconds"),
    *_read_again("jazzy", ("DistanceTraveled",), "distance", "global_frame", "robot_base_frame"),
    *_read_again("jazzy", _MOVES, "time_allowance", "is_recovery"),
    *_read_again("jazzy", ("BackUp",), "backup_dist", "backup_speed"),
    *_read_again("jazzy", ("DriveOnHeading",), "dist_to_travel", "speed"),
    *_read_again("jazzy", ("Spin",), "spin_dist"),
    *_read_again("jazzy", ("Wait",), "wait_duration"),
    *_read_again("jazzy", ("TruncatePath",), "distance"),
    *_read_again("jazzy", ("RemovePassedGoals",), "radius"),
    *_read_again("jazzy", ("IsBatteryLow",), "min_battery", "battery_topic", "is_voltage"),
    *_read_again("jazzy", ("TransformAvailable",), "child", "parent"),
    *_read_again("jazzy", ("IsPathValid",), "server_timeout"),
    BehaviorChange(
        "jazzy",
        ("GoalReached", "RemovePassedGoals"),
        "does not use `global_frame` any more: the frame of the goal counts",
        "remove the port",
        "global_frame",
        ".*",
    ),
    BehaviorChange(
        "jazzy",
        ("DistanceController", "DistanceTraveled"),
        f"without `global_frame` {_FRAME.format('map')}",
        port="global_frame",
        value=None,
        keeps="map",
    ),
    BehaviorChange(
        "jazzy",
        ("DistanceController", "DistanceTraveled", "GoalReached", "RemovePassedGoals"),
        f"without `robot_base_frame` {_FRAME.format('base_link')}",
        port="robot_base_frame",
        value=None,
        keeps="base_link",
    ),
    BehaviorChange(
        "jazzy",
        ("AreErrorCodesPresent",),
        "reads the list of codes, from 1.3.6 on; before, it always failed",
        "remove it if what follows its success should not run",
        port="error_codes_to_check",
        value=r"[^{].*",
    ),
    # Kilted
    *_read_again("kilted", ("IsBatteryCharging",), "battery_topic"),
    *_read_again(
        "kilted",
        ("ControllerSelector", "PlannerSelector", "SmootherSelector", "GoalCheckerSelector", "ProgressCheckerSelector"),
        "topic_name",
    ),
    *_read_again("kilted", (ANY,), "service_name"),
    *(
        BehaviorChange(
            "kilted",
            (ANY,),
            f"reads `{port}` in another form: each pose begins with `stamp;frame;`",
            "pass an entry, or write the poses in the new form",
            port,
            r"[^{].*",
            breaks=True,
        )
        for port in ("goals", "input_goals")
    ),
    BehaviorChange(
        "kilted",
        ("RemovePassedGoals",),
        "keeps the status of waypoints only if it gets it: without, they stay pending to the end",
        "pass `{waypoint_statuses}` to `input_waypoint_statuses` and `output_waypoint_statuses`",
        "input_waypoint_statuses",
        None,
    ),
    BehaviorChange(
        "kilted",
        (ANY,),
        "writes its error where nobody collects it: results have only entries that end in `_error_code`",
        "write an entry such as `{follow_path_error_code}`",
        "error_code_id",
        r"\{(?!.*_error_code\}).+\}",
        when="collected",
    ),
    BehaviorChange(
        "kilted",
        ("IsPathValid",),
        "ends the goal with an exception if there is no answer in time; before, it failed",
        "write a `server_timeout` that is long enough",
    ),
    # Lyrical
    BehaviorChange(
        "lyrical",
        ("IsPathValid",),
        "without `max_cost` regards a cost up to 254 as free, no longer up to 253",
        port="max_cost",
        value=None,
        keeps="253",
    ),
    BehaviorChange(
        "lyrical",
        ("RoundRobin",),
        "does not begin again after its last child: it then fails, even if that child has succeeded",
        "",
        "wrap_around",
        None,
        keeps="true",
    ),
    BehaviorChange(
        "lyrical",
        ("TruncatePathLocal",),
        f"without a frame of the robot {_FRAME.format('base_link')}",
        'write `robot_base_frame="base_link"`, or the frame that is meant',
        port="robot_frame",
        value=None,
    ),
    BehaviorChange(
        "lyrical",
        ("TruncatePathLocal",),
        "takes a negative `distance_forward` for no limit",
        "write the distance that is meant",
        port="distance_forward",
        value=r"-.+",
    ),
    BehaviorChange(
        "lyrical",
        _CLEARS,
        "fails if the service answers that it has not succeeded; before, it succeeded",
        "write a ForceSuccess around it to go on all the same",
    ),
    BehaviorChange(
        "lyrical",
        ("FollowPath", "GetPoseFromPath", "IsPathValid", "PathExpiringTimer", "PathLongerOnApproach"),
        "finds an empty path in `{path}` at the start of each goal, no longer that of the last goal",
        "put it after the node that computes the path, or write another entry to keep one",
        port="path",
        value=r"\{path\}",
    ),
)
