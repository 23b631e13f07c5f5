"""What BehaviorTree.CPP 3.8 does that version 4 does not, or does otherwise.

Source: facts about BehaviorTree.CPP 3.8.7, read in its sources and seen in runs of it with the nodes of Nav2.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from btq_lang.simulator.blackboard import BOOL, DOUBLE, STRING, Board, Unknown, Value, parsed
from btq_lang.simulator.errors import EngineError
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import key_of, read, read_status, read_whole
from btq_lang.simulator.scripts import EPSILON, text_of
from btq_lang.simulator.ticking import execute_tick, reset_child, reset_children, set_status


def tick_parallel(machine: Machine, node: SimulatedNode) -> int:
    """All children that have not ended, until enough of them have succeeded or failed."""
    size = len(node.children)
    needed, allowed = _threshold(node, "success_threshold"), _threshold(node, "failure_threshold", 1)
    for number, what in ((needed, "succeed"), (allowed, "fail")):
        if not 0 <= number <= size:
            raise EngineError(f"Number of children is less than threshold. Can never {what}.")
    successes = failures = 0
    for position, child in enumerate(node.children):
        result = child.status if position in node.completed else execute_tick(machine, child)
        if result == RUNNING:
            continue
        node.completed |= {position}
        successes += result == SUCCESS
        failures += result == FAILURE
        if result == SUCCESS and successes == needed:
            break
        if result == FAILURE and (failures > size - needed or failures == allowed):
            break
    else:
        return RUNNING
    node.completed = frozenset()
    reset_children(machine, node)
    return result


def _threshold(node: SimulatedNode, port: str, default: int | None = None) -> int:
    """How many children: a negative number counts from all."""
    number = read_whole(node, port) if port in node.ports else default
    if number is None:
        raise EngineError(f"Missing parameter [{port}] in ParallelNode")
    return number if number >= 0 else len(node.children) + number + 1


def tick_blackboard_check(machine: Machine, node: SimulatedNode) -> int:
    """The child while two values are the same."""
    set_status(machine, node, RUNNING)
    first, second = _compared(node, "value_A"), _compared(node, "value_B")
    if first is not None and second is not None and _is_same(first, second):
        return execute_tick(machine, node.child)
    if node.child.status == RUNNING:
        reset_child(machine, node.child)
    otherwise = read_status(node, "return_on_mismatch")
    return FAILURE if otherwise is None else otherwise


def _compared(node: SimulatedNode, port: str) -> Value | None:
    """The value at a port in the type that the node compares; None: there is none."""
    value, type_ = read(node, port), _COMPARED[node.id]
    if value is None or type_ == STRING or isinstance(value, Unknown):
        return value
    try:
        return parsed(text_of(value), type_)
    except EngineError:
        return None


def _is_same(first: Value, second: Value) -> bool:
    if isinstance(first, Unknown):
        return first.compared("==", second)
    if isinstance(second, Unknown):
        return second.compared("==", first)
    if isinstance(first, float) and isinstance(second, float):
        return abs(first - second) <= EPSILON
    return first == second


def inner_board(tag: str, values: Mapping[str, str], board: Board) -> Board:
    """The blackboard of a SubTree, whose ports are names of entries, or of a SubTreePlus."""
    if tag == SUBTREE:
        if _is_true(values, "__shared_blackboard"):
            return board
        inner = Board(board)
        inner.remapped.update(values)
        return inner
    inner = Board(board, _is_true(values, "__autoremap"))
    for port, value in values.items():
        if (key := key_of(value, port)) is not None:
            inner.remapped[port] = key
        elif port not in ("ID", "name", "__autoremap"):
            inner.define(port, value, "")
    return inner


def _is_true(values: Mapping[str, str], attribute: str) -> bool:
    return parsed(values.get(attribute, "false"), BOOL) == 1


SUBTREE: Final = "SubTree"
SUBTREES: Final = (SUBTREE, "SubTreePlus")
_COMPARED: Final = {
    "BlackboardCheckInt": "int",
    "BlackboardCheckDouble": DOUBLE,
    "BlackboardCheckString": STRING,
    "BlackboardCheckBool": BOOL,
}
