"""How long a node takes, given how long its children take: a rule for each flow.

One invariant: every run of the engine is within the ranges, if the children are within theirs.  Five things are left
out: the time between two ticks, that the variable of a switch changes while a case runs, how long a node that its
parent has not reset holds its child back, activations that continue because their parent did not halt them (the timer
of a Delay or Timeout that was skipped, the child of a DistanceController without a position of the robot), and that
4.8.3 and 4.8.4 wait in no Delay.  The rules of decorators are here, those of control nodes in `control_budgets` and
`nav2_budgets`.  Requirements are for `budgets`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import inf
from typing import Final

from btq_lang.catalog.kinds import Flow
from btq_lang.requirements import control_budgets, nav2_budgets
from btq_lang.requirements.budget_parts import (
    UNKNOWN,
    Budget,
    end_after,
    inverted,
    likelihood,
    mapped,
    port_count,
    port_of,
    port_range,
    port_seconds,
    without_limit,
)
from btq_lang.requirements.durations import ANY, ZERO, Range, cut, from_zero, hull, plus, times, without_end
from btq_lang.util.record import replace
from btq_lang.workspace.node_names import copies
from btq_lang.workspace.resolved import ResolvedNode


def compose(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """How long a node takes, from its kind, its ports and its children's budgets; SubTrees and custom nodes are not
    known here.

    Args:
        children: one for each, verbatim XML too; their terms are the children themselves.
    """
    if node.flow in _LEAVES:
        is_copy = node.behavior is not None and copies(node.behavior, node.node)
        return _LEAVES["answers" if is_copy else node.flow]
    if node.flow == "sleeps":
        return Budget(port_range(node), None)
    budget: Budget | None = None
    if node.flow in _DECORATORS and len(children) == 1:
        budget = _DECORATORS[node.flow](node, children[0])
    elif node.flow in _CONTROLS and children and node.category != "Decorator":
        budget = _CONTROLS[node.flow](node, children)
    if budget is None:
        return UNKNOWN
    if budget.waits or node.behavior is None or node.behavior.execution != "asynchronous":
        return budget
    return replace(budget, waits=True)


# ---- decorators of the engine ----


def _repeat(node: ResolvedNode, child: Budget) -> Budget:
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


def _timeout(node: ResolvedNode, child: Budget) -> Budget:
    """It can interrupt only what returns RUNNING.  A child that ends just when the time has passed may be too late."""
    limit = port_seconds(node)
    longest = child.running
    if limit == 0 or not child.waits:
        return child
    if limit is None:
        return replace(child, failure=hull(child.failure, longest))
    runs_out = Range(limit, limit, tuple(replace(term, seconds=limit) for term in longest.terms[:1]))
    limited = mapped(child, lambda each: cut(each, limit))
    failure = hull(limited.failure, runs_out if longest.high >= limit else None)
    return replace(limited, failure=failure, endless=False)


def _delay(node: ResolvedNode, child: Budget) -> Budget:
    wait = port_range(node)
    return replace(mapped(child, lambda each: plus(wait, each)), waits=True)


def _until_failure(node: ResolvedNode, child: Budget) -> Budget:
    again = child.success is not None or child.skip is not None
    failure = without_end(child.failure) if again else child.failure
    likely = child.probability if child.probability == 1.0 or not again else 0.0
    return Budget(None, failure, None, True, likely, child.endless or again)


def _once(node: ResolvedNode, child: Budget) -> Budget:
    """After the first run it is skipped, or repeats its result at once."""
    return replace(
        child,
        success=hull(child.success, ZERO) if child.success is not None else None,
        failure=hull(child.failure, ZERO) if child.failure is not None else None,
        skip=hull(child.skip, ZERO),
    )


def _precondition(node: ResolvedNode, child: Budget) -> Budget:
    """4.6 evaluates the script at every tick, later versions when the child starts."""
    word, default = port_of(node, "otherwise")
    status = word.text if word is not None else default
    running = child.running
    if status not in ("SUCCESS", "FAILURE", "SKIPPED"):
        return Budget(running, running, running, True, child.probability, endless=child.endless)
    key = {"SUCCESS": "success", "FAILURE": "failure", "SKIPPED": "skip"}[status]
    return replace(child, **{key: hull(getattr(child, key), running)})


def _for_each(node: ResolvedNode, child: Budget) -> Budget:
    if child.running.high == 0.0:
        return Budget(ZERO, ZERO, ZERO, True, child.probability)
    return without_limit([child])  # the queue's length is unknown


def _wait_until_updated(node: ResolvedNode, child: Budget) -> Budget:
    return replace(mapped(child, without_end), waits=True, endless=True)


_LEAVES: Final[Mapping[Flow, Budget]] = {
    "succeeds": Budget(ZERO, None, None, False),
    "fails": Budget(None, ZERO, None, False),
    "answers": Budget(ZERO, ZERO, None, False),
    "notices": Budget(ZERO, ZERO, None, False),
    "waits": Budget(ANY, ANY),
}
_CONTROLS: Final[Mapping[Flow, Callable[[ResolvedNode, Sequence[Budget]], Budget | None]]] = {
    "sequence": control_budgets.sequence,
    "fallback": lambda node, children: inverted(control_budgets.sequence(node, [*map(inverted, children)])),
    "parallel": control_budgets.parallel,
    "parallel-all": control_budgets.parallel_all,
    "choice": control_budgets.choice,
    "switch": control_budgets.switch,
    "try": control_budgets.try_and_catch,
    "pipeline": nav2_budgets.pipeline,
    "together": nav2_budgets.together,
    "resume": nav2_budgets.resume,
    "recover": nav2_budgets.recover,
    "rotate": nav2_budgets.rotate,
}
_DECORATORS: Final[Mapping[Flow, Callable[[ResolvedNode, Budget], Budget]]] = {
    "invert": lambda _, child: inverted(child),
    "force-success": lambda _, child: replace(child, success=child.completes, failure=None),
    "force-failure": lambda _, child: replace(child, success=None, failure=child.completes),
    "retry": lambda node, child: inverted(_repeat(node, inverted(child))),
    "repeat": _repeat,
    "timeout": _timeout,
    "delay": _delay,
    "until-failure": _until_failure,
    "once": _once,
    "precondition": _precondition,
    "for-each": _for_each,
    "skip-unless-updated": lambda _, child: replace(child, skip=hull(child.skip, ZERO)),
    "wait-until-updated": _wait_until_updated,
    "pass": lambda _, child: child,
    "throttle": lambda _, child: child,
    "throttle-or-fail": lambda _, child: replace(child, failure=hull(child.failure, from_zero(child.running))),
    "pass-or-succeed": lambda _, child: replace(child, success=hull(child.success, from_zero(child.running))),
    "pass-once": lambda _, child: replace(child, failure=hull(child.failure, ZERO)),
}
