"""The engine's own leaves, and those of a program.

Source: facts about BehaviorTree.CPP 4.6 to 4.10, seen in runs of the engine.
"""

from __future__ import annotations

from btq_lang.simulator.blackboard import STRING, UNTYPED, Value, parsed, type_of
from btq_lang.simulator.decorators import sees_update
from btq_lang.simulator.errors import EngineError
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import key_of, read_text
from btq_lang.simulator.scripts import holds, run_script
from btq_lang.simulator.ticking import reset_status


def tick_always_success(machine: Machine, node: SimulatedNode) -> int:
    return SUCCESS


def tick_always_failure(machine: Machine, node: SimulatedNode) -> int:
    return FAILURE


def tick_script(machine: Machine, node: SimulatedNode) -> int:
    """Run the script."""
    run_script(node.scripts["code"], node.board, machine.dialect.has_real_truth)
    return SUCCESS


def tick_script_condition(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS if the script is true."""
    return SUCCESS if holds(node.scripts["code"], node.board, machine.dialect.has_real_truth) else FAILURE


def tick_was_entry_updated(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS if the entry was written since the last time."""
    return SUCCESS if sees_update(node) else FAILURE


def tick_unset_blackboard(machine: Machine, node: SimulatedNode) -> int:
    """Remove an entry of the tree's own."""
    key = read_text(node, "key")
    if key is None:
        raise EngineError("missing input port [key]")
    node.board.unset(key)
    return SUCCESS


def tick_set_blackboard(machine: Machine, node: SimulatedNode) -> int:
    """Write a literal, or copy an entry."""
    key = read_text(node, "output_key")
    if key is None:
        raise EngineError("missing port [output_key]")
    written = node.ports["value"]
    source_key = key_of(written, "value")
    target = node.board.entry(key)
    if source_key is None:
        value: Value | None = written
        type_ = STRING
    else:
        source = node.board.entry(source_key)
        if source is None:
            raise EngineError("Can't find the port referred by [value]")
        if target is None:
            target = node.board.create(key, source.type)
        value, type_ = source.value, source.type or type_of(source.value)
    if not machine.dialect.counts_copies:  # up to 4.6
        if source_key is None or target is None:
            node.board.write(key, written, STRING)
        else:
            target.value = value
        return SUCCESS
    if value is None:
        return FAILURE
    if target is not None and isinstance(value, str) and target.type not in (UNTYPED, STRING):
        try:
            value = parsed(value, target.type)
        except EngineError as error:
            raise EngineError(f"Can't convert string [{value}] to type [{target.type}]: {error}") from None
        type_ = target.type
    node.board.replace(key, value, type_)
    return SUCCESS


def tick_custom(machine: Machine, node: SimulatedNode) -> int:
    """A leaf of the program: an action that has ended and was not reset keeps its result."""
    if node.status in (SUCCESS, FAILURE) and node.rules.is_stateful:
        return node.status
    return machine.program.tick(node)


def halt_leaf(machine: Machine, node: SimulatedNode) -> None:
    """Halt a leaf."""
    if node.status == RUNNING:
        machine.program.halt(node)
    reset_status(machine, node)
