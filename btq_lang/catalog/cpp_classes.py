"""The base classes of BehaviorTree.CPP and of the libraries around it, with the category of what derives from them
and the ports that they provide.

One invariant: a class is here only if its category is the same in all versions.  Source of the ports of Nav2's classes:
`providedBasicPorts` in nav2_behavior_tree/include/nav2_behavior_tree/bt_*_node.hpp of each branch, against which
`tests/cpp/test_nav2_sources.py` holds them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Category, Direction


class BasePort(Record):
    """A port that a base class provides; since: the first distribution that has it.

    None of them has a default or needs a value: names may come from the constructor, and the timeout from bt_navigator.
    """

    direction: Direction
    name: str
    type: str
    text: str = ""
    since: str = DISTRIBUTIONS[0]

    def is_in(self, distribution: str) -> bool:
        """Whether a distribution has it."""
        return DISTRIBUTIONS.index(self.since) <= DISTRIBUTIONS.index(distribution)


_ENGINE: Final[dict[Category, str]] = {
    "Action": "ActionNodeBase SyncActionNode AsyncActionNode ThreadedAction StatefulActionNode CoroActionNode "
    "SimpleActionNode ActionNode",
    "Condition": "ConditionNode SimpleConditionNode",
    "Control": "ControlNode SequenceNode SequenceWithMemory SequenceStarNode ReactiveSequence FallbackNode "
    "ReactiveFallback IfThenElseNode WhileDoElseNode ParallelNode ParallelAllNode SwitchNode ManualSelectorNode",
    "Decorator": "DecoratorNode SimpleDecoratorNode InverterNode ForceSuccessNode ForceFailureNode "
    "KeepRunningUntilFailureNode RepeatNode RetryNode TimeoutNode DelayNode RunOnceNode LoopNode",
}
# The engine's own; `TAGS` has those that are nodes with ports.
ENGINE: Final[dict[str, Category]] = {name: category for category, names in _ENGINE.items() for name in names.split()}
TAGS: Final = {
    "ParallelNode": "Parallel",
    "ParallelAllNode": "ParallelAll",
    "RepeatNode": "Repeat",
    "RetryNode": "RetryUntilSuccessful",
    "TimeoutNode": "Timeout",
    "DelayNode": "Delay",
    "RunOnceNode": "RunOnce",
    "LoopNode": "LoopString",
}
# Classes whose tag has the number that is their argument.
NUMBERED_TAGS: Final = {"SwitchNode": "Switch{}"}
# Of behaviortree_ros2, each with the port that it adds; versions differ in the default, and none needs a value.
ROS_PORTS: Final = {
    "RosActionNode": ("action_name", "Action server name"),
    "RosServiceNode": ("service_name", "Service name"),
    "RosTopicPubNode": ("topic_name", "Topic name"),
    "RosTopicSubNode": ("topic_name", "Topic name"),
}
# Of behaviortree_ros2 and nav2_behavior_tree; `BASES` has the ports of the latter.
LIBRARIES: Final[dict[str, Category]] = {
    **dict.fromkeys(
        ("RosActionNode", "RosServiceNode", "BtActionNode", "BtCancelActionNode", "BtServiceNode"), "Action"
    ),
    **dict.fromkeys(("RosTopicPubNode", "RosTopicSubNode"), "Condition"),
}
# Classes whose actions start only after a reset: they tick what has ended without starting it.
STARTING_AFTER_RESET: Final = frozenset(
    (*("StatefulActionNode", "ThreadedAction", "AsyncActionNode"), *("RosActionNode", "RosServiceNode", "BtActionNode"))
)
# By class of nav2_behavior_tree.
_NAME: Final = BasePort("input", "server_name", "std::string", "Action server name")
_TIMEOUT: Final = BasePort("input", "server_timeout", "std::chrono::milliseconds")
BASES: Final = {
    "BtActionNode": (
        _NAME,
        _TIMEOUT,
        BasePort("output", "error_code_id", "uint16_t", "The action error code", "lyrical"),
        BasePort("output", "error_msg", "std::string", "The action error message", "lyrical"),
    ),
    "BtCancelActionNode": (_NAME, _TIMEOUT),
    "BtServiceNode": (
        BasePort("input", "service_name", "std::string", "please_set_service_name_in_BT_Node"),
        _TIMEOUT,
    ),
}
NAMESPACE: Final = "nav2_behavior_tree"
