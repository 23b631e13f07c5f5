"""How a program ticks its tree, and how time passes between two ticks.

Once a tick has left everything as it was, the ticks after it do the same until a timer goes off or the world changes,
so time jumps there.
"""

from __future__ import annotations

from collections.abc import Callable

from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, Machine
from btq_lang.simulator.ticking import check_rounds, execute_tick, halt_node, reset_status
from btq_lang.simulator.timers import NEVER, advance, next_due, next_passing
from btq_lang.workspace.project_driver import Driver


def tick_exactly_once(machine: Machine) -> int:
    """Tick the tree; its result.

    Raises:
        EngineError: as in the engine; nothing is reset then.
    """
    result = execute_tick(machine, machine.root)
    if result in (SUCCESS, FAILURE):
        reset_status(machine, machine.root)
    return result


def tick_once(machine: Machine) -> int:
    """Tick the tree, and again at once while it runs and a node asks for that; its result.

    Raises:
        EngineError: as in the engine; nothing is reset then.
        NotModelled: nodes ask very often; the engine may never return.
    """
    result = execute_tick(machine, machine.root)
    rounds = 0
    while result == RUNNING and machine.is_woken:
        check_rounds(machine.waker, rounds := rounds + 1)
        machine.is_woken = False
        result = execute_tick(machine, machine.root)
    if result in (SUCCESS, FAILURE):
        reset_status(machine, machine.root)
    return result


def tick_of(driver: Driver) -> Callable[[Machine], int]:
    """The function with which a program ticks its tree."""
    return tick_exactly_once if driver.function == "tick_exactly_once" else tick_once


def halt_tree(machine: Machine) -> None:
    """Halt the root, and then each node, running or not."""
    for node in (machine.root, *machine.nodes):
        halt_node(machine, node)
        if machine.dialect.is_old:
            reset_status(machine, node)
    reset_status(machine, machine.root)


def drive(machine: Machine, driver: Driver, limit: int, is_over: Callable[[], bool] = lambda: False) -> int:
    """Tick the tree until it has ended; its result, or RUNNING if it never ends, or not within a limit.

    Args:
        limit: in milliseconds.
        is_over: called before and after each tick, when time has passed; whether the program ticks no more.

    Raises:
        EngineError: as in the engine.
    """
    tick = tick_of(driver)
    before: object = None
    while not is_over():
        result = tick(machine)
        if result != RUNNING:
            return result
        if is_over() or machine.now >= limit:
            break
        after = machine.state()
        if after != before:
            before = after
            until = machine.now + driver.period
        else:
            before = None
            changes = machine.program.next_change(machine.now), next_passing(machine), next_due(machine)
            later = [time for time in changes if time != NEVER]
            if not later:
                break
            until = driver.tick_after(machine.now, min(later))
        _sleep(machine, until, driver.is_woken)
    return RUNNING


def _sleep(machine: Machine, until: int, is_woken: bool) -> None:
    """Let time pass until a time.

    Args:
        is_woken: a timer ends the sleep that has a node ask to be ticked, which the next tick answers.
    """
    if not is_woken:
        advance(machine, until)
        return
    while machine.now < until and not machine.is_woken:
        due = next_due(machine)
        advance(machine, min(due, until) if due != NEVER else until)
    machine.is_woken = False
