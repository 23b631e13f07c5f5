"""What differs between versions of the engine, and which function is which node's.

Source: facts about BehaviorTree.CPP 4.6 to 4.10, seen in runs of 4.6.2 and 4.10.0, and read in the sources between.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

from btq_lang.catalog.versions import numbers
from btq_lang.simulator import controls, decorators, leaves
from btq_lang.simulator.errors import NotModelled
from btq_lang.simulator.nodes import SimulatedNode
from btq_lang.simulator.ticking import Machine, halt_children

Flow: TypeAlias = Callable[[Machine, SimulatedNode], int]
Halt: TypeAlias = Callable[[Machine, SimulatedNode], None]


class Dialect:
    """A version of the engine.

    Attributes:
        counts_skips: a Sequence whose child ran and was then skipped counts that as a skip (since 4.7).
        reads_attempts_again: Retry reads its port again after each failure (since 4.7).
        keeps_precondition: a Precondition asks no more once its child has begun (since 4.7).
        copies_queues: a loop over a literal begins anew at each start (since 4.7).
        counts_copies: SetBlackboard counts the copy of an entry as a write (since 4.7).
        names_thrower: messages of exceptions name the node (since 4.9).
        has_real_truth: `true` in a script is a real number (since 4.9).
        halts_updated_child: SkipUnlessUpdated and WaitValueUpdate halt their child (since 4.9).
        types_constants: a number given to a port of a SubTree is one there (since 4.9.1), rather than a text.
        matches_prefixes: a case of a Switch matches a variable that begins with its number (up to 4.9).
    """

    def __init__(self, version: str, stateful: frozenset[str] = frozenset()) -> None:
        """A version, such as `4.6`, and which nodes of the program are stateful actions."""
        key = numbers(version)
        self.version: Final = version
        since_4_7 = key >= (4, 7)
        since_4_9 = key >= (4, 9)
        self.counts_skips: Final = since_4_7
        self.reads_attempts_again: Final = since_4_7
        self.keeps_precondition: Final = since_4_7
        self.copies_queues: Final = since_4_7
        self.counts_copies: Final = since_4_7
        self.names_thrower: Final = since_4_9
        self.has_real_truth: Final = since_4_9
        self.halts_updated_child: Final = since_4_9
        self.types_constants: Final = key >= (4, 9, 1) or key == (4, 9)
        self.matches_prefixes: Final = key < (4, 10)
        self._stateful: Final = stateful

    def flow(self, node: SimulatedNode) -> Flow:
        """What a tick of a node does."""
        function = FLOWS.get(node.id)
        if function is None:
            if node.children:
                raise NotModelled(f"the node {node.id} of {node.path} is no node of the engine")
            return leaves.tick_custom
        return function

    def halt(self, node: SimulatedNode) -> Halt:
        """What a halt of a node does."""
        return _HALTS.get(node.id, halt_children if node.children else leaves.halt_leaf)

    def is_stateful(self, node: SimulatedNode) -> bool:
        """Whether a node of the program is a stateful action."""
        return node.id in self._stateful

    def is_decorator(self, node: SimulatedNode) -> bool:
        """Whether a node has one child by its kind."""
        return node.id in DECORATORS


DECORATORS: Final[dict[str, Flow]] = {
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
FLOWS: Final[dict[str, Flow]] = {
    **DECORATORS,
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
    **{f"Switch{cases}": controls.halt_switch for cases in range(2, 7)},
    "TryCatch": controls.halt_try_catch,
    **dict.fromkeys(("Repeat", "RetryUntilSuccessful"), decorators.halt_counting),
    **dict.fromkeys(("SkipUnlessUpdated", "WaitValueUpdate"), decorators.halt_updated),
}
