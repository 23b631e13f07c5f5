"""How long Nav2's control nodes and decorators take, given how long their children take.

What holds for every rule: `composition`.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from btq_lang.requirements.budget_parts import (
    UNKNOWN,
    Budget,
    combined,
    end_after,
    in_order,
    likelihood,
    port_count,
    port_of,
    without_limit,
)
from btq_lang.requirements.durations import ZERO, from_zero, hull, plus, times, total
from btq_lang.syntax.tokens import BRACED
from btq_lang.util.record import replace
from btq_lang.workspace.node_names import wraps
from btq_lang.workspace.resolved import ResolvedNode


def pipeline(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """An earlier child is ticked again while a later one runs, and may then fail, or be skipped with all others."""
    go, end, skip = in_order([(each.success, each.failure, each.skip) for each in children])
    longest = total(child.running for child in children)
    if any(child.waits for child in children[1:]):
        end = hull(end, longest) if end is not None else None
        skip = hull(skip, longest) if skip is not None else None
    return combined(children, go, end, skip)


def together(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """A child that has ended starts again as long as another one runs."""
    if sum(child.waits for child in children) > 1:
        return replace(without_limit(children), skip=None)
    success = total(child.success for child in children)
    fails = any(child.failure is not None for child in children)
    return combined(children, success, total(child.running for child in children) if fails else None, None)


def resume(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """It may begin with any child, and end before the first one.  With a number instead of an entry it begins there at
    every tick."""
    word, _ = port_of(node, "index")
    if word is not None and word.kind != BRACED:
        return UNKNOWN
    go, end, _ = in_order([(each.success, each.failure, each.skip) for each in children])
    return combined(children, hull(from_zero(go), ZERO), from_zero(end), None)


def recover(node: ResolvedNode, children: Sequence[Budget]) -> Budget | None:
    """The second child's success begins the first one again, its failure or skip is the failure of the node; after a
    skip the next activation has fewer tries left."""
    if len(children) != 2:
        return None
    first, second = children
    count = port_count(node, "retries")
    if count is not None and count < 0:
        count = None  # before Jazzy without limit, from then on one
    cycle, gives_up = plus(first.failure, second.success), plus(first.failure, hull(second.failure, second.skip))
    most = inf if count is None else count
    last = first.failure
    if count is not None and second.skip is None:
        last = plus(times(count, cycle), first.failure) if count == 0 or cycle is not None else None
    elif cycle is not None:
        last = end_after(cycle, first.failure, most)
    budget = combined(
        children,
        end_after(cycle, first.success, most),
        hull(last, end_after(cycle, gives_up, most - 1) if most > 0 else None),
        end_after(cycle, first.skip, most),
    )
    likely = likelihood([child.probability for child in children], None if count is None else count + 1)
    return replace(budget, probability=likely, endless=budget.endless or (count is None and cycle is not None))


def rotate(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """It may begin with any child; one that was skipped it ticks again, if its first follows its last."""
    goes_round = node.behavior is not None and wraps(node.behavior, node.node) is not False
    if goes_round and any(child.skip is not None and child.skip.high > 0.0 for child in children):
        return replace(UNKNOWN, waits=any(child.waits for child in children))
    longest = total(child.running for child in children)
    succeeds = [child.success for child in children if child.success is not None]
    return combined(
        children,
        replace(longest, low=min(each.low for each in succeeds)) if succeeds and longest is not None else None,
        longest,
        longest if all(child.skip is not None for child in children) else None,
    )
