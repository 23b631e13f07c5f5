"""The functions of each kind of node."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.simulator import controls, decorators, leaves, nav2, nav2_conditions, timers, version3
from btq_lang.simulator.errors import NotModelled
from btq_lang.simulator.nodes import Flow, Halt, TickRules
from btq_lang.simulator.ticking import halt_children
from btq_lang.util.record import replace


def rules_of(
    id_: str, has_children: bool, stateful: Collection[str], nav2: Collection[str] = (), is_old: bool = False
) -> TickRules:
    """The rules of a registered name.

    Args:
        nav2: the nodes of Nav2 that the program registers.
        is_old: the engine is version 3.
        has_children: whether the written node has some.
        stateful: the stateful actions of the program.

    Raises:
        NotModelled: it has children, and the engine does not have it.
    """
    rules = _NAV2.get(id_) if id_ in nav2 else (_OLD_RULES if is_old else _RULES).get(id_)
    if rules is not None:
        return rules
    if has_children:
        raise NotModelled(f"what {id_} does with its children is unknown")
    return _STATEFUL if id_ in stateful else _LEAF


def is_of_nav2(id_: str) -> bool:
    """Whether a registered name is that of a node of Nav2 that is modelled here."""
    return id_ in _NAV2


_LEAF: Final = TickRules(leaves.tick_custom, leaves.halt_leaf)
_STATEFUL: Final = TickRules(leaves.tick_custom, leaves.halt_leaf, is_stateful=True)
_DECORATORS: Final[dict[str, Flow]] = {
    "Inverter": decorators.tick_inverter,
    "ForceSuccess": decorators.tick_force_success,
    "ForceFailure": decorators.tick_force_failure,
    "KeepRunningUntilFailure": decorators.tick_keep_running_until_failure,
    "Repeat": decorators.tick_repeat,
    "RetryUntilSuccessful": decorators.tick_retry,
    "RunOnce": decorators.tick_run_once,
    "Precondition": decorators.tick_precondition,
    "SkipUnlessUpdated": decorators.tick_skip_unless_updated,
    "WaitValueUpdate": decorators.tick_wait_value_update,
    "SubTree": decorators.tick_subtree,
    **dict.fromkeys(("LoopInt", "LoopDouble", "LoopBool", "LoopString"), decorators.tick_loop),
}
_CONTROLS: Final[dict[str, Flow]] = {
    "Sequence": controls.tick_sequence,
    "AsyncSequence": controls.tick_sequence,
    "Fallback": controls.tick_fallback,
    "AsyncFallback": controls.tick_fallback,
    "SequenceWithMemory": controls.tick_sequence_with_memory,
    "ReactiveSequence": controls.tick_reactive_sequence,
    "ReactiveFallback": controls.tick_reactive_fallback,
    "Parallel": controls.tick_parallel,
    "ParallelAll": controls.tick_parallel_all,
    "IfThenElse": controls.tick_if_then_else,
    "WhileDoElse": controls.tick_while_do_else,
    **{f"Switch{cases}": controls.tick_switch for cases in range(2, 7)},
    "TryCatch": controls.tick_try_catch,
}
_LEAVES: Final[dict[str, Flow]] = {
    "AlwaysSuccess": leaves.tick_always_success,
    "AlwaysFailure": leaves.tick_always_failure,
    "Script": leaves.tick_script,
    "ScriptCondition": leaves.tick_script_condition,
    "SetBlackboard": leaves.tick_set_blackboard,
    "UnsetBlackboard": leaves.tick_unset_blackboard,
    "WasEntryUpdated": leaves.tick_was_entry_updated,
}
_HALTS: Final[dict[str, Halt]] = {
    **dict.fromkeys(("Sequence", "AsyncSequence", "Fallback", "AsyncFallback", "IfThenElse"), controls.halt_in_order),
    **dict.fromkeys(("Parallel", "ParallelAll"), controls.halt_parallel),
    **{f"Switch{cases}": controls.halt_in_order for cases in range(2, 7)},
    "TryCatch": controls.halt_try_catch,
    **dict.fromkeys(("Repeat", "RetryUntilSuccessful"), decorators.halt_counting),
    **dict.fromkeys(("SkipUnlessUpdated", "WaitValueUpdate"), decorators.halt_updated),
}
_TIMED: Final[dict[str, TickRules]] = {
    "Timeout": TickRules(timers.tick_timeout, timers.halt_timed, is_decorator=True, is_timed=True),
    "Delay": TickRules(timers.tick_delay, timers.halt_timed, is_decorator=True, is_timed=True),
    "Sleep": TickRules(timers.tick_sleep, timers.halt_sleep, is_timed=True),
}
_COUNTING: Final = ("SkipUnlessUpdated", "WaitValueUpdate", "WasEntryUpdated")
_REPEATING: Final = ("Repeat", "RetryUntilSuccessful")
_RULES: Final = {
    **_TIMED,
    **{
        id_: TickRules(flow, _HALTS.get(id_, halt_children), yields=BUILTINS[id_].pauses)
        for id_, flow in _CONTROLS.items()
    },
    **{
        id_: TickRules(
            flow,
            _HALTS.get(id_, halt_children),
            is_decorator=True,
            counts_writes=id_ in _COUNTING,
            yields=id_ in _REPEATING,
        )
        for id_, flow in _DECORATORS.items()
    },
    **{id_: TickRules(flow, leaves.halt_leaf, counts_writes=id_ in _COUNTING) for id_, flow in _LEAVES.items()},
}
_OLD_RULES: Final = {
    **{
        id_: _RULES[id_]
        for id_ in (
            *("Sequence", "Fallback", "ReactiveSequence", "ReactiveFallback", "IfThenElse", "WhileDoElse", "SubTree"),
            *("Inverter", "ForceSuccess", "ForceFailure", "KeepRunningUntilFailure"),
            *("AlwaysSuccess", "AlwaysFailure", "SetBlackboard"),
            *(f"Switch{cases}" for cases in range(2, 7)),
        )
    },
    "SubTreePlus": _RULES["SubTree"],
    "SequenceStar": TickRules(controls.tick_sequence_with_memory, controls.halt_in_order),
    "Parallel": TickRules(version3.tick_parallel, controls.halt_parallel),
    **{id_: replace(_RULES[id_], yields=False) for id_ in _REPEATING},
    **{
        f"BlackboardCheck{type_}": TickRules(version3.tick_blackboard_check, halt_children, is_decorator=True)
        for type_ in ("Int", "Double", "String", "Bool")
    },
}
_NAV2: Final = {
    "PipelineSequence": TickRules(nav2.tick_pipeline, controls.halt_in_order),
    "RecoveryNode": TickRules(nav2.tick_recovery, nav2.halt_turns),
    "RoundRobin": TickRules(nav2.tick_round_robin, nav2.halt_turns),
    "NonblockingSequence": TickRules(nav2.tick_nonblocking, halt_children),
    "PersistentSequence": TickRules(nav2.tick_persistent, halt_children),
    "PauseResumeController": TickRules(nav2.tick_pause_resume, controls.halt_in_order),
    "RateController": TickRules(nav2.tick_rate_controller, halt_children, is_decorator=True, watches_time=True),
    "SpeedController": TickRules(nav2.tick_speed_controller, halt_children, is_decorator=True, watches_time=True),
    **{
        id_: TickRules(flow, halt_children, is_decorator=True)
        for id_, flow in (
            ("DistanceController", nav2.tick_distance_controller),
            ("GoalUpdatedController", nav2.tick_goal_updated_controller),
            ("GoalUpdater", nav2.tick_goal_updater),
            ("PathLongerOnApproach", nav2.tick_path_longer),
            ("SingleTrigger", nav2.tick_single_trigger),
        )
    },
    "TimeExpired": TickRules(nav2_conditions.tick_time_expired, leaves.halt_leaf, watches_time=True),
    "PathExpiringTimer": TickRules(nav2_conditions.tick_path_expiring_timer, leaves.halt_leaf, watches_time=True),
    **{
        id_: TickRules(flow, leaves.halt_leaf)
        for id_, flow in (
            ("GoalUpdated", nav2_conditions.tick_goal_updated),
            ("GlobalUpdatedGoal", nav2_conditions.tick_global_updated_goal),
            ("DistanceTraveled", nav2_conditions.tick_distance_traveled),
            ("InitialPoseReceived", nav2_conditions.tick_initial_pose_received),
            ("AreErrorCodesPresent", nav2_conditions.tick_error_codes),
        )
    },
}
