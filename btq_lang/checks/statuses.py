"""The possible results of a node with a known flow, given those of its children.

One invariant: every status that the node returns in any version is included.  A set of statuses is a sum of
powers of two; a missing or surplus child can return anything.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from operator import and_, or_
from typing import Final

from btq_lang.catalog.kinds import Flow, NodeKind, Role
from btq_lang.syntax.tree import Node, Word
from btq_lang.workspace.node_names import copies, wraps

SUCCESS: Final = 1
FAILURE: Final = 2
SKIPPED: Final = 4
RUNNING: Final = 8
ANYTHING: Final = SUCCESS | FAILURE | SKIPPED | RUNNING


def of_kind(kind: NodeKind, node: Node, children: Sequence[int], starting: bool) -> int:
    """The statuses that a node can return.

    Args:
        node: that has the ports.
        children: the possible results of each child.
        starting: whether the sets are those of the tick that starts the node; else of any tick.
    """
    flow = kind.flow
    if flow in _LEAVES:
        return _LEAVES["answers" if copies(kind, node) else flow]
    if flow == "notices":
        return FAILURE if starting else SUCCESS | FAILURE
    if flow == "sleeps":
        return RUNNING if starting and _number(kind, node, "time") != 0 else SUCCESS | RUNNING
    if flow in GOES_ON:
        return _in_order(children, GOES_ON[flow], kind.pauses, starting)
    if flow in _DECORATORS:
        return _DECORATORS[flow](children[0] if len(children) == 1 else ANYTHING, starting, kind, node)
    if flow == "try" and len(children) > 1:
        tried = _in_order(children[:-1], SUCCESS, False, starting)
        return tried | _if(tried, FAILURE, children[-1] & RUNNING)
    return _CONTROLS[flow](children, kind, node) if flow in _CONTROLS and children else ANYTHING


def _number(kind: NodeKind, node: Node, role: Role) -> int | None:
    """The literal integer of a port; None if the value is anything else."""
    value = _port_value(kind, node, role)
    text = value.text if value is not None else ""
    return int(text) if text.removeprefix("-").isdecimal() and len(text) < 12 else None


def _port_value(kind: NodeKind, node: Node, role: Role) -> Word | None:
    port = kind.port_for(role)
    return node.attribute(port.name) if port is not None else None


def _in_order(children: Sequence[int], goes_on: int, pauses: bool, starting: bool) -> int:
    """The results of a node that ticks its children one after the other.

    Args:
        goes_on: the status after which it ticks the next child: SUCCESS for a sequence, FAILURE for a fallback.
        pauses: whether it returns RUNNING between two children that complete at once.
    """
    results = 0
    skipped = ANYTHING
    for index, child in enumerate(children):
        results |= child & (RUNNING | SUCCESS | FAILURE) & ~goes_on
        skipped &= child
        if pauses and child & goes_on and index + 1 < len(children):
            results |= RUNNING
            child &= ~goes_on if starting else ANYTHING
        if not child & (goes_on | SKIPPED):
            return results
    # Resumed at a child that was running and is now skipped, it has forgotten that earlier ones were skipped too.
    resumed = not starting and skipped & SKIPPED and any(child & RUNNING for child in children)
    passed = goes_on if resumed or any(child & goes_on for child in children) else 0
    return results | passed | (skipped & SKIPPED)


def _if(results: int, status: int, then: int) -> int:
    return then if results & status else 0


def _any_of(children: Sequence[int]) -> int:
    return reduce(or_, children, 0)


def _if_then_else(children: Sequence[int], *_: object) -> int:
    if len(children) not in (2, 3):
        return ANYTHING
    condition, then, otherwise = (*children, FAILURE)[:3]
    results = condition & RUNNING | _if(condition, SUCCESS, then) | _if(condition, FAILURE, otherwise)
    return results if not condition & SKIPPED else ANYTHING


def _parallel(children: Sequence[int], kind: NodeKind, node: Node) -> int:
    """The results of a Parallel: without thresholds all children must succeed, and one failure decides; with some, any
    completed child may decide."""
    results = _any_of(children)
    everyone = ANYTHING
    for child in children:
        everyone &= child | _if(child, SKIPPED, SUCCESS)
    if not results & (SUCCESS | FAILURE | SKIPPED):
        return results
    if any(_port_value(kind, node, role) is not None for role in ("successes", "failures")):
        return results | SUCCESS | FAILURE
    return (results & (FAILURE | RUNNING | SKIPPED)) | (everyone & SUCCESS)


def _rotate(children: Sequence[int], kind: NodeKind, node: Node) -> int:
    """The results of a node that takes the next child after a failure; unless it wraps, it fails after the last one."""
    results, last = _any_of(children), children[-1]
    without = _any_of(children[:-1]) | last & ~SUCCESS | _if(last, SUCCESS | SKIPPED, FAILURE)
    goes_round = wraps(kind, node)
    return results if goes_round else without if goes_round is False else results | without


def _again(child: int, repeats: int, count: int | None, starting: bool) -> int:
    """The results of a loop that repeats after SUCCESS or after FAILURE; a count of -1 is unlimited."""
    if count is not None and (count == 0 or count < -1):
        return repeats | SKIPPED
    if count == 1 or not child & repeats:
        return child
    results = child | RUNNING
    counted = not starting or child & SKIPPED  # a skipped child does not change the count
    return results if count is None or (count > 0 and counted) else results & ~repeats


def _otherwise(kind: NodeKind, node: Node) -> int:
    """The result that a node returns instead of its child's."""
    port, value = kind.port_for("otherwise"), _port_value(kind, node, "otherwise")
    text = value.text if value is not None else port.default if port is not None else None
    return _STATUSES.get(text or "", ANYTHING)


_STATUSES: Final = {"SUCCESS": SUCCESS, "FAILURE": FAILURE, "SKIPPED": SKIPPED, "RUNNING": RUNNING}
_LEAVES: Final[Mapping[Flow, int]] = {
    "succeeds": SUCCESS,
    "fails": FAILURE,
    "answers": SUCCESS | FAILURE,
    "waits": SUCCESS | FAILURE | RUNNING,
}
_DECORATORS: Final[Mapping[Flow, Callable[[int, bool, NodeKind, Node], int]]] = {
    "invert": lambda child, *_: (
        child & ~(SUCCESS | FAILURE) | _if(child, SUCCESS, FAILURE) | _if(child, FAILURE, SUCCESS)
    ),
    "force-success": lambda child, *_: child & ~FAILURE | _if(child, FAILURE, SUCCESS),
    "force-failure": lambda child, *_: child & ~SUCCESS | _if(child, SUCCESS, FAILURE),
    "until-failure": lambda child, *_: child & ~SUCCESS | _if(child, SUCCESS | SKIPPED, RUNNING),
    "repeat": lambda child, starting, kind, node: _again(child, SUCCESS, _number(kind, node, "count"), starting),
    "retry": lambda child, starting, kind, node: _again(child, FAILURE, _number(kind, node, "count"), starting),
    "timeout": lambda child, starting, *_: child | (0 if starting else _if(child, RUNNING, FAILURE)),
    "delay": lambda child, starting, kind, node: (
        RUNNING if starting and _number(kind, node, "time") != 0 else child | RUNNING
    ),
    # Once it has run it is skipped, or repeats a result that it had at any tick.
    "once": lambda child, _, __, node: child | (SKIPPED if node.attribute("then_skip") is None else ANYTHING),
    "precondition": lambda child, _, kind, node: child | _otherwise(kind, node),
    "for-each": lambda child, _, kind, node: child | RUNNING | _otherwise(kind, node),
    "skip-unless-updated": lambda child, *_: child | SKIPPED,
    "wait-until-updated": lambda child, *_: child | RUNNING,
    "pass": lambda child, *_: child,
    "throttle": lambda child, starting, *_: child | (0 if starting else RUNNING),
    "throttle-or-fail": lambda child, starting, *_: child | (FAILURE if starting else FAILURE | RUNNING),
    "pass-or-succeed": lambda child, *_: child | SUCCESS,
    "pass-once": lambda child, starting, *_: child if starting else child | FAILURE,
}
_CONTROLS: Final[Mapping[Flow, Callable[[Sequence[int], NodeKind, Node], int]]] = {
    "switch": lambda children, _, node: _any_of(children if node.attribute("variable") is not None else children[-1:]),
    "choice": _if_then_else,
    "parallel": _parallel,
    "parallel-all": _parallel,
    # It throws if a child is skipped.
    "together": lambda children, *_: _any_of(children) & (FAILURE | RUNNING) | reduce(and_, children) & SUCCESS,
    # Its index may be beyond its children.
    "resume": lambda children, *_: _any_of(children) & (FAILURE | RUNNING) | SUCCESS,
    "recover": lambda children, *_: (
        children[0] | _if(children[0], FAILURE, children[1] & RUNNING) if len(children) == 2 else ANYTHING
    ),
    "rotate": _rotate,
    "pause": lambda children, *_: _any_of(children) & FAILURE | RUNNING | _if(children[0], SUCCESS | SKIPPED, SUCCESS),
}
# The status of a child after which the next one is ticked.
GOES_ON: Final[Mapping[Flow, int]] = {"sequence": SUCCESS, "fallback": FAILURE, "pipeline": SUCCESS}
