"""What each control node does with its children.

Source: facts about BehaviorTree.CPP 4.6 to 4.10, seen in runs of the engine.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.simulator.blackboard import Unknown
from btq_lang.simulator.errors import EngineError
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import read, read_text, read_truth, read_whole
from btq_lang.simulator.scripts import EPSILON, NUMBER
from btq_lang.simulator.ticking import (
    execute_tick,
    halt_children,
    halt_node,
    reset_child,
    reset_children,
    set_status,
)
from btq_lang.simulator.versions import Dialect

# ---- one child after the other ----


def tick_sequence(machine: Machine, node: SimulatedNode) -> int:
    """Sequence and AsyncSequence: until a child fails."""
    return _in_order(machine, node, FAILURE, SUCCESS)


def tick_fallback(machine: Machine, node: SimulatedNode) -> int:
    """Fallback and AsyncFallback: until a child succeeds."""
    return _in_order(machine, node, SUCCESS, FAILURE)


def tick_sequence_with_memory(machine: Machine, node: SimulatedNode) -> int:
    """As a Sequence, but goes on at the child that failed or was halted."""
    return _in_order(machine, node, FAILURE, SUCCESS, keeps_place=True)


def _in_order(machine: Machine, node: SimulatedNode, ends: int, goes_on: int, keeps_place: bool = False) -> int:
    """Tick children in order until one has the result `ends`; those before it had the result `goes_on`.

    Args:
        keeps_place: it begins again at the child that ended it, and resets only that one and later ones.
    """
    if node.status == IDLE:
        node.skipped = 0
        node.is_on = True  # all results so far were skips, for versions that do not count them
    set_status(machine, node, RUNNING)
    while node.index < len(node.children):
        child = node.children[node.index]
        before = child.status
        result = execute_tick(machine, child)
        if result != SKIPPED:
            node.is_on = False
        if result == RUNNING:
            return RUNNING
        if result == ends:
            for later in node.children[node.index if keeps_place else 0 :]:
                reset_child(machine, later)
            node.index = node.index if keeps_place else 0
            return ends
        node.index += 1
        if result == SKIPPED:
            node.skipped += 1
        elif node.rules.yields and before == IDLE and node.index < len(node.children):
            machine.wake(node)
            return RUNNING
    all_skipped = node.skipped == len(node.children) if machine.dialect.counts_skips else node.is_on
    reset_children(machine, node)
    node.index = 0
    node.skipped = 0
    return SKIPPED if all_skipped else goes_on


def tick_reactive_sequence(machine: Machine, node: SimulatedNode) -> int:
    """All children from the first at every tick, until one fails or runs."""
    return _reactive(machine, node, FAILURE, SUCCESS)


def tick_reactive_fallback(machine: Machine, node: SimulatedNode) -> int:
    """All children from the first at every tick, until one succeeds or runs."""
    return _reactive(machine, node, SUCCESS, FAILURE)


def _reactive(machine: Machine, node: SimulatedNode, ends: int, goes_on: int) -> int:
    set_status(machine, node, RUNNING)
    all_skipped = True
    for child in node.children:
        result = execute_tick(machine, child)
        if result == SKIPPED:
            reset_child(machine, child)
            continue
        all_skipped = False
        if result == RUNNING:
            for other in node.children:
                if other is not child:
                    reset_child(machine, other)
            return RUNNING
        if result == ends:
            reset_children(machine, node)
            return ends
    reset_children(machine, node)
    return SKIPPED if all_skipped else goes_on


# ---- all children ----


def tick_parallel(machine: Machine, node: SimulatedNode) -> int:
    """All children that have not ended, until enough of them have succeeded or failed."""
    size = len(node.children)
    written = _threshold(node, "success_count")
    needed = written if written >= 0 else max(size + written + 1, 0)
    failures = _threshold(node, "failure_count")
    allowed = failures if failures >= 0 else max(size + failures + 1, 0)
    for number, what in ((needed, "succeed"), (allowed, "fail")):
        if size < number:
            raise EngineError(f"Number of children is less than threshold. Can never {what}.")
    set_status(machine, node, RUNNING)
    skipped = 0
    for position, child in enumerate(node.children):
        if position not in node.completed:
            result = execute_tick(machine, child)
            if result == SKIPPED:
                skipped += 1
            elif result != RUNNING:
                node.completed |= {position}
                node.count += result == FAILURE
        successes = len(node.completed) - node.count
        if successes >= needed or (written < 0 and successes + skipped >= needed):
            _forget(node)
            reset_children(machine, node)
            return SUCCESS
        if size - node.count < needed or node.count == allowed:
            _forget(node)
            reset_children(machine, node)
            return FAILURE
    return SKIPPED if skipped == size else RUNNING


def _threshold(node: SimulatedNode, port: str) -> int:
    number = read_whole(node, port)
    if number is None:
        raise EngineError(f"Missing parameter [{port}] in ParallelNode")
    return number


def tick_parallel_all(machine: Machine, node: SimulatedNode) -> int:
    """All children that have not ended, until all have."""
    size = len(node.children)
    written = _threshold(node, "max_failures")
    allowed = written if written >= 0 else max(size + written + 1, 0)
    if size < allowed:
        raise EngineError("Number of children is less than threshold. Can never fail.")
    set_status(machine, node, RUNNING)
    skipped = 0
    for position, child in enumerate(node.children):
        if position in node.completed:
            continue
        result = execute_tick(machine, child)
        if result == SKIPPED:
            skipped += 1
        elif result != RUNNING:
            node.completed |= {position}
            node.count += result == FAILURE
    if skipped == size:
        return SKIPPED
    if skipped + len(node.completed) < size:
        return RUNNING
    reset_children(machine, node)
    result = FAILURE if node.count >= allowed else SUCCESS
    _forget(node)
    return result


def _forget(node: SimulatedNode) -> None:
    node.completed = frozenset()
    node.count = 0


def halt_parallel(machine: Machine, node: SimulatedNode) -> None:
    """Forget which children have ended."""
    _forget(node)
    halt_children(machine, node)


# ---- branches ----


def tick_if_then_else(machine: Machine, node: SimulatedNode) -> int:
    """A condition, and then one of two branches, which is kept while it runs."""
    _check_branches(node, "IfThenElseNode")
    set_status(machine, node, RUNNING)
    if node.index == 0:
        condition = execute_tick(machine, node.children[0])
        if condition == RUNNING:
            return RUNNING
        if condition == FAILURE and len(node.children) == 2:
            return FAILURE  # the condition keeps its status
        if condition == SKIPPED:
            raise EngineError("Something unexpected happened in IfThenElseNode")
        node.index = 1 if condition == SUCCESS else 2
    result = execute_tick(machine, node.children[node.index])
    if result != RUNNING:
        reset_children(machine, node)
        node.index = 0
    return result


def tick_while_do_else(machine: Machine, node: SimulatedNode) -> int:
    """A condition at every tick, and one of two branches."""
    if machine.dialect.is_old and len(node.children) != 3:
        raise EngineError("WhileDoElse must have 3 children")
    _check_branches(node, "WhileDoElseNode")
    set_status(machine, node, RUNNING)
    condition = execute_tick(machine, node.children[0])
    if condition == RUNNING:
        return RUNNING
    has_else = len(node.children) == 3
    result = IDLE
    if condition == SUCCESS:
        if has_else:
            reset_child(machine, node.children[2])
        result = execute_tick(machine, node.children[1])
    elif condition == FAILURE:
        result = FAILURE
        if has_else:
            reset_child(machine, node.children[1])
            result = execute_tick(machine, node.children[2])
    if result != RUNNING:
        reset_children(machine, node)
    return result


def _check_branches(node: SimulatedNode, class_name: str) -> None:
    if len(node.children) not in (2, 3):
        raise EngineError(f"{class_name} must have either 2 or 3 children")


def tick_switch(machine: Machine, node: SimulatedNode) -> int:
    """The child of the case that the variable has, chosen at every tick."""
    cases = len(BUILTINS[node.id].ports) - 1
    if len(node.children) != cases + 1:
        raise EngineError("Wrong number of children in SwitchNode; must be (num_cases + default)")
    variable = _variable(node)
    chosen = cases
    for position in range(cases) if variable is not None else ():
        case = read_text(node, f"case_{position + 1}")
        if case is not None and variable is not None and _is_case(variable, case, machine.dialect):
            chosen = position
            break
    if node.index not in (0, chosen + 1):
        reset_child(machine, node.children[node.index - 1])
    result = execute_tick(machine, node.children[chosen])
    if result == RUNNING:
        node.index = chosen + 1
        return RUNNING
    node.index = 0
    if result != SKIPPED:
        reset_children(machine, node)
    return result


def _variable(node: SimulatedNode) -> str | Unknown | None:
    """What a Switch compares with its cases."""
    value = read(node, "variable")
    return value if isinstance(value, Unknown) else read_text(node, "variable")


def _as_whole(text: str, matches_prefixes: bool) -> float | None:
    match = (_WHOLE.match if matches_prefixes else _WHOLE.fullmatch)(text)
    return float(match[0]) if match is not None else None


def _as_real(text: str, matches_prefixes: bool) -> float | None:
    match = (NUMBER.match if matches_prefixes else NUMBER.fullmatch)(text)
    return float(match[0]) if match is not None else None


def _is_case(variable: str | Unknown, case: str, dialect: Dialect) -> bool:
    """Whether two texts are equal, or, since version 4, the same number."""
    if isinstance(variable, Unknown):
        return variable.compared("==", case)
    if variable == case or dialect.is_old:
        return variable == case
    for number, tolerance in ((_as_whole, 0.0), (_as_real, EPSILON)):
        first, second = number(variable, dialect.matches_prefixes), number(case, dialect.matches_prefixes)
        if first is not None and second is not None and abs(first - second) <= tolerance:
            return True
    return False


def tick_try_catch(machine: Machine, node: SimulatedNode) -> int:
    """All children but the last as a Sequence; the last if one of them fails."""
    size = len(node.children)
    if size < 2:
        raise EngineError(f"[{node.name}]: TryCatch requires at least 2 children")
    if node.status == IDLE:
        node.skipped = 0
        node.is_on = False
    set_status(machine, node, RUNNING)
    while not node.is_on and node.index < size - 1:
        result = execute_tick(machine, node.children[node.index])
        if result == RUNNING:
            return RUNNING
        if result == FAILURE:
            reset_children(machine, node)
            node.index = 0
            node.is_on = True
        else:
            node.index += 1
            node.skipped += result == SKIPPED
    if node.is_on:
        if execute_tick(machine, node.children[-1]) == RUNNING:
            return RUNNING
        reset_children(machine, node)
        node.index = 0
        node.is_on = False
        return FAILURE
    all_skipped = node.skipped == size - 1
    reset_children(machine, node)
    node.index = 0
    node.skipped = 0
    return SKIPPED if all_skipped else SUCCESS


# ---- halts ----


def halt_in_order(machine: Machine, node: SimulatedNode) -> None:
    """Begin with the first child again."""
    node.index = 0
    node.skipped = 0
    halt_children(machine, node)


def halt_try_catch(machine: Machine, node: SimulatedNode) -> None:
    """Tick the last child once if that is wanted, and forget where it was."""
    if read_truth(node, "catch_on_halt") and node.status != IDLE and not node.is_on:
        for child in node.children[:-1]:
            reset_child(machine, child)
        last = node.children[-1]
        execute_tick(machine, last)
        if last.status == RUNNING:
            halt_node(machine, last)
    node.index = 0
    node.skipped = 0
    node.is_on = False
    halt_children(machine, node)


_WHOLE: Final = re.compile(r"-?\d+")
