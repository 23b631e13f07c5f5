"""How long a node takes, given how long its children take: a rule for each flow.

One invariant: every run of the engine is within the ranges, if the children are within theirs.  Three things are left
out: the time between two ticks, that the variable of a switch changes while a case runs, and how long a node holds its
child back that its parent has not reset.  Requirements are for `budgets`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import fsum, inf
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.units import to_si
from btq_lang.requirements.durations import (
    ANY,
    ZERO,
    Range,
    cut,
    from_zero,
    hull,
    plus,
    times,
    total,
    without_end,
)
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import BRACED, QUANTITY
from btq_lang.util.record import Record, replace
from btq_lang.workspace.node_names import wraps

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Flow, Role
    from btq_lang.syntax.tree import Word
    from btq_lang.workspace.resolved import ResolvedNode


class Budget(Record):
    """How long a node takes.

    Attributes:
        success, failure: of an activation that succeeds or fails; None if none does.
        skip: until it is skipped.
        waits: whether it may return RUNNING, so that it can be interrupted.
        probability: at least this, that all holds on which the ranges depend (by the union bound).
        reason: why the node itself has no upper bound, in words to follow its name; empty if its children are the
            reason.
        endless: whether it may run for ever, without an outcome.
    """

    success: Range | None
    failure: Range | None
    skip: Range | None = None
    waits: bool = True
    probability: float = 1.0
    reason: str = ""
    endless: bool = False

    @property
    def completes(self) -> Range | None:
        """Of an activation that succeeds or fails."""
        return hull(self.success, self.failure)

    @property
    def anything(self) -> Range | None:
        """Of any activation, however it ends."""
        return hull(self.success, self.failure, self.skip)

    @property
    def running(self) -> Range:
        """How long it may run until it is interrupted, or while it is running."""
        longest = self.anything
        return ANY if self.endless or longest is None else replace(longest, low=0.0)

    @property
    def is_bounded(self) -> bool:
        """Whether there is a bound on how long it may run."""
        longest = None if self.endless else self.anything
        return longest is not None and longest.high < inf


def compose(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """How long a node takes, from its kind, its ports and its children's budgets; SubTrees and custom nodes are not
    known here.

    Args:
        children: one for each, verbatim XML too; their terms are the children themselves.
    """
    if node.flow in _LEAVES:
        return _LEAVES[node.flow]
    if node.flow == "sleeps":
        return _sleep(node)
    found: Budget | None = None
    if node.flow in _DECORATORS and len(children) == 1:
        found = _DECORATORS[node.flow](node, children[0])
    elif node.flow in _CONTROLS and children and node.category != "Decorator":
        found = _CONTROLS[node.flow](node, children)
    else:
        return unknown("is a node of unknown duration")
    if found is None:
        return unknown("has the wrong number of children")
    if found.waits or node.behavior is None or node.behavior.execution != "asynchronous":
        return found
    return replace(found, waits=True)


def unknown(reason: str) -> Budget:
    """The budget of a node that may do anything and take any time."""
    return Budget(ANY, ANY, ANY, reason=reason, endless=True)


def port_seconds(node: ResolvedNode) -> float | None:
    """The literal milliseconds of its time, in seconds; None if that is not a literal number."""
    word, _ = _port(node, "time")
    if word is None:
        return None
    quantity = parse_quantity(word.text) if word.kind == QUANTITY else None
    if quantity is not None:
        found = to_si(quantity[0], quantity[1])
        return max(round(found * 1000), 0) / 1000 if found < inf else None
    return int(word.text) / 1000 if word.text.isdecimal() and len(word.text) < 12 else None


def port_count(node: ResolvedNode, role: Role) -> int | None:
    """The literal integer of the port, or its default; None if that is not an integer."""
    word, text = _port(node, role)
    if word is not None:
        text = word.text
    return int(text) if text.removeprefix("-").isdecimal() and len(text) < 12 else None


def _port(node: ResolvedNode, role: Role) -> tuple[Word | None, str]:
    """The value of the port, and its default."""
    port = node.behavior.port_for(role) if node.behavior is not None else None
    return (None, "") if port is None else (node.node.attribute(port.name), port.default or "")


# ---- control nodes ----


def _sequence(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    if node.behavior is not None and node.behavior.keeps_place:
        return _with_memory(children)
    go, end, skip = _in_order([(each.success, each.failure, each.skip) for each in children])
    found = _made(children, go, end, skip)
    return _reactive(children, found, "failure") if node.behavior is not None and node.behavior.reactive else found


def _fallback(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    go, end, skip = _in_order([(each.failure, each.success, each.skip) for each in children])
    found = _made(children, end, go, skip)
    return _reactive(children, found, "success") if node.behavior is not None and node.behavior.reactive else found


def _in_order(
    parts: Sequence[tuple[Range | None, Range | None, Range | None]],
) -> tuple[Range | None, Range | None, Range | None]:
    """One after the other, as long as each goes on: the ranges of going on, of ending, and of skipping all."""
    passed: Range | None = ZERO
    ended: Range | None = None
    for go, end, skip in parts:
        ended = hull(ended, plus(passed, end))
        passed = plus(passed, hull(go, skip))
    return passed, ended, total(skip for _, _, skip in parts)


def _with_memory(children: Sequence[Budget]) -> Budget:
    """As a sequence, but after a failure or a halt it resumes at the child that failed: any part of it may be done."""
    go, end, skip = _in_order([(each.success, each.failure, each.skip) for each in children])
    last = hull(children[-1].success, children[-1].skip)
    first = min((each.failure.low for each in children if each.failure is not None), default=0.0)
    return _made(
        children,
        replace(go, low=last.low) if go is not None and last is not None else None,
        replace(end, low=first) if end is not None else None,
        from_zero(skip),
    )


def _reactive(children: Sequence[Budget], found: Budget, ends: str) -> Budget:
    """A child before the running one is ticked at every tick, and may end the whole."""
    waiting = [index for index, child in enumerate(children) if child.waits]
    if len(waiting) > 1:
        reason = "has several children that take time, and may restart each of them without limit"
        return replace(
            found,
            success=ANY if found.success is not None else None,
            failure=ANY if found.failure is not None else None,
            skip=ANY if found.skip is not None else None,
            probability=0.0 if found.probability < 1.0 else 1.0,
            reason=reason,
            endless=True,
        )
    before = children[: waiting[0]] if waiting else ()
    if any(getattr(child, ends) is not None for child in before):
        running = children[waiting[0]].running
        return replace(found, **{ends: hull(getattr(found, ends), running)})
    return found


def _parallel(node: ResolvedNode, children: Sequence[Budget]) -> Budget | None:
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
        return _made(children, longest, longest, longest)
    if not 0 < wanted <= n or not 0 < failures <= n:
        return None
    enough = min(failures, n - wanted + 1)
    highs = sorted(everything, key=lambda each: each.high)
    last = highs[wanted + enough - 2]
    succeeds = _nth(children, "success", wanted)
    fails = _nth(children, "failure", enough)
    return _made(
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
        reason = "ticks a skipped child without limit"
        likely = _likely([child.probability for child in children], None)
        return Budget(ANY, ANY, ANY, probability=likely, reason=reason, endless=True)
    longest = total(child.running for child in children)
    return _made(children, longest, longest, longest)


def _nth(children: Sequence[Budget], outcome: str, count: int) -> float:
    """When that many can have ended so, at the earliest."""
    found = [getattr(child, outcome) for child in children]
    return sorted(each.low if each is not None else inf for each in found)[count - 1]


def _parallel_all(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """Waits for all of them, then counts the failures."""
    n = len(children)
    most = port_count(node, "failures")
    most = n + most + 1 if most is not None and most < 0 else most
    if (with_skips := _with_skips(node, children, False)) is not None:
        return with_skips
    if any(child.completes is None for child in children):
        return _made(children, None, None, None)
    longest = _slowest([child.completes or ZERO for child in children])
    always = sum(child.success is None for child in children)
    maybe = sum(child.failure is not None for child in children)
    fails = most is None or maybe >= most
    succeeds = most is None or always < most
    return _made(children, longest if succeeds else None, longest if fails else None, None)


def _slowest(ranges: Sequence[Range]) -> Range:
    """All at once: it takes as long as the longest."""
    return replace(max(ranges, key=lambda each: each.high), low=max(each.low for each in ranges))


def _choice(node: ResolvedNode, children: Sequence[Budget]) -> Budget | None:
    if len(children) not in (2, 3):
        return None
    found = _if_then_else(children)
    return _rechecking(children, found) if node.behavior is not None and node.behavior.reactive else found


def _if_then_else(children: Sequence[Budget]) -> Budget:
    condition, then = children[0], children[1]
    otherwise = children[2] if len(children) == 3 else Budget(None, ZERO, None, False)
    return replace(
        _made(
            children,
            hull(plus(condition.success, then.success), plus(condition.failure, otherwise.success)),
            hull(plus(condition.success, then.failure), plus(condition.failure, otherwise.failure)),
            hull(plus(condition.success, then.skip), plus(condition.failure, otherwise.skip)),
        ),
        probability=_likely([condition.probability, min(then.probability, otherwise.probability)]),
    )


def _rechecking(children: Sequence[Budget], found: Budget) -> Budget:
    """The condition is evaluated at every tick, and its result may change."""
    condition, *branches = children
    if condition.waits or (len(branches) == 2 and all(branch.waits for branch in branches)):
        changes = condition.success is not None and condition.failure is not None
        if condition.waits or changes:
            reason = "checks its condition at every tick, so it may restart its branches without limit"
            return Budget(
                ANY, ANY, ANY, reason=reason, probability=0.0 if found.probability < 1.0 else 1.0, endless=True
            )
        return found
    running = total(branch.running if branch.waits else ZERO for branch in branches)
    if condition.failure is None or condition.success is None:
        return found
    return replace(
        found,
        success=hull(found.success, running) if len(branches) == 2 else found.success,
        failure=hull(found.failure, running),
        skip=hull(found.skip, running) if found.skip is not None else None,
        probability=_likely([child.probability for child in children]),
    )


def _switch(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    cases = children if node.node.attribute("variable") is not None else children[-1:]
    found = _made(
        children,
        hull(*(child.success for child in cases)),
        hull(*(child.failure for child in cases)),
        hull(*(child.skip for child in cases)),
    )
    return replace(found, probability=min(child.probability for child in cases))


def _try(node: ResolvedNode, children: Sequence[Budget]) -> Budget | None:
    """The last child cleans up after a failure; whatever it returns, the result is a failure."""
    if len(children) < 2:
        return None
    *tried, catch = children
    go, end, skip = _in_order([(each.success, each.failure, each.skip) for each in tried])
    return _made(children, go, plus(end, catch.anything), skip)


def _pipeline(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """An earlier child is ticked again while a later one runs, and may then fail, or be skipped with all others."""
    go, end, skip = _in_order([(each.success, each.failure, each.skip) for each in children])
    longest = total(child.running for child in children)
    if any(child.waits for child in children[1:]):
        end = hull(end, longest) if end is not None else None
        skip = hull(skip, longest) if skip is not None else None
    return _made(children, go, end, skip)


def _together(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """A child that has ended starts again as long as another one runs."""
    if sum(child.waits for child in children) > 1:
        likely = 0.0 if any(child.probability < 1.0 for child in children) else 1.0
        reason = "restarts children that have ended until all succeed in one tick"
        return Budget(ANY, ANY, None, probability=likely, reason=reason, endless=True)
    success = total(child.success for child in children)
    fails = any(child.failure is not None for child in children)
    return _made(children, success, total(child.running for child in children) if fails else None, None)


def _resume(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """It may begin with any child, and end before the first one.  With a number instead of an entry it begins there at
    every tick."""
    word, _ = _port(node, "index")
    if word is not None and word.kind != BRACED:
        return unknown("begins with the same child at every tick")
    go, end, _ = _in_order([(each.success, each.failure, each.skip) for each in children])
    return _made(children, hull(from_zero(go), ZERO), from_zero(end), None)


def _recover(node: ResolvedNode, children: Sequence[Budget]) -> Budget | None:
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
        last = _before(cycle, first.failure, most)
    found = _made(
        children,
        _before(cycle, first.success, most),
        hull(last, _before(cycle, gives_up, most - 1) if most > 0 else None),
        _before(cycle, first.skip, most),
    )
    reason = "" if count is not None or cycle is None else "has no known limit of its retries"
    likely = _likely([child.probability for child in children], None if count is None else count + 1)
    return replace(found, probability=likely, reason=reason, endless=found.endless or bool(reason))


def _rotate(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """It may begin with any child; one that was skipped it ticks again, if its first follows its last."""
    goes_round = node.behavior is not None and wraps(node.behavior, node.node) is not False
    if goes_round and any(child.skip is not None and child.skip.high > 0.0 for child in children):
        return replace(unknown("ticks a skipped child without limit"), waits=any(child.waits for child in children))
    longest = total(child.running for child in children)
    succeeds = [child.success for child in children if child.success is not None]
    return _made(
        children,
        replace(longest, low=min(each.low for each in succeeds)) if succeeds and longest is not None else None,
        longest,
        longest if all(child.skip is not None for child in children) else None,
    )


# ---- decorators ----


def _pass(node: ResolvedNode, child: Budget) -> Budget:
    return child


def _throttle_or_fail(node: ResolvedNode, child: Budget) -> Budget:
    return replace(child, failure=hull(child.failure, from_zero(child.running)))


def _pass_or_succeed(node: ResolvedNode, child: Budget) -> Budget:
    return replace(child, success=hull(child.success, from_zero(child.running)))


def _pass_once(node: ResolvedNode, child: Budget) -> Budget:
    return replace(child, failure=hull(child.failure, ZERO))


def _invert(node: ResolvedNode, child: Budget) -> Budget:
    return replace(child, success=child.failure, failure=child.success)


def _force_success(node: ResolvedNode, child: Budget) -> Budget:
    return replace(child, success=child.completes, failure=None)


def _force_failure(node: ResolvedNode, child: Budget) -> Budget:
    return replace(child, success=None, failure=child.completes)


def _retry(node: ResolvedNode, child: Budget) -> Budget:
    count = port_count(node, "count")
    go, end, skip, reason = _again(child.failure, child.success, child.skip, count)
    return Budget(
        end, go, skip, True, _likely([child.probability], count), reason, _has_no_end(child, child.failure, count)
    )


def _repeat(node: ResolvedNode, child: Budget) -> Budget:
    count = port_count(node, "count")
    go, end, skip, reason = _again(child.success, child.failure, child.skip, count)
    return Budget(
        go, end, skip, True, _likely([child.probability], count), reason, _has_no_end(child, child.success, count)
    )


def _has_no_end(child: Budget, go: Range | None, count: int | None) -> bool:
    return child.endless or (go is not None and count in (-1, None))


def _again(
    go: Range | None, end: Range | None, skip: Range | None, count: int | None
) -> tuple[Range | None, Range | None, Range | None, str]:
    """Repeats while the child goes on, `count` times at most: the ranges of having gone on so often, of ending before,
    and of being skipped; a skip keeps the count, so that the next activation has fewer repetitions left."""
    if count == 0 or (count is not None and count < -1):
        return ZERO, None, ZERO, ""
    if count is None or count == -1:
        reason = "has no limit" if count == -1 else "reads from the blackboard how often it runs its child"
        if count == -1:
            return None, _before(go, end, inf), _before(go, skip, inf), reason
        return without_end(hull(go, ZERO)), _before(go, end, inf), hull(_before(go, skip, inf), ZERO), reason
    all_of_it = times(count, go)
    if skip is not None and all_of_it is not None and go is not None:
        all_of_it = replace(all_of_it, low=go.low)
    return all_of_it, _before(go, end, count - 1), _before(go, skip, count - 1), ""


def _before(go: Range | None, end: Range | None, count: float) -> Range | None:
    """`end` after at most `count` times `go`."""
    if go is None or end is None or count == 0:
        return end
    if count == inf:
        return without_end(end) if go.high > 0.0 else end
    return hull(end, plus(times(int(count), go), end))


def _timeout(node: ResolvedNode, child: Budget) -> Budget:
    """It can interrupt only what returns RUNNING."""
    limit = port_seconds(node)
    longest = child.running
    if limit == 0 or not child.waits:
        return child
    if limit is None:
        return replace(child, failure=hull(child.failure, longest))
    runs_out = Range(limit, limit, tuple(replace(term, seconds=limit) for term in longest.terms[:1]))
    return replace(
        child,
        success=cut(child.success, limit),
        failure=hull(cut(child.failure, limit), runs_out if longest.high > limit else None),
        skip=cut(child.skip, limit),
        endless=False,
    )


def _delay(node: ResolvedNode, child: Budget) -> Budget:
    seconds = port_seconds(node)
    wait = ANY if seconds is None else Range(seconds, seconds)
    reason = "" if seconds is not None else "reads from the blackboard how long it waits"
    return replace(
        child,
        success=plus(wait, child.success),
        failure=plus(wait, child.failure),
        skip=plus(wait, child.skip),
        waits=True,
        reason=reason,
    )


def _until_failure(node: ResolvedNode, child: Budget) -> Budget:
    again = child.success is not None or child.skip is not None
    failure = without_end(child.failure) if again else child.failure
    likely = child.probability if child.probability == 1.0 or not again else 0.0
    reason = "repeats its child until it fails" if again else ""
    return Budget(None, failure, None, True, likely, reason, child.endless or again)


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
    word, default = _port(node, "otherwise")
    status = word.text if word is not None else default
    running = child.running
    if status not in ("SUCCESS", "FAILURE", "SKIPPED"):
        return Budget(running, running, running, True, child.probability, endless=child.endless)
    key = {"SUCCESS": "success", "FAILURE": "failure", "SKIPPED": "skip"}[status]
    return replace(child, **{key: hull(getattr(child, key), running)})


def _for_each(node: ResolvedNode, child: Budget) -> Budget:
    if child.running.high == 0.0:
        return Budget(ZERO, ZERO, ZERO, True, child.probability)
    reason = "runs its child for each item of a queue of unknown length"
    return Budget(ANY, ANY, ANY, True, 0.0 if child.probability < 1.0 else 1.0, reason, True)


def _skip_unless_updated(node: ResolvedNode, child: Budget) -> Budget:
    return replace(child, skip=hull(child.skip, ZERO))


def _wait_until_updated(node: ResolvedNode, child: Budget) -> Budget:
    return replace(
        child,
        success=without_end(child.success),
        failure=without_end(child.failure),
        skip=without_end(child.skip),
        waits=True,
        reason="waits until an entry is written",
        endless=True,
    )


def _sleep(node: ResolvedNode) -> Budget:
    seconds = port_seconds(node)
    if seconds is None:
        return Budget(ANY, None, reason="reads from the blackboard how long it waits")
    return Budget(Range(seconds, seconds), None)


def _made(children: Sequence[Budget], success: Range | None, failure: Range | None, skip: Range | None) -> Budget:
    waits = any(child.waits for child in children)
    likely = _likely([child.probability for child in children])
    return Budget(success, failure, skip, waits, likely, endless=any(child.endless for child in children))


def _likely(probabilities: Sequence[float], count: int | None = 1) -> float:
    """The union bound: all of them hold, each `count` times; without a count that is unknown, unless all are
    certain."""
    if all(probability == 1.0 for probability in probabilities):
        return 1.0
    if count is None or count < 0:
        return 0.0
    return max(0.0, 1.0 - count * fsum([1.0 - probability for probability in probabilities]))


_LEAVES: Final[Mapping[Flow, Budget]] = {
    "succeeds": Budget(ZERO, None, None, False),
    "fails": Budget(None, ZERO, None, False),
    "answers": Budget(ZERO, ZERO, None, False),
    "notices": Budget(ZERO, ZERO, None, False),
    "waits": Budget(ANY, ANY, reason="has no `takes` clause"),
}
_CONTROLS: Final[Mapping[Flow, Callable[[ResolvedNode, Sequence[Budget]], Budget | None]]] = {
    "sequence": _sequence,
    "fallback": _fallback,
    "parallel": _parallel,
    "parallel-all": _parallel_all,
    "choice": _choice,
    "switch": _switch,
    "try": _try,
    "pipeline": _pipeline,
    "together": _together,
    "resume": _resume,
    "recover": _recover,
    "rotate": _rotate,
}
_DECORATORS: Final[Mapping[Flow, Callable[[ResolvedNode, Budget], Budget]]] = {
    "invert": _invert,
    "force-success": _force_success,
    "force-failure": _force_failure,
    "retry": _retry,
    "repeat": _repeat,
    "timeout": _timeout,
    "delay": _delay,
    "until-failure": _until_failure,
    "once": _once,
    "precondition": _precondition,
    "for-each": _for_each,
    "skip-unless-updated": _skip_unless_updated,
    "wait-until-updated": _wait_until_updated,
    "pass": _pass,
    "throttle": _pass,
    "throttle-or-fail": _throttle_or_fail,
    "pass-or-succeed": _pass_or_succeed,
    "pass-once": _pass_once,
}
