"""Which nodes are the reason that a tree cannot succeed, or cannot fail, although nodes in it can.

One invariant: a reason has run, and in no state that was seen with the result that it is the reason for.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Final, TypeAlias

from btq_lang.simulator import decorators
from btq_lang.simulator.nodes import FAILURE, SUCCESS, SimulatedNode

Reason: TypeAlias = tuple[SimulatedNode, int]  # a node, and the result that it never has


def reasons(node: SimulatedNode, result: int, seen: Collection[tuple[int, int]]) -> Sequence[Reason]:
    """The topmost nodes that make it impossible that a node has a result; none if no leaf can have it.

    Args:
        result: SUCCESS or FAILURE; the node never has it.
        seen: the numbers of all nodes that have run, each with the statuses that it had.
    """
    ran = {uid for uid, _ in seen}

    def below(node: SimulatedNode, result: int) -> list[Reason]:
        wanted = _OPPOSITE[result] if node.rules.flow is decorators.tick_inverter else result
        children = [child for child in node.children if child.uid in ran]
        unable = [child for child in children if (child.uid, wanted) not in seen]
        causes = [cause for child in unable for cause in below(child, wanted)]
        if causes or len(unable) == len(children):
            return causes
        return [(child, wanted) for child in unable] or [(node, result)]

    return below(node, result)


_OPPOSITE: Final = {SUCCESS: FAILURE, FAILURE: SUCCESS}
