"""The possible results of a node of which it is known what it does, given those of its children.

One invariant: every status that the node returns in any version is included.  A set of statuses is a sum of
powers of two; a missing or surplus child can return anything.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from btq_lang.catalog.kinds import Flow, NodeKind, Role
from btq_lang.syntax.tree import Node, Word
from btq_lang.workspace.node_names import wraps

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
        return _LEAVES[flow]
    if flow == "notices":
        return FAILURE if starting else SUCCESS | FAILURE
    if flow == "sleeps":
        return RUNNING if starting and _number(kind, node, "time") != 0 else SUCCESS | RUNNING
    if flow in GOES_ON:
        return _in_order(children, GOES_ON[flow], kind.pauses, starting)
    decorated = _decorated(kind, node, children[0] if len(children) == 1 else ANYTHING, starting)
    if decorated is not None:
        return decorated
    if flow == "switch" and children:
        return _any_of(children if node.attribute("variable") is not None else children[-1:])
    if flow == "choice" and len(children) in (2, 3):
        return _if_then_else(children)
    if flow == "try" and len(children) > 1:
        tried = _in_order(children[:-1], SUCCESS, False, starting)
        return tried | (children[-1] & RUNNING if tried & FAILURE else 0)
    if flow in ("parallel", "parallel-all") and children:
        return _parallel(kind, node, children)
    return _of_library(kind, node, children) if children else ANYTHING


def _number(kind: NodeKind, node: Node, role: Role) -> int | None:
    """The literal integer of the port; None if that is not an integer."""
    value = _written(kind, node, role)
    text = value.text if value is not None else ""
    return int(text) if text.removeprefix("-").isdecimal() and len(text) < 12 else None


def _written(kind: NodeKind, node: Node, role: Role) -> Word | None:
    port = kind.port_for(role)
    return node.attribute(port.name) if port is not None else None


def _in_order(children: Sequence[int], goes_on: int, pauses: bool, starting: bool) -> int:
    """A sequence goes on after SUCCESS, a fallback after FAILURE.

    `pauses`: whether it returns RUNNING between two children that complete at once.
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
    # Resumed at a child that was running and is now skipped, it has forgotten that earlier ones were skipped too.
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


def _parallel(kind: NodeKind, node: Node, children: Sequence[int]) -> int:
    """Without thresholds all must succeed and one may fail; with some, any completed child may decide."""
    found = _any_of(children)
    everyone = ANYTHING
    for child in children:
        everyone &= child | (SUCCESS if child & SKIPPED else 0)
    if not found & (SUCCESS | FAILURE | SKIPPED):
        return found
    if any(_written(kind, node, role) is not None for role in ("successes", "failures")):
        return found | SUCCESS | FAILURE
    succeeds = SUCCESS if everyone & SUCCESS else 0
    return (found & (FAILURE | RUNNING)) | succeeds | (SKIPPED if found & SKIPPED else 0)


def _of_library(kind: NodeKind, node: Node, children: Sequence[int]) -> int:
    """The statuses of a control node of a library."""
    found = _any_of(children)
    first, last = children[0], children[-1]
    match kind.flow:
        case "together":  # it throws if a child is skipped
            everyone = SUCCESS if all(child & SUCCESS for child in children) else 0
            return found & (FAILURE | RUNNING) | everyone
        case "resume":  # its index may be beyond its children
            return found & (FAILURE | RUNNING) | SUCCESS
        case "recover" if len(children) == 2:
            return first | (last & RUNNING if first & FAILURE else 0)
        case "rotate":
            ends = FAILURE if last & (SUCCESS | SKIPPED) else 0
            without = _any_of(children[:-1]) | last & ~SUCCESS | ends
            does = wraps(kind, node)
            return found if does else without if does is False else found | without
        case "pause":
            return found & (FAILURE | RUNNING) | RUNNING | (SUCCESS if first & (SUCCESS | SKIPPED) else 0)
    return ANYTHING


def _decorated(kind: NodeKind, node: Node, child: int, starting: bool) -> int | None:
    """The statuses of a decorator; None for another flow."""
    match kind.flow:
        case "invert":
            found = child & ~(SUCCESS | FAILURE)
            return found | (FAILURE if child & SUCCESS else 0) | (SUCCESS if child & FAILURE else 0)
        case "force-success":
            return child & ~FAILURE | (SUCCESS if child & FAILURE else 0)
        case "force-failure":
            return child & ~SUCCESS | (FAILURE if child & SUCCESS else 0)
        case "until-failure":
            return child & ~SUCCESS | (RUNNING if child & (SUCCESS | SKIPPED) else 0)
        case "repeat":
            return _again(child, SUCCESS, _number(kind, node, "count"), starting)
        case "retry":
            return _again(child, FAILURE, _number(kind, node, "count"), starting)
        case "timeout":
            return child | (FAILURE if child & RUNNING and not starting else 0)
        case "delay":
            return RUNNING if starting and _number(kind, node, "time") != 0 else child | RUNNING
        case "once":  # once it has run it is skipped, or repeats a result that it had at any tick
            return child | (SKIPPED if node.attribute("then_skip") is None else ANYTHING)
        case "precondition":
            return child | _otherwise(kind, node)
        case "for-each":
            return child | RUNNING | _otherwise(kind, node)
        case "skip-unless-updated":
            return child | SKIPPED
        case "wait-until-updated":
            return child | RUNNING
        case "pass":
            return child
        case "throttle" | "throttle-or-fail":
            fails = FAILURE if kind.flow == "throttle-or-fail" else 0
            return child | fails | (0 if starting else RUNNING)
        case "pass-or-succeed":
            return child | SUCCESS
        case "pass-once":
            return child if starting else child | FAILURE
    return None


def _again(child: int, repeats: int, count: int | None, starting: bool) -> int:
    """It repeats after SUCCESS or after FAILURE; a count of -1 is unlimited."""
    if count is not None and (count == 0 or count < -1):
        return repeats | SKIPPED
    if count == 1 or not child & repeats:
        return child
    found = child | RUNNING
    counted = not starting or child & SKIPPED  # a skipped child does not change the count
    return found if count is None or (count > 0 and counted) else found & ~repeats


def _otherwise(kind: NodeKind, node: Node) -> int:
    """The result without its child."""
    port, value = kind.port_for("otherwise"), _written(kind, node, "otherwise")
    text = value.text if value is not None else port.default if port is not None else None
    return _STATUSES.get(text or "", ANYTHING)


_STATUSES: Final = {"SUCCESS": SUCCESS, "FAILURE": FAILURE, "SKIPPED": SKIPPED, "RUNNING": RUNNING}
_LEAVES: Final[Mapping[Flow, int]] = {
    "succeeds": SUCCESS,
    "fails": FAILURE,
    "answers": SUCCESS | FAILURE,
    "waits": SUCCESS | FAILURE | RUNNING,
}
# The status of a child after which the next one is ticked.
GOES_ON: Final[Mapping[Flow, int]] = {"sequence": SUCCESS, "fallback": FAILURE, "pipeline": SUCCESS}
