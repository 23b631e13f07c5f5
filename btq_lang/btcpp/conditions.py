"""Conditions and values as scripts of the engine, spelt so that 4.6, 4.8 and 4.10 evaluate them alike.

One invariant: a script means what the condition means; a condition that no script can express is refused with a reason.
Every part is in brackets and every number has a point: older engines bind `-` otherwise, refuse operators of different
kinds beside each other, and give a variable the type of its first value. It does not check whether the variables exist.

Source: the engines' own grammars, src/script_parser.cpp (4.9 and later) and scripting/operators.hpp (before).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import reduce
from math import inf
from typing import Final, TypeAlias

from btq_lang.catalog.units import Unit, from_si
from btq_lang.requirements.model import (
    Age,
    Aggregate,
    All,
    Any,
    Arithmetic,
    Bounded,
    ClassicScript,
    Compare,
    Condition,
    Flag,
    InContext,
    Minus,
    Negation,
    Number,
    Quantity,
    ResolvedScope,
    ResolvedSignal,
    ResolvedTable,
    Running,
    SignalRead,
    TextValue,
)

# The variable that holds the value of a table, read when the node starts, in this unit (None: SI).
Stored: TypeAlias = Callable[[ResolvedTable, "Unit | None"], str]


class NoScript(Exception):
    """No script of the engine can express this; the text is the reason and reads well after "because"."""


def condition_script(condition: Condition, stored: Stored) -> str:
    """The script of a condition.

    Raises:
        NoScript: with the reason.
    """
    if isinstance(condition, All | Any):
        operator = "&&" if isinstance(condition, All) else "||"
        script = condition_script(condition.conditions[0], stored)
        for operand in condition.conditions[1:]:
            script = f"({script} {operator} {condition_script(operand, stored)})"
            no_longer_than_allowed(script)  # nested contexts make scripts grow without bounds
        return script
    if isinstance(condition, Negation):
        return f"(!{condition_script(condition.condition, stored)})"
    if isinstance(condition, InContext | ResolvedScope):
        return condition_script(condition.condition, stored)
    if isinstance(condition, Compare):
        return _comparison(condition, stored)
    if isinstance(condition, SignalRead):
        return f"({signal_script(condition.signal)} == true)"
    if isinstance(condition, Flag):
        return f"(true == {condition.text})"
    if isinstance(condition, ClassicScript):
        return _own_script(condition)
    if isinstance(condition, Running):
        raise NoScript("a script cannot check whether a node runs")
    raise NoScript(f"`{condition.name}` has no value")


def table_script(table: ResolvedTable, spelt: Callable[[Bounded], str], stored: Stored) -> str:
    """The script that gives the value of the first case that holds.

    Raises:
        NoScript: with the reason.
    """
    script = ""
    for case in reversed(table.cases):
        value = spelt(case.value)
        script = f"({condition_script(case.condition, stored)} ? {value} : {script})" if case.condition else value
    return script


def table_in_condition(table: ResolvedTable, unit: Unit | None) -> str:
    """The script of a table as a part of a condition, in a unit (None: SI).

    Raises:
        NoScript: with the reason.
    """
    return table_script(table, lambda value: number_script(value, unit, table_in_condition), table_in_condition)


def all_of(scripts: Iterable[str]) -> str:
    """The script that holds if each of some does; at least one."""
    return reduce("({} && {})".format, scripts)


def signal_script(signal: ResolvedSignal) -> str:
    """The entry that a signal is read from: always one of the root blackboard.

    Raises:
        NoScript: a script cannot name it.
    """
    key = signal.entry
    if signal.key is None:
        raise NoScript(f"`{signal.name}` has no blackboard entry")
    if not (key.isascii() and key.isidentifier()):
        raise NoScript(f"`{signal.name}` is read from `{key}`, which cannot be a name in a script")
    return f"@{key}"


def first_value_script(signal: ResolvedSignal) -> str:
    """The value of a signal before its first sample.

    Raises:
        NoScript: with the reason.
    """
    assert signal.initially is not None, "asked only of signals that have one"
    return number_script(signal.initially, signal.unit, _none_stored)


def no_longer_than_allowed(script: str) -> None:
    """Refuse a script that is too long to read.

    Raises:
        NoScript: it is too long.
    """
    if len(script) > LONGEST:
        what_to_do = "compute it in a node, and declare a signal for its output"
        raise NoScript(f"its script would be longer than {LONGEST} characters; {what_to_do}")


def real(value: float) -> str:
    """A number, spelt so that every version reads it as a real."""
    if not -inf < value < inf:
        raise NoScript("it contains an infinite number")
    text = repr(abs(value))
    if "e" in text:
        from decimal import Decimal

        text = format(Decimal(text), "f")
    text = text if "." in text else f"{text}.0"
    return f"(-{text})" if value < 0 else text


def _comparison(compare: Compare, stored: Stored) -> str:
    """`a < b`, `a < b < c`: in the signals' unit if they share one and nothing is calculated, else in SI."""
    signals = [operand.signal for operand in compare.operands if isinstance(operand, SignalRead)]
    units = {signal.unit for signal in signals}
    plain = all(
        isinstance(operand, SignalRead | Quantity | ResolvedTable | Flag | TextValue) for operand in compare.operands
    )
    unit = signals[0].unit if plain and len(units) == 1 else None
    scripts = [number_script(operand, unit, stored) for operand in compare.operands]
    pairs = zip(compare.operators, scripts, scripts[1:], strict=False)
    return all_of(f"({left} {operator} {right})" for operator, left, right in pairs)


def number_script(number: Number, unit: Unit | None, stored: Stored) -> str:
    """The script of a number in a unit (None: SI).

    Raises:
        NoScript: with the reason.
    """
    if isinstance(number, Quantity):
        return real(from_si(number.si, unit) if unit is not None else number.si)
    if isinstance(number, Flag):
        return number.text
    if isinstance(number, TextValue):
        return _text(number.value)
    if isinstance(number, SignalRead):
        return _read(number.signal, unit)
    if isinstance(number, Minus):
        return f"(-{number_script(number.operand, unit, stored)})"
    if isinstance(number, Arithmetic):
        left, right = (number_script(part, unit, stored) for part in (number.left, number.right))
        return f"({left} {number.operator} {right})"
    if isinstance(number, ResolvedTable):
        return stored(number, unit)
    if isinstance(number, Age):
        raise NoScript(f"a script cannot tell how old `{number.signal.name}` is")
    if isinstance(number, Aggregate):
        raise NoScript(f"a script cannot read the samples of `{number.function}({number.signal.name})`")
    raise NoScript(f"`{number.name}` has no value")


def _read(signal: ResolvedSignal, unit: Unit | None) -> str:
    key = signal_script(signal)
    own = signal.unit
    if signal.sort != "number" or own is None or own == unit:
        return key
    if unit is not None:  # the unit of another signal, of the same dimension
        return _scaled(_scaled(key, own.factor, own.offset), 1 / unit.factor, -unit.offset / unit.factor)
    return _scaled(key, own.factor, own.offset)


def _scaled(script: str, factor: float, offset: float) -> str:
    if factor != 1.0:
        script = f"({script} * {real(factor)})"
    return f"({script} + {real(offset)})" if offset else script


def _text(text: str) -> str:
    if "'" in text or not text.isascii():
        raise NoScript("a string in a script cannot contain single quotes, and before 4.9 only ASCII characters")
    return f"'{text}'"


def _own_script(script: ClassicScript) -> str:
    """The script in a classic description: one expression without assignments that means the same in every version."""
    from btq_lang.syntax.script.check import check_script  # few missions have one
    from btq_lang.syntax.script.parser import parse_script
    from btq_lang.syntax.script.tree import variables

    parsed = parse_script(script.code)
    if check_script(parsed, expects_value=True) or len(parsed.statements) != 1:
        raise NoScript("its script is not a single expression that all versions of the engine evaluate alike")
    if any(each.writes for each in variables(parsed)):
        raise NoScript("its script changes an entry")
    return f"({script.code.strip().rstrip(';').strip()})"


def _none_stored(_table: ResolvedTable, _unit: Unit | None) -> str:
    raise NoScript("an initial value cannot depend on a condition")


LONGEST: Final = 10_000  # characters: the engine parses the script at each load, and people must be able to read it
