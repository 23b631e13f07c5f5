"""One tick of a node: its conditions, what it does by its kind, its scripts; and how a node is halted.

Source: facts about BehaviorTree.CPP 4.6 to 4.10, seen in runs of the engine.
"""

from __future__ import annotations

from typing import Final

from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.scripts import holds, run_script


def execute_tick(machine: Machine, node: SimulatedNode) -> int:
    """Tick a node; its result, which is its status afterwards unless it is SKIPPED."""
    return tick_itself(machine, node) if machine.recall is None else machine.recall(node)


def tick_itself(machine: Machine, node: SimulatedNode, goes_on: bool = False) -> int:
    """Tick a node, whatever is remembered of it; its result.

    Args:
        goes_on: its tick has begun and is continued, so that its conditions are not asked.
    """
    try:
        result = _by_condition(machine, node) if node.conditions and not goes_on else IDLE
        if result == IDLE:
            try:
                result = node.rules.flow(machine, node)
            except EngineError as error:
                if error.is_wrapped or not machine.dialect.names_thrower:
                    raise
                raise EngineError(f"Exception in node '{node.path}' [{node.id}]: {error}", is_wrapped=True) from None
        if node.scripts and result in (SUCCESS, FAILURE):
            _run(machine, node, "_onSuccess" if result == SUCCESS else "_onFailure")
            _run(machine, node, "_post")
    except NotModelled as error:
        error.uid = error.uid or node.uid
        raise
    if result != SKIPPED:
        set_status(machine, node, result)
    else:
        machine.skipped.add(node.uid)
    if node.rules.is_decorator and node.child.status in (SUCCESS, FAILURE):
        reset_status(machine, node.child)
    return result


def _by_condition(machine: Machine, node: SimulatedNode) -> int:
    """The result on which a condition decides; IDLE if none does."""
    for name, script in node.conditions:
        if node.status == IDLE:
            is_true = holds(script, node.board, machine.dialect.has_real_truth)
            if is_true != (name == "_while"):
                return _DECIDES[name]
        elif (
            node.status == RUNNING
            and name == "_while"
            and not holds(script, node.board, machine.dialect.has_real_truth)
        ):
            halt_node(machine, node)
            return SKIPPED
    return IDLE


def _run(machine: Machine, node: SimulatedNode, name: str) -> None:
    script = node.scripts.get(name)
    if script is not None:
        run_script(script, node.board, machine.dialect.has_real_truth)


def set_status(machine: Machine, node: SimulatedNode, status: int) -> None:
    """Give a node a status.

    Raises:
        EngineError: the status is IDLE.
    """
    if status == IDLE:
        raise EngineError(
            f"Node [{node.name}]: you are not allowed to set manually the status to IDLE. "
            "If you know what you are doing (?) use resetStatus() instead."
        )
    before = node.status
    if before != status:
        node.status = status
        machine.changes(node, before, status)


def reset_status(machine: Machine, node: SimulatedNode) -> None:
    """Make a node IDLE; it keeps what it remembers."""
    before = node.status
    if before != IDLE:
        node.status = IDLE
        machine.changes(node, before, IDLE)


def halt_node(machine: Machine, node: SimulatedNode) -> None:
    """Halt a node, whatever its status, and run its `_onHalted`."""
    node.rules.halt(machine, node)
    _run(machine, node, "_onHalted")


def reset_child(machine: Machine, child: SimulatedNode) -> None:
    """Halt a child if it runs, and make it IDLE."""
    if child.status == RUNNING:
        halt_node(machine, child)
    reset_status(machine, child)


def reset_children(machine: Machine, node: SimulatedNode) -> None:
    """Halt those children that run, and make all of them IDLE, in order."""
    for child in node.children:
        reset_child(machine, child)


def check_rounds(node: SimulatedNode, rounds: int) -> None:
    """See that a node which goes on within a tick comes to an end.

    Raises:
        NotModelled: it has gone on very often; the engine may never return.
    """
    if rounds > _MOST_ROUNDS:
        raise NotModelled(f"{node.path} goes on without an end in one tick")


def halt_children(machine: Machine, node: SimulatedNode) -> None:
    """Halt a node with children and without memory that a halt clears."""
    reset_children(machine, node)
    if not machine.dialect.is_old:  # there only its parent does that
        reset_status(machine, node)


_MOST_ROUNDS: Final = 10_000
_DECIDES: Final = {"_failureIf": FAILURE, "_successIf": SUCCESS, "_skipIf": SKIPPED, "_while": SKIPPED}
