"""Which leaves are to run on: those whose ancestors do something else while they run than wait for them."""

from __future__ import annotations

from typing import Final

from btq_lang.simulator.nodes import SimulatedNode


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
        is_seen = is_seen or node.id not in _WAITING
        stack += [(child, is_seen) for child in node.children]
    return frozenset(numbers)


_WAITING: Final = frozenset(
    (
        *("Sequence", "Fallback", "AsyncSequence", "AsyncFallback", "SequenceWithMemory", "SequenceStar"),
        *("IfThenElse", "TryCatch", "Inverter", "ForceSuccess", "ForceFailure", "Repeat", "RetryUntilSuccessful"),
        *("RunOnce", "SubTree", "SubTreePlus", "KeepRunningUntilFailure", "Delay", "Precondition"),
        *("RecoveryNode", "RoundRobin", "PersistentSequence", "SingleTrigger"),
    )
)
