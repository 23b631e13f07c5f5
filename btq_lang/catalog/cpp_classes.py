"""The base classes of BehaviorTree.CPP and of the libraries around it, with the category of what derives from them.

One invariant: a class is here only if its category is the same in all versions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Category

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
# Of behaviortree_ros2 and nav2_behavior_tree; the ports of the latter are in nav2/bases.py.
LIBRARIES: Final[dict[str, Category]] = {
    **dict.fromkeys(
        ("RosActionNode", "RosServiceNode", "BtActionNode", "BtCancelActionNode", "BtServiceNode"), "Action"
    ),
    **dict.fromkeys(("RosTopicPubNode", "RosTopicSubNode"), "Condition"),
}
