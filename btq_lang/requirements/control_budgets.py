"""How long the engine's control nodes take, given how long their children take.

What holds for every rule: `composition`.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from btq_lang.requirements.budget_parts import Budget, combined, in_order, likelihood, opened, port_count, without_limit
from btq_lang.requirements.durations import ZERO, Range, from_zero, hull, plus, total
from btq_lang.util.record import replace
from btq_lang.workspace.resolved import ResolvedNode


def sequence(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    if node.behavior is not None and node.behavior.keeps_place:
        return _with_memory(children)
    go, end, skip = in_order([(each.success, each.failure, each.skip) for each in children])
    budget = combined(children, go, end, skip)
    return _reactive(children, budget, "failure") if node.behavior is not None and node.behavior.reactive else budget


def _with_memory(children: Sequence[Budget]) -> Budget:
    """As a sequence, but after a failure or a halt it resumes at the child that failed: any part of it may be done."""
    go, end, skip = in_order([(each.success, each.failure, each.skip) for each in children])
    last = hull(children[-1].success, children[-1].skip)
    first = min((each.failure.low for each in children if each.failure is not None), default=0.0)
    return combined(
        children,
        replace(go, low=last.low) if go is not None and last is not None else None,
        replace(end, low=first) if end is not None else None,
        from_zero(skip),
    )


def _reactive(children: Sequence[Budget], budget: Budget, ends: str) -> Budget:
    """A child before the running one is ticked at every tick, and may end the whole; each of several that take time may
    be restarted without limit."""
    waiting = [index for index, child in enumerate(children) if child.waits]
    if len(waiting) > 1:
        return replace(opened(budget), probability=likelihood([budget.probability], None), endless=True)
    before = children[: waiting[0]] if waiting else ()
    if any(getattr(child, ends) is not None for child in before):
        running = children[waiting[0]].running
        return replace(budget, **{ends: hull(getattr(budget, ends), running)})
    return budget


def parallel(node: ResolvedNode, children: Sequence[Budget]) -> Budget | None:
    """Counts successes and failures, and is done when either is enough."""
    n = len(children)
    wanted, failures = port_count(node, "successes"), port_count(node, "failures")
    everything = [child.running for child in children]
    wanted = n + wanted + 1 if wanted is not None and wanted < 0 else wanted
    failures = n + failures + 1 if failures is not None and failures < 0 else failures
    asks_again = port_count(node, "successes") not in range(-n, 0)
    if (with_skips := _with_skips(node, children, asks_again)) is not None:
        return with_skips
    if wanted is None or failures is None:
        longest = _slowest(everything)
        return combined(children, longest, longest, longest)
    if not 0 < wanted <= n or not 0 < failures <= n:
        return None
    enough = min(failures, n - wanted + 1)
    highs = sorted(everything, key=lambda each: each.high)
    last = highs[wanted + enough - 2]
    succeeds = _nth(children, "success", wanted)
    fails = _nth(children, "failure", enough)
    return combined(
        children,
        replace(last, low=succeeds) if succeeds < inf else None,
        replace(last, low=fails) if fails < inf else None,
        None,
    )


def _with_skips(node: ResolvedNode, children: Sequence[Budget], asks_again: bool) -> Budget | None:
    """All at once, if some may be skipped; None if none may.  A skipped child is ticked again as long as another runs,
    so they may also run one after the other; two that a skip interrupts may keep each other running.

    Args:
        asks_again: whether a skipped child does not count, so that the others wait for it.
    """
    skips = [child.skip for child in children if child.skip is not None]
    if not skips:
        return None
    if asks_again or any(child.endless for child in children) or sum(skip.high > 0.0 for skip in skips) > 1:
        return without_limit(children)
    longest = total(child.running for child in children)
    return combined(children, longest, longest, longest)


def _nth(children: Sequence[Budget], outcome: str, count: int) -> float:
    """The earliest time at which so many children can have an outcome."""
    ranges = [getattr(child, outcome) for child in children]
    return sorted(each.low if each is not None else inf for each in ranges)[count - 1]


def parallel_all(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """Waits for all of them, then counts the failures."""
    n = len(children)
    most = port_count(node, "failures")
    most = n + most + 1 if most is not None and most < 0 else most
    if (with_skips := _with_skips(node, children, False)) is not None:
        return with_skips
    if any(child.completes is None for child in children):
        return combined(children, None, None, None)
    longest = _slowest([child.completes or ZERO for child in children])
    always = sum(child.success is None for child in children)
    maybe = sum(child.failure is not None for child in children)
    fails = most is None or maybe >= most
    succeeds = most is None or always < most
    return combined(children, longest if succeeds else None, longest if fails else None, None)


def _slowest(ranges: Sequence[Range]) -> Range:
    """All at once: it takes as long as the longest."""
    return replace(max(ranges, key=lambda each: each.high), low=max(each.low for each in ranges))


def choice(node: ResolvedNode, children: Sequence[Budget]) -> Budget | None:
    if len(children) not in (2, 3):
        return None
    budget = _if_then_else(children)
    return _rechecking(children, budget) if node.behavior is not None and node.behavior.reactive else budget


def _if_then_else(children: Sequence[Budget]) -> Budget:
    """Without a third child, IfThenElse does not reset a condition that fails: an action then keeps its failure, and is
    not begun again by the next activation."""
    condition, then = children[0], children[1]
    otherwise = children[2] if len(children) == 3 else Budget(None, ZERO, None, False)
    if len(children) == 2:
        condition = replace(condition, failure=from_zero(condition.failure))
    return replace(
        combined(
            children,
            hull(plus(condition.success, then.success), plus(condition.failure, otherwise.success)),
            hull(plus(condition.success, then.failure), plus(condition.failure, otherwise.failure)),
            hull(plus(condition.success, then.skip), plus(condition.failure, otherwise.skip)),
        ),
        probability=likelihood([condition.probability, min(then.probability, otherwise.probability)]),
    )


def _rechecking(children: Sequence[Budget], budget: Budget) -> Budget:
    """The condition is evaluated at every tick, and its result may change."""
    condition, *branches = children
    changes = condition.success is not None and condition.failure is not None
    if condition.waits or (changes and len(branches) == 2 and all(branch.waits for branch in branches)):
        return without_limit(children)
    if not changes:
        return budget
    running = total(branch.running if branch.waits else ZERO for branch in branches)
    return replace(
        budget,
        success=hull(budget.success, running) if len(branches) == 2 else budget.success,
        failure=hull(budget.failure, running),
        skip=hull(budget.skip, running) if budget.skip is not None else None,
        probability=likelihood([child.probability for child in children]),
    )


def switch(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    cases = children if node.node.attribute("variable") is not None else children[-1:]
    budget = combined(
        children,
        hull(*(child.success for child in cases)),
        hull(*(child.failure for child in cases)),
        hull(*(child.skip for child in cases)),
    )
    return replace(budget, probability=min(child.probability for child in cases))


def try_and_catch(node: ResolvedNode, children: Sequence[Budget]) -> Budget | None:
    """The last child cleans up after a failure; whatever it returns, the result is a failure."""
    if len(children) < 2:
        return None
    *tried, catch = children
    go, end, skip = in_order([(each.success, each.failure, each.skip) for each in tried])
    return combined(children, go, plus(end, catch.anything), skip)
