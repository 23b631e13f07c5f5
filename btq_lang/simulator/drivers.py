"""How a program ticks its tree."""

from __future__ import annotations

from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, Machine
from btq_lang.simulator.ticking import execute_tick, halt_node, reset_status


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
    """
    result = execute_tick(machine, machine.root)
    while result == RUNNING and machine.is_woken:
        machine.is_woken = False
        result = execute_tick(machine, machine.root)
    if result in (SUCCESS, FAILURE):
        reset_status(machine, machine.root)
    return result


def halt_tree(machine: Machine) -> None:
    """Halt the root, and then each node, running or not."""
    halt_node(machine, machine.root)
    for node in machine.nodes:
        halt_node(machine, node)
    reset_status(machine, machine.root)
