"""Which leaves are to run on: those whose ancestors do something else while they run than wait for them."""

from __future__ import annotations

from typing import Final

from btq_lang.simulator import controls, decorators, nav2, timers
from btq_lang.simulator.nodes import Flow, SimulatedNode


def may_run(root: SimulatedNode, conditions: frozenset[str], asked: frozenset[int] = frozenset()) -> frozenset[int]:
    """The numbers of the leaves of a program that matter while they run.

    Args:
        conditions: the names of leaves that never run.
        asked: the numbers of nodes below which all leaves matter.
    """
    numbers: set[int] = set()
    stack = [(root, False)]
    while stack:
        node, is_seen = stack.pop()
        is_seen = is_seen or node.uid in asked or any(name == "_while" for name, _ in node.conditions)
        if not node.children:
            if is_seen and node.id not in conditions:
                numbers.add(node.uid)
            continue
        is_seen = is_seen or node.rules.flow not in _WAITING
        stack += [(child, is_seen) for child in node.children]
    return frozenset(numbers)


_WAITING: Final[tuple[Flow, ...]] = (
    controls.tick_sequence,
    controls.tick_fallback,
    controls.tick_sequence_with_memory,
    controls.tick_if_then_else,
    controls.tick_try_catch,
    decorators.tick_inverter,
    decorators.tick_force_success,
    decorators.tick_force_failure,
    decorators.tick_repeat,
    decorators.tick_retry,
    decorators.tick_run_once,
    decorators.tick_precondition,
    decorators.tick_keep_running_until_failure,
    decorators.tick_subtree,
    timers.tick_delay,
    nav2.tick_recovery,
    nav2.tick_round_robin,
    nav2.tick_persistent,
    nav2.tick_single_trigger,
)
