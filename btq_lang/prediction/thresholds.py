"""With which values the signals of a world are compared: what is read must be looked at when it reaches one of them.

One invariant: a use of a signal that is not understood makes it be looked at whenever it may have changed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from btq_lang.catalog.units import from_si
from btq_lang.prediction.world import Course
from btq_lang.requirements.model import Compare, Quantity, SignalRead, parts_in
from btq_lang.simulator.leaves import tick_custom
from btq_lang.simulator.nodes import Machine, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.syntax.script.tree import (
    Assign,
    Expression,
    Name,
    Number,
    Script,
    ScriptBinary,
    ScriptComparison,
    Ternary,
    Unary,
    ungrouped,
)


def look_at_scripts(machine: Machine, courses: Iterable[Course]) -> None:
    """Note the values with which scripts compare the entries of signals, and other uses of these."""
    root = machine.root.board.root
    by_entry = {course.settings.entry: course for course in courses if course.settings.entry}
    for node in machine.nodes:
        for script in (*(script for _, script in node.conditions), *node.scripts.values()):
            for name, values in _compared(script):
                board, key = node.board.home(name)
                if board is root and key in by_entry:
                    _note(by_entry[key], values)
        for port, written in node.ports.items() if node.rules.flow is not tick_custom else ():
            if (entry := key_of(written, port)) is not None:
                board, key = node.board.home(entry)
                if board is root and key in by_entry and not _is_subtree(node):
                    by_entry[key].is_polled = True


def look_at_conditions(parts: Iterable[object], courses: Mapping[str, Course]) -> None:
    """Note the values with which conditions compare signals; `courses`: by signal."""
    for part in parts_in(tuple(parts)):
        if isinstance(part, Compare):
            reads = [each for each in part.operands if isinstance(each, SignalRead)]
            values = [each for each in part.operands if isinstance(each, Quantity)]
            is_simple = len(reads) == 1 and len(reads) + len(values) == len(part.operands)
            for read in parts_in(part.operands):
                course = courses.get(read.signal.name) if isinstance(read, SignalRead) else None
                if course is None or not isinstance(read, SignalRead):
                    continue
                unit = read.signal.unit
                own = [from_si(value.si, unit) if unit is not None else value.si for value in values]
                _note(course, own if is_simple else None)


def _note(course: Course, values: Iterable[float] | None) -> None:
    if values is None:
        course.is_polled = True
    else:
        course.thresholds.update(values)


def _is_subtree(node: SimulatedNode) -> bool:
    """Whether the ports of a node are only other names of entries."""
    return node.id.startswith("SubTree")


def _compared(script: Script) -> Iterator[tuple[str, list[float] | None]]:
    """The entries that a script reads, each with the numbers that it is compared with; None: it is used otherwise."""
    waiting: list[Expression] = [*script.statements]
    while waiting:
        part = ungrouped(waiting.pop())
        if isinstance(part, Name):
            yield part.name, None
        elif isinstance(part, ScriptComparison):
            operands = [ungrouped(operand) for operand in part.operands]
            numbers = [value for operand in operands if (value := _number(operand)) is not None]
            names = [operand.name for operand in operands if isinstance(operand, Name)]
            if len(names) == 1 and len(numbers) + 1 == len(operands):
                yield names[0], numbers
            else:
                waiting += operands
        elif isinstance(part, Assign):
            waiting.append(part.value)
        elif isinstance(part, Unary):
            waiting.append(part.operand)
        elif isinstance(part, ScriptBinary):
            waiting += (part.left, part.right)
        elif isinstance(part, Ternary):
            waiting += (part.condition, part.then, part.otherwise)


def _number(part: Expression) -> float | None:
    if isinstance(part, Unary) and part.operator == "-":
        value = _number(ungrouped(part.operand))
        return -value if value is not None else None
    return float(part.value) if isinstance(part, Number) else None
