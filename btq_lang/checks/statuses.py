"""What a built-in can return when it is known what its children can.

One invariant: never less than the engine's node returns, in any version.  A set of statuses is a sum of powers of two;
a missing or surplus child is one that can return anything.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.syntax.tree import Node

SUCCESS: Final = 1
FAILURE: Final = 2
SKIPPED: Final = 4
RUNNING: Final = 8
ANYTHING: Final = SUCCESS | FAILURE | SKIPPED | RUNNING


def of_builtin(tag: str, node: Node, children: Sequence[int], starting: bool) -> int:
    """The statuses that a built-in can return.

    Args:
        tag: its tag.
        node: where its ports are.
        children: what each of its children can return.
        starting: the sets are those of the tick that starts the node; else those of any tick.
    """
    if tag in _LEAVES:
        return _LEAVES[tag]
    if tag == "Sleep":
        return RUNNING if starting and literal(node, "msec") != 0 else SUCCESS | RUNNING
    if tag in _IN_ORDER:
        goes_on, pauses = _IN_ORDER[tag]
        return _in_order(children, goes_on, pauses, starting)
    if tag in _DECORATORS:
        return _DECORATORS[tag](node, children[0] if len(children) == 1 else ANYTHING, starting)
    if tag.startswith("Switch") and children:
        return _any_of(children if node.attribute("variable") is not None else children[-1:])
    if tag in ("IfThenElse", "WhileDoElse") and len(children) in (2, 3):
        return _if_then_else(children)
    if tag == "TryCatch" and len(children) > 1:
        tried = _in_order(children[:-1], SUCCESS, False, starting)
        return tried | (children[-1] & RUNNING if tried & FAILURE else 0)
    if tag in ("Parallel", "ParallelAll") and children:
        return _parallel(node, children)
    return ANYTHING


def literal(node: Node, port: str) -> int | None:
    """The whole number that is written as the value of a port; None where another thing is, or nothing."""
    value = node.attribute(port)
    text = value.text if value is not None else ""
    return int(text) if text.removeprefix("-").isdecimal() and len(text) < 12 else None


def _in_order(children: Sequence[int], goes_on: int, pauses: bool, starting: bool) -> int:
    """A Sequence (it goes on after SUCCESS) or a Fallback (after FAILURE).

    `pauses`: it returns RUNNING between two children that complete at once.
    """
    found = 0
    skipped = ANYTHING
    for index, child in enumerate(children):
        found |= child & (RUNNING | SUCCESS | FAILURE) & ~goes_on
        skipped &= child
        if pauses and child & goes_on and index + 1 < len(children):
            found |= RUNNING
            child &= ~goes_on if starting else ANYTHING
        if not child & (goes_on | SKIPPED):
            return found
    # Resumed at a child that was running and is now skipped, it has forgotten that those before it were skipped too.
    resumed = not starting and skipped & SKIPPED and any(child & RUNNING for child in children)
    passed = goes_on if resumed or any(child & goes_on for child in children) else 0
    return found | passed | (skipped & SKIPPED)


def _any_of(children: Sequence[int]) -> int:
    found = 0
    for child in children:
        found |= child
    return found


def _if_then_else(children: Sequence[int]) -> int:
    condition, then = children[0], children[1]
    otherwise = children[2] if len(children) == 3 else FAILURE
    found = condition & RUNNING
    if condition & SUCCESS:
        found |= then
    if condition & FAILURE:
        found |= otherwise
    return found if not condition & SKIPPED else ANYTHING


def _parallel(node: Node, children: Sequence[int]) -> int:
    """Without thresholds all must succeed and one may fail; with some, anything that a child completes with."""
    found = _any_of(children)
    everyone = ANYTHING
    for child in children:
        everyone &= child | (SUCCESS if child & SKIPPED else 0)
    if not found & (SUCCESS | FAILURE | SKIPPED):
        return found
    if any(node.attribute(port) is not None for port in ("success_count", "failure_count", "max_failures")):
        return found | SUCCESS | FAILURE
    succeeds = SUCCESS if everyone & SUCCESS else 0
    return (found & (FAILURE | RUNNING)) | succeeds | (SKIPPED if found & SKIPPED else 0)


def _repeat(node: Node, child: int, starting: bool) -> int:
    return _again(child, SUCCESS, literal(node, "num_cycles"), starting)


def _retry(node: Node, child: int, starting: bool) -> int:
    return _again(child, FAILURE, literal(node, "num_attempts"), starting)


def _again(child: int, repeats: int, count: int | None, starting: bool) -> int:
    """Repeat (it repeats after SUCCESS) or RetryUntilSuccessful (after FAILURE); -1 is without end."""
    if count is not None and (count == 0 or count < -1):
        return repeats | SKIPPED
    if count == 1 or not child & repeats:
        return child
    found = child | RUNNING
    counted = not starting or child & SKIPPED  # a skipped child leaves the count as it is
    return found if count is None or (count > 0 and counted) else found & ~repeats


def _inverter(node: Node, child: int, starting: bool) -> int:
    found = child & ~(SUCCESS | FAILURE)
    return found | (FAILURE if child & SUCCESS else 0) | (SUCCESS if child & FAILURE else 0)


def _force_success(node: Node, child: int, starting: bool) -> int:
    return child & ~FAILURE | (SUCCESS if child & FAILURE else 0)


def _force_failure(node: Node, child: int, starting: bool) -> int:
    return child & ~SUCCESS | (FAILURE if child & SUCCESS else 0)


def _keep_running(node: Node, child: int, starting: bool) -> int:
    return child & ~SUCCESS | (RUNNING if child & (SUCCESS | SKIPPED) else 0)


def _timeout(node: Node, child: int, starting: bool) -> int:
    return child | (FAILURE if child & RUNNING and not starting else 0)


def _delay(node: Node, child: int, starting: bool) -> int:
    return RUNNING if starting and literal(node, "delay_msec") != 0 else child | RUNNING


def _run_once(node: Node, child: int, starting: bool) -> int:
    """Once it has run it is skipped, or returns a result again that it had at any tick."""
    skips = node.attribute("then_skip") is None
    return child | (SKIPPED if skips else ANYTHING)


def _precondition(node: Node, child: int, starting: bool) -> int:
    return child | _status(node, "else", FAILURE)


def _loop(node: Node, child: int, starting: bool) -> int:
    return child | RUNNING | _status(node, "if_empty", SUCCESS)


def _skip_unless_updated(node: Node, child: int, starting: bool) -> int:
    return child | SKIPPED


def _wait_value_update(node: Node, child: int, starting: bool) -> int:
    return child | RUNNING


def _status(node: Node, port: str, default: int) -> int:
    value = node.attribute(port)
    return default if value is None else _STATUSES.get(value.text, ANYTHING)


_STATUSES: Final = {"SUCCESS": SUCCESS, "FAILURE": FAILURE, "SKIPPED": SKIPPED, "RUNNING": RUNNING}
_LEAVES: Final = {
    "AlwaysSuccess": SUCCESS,
    "AlwaysFailure": FAILURE,
    "Script": SUCCESS,
    "SetBlackboard": SUCCESS,
    "UnsetBlackboard": SUCCESS,
    "ScriptCondition": SUCCESS | FAILURE,
    "WasEntryUpdated": SUCCESS | FAILURE,
}
# After which status it goes on to the next child, and whether it returns RUNNING in between.
_IN_ORDER: Final = {
    "Sequence": (SUCCESS, False),
    "ReactiveSequence": (SUCCESS, False),
    "AsyncSequence": (SUCCESS, True),
    "SequenceWithMemory": (SUCCESS, True),
    "Fallback": (FAILURE, False),
    "ReactiveFallback": (FAILURE, False),
    "AsyncFallback": (FAILURE, True),
}
_DECORATORS: Final[dict[str, Callable[[Node, int, bool], int]]] = {
    "Inverter": _inverter,
    "ForceSuccess": _force_success,
    "ForceFailure": _force_failure,
    "KeepRunningUntilFailure": _keep_running,
    "Repeat": _repeat,
    "RetryUntilSuccessful": _retry,
    "Timeout": _timeout,
    "Delay": _delay,
    "RunOnce": _run_once,
    "Precondition": _precondition,
    "LoopInt": _loop,
    "LoopBool": _loop,
    "LoopDouble": _loop,
    "LoopString": _loop,
    "SkipUnlessUpdated": _skip_unless_updated,
    "WaitValueUpdate": _wait_value_update,
}
