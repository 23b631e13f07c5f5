"""Which function is which node's."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.simulator import controls, decorators, leaves, timers
from btq_lang.simulator.errors import NotModelled
from btq_lang.simulator.nodes import Flow, Halt, TickRules
from btq_lang.simulator.ticking import halt_children


def rules_of(id_: str, has_children: bool, stateful: Collection[str]) -> TickRules:
    """The rules of a registered name.

    Args:
        has_children: whether the written node has some.
        stateful: the stateful actions of the program.

    Raises:
        NotModelled: it has children, and the engine does not have it.
    """
    rules = _RULES.get(id_)
    if rules is not None:
        return rules
    if has_children:
        raise NotModelled(f"what {id_} does with its children is unknown")
    return _STATEFUL if id_ in stateful else _LEAF


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
_RULES: Final = {
    **_TIMED,
    **{
        id_: TickRules(flow, _HALTS.get(id_, halt_children), yields=BUILTINS[id_].pauses)
        for id_, flow in _CONTROLS.items()
    },
    **{
        id_: TickRules(flow, _HALTS.get(id_, halt_children), is_decorator=True, counts_writes=id_ in _COUNTING)
        for id_, flow in _DECORATORS.items()
    },
    **{id_: TickRules(flow, leaves.halt_leaf, counts_writes=id_ in _COUNTING) for id_, flow in _LEAVES.items()},
}
