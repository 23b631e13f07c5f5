"""Nodes that wait, and the time of a simulated program, in milliseconds since its start.

Between two ticks the timers that are due go off in the order of their times.  Source: facts about BehaviorTree.CPP 4.6
to 4.10, seen in runs of the engine.
"""

from __future__ import annotations

from typing import Final

from btq_lang.simulator.errors import EngineError
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import read_whole
from btq_lang.simulator.ticking import execute_tick, halt_children, reset_child, reset_status, set_status

NEVER: Final = -1


def tick_timeout(machine: Machine, node: SimulatedNode) -> int:
    """The child; FAILURE in the tick after the timer halted it."""
    limit = _milliseconds(node, "msec", "TimeoutNode")
    if not node.is_on:
        node.is_on = True
        set_status(machine, node, RUNNING)
        node.has_fired = False
        if limit > 0:
            node.due = machine.now + limit
    if node.has_fired:
        node.is_on = False
        return FAILURE
    result = execute_tick(machine, node.child)
    if result in (SUCCESS, FAILURE):
        node.is_on = False
        node.due = NEVER
        reset_child(machine, node.child)
    return result


def tick_delay(machine: Machine, node: SimulatedNode) -> int:
    """The child, from the first tick after a time has passed."""
    wait = _milliseconds(node, "delay_msec", "DelayNode")
    if not node.is_on:
        node.is_on = True
        node.has_fired = False
        set_status(machine, node, RUNNING)
        node.due = machine.now + wait
    if not node.has_fired:
        return RUNNING
    result = execute_tick(machine, node.child)
    if result in (SUCCESS, FAILURE):
        node.is_on = False
        reset_child(machine, node.child)
    return result


def tick_sleep(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS after a time."""
    if node.status == IDLE:
        wait = _milliseconds(node, "msec", "SleepNode")
        if wait == 0:
            return SUCCESS
        node.has_fired = False
        node.due = machine.now + wait
        return RUNNING
    if node.status != RUNNING:
        return node.status
    return SUCCESS if node.has_fired else RUNNING


def _milliseconds(node: SimulatedNode, port: str, class_name: str) -> int:
    number = read_whole(node, port)
    if number is None or number < 0:
        raise EngineError(f"Missing parameter [{port}] in {class_name}")
    return number


def halt_timed(machine: Machine, node: SimulatedNode) -> None:
    """Stop the timer of a decorator, and halt it."""
    node.is_on = False
    node.due = NEVER
    halt_children(machine, node)


def halt_sleep(machine: Machine, node: SimulatedNode) -> None:
    """Stop the timer."""
    node.due = NEVER
    reset_status(machine, node)


def after(machine: Machine, seconds: float) -> int:
    """The first millisecond at which so many seconds from now have passed."""
    wait = max(min(ENDLESS, seconds * 1_000), 0.0)
    whole = round(wait)
    return machine.now + whole + (whole / 1_000 < seconds and wait < ENDLESS)


def has_passed(machine: Machine, node: SimulatedNode) -> bool:
    """Whether the time has passed for which a node waits; it has if the node never began to wait."""
    return node.due <= machine.now if machine.passed is None else machine.passed(node)


def next_due(machine: Machine) -> int:
    """When the next timer goes off; `NEVER` if none runs."""
    return min([node.due for node in machine.timed if node.due != NEVER], default=NEVER)


def next_passing(machine: Machine) -> int:
    """When the next time has passed for which a node waits; `NEVER` if none waits."""
    return min([node.due for node in machine.watching if machine.now < node.due < ENDLESS], default=NEVER)


def advance(machine: Machine, now: int) -> None:
    """Let time pass until `now`."""
    while NEVER != (due := next_due(machine)) <= now:
        machine.now = due
        for node in machine.timed:
            if node.due == due:
                fire(machine, node)
    machine.now = now


def fire(machine: Machine, node: SimulatedNode) -> None:
    """What a timer does when it goes off: that of a Timeout, nothing unless the child runs."""
    node.due = NEVER
    if node.rules.flow is not tick_timeout:
        node.has_fired = True
    elif node.child.status == RUNNING:
        node.has_fired = True
        reset_child(machine, node.child)
    else:
        return
    machine.wake(node)


ENDLESS: Final = 1e15  # milliseconds
