"""How long decorators of the engine take, given how long their child takes.

What holds for every rule: `composition`.
"""

from __future__ import annotations

from math import inf

from btq_lang.requirements.budget_parts import (
    Budget,
    end_after,
    likelihood,
    mapped,
    port_count,
    port_of,
    port_range,
    port_seconds,
    without_limit,
)
from btq_lang.requirements.durations import ZERO, Range, cut, hull, plus, times, without_end
from btq_lang.util.record import replace
from btq_lang.workspace.resolved import ResolvedNode


def repeat(node: ResolvedNode, child: Budget) -> Budget:
    count = port_count(node, "count")
    go, end, skip = _again(child.success, child.failure, child.skip, count)
    has_no_end = child.endless or (child.success is not None and count in (-1, None))
    return Budget(go, end, skip, True, likelihood([child.probability], count), has_no_end)


def _again(
    go: Range | None, end: Range | None, skip: Range | None, count: int | None
) -> tuple[Range | None, Range | None, Range | None]:
    """Repeats while the child goes on, `count` times at most: the ranges of having gone on so often, of ending before,
    and of being skipped; a skip keeps the count, so that the next activation has fewer repetitions left."""
    if count == 0 or (count is not None and count < -1):
        return ZERO, None, ZERO
    if count == -1:
        return None, end_after(go, end, inf), end_after(go, skip, inf)
    if count is None:
        return without_end(hull(go, ZERO)), end_after(go, end, inf), hull(end_after(go, skip, inf), ZERO)
    all_of_it = times(count, go)
    if skip is not None and all_of_it is not None and go is not None:
        all_of_it = replace(all_of_it, low=go.low)
    return all_of_it, end_after(go, end, count - 1), end_after(go, skip, count - 1)


def timeout(node: ResolvedNode, child: Budget) -> Budget:
    """It can interrupt only what returns RUNNING."""
    limit = port_seconds(node)
    longest = child.running
    if limit == 0 or not child.waits:
        return child
    if limit is None:
        return replace(child, failure=hull(child.failure, longest))
    runs_out = Range(limit, limit, tuple(replace(term, seconds=limit) for term in longest.terms[:1]))
    found = mapped(child, lambda each: cut(each, limit))
    failure = hull(found.failure, runs_out if longest.high > limit else None)
    return replace(found, failure=failure, endless=False)


def delay(node: ResolvedNode, child: Budget) -> Budget:
    wait = port_range(node)
    return replace(mapped(child, lambda each: plus(wait, each)), waits=True)


def until_failure(node: ResolvedNode, child: Budget) -> Budget:
    again = child.success is not None or child.skip is not None
    failure = without_end(child.failure) if again else child.failure
    likely = child.probability if child.probability == 1.0 or not again else 0.0
    return Budget(None, failure, None, True, likely, child.endless or again)


def once(node: ResolvedNode, child: Budget) -> Budget:
    """After the first run it is skipped, or repeats its result at once."""
    return replace(
        child,
        success=hull(child.success, ZERO) if child.success is not None else None,
        failure=hull(child.failure, ZERO) if child.failure is not None else None,
        skip=hull(child.skip, ZERO),
    )


def precondition(node: ResolvedNode, child: Budget) -> Budget:
    """4.6 evaluates the script at every tick, later versions when the child starts."""
    word, default = port_of(node, "otherwise")
    status = word.text if word is not None else default
    running = child.running
    if status not in ("SUCCESS", "FAILURE", "SKIPPED"):
        return Budget(running, running, running, True, child.probability, endless=child.endless)
    key = {"SUCCESS": "success", "FAILURE": "failure", "SKIPPED": "skip"}[status]
    return replace(child, **{key: hull(getattr(child, key), running)})


def for_each(node: ResolvedNode, child: Budget) -> Budget:
    if child.running.high == 0.0:
        return Budget(ZERO, ZERO, ZERO, True, child.probability)
    return without_limit([child])  # the queue's length is unknown


def wait_until_updated(node: ResolvedNode, child: Budget) -> Budget:
    return replace(mapped(child, without_end), waits=True, endless=True)
