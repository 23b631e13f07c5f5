"""Whether conditions hold at a moment, and what bounds are, by what signals were then.

One invariant: an unknown part makes the whole unknown unless the other parts decide it (Kleene), and the reason of the
first such part is kept.
"""

from __future__ import annotations

import operator

from btq_lang.evidence.signals import Unknown
from btq_lang.record import Record, replace
from btq_lang.requirements.model import (
    Aggregate,
    All,
    Any,
    Arithmetic,
    Compare,
    Flag,
    InContext,
    Minus,
    Not,
    Parameter,
    Read,
    Running,
    Script,
    Table,
    Text,
    Value,
)

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import Final, TypeAlias

    from btq_lang.evidence.model import SampleValue
    from btq_lang.evidence.signals import Signals
    from btq_lang.requirements.model import Bounded, Condition, Number, Signal
    from btq_lang.units import Unit

    Truth: TypeAlias = bool | Unknown


class Bound(Record):
    """What a bound is at a moment.

    Attributes:
        text: as typed.
    """

    si: float
    unit: Unit | None
    text: str


class Reading(Record):
    """A signal beside a bound, which is what many a condition is: `battery >= 3 %`.

    Attributes:
        excess: how far the signal is on the wrong side of the bound, in SI; negative on the right side.
    """

    signal: Signal
    si: float
    bound: Bound
    excess: float


def truth(condition: Condition, signals: Signals, time: int) -> Truth:
    """Whether a condition holds at a time."""
    if isinstance(condition, Compare):
        return _compared(condition, signals, time)
    if isinstance(condition, All | Any):
        decides = isinstance(condition, Any)
        unknown: Truth = not decides
        for part in condition.conditions:
            found = truth(part, signals, time)
            if found is decides:
                return decides
            if isinstance(found, Unknown) and not isinstance(unknown, Unknown):
                unknown = found
        return unknown
    if isinstance(condition, Not):
        found = truth(condition.condition, signals, time)
        return found if isinstance(found, Unknown) else not found
    if isinstance(condition, InContext):
        return truth(condition.condition, signals, time)
    if isinstance(condition, Flag):
        return condition.value
    if isinstance(condition, Read):
        value = signals.reading(condition.signal, time)
        return value if isinstance(value, bool | Unknown) else Unknown(f"`{condition.signal.name}` is not a bool")
    return Unknown(_not_judged(condition))


def bound_at(bounded: Bounded, signals: Signals, time: int) -> Bound | Unknown:
    """A bound at a time: of a table the value of the first case that holds then."""
    if isinstance(bounded, Table):
        for case in bounded.cases:
            holds = case.condition is None or truth(case.condition, signals, time)
            if isinstance(holds, Unknown):
                return holds
            if holds:
                return bound_at(case.value, signals, time)
        return Unknown("no case of the bound holds")
    if isinstance(bounded, Value):
        return Bound(bounded.si, bounded.unit, bounded.text)
    value = _number(bounded, signals, time)
    if isinstance(value, Unknown) or not isinstance(value, float):
        return value if isinstance(value, Unknown) else Unknown(f"`{bounded.text}` is not a number")
    return Bound(value, bounded.signal.unit if isinstance(bounded, Read) else None, bounded.text)


def reading_of(condition: Condition, signals: Signals, time: int) -> Reading | None:
    """The signal and the bound of a condition that is one comparison of these; None of any other, or where unknown."""
    if isinstance(condition, InContext):
        return reading_of(condition.condition, signals, time)
    if isinstance(condition, Not):
        found = reading_of(condition.condition, signals, time)
        return replace(found, excess=-found.excess) if found is not None else None
    if not isinstance(condition, Compare) or len(condition.operators) != 1 or condition.operators[0] not in _MIRRORED:
        return None
    sign = condition.operators[0]
    left, right = condition.operands
    if not isinstance(left, Read):
        sign, left, right = _MIRRORED[sign], right, left
    if not isinstance(left, Read) or not isinstance(right, Value | Table | Read):
        return None
    value, bound = signals.reading(left.signal, time), bound_at(right, signals, time)
    if not isinstance(value, float) or isinstance(bound, Unknown):
        return None
    return Reading(left.signal, value, bound, value - bound.si if sign in ("<", "<=") else bound.si - value)


def signals_in(part: object) -> Iterator[Signal]:
    """The signals that a condition or a bound reads."""
    if isinstance(part, Read | Aggregate):
        yield part.signal
    elif isinstance(part, Compare):
        yield from (found for each in part.operands for found in signals_in(each))
    elif isinstance(part, All | Any):
        yield from (found for each in part.conditions for found in signals_in(each))
    elif isinstance(part, Not | InContext):
        yield from signals_in(part.condition)
    elif isinstance(part, Minus):
        yield from signals_in(part.operand)
    elif isinstance(part, Arithmetic):
        yield from (found for each in (part.left, part.right) for found in signals_in(each))
    elif isinstance(part, Table):
        for case in part.cases:
            yield from signals_in(case.value)
            yield from signals_in(case.condition)


def _compared(condition: Compare, signals: Signals, time: int) -> Truth:
    values = [_number(each, signals, time) for each in condition.operands]
    result: Truth = True
    for sign, left, right in zip(condition.operators, values, values[1:], strict=False):
        if isinstance(left, Unknown) or isinstance(right, Unknown):
            unknown = left if isinstance(left, Unknown) else right
            assert isinstance(unknown, Unknown), "one of the two is"
            result = unknown if result is True else result
        elif isinstance(left, str) != isinstance(right, str):
            result = Unknown("a string cannot be compared with a number")
        elif not _COMPARISONS[sign](left, right):
            return False
    return result


def _number(part: Number | Flag | Text, signals: Signals, time: int) -> SampleValue | Unknown:
    """An operand of a comparison in SI; of a text and a bool its value."""
    if isinstance(part, Value):
        return part.si
    if isinstance(part, Flag | Text):
        return part.value
    if isinstance(part, Read):
        return signals.reading(part.signal, time)
    if isinstance(part, Table):
        bound = bound_at(part, signals, time)
        return bound if isinstance(bound, Unknown) else bound.si
    if isinstance(part, Minus):
        value = _number(part.operand, signals, time)
        return value if isinstance(value, Unknown | str) else -value
    if isinstance(part, Arithmetic):
        left, right = _number(part.left, signals, time), _number(part.right, signals, time)
        if isinstance(left, Unknown) or isinstance(right, Unknown):
            return left if isinstance(left, Unknown) else right
        if isinstance(left, str) or isinstance(right, str):
            return Unknown("no calculation is possible with a string")
        if part.operator == "/" and right == 0:
            return Unknown("a division by zero")
        return float(_OPERATIONS[part.operator](left, right))
    return Unknown(_not_judged(part))


def _not_judged(part: object) -> str:
    """What of the language is not judged from logs yet."""
    if isinstance(part, Running):
        return f"`node {part.target.node.shown.strip('`')}` in a condition is not judged yet"
    if isinstance(part, Script):
        return "a script of the engine is not judged"
    if isinstance(part, Aggregate):
        return f"`{part.function}({part.signal.name})` is not judged yet"
    return f"the parameter `{part.name}` has no value" if isinstance(part, Parameter) else "it is not judged"


_COMPARISONS: Final[dict[str, Callable[[object, object], bool]]] = {
    "<": operator.lt,  # type: ignore[dict-item]  # what is compared is of one sort
    "<=": operator.le,  # type: ignore[dict-item]
    ">": operator.gt,  # type: ignore[dict-item]
    ">=": operator.ge,  # type: ignore[dict-item]
    "==": operator.eq,
    "!=": operator.ne,
}
_OPERATIONS: Final[dict[str, Callable[[float, float], float]]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}
_MIRRORED: Final = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
