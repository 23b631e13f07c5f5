"""The behavior of Nav2's nodes: its control nodes, its decorators, and the leaves that differ from others.

One invariant: every row was read in the C++ code of the branches; where they differ there is a row for the older ones.
Actions without a row run on a server; conditions without a row answer within the tick.  Which ports a node has is in
the files beside this one, and what an action is for: here are only the ports that determine what a node returns.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.kinds import NodeKind, PortKind, action, control, decorator

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Category, Flow

_CONTROL: Final = (
    control(
        "PipelineSequence",
        "A sequence that ticks the earlier children again while a later one runs.",
        "It begins with its first child at every tick. A child that succeeds is ticked again at the next tick, and one "
        "that then returns RUNNING does not keep the later ones from being ticked. FAILURE of any child halts all and "
        "is its result; SUCCESS of the last one too.",
        flow="pipeline",
        one_tick="next",
    ),
    control(
        "RecoveryNode",
        "Ticks the second child when the first one fails, then the first one again.",
        "SUCCESS as soon as the first child succeeds. When it fails, the second child is ticked, and after its success "
        "the first one again, number_of_retries times at most. If the second child fails or is skipped, so does the "
        "node at once. Another number of children throws at the first tick.",
        children=(2, 2),
        ports=(
            PortKind(
                "number_of_retries",
                "input",
                "int",
                "how often the second child may be ticked",
                "1",
                role="retries",
                literal="unsigned int",
            ),
        ),
        flow="recover",
        one_tick="both",
        late_count=True,
    ),
    control(
        "NonblockingSequence",
        "Ticks all children each time, until all succeed in one tick.",
        "Children that have ended are ticked again. FAILURE of any child halts all and is its result; SUCCESS if all "
        "children succeed in one tick. A skipped child throws.",
        flow="together",
        one_tick="next",
    ),
    control(
        "PersistentSequence",
        "A sequence that keeps its index in an entry.",
        "It begins with the child whose index current_child_idx has, and counts on in that entry; a halt does not "
        "change it. After a failure and at its end the entry is 0. Without the entry it throws.",
        ports=(
            PortKind(
                "current_child_idx",
                "inout",
                "int",
                "the entry that keeps the index of the child",
                required=True,
                role="index",
            ),
        ),
        flow="resume",
        one_tick="both",
    ),
    control(
        "PauseResumeController",
        "Pauses and resumes its first child when services are called.",
        "The children are what runs, what runs while it is paused, and what to do on pausing and on resuming. Only "
        "SUCCESS of the first child is its success; FAILURE of any child is its failure. Another number of children "
        "throws at the first tick.",
        children=(1, 4),
        execution="asynchronous",
        flow="pause",
        one_tick="first",
        late_count=True,
    ),
)
_TURNS: Final = (
    "It ticks one child until that ends. After a success the next activation begins with the next child; after a "
    "failure the next child is ticked at once. It fails when all children have failed in a row, and then begins with "
    "the first one again. "
)
_ROUND_ROBIN: Final = control(
    "RoundRobin",
    "Ticks its children in turn.",
    f"{_TURNS}In Lyrical, without wrap_around it also fails when its last child has ended, even if that has succeeded; "
    "before, the first child follows the last one.",
    ports=(
        PortKind("wrap_around", "input", "bool", "whether the first child follows the last one", "false", role="wraps"),
    ),
    flow="rotate",
    one_tick="both",
)
_OLDER_ROUND_ROBIN: Final = control(
    "RoundRobin",
    "Ticks its children in turn.",
    f"{_TURNS}After the last child follows the first one.",
    flow="rotate",
    one_tick="both",
)


def _throttle(tag: str, doc: str, again: str, besides: str = "", flow: Flow = "throttle") -> NodeKind:
    semantics = (
        f"It ticks its child when it starts, as long as that runs, and {again}; otherwise it returns RUNNING. "
        f"{besides}When its parent resets it after a success it starts again, and holds nothing back."
    )
    # No `one_tick`: when it starts without a reset it waits, and no row says which.
    return decorator(tag, doc, semantics, flow=flow, memory="success")


_DECORATORS: Final = (
    _throttle("RateController", "Ticks its child at a rate.", "when 1/hz seconds have passed since its last success"),
    _throttle(
        "DistanceController",
        "Ticks its child each time the robot has moved some distance.",
        "when the robot has moved the distance since its last success",
        "It fails if it is not known where the robot is. ",
        "throttle-or-fail",
    ),
    _throttle(
        "SpeedController",
        "Ticks its child the more often the faster the robot is.",
        "when a period has passed that is the shorter the faster the robot is, and when the goal has changed",
    ),
    _throttle("GoalUpdatedController", "Ticks its child each time the goal changes.", "when the goal has changed"),
    decorator(
        "GoalUpdater",
        "Replaces the goal of its child by one that a topic gives.",
        "It writes the goal at every tick, ticks its child and returns what that returns.",
        flow="pass",
        one_tick="next",
    ),
    decorator(
        "PathLongerOnApproach",
        "Ticks its child if the path became much longer close to the goal.",
        "Otherwise it succeeds, also while its child runs, which is then neither ticked nor halted.",
        flow="pass-or-succeed",
        one_tick="first",
    ),
    decorator(
        "SingleTrigger",
        "Ticks its child until it ends, once.",
        "Afterwards it fails, until its parent resets it. Most parents do so when it has ended: then it does nothing.",
        flow="pass-once",
        one_tick="first",
        memory="success",
    ),
)


def _notices(tag: str, doc: str, condition: str) -> NodeKind:
    semantics = (
        f"At its first tick it fails and remembers {condition}; it succeeds at a later one. A parent that resets it "
        "when it has failed makes it start again, so that it never succeeds: only WhileDoElse keeps its condition."
    )
    return NodeKind(tag, doc, semantics, "Condition", (0, 0), execution="synchronous", flow="notices", memory="failure")


def _waits(tag: str, category: Category, doc: str) -> NodeKind:
    semantics = "It fails while the robot moves, and returns RUNNING until it has been still for duration_stopped."
    return NodeKind(tag, doc, semantics, category, (0, 0), execution="asynchronous", flow="waits")


_LEAVES: Final = (
    _notices("GoalUpdated", "SUCCESS if the goal has changed since this node became active.", "the goal"),
    _notices("TimeExpired", "SUCCESS each time some time has passed.", "the time"),
    _notices("DistanceTraveled", "SUCCESS each time the robot has moved some distance.", "where the robot is"),
    _waits("IsStopped", "Condition", "SUCCESS if the robot has not moved for some time."),
    _waits("CheckStopStatus", "Action", "SUCCESS once the robot has been still for some time, FAILURE while it moves."),
)
_WITHIN_A_TICK: Final = (
    *("AppendGoalPoseToGoals", "ConcatenatePaths", "ControllerSelector", "ExtractRouteNodesAsGoals", "GetCurrentPose"),
    *("GetNextFewGoals", "GetPoseFromPath", "GoalCheckerSelector", "PathHandlerSelector", "PlannerSelector"),
    *("ProgressCheckerSelector", "RemovePassedGoals", "SmootherSelector", "TruncatePath", "TruncatePathLocal"),
)
_SYNCHRONOUS: Final = tuple(
    action(tag, "", "It ends within the tick.", execution="synchronous", flow="answers") for tag in _WITHIN_A_TICK
)

# The decorators that read goals, the path, the robot or a topic, so that scenarios may say what they find.
ASKING: Final = frozenset(
    ("DistanceController", "GoalUpdatedController", "GoalUpdater", "PathLongerOnApproach", "SpeedController")
)
NODES: Final[Mapping[str, NodeKind]] = {
    kind.tag: kind for kind in (*_CONTROL, _ROUND_ROBIN, *_DECORATORS, *_LEAVES, *_SYNCHRONOUS)
}


@cache
def nodes_of(distribution: str) -> Mapping[str, NodeKind]:
    """The nodes by name; also those that the distribution does not have."""
    return NODES if distribution == "lyrical" else {**NODES, _OLDER_ROUND_ROBIN.tag: _OLDER_ROUND_ROBIN}
