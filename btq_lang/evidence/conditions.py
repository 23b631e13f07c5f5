"""Evaluates conditions and bounds at a moment, from what was observed, and compares measures with bounds.

One invariant: an unknown part makes the whole unknown unless the other parts decide it (Kleene), and the reason of the
first such part is kept.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.catalog.units import ONE, Unit, parse_unit
from btq_lang.evidence.signals import UnknownValue
from btq_lang.requirements.model import (
    Age,
    Aggregate,
    All,
    Any,
    Arithmetic,
    ClassicScript,
    Compare,
    Flag,
    InContext,
    Minus,
    Negation,
    Quantity,
    ResolvedParameter,
    ResolvedScope,
    ResolvedTable,
    Running,
    SignalRead,
    TextValue,
)

if TYPE_CHECKING:
    from btq_lang.evidence.model import Moment, SampleValue
    from btq_lang.evidence.observed import Observed
    from btq_lang.requirements.model import Bounded, Condition, Number, ResolvedClaim

    Truth: TypeAlias = bool | UnknownValue


class Measure:
    """A measured value with its bound; of two bounds, the one that it is closer to violating.

    Attributes:
        unit: to print both in; None for a number of starts.
        excess: how far the value is on the wrong side of the bound, in SI; negative on the right side.
        is_upper: the value is bounded from above.
        name: the operand of a condition, as typed: `battery`, `max(force)`.
    """

    # Not a Record: a log has as many as it has judgements, and a Record takes three times as long to make.
    __slots__ = ("bound", "excess", "is_upper", "name", "si", "unit")

    def __init__(self, si: float, relation: str, bound: Quantity, unit: Unit | None, name: str = "") -> None:
        self.si: Final = si
        self.unit = unit
        self.bound: Final = bound
        self.is_upper: Final = relation in ("<=", "<")
        self.name: Final = name
        self.excess = si - bound.si if self.is_upper else bound.si - si
        if self.excess == 0 and relation in ("<", ">"):
            self.excess = _JUST

    def beyond(self) -> Measure:
        """The same, on the wrong side of the bound: the engine stopped what it measures because of the bound."""
        self.excess = max(self.excess, _JUST)
        return self

    @property
    def holds(self) -> bool:
        """Whether the bound is kept."""
        return self.excess <= 0

    def kept(self, is_complete: bool) -> bool | None:
        """Whether the bound is kept; None: undecided, because a measure that is not complete may grow."""
        if self.excess > 0:
            return False if self.is_upper or is_complete else None
        return True if is_complete else None


def truth(condition: Condition, observed: Observed, moment: Moment) -> Truth:
    """Whether a condition holds at a moment."""
    if isinstance(condition, Compare):
        return _compared(condition, observed, moment)
    if isinstance(condition, All | Any):
        decides = isinstance(condition, Any)
        unknown: Truth = not decides
        for part in condition.conditions:
            holds = truth(part, observed, moment)
            if holds is decides:
                return decides
            if isinstance(holds, UnknownValue) and not isinstance(unknown, UnknownValue):
                unknown = holds
        return unknown
    if isinstance(condition, Negation):
        holds = truth(condition.condition, observed, moment)
        return holds if isinstance(holds, UnknownValue) else not holds
    if isinstance(condition, InContext):
        return observed.holds(condition, moment, lambda: truth(condition.condition, observed, moment))
    if isinstance(condition, ResolvedScope):
        return truth(condition.condition, observed.in_scope, moment)
    if isinstance(condition, Flag):
        return condition.value
    if isinstance(condition, SignalRead):
        value = observed.reading(condition.signal, moment)
        return (
            value
            if isinstance(value, bool | UnknownValue)
            else UnknownValue(f"`{condition.signal.name}` is not a bool")
        )
    if isinstance(condition, Running):
        return observed.nodes.runs(condition.target, moment, observed.is_early)
    return UnknownValue(_not_judged(condition))


def bound_at(bounded: Bounded, observed: Observed, moment: Moment) -> Quantity | UnknownValue:
    """The value of a bound at a moment; for a table, that of the first case that holds then."""
    if isinstance(bounded, ResolvedTable):
        observed = observed.in_scope
        for case in bounded.cases:
            holds = case.condition is None or truth(case.condition, observed, moment)
            if isinstance(holds, UnknownValue):
                return holds
            if holds:
                return bound_at(case.value, observed, moment)
        return UnknownValue("no case of the bound holds")
    if isinstance(bounded, Quantity):
        return bounded
    value = _number(bounded, observed, moment)
    if isinstance(value, UnknownValue) or not isinstance(value, float):
        return value if isinstance(value, UnknownValue) else UnknownValue(f"`{bounded.text}` is not a number")
    unit = bounded.signal.unit if isinstance(bounded, SignalRead) else None
    return Quantity(bounded.text, value, unit or ONE)


def compared(claim: ResolvedClaim, si: float, observed: Observed, moment: Moment) -> Measure | UnknownValue:
    """Compare a measured value with the bound of a claim, which is evaluated at a moment."""
    limit = claim.limit
    assert limit is not None, "what is measured has a bound"
    bound = bound_at(limit.value, observed, moment)
    if isinstance(bound, UnknownValue):
        return bound
    measure = Measure(si, limit.relation, bound, bound.unit)
    if limit.upper is None:
        return measure
    upper = bound_at(limit.upper, observed, moment)
    if isinstance(upper, UnknownValue):
        return upper
    return max(measure, Measure(si, "<=", upper, upper.unit), key=operator.attrgetter("excess"))


def measure_of(condition: Condition, observed: Observed, moment: Moment, is_negated: bool = False) -> Measure | None:
    """What a condition measures that compares a signal with a bound, or is `not A or B` with such a B where A holds;
    None for other conditions and unknown values.
    """
    if isinstance(condition, Compare):
        return _compared_with_bound(condition, observed, moment, is_negated)
    if isinstance(condition, InContext | Negation):
        is_other = is_negated != isinstance(condition, Negation)
        return measure_of(condition.condition, observed, moment, is_other)
    if isinstance(condition, Any):
        *cases, last = condition.conditions
        is_last = all(isinstance(case, Negation) and truth(case, observed, moment) is False for case in cases)
        return measure_of(last, observed, moment, is_negated) if is_last else None
    return None


def _compared_with_bound(condition: Compare, observed: Observed, moment: Moment, is_negated: bool) -> Measure | None:
    """The measure of a comparison of a signal with a bound; None for other comparisons and unknown values."""
    sign, *others = condition.operators
    if others or sign not in MIRRORED:
        return None
    left, right = condition.operands
    if not isinstance(left, _MEASURED):
        sign, left, right = MIRRORED[sign], right, left
    if not isinstance(left, _MEASURED) or not isinstance(right, _BOUNDS):
        return None
    value = _number(left, observed, moment)
    bound = bound_at(right, observed, moment)
    if not isinstance(value, float) or isinstance(bound, UnknownValue):
        return None
    sign = OPPOSITE[sign] if is_negated else sign
    if isinstance(left, Age):
        return Measure(value, sign, bound, bound.unit, f"age({left.signal.name})")
    name = left.signal.name if isinstance(left, SignalRead) else f"{left.function}({left.signal.name})"
    return Measure(value, sign, bound, _unit(left), name)


def _compared(condition: Compare, observed: Observed, moment: Moment) -> Truth:
    values = [_number(operand, observed, moment) for operand in condition.operands]
    result: Truth = True
    for sign, left, right in zip(condition.operators, values, values[1:], strict=False):
        if isinstance(left, UnknownValue) or isinstance(right, UnknownValue):
            unknown = left if isinstance(left, UnknownValue) else right
            assert isinstance(unknown, UnknownValue), "one of the two is"
            result = unknown if result is True else result
        elif isinstance(left, str) != isinstance(right, str):
            result = UnknownValue("a string cannot be compared with a number")
        elif not _COMPARISONS[sign](left, right):
            return False
    return result


def _number(part: Number | Flag | TextValue, observed: Observed, moment: Moment) -> SampleValue | UnknownValue:
    """The value of an operand of a comparison, numbers in SI."""
    if isinstance(part, SignalRead):
        return observed.reading(part.signal, moment)
    if isinstance(part, Quantity):
        return part.si
    if isinstance(part, Flag | TextValue):
        return part.value
    if isinstance(part, Age):
        return observed.age(part.signal, moment)
    if isinstance(part, Aggregate):
        return observed.summary(part.function, part.signal)
    if isinstance(part, ResolvedTable):
        bound = bound_at(part, observed, moment)
        return bound if isinstance(bound, UnknownValue) else bound.si
    if isinstance(part, Minus):
        value = _number(part.operand, observed, moment)
        return value if isinstance(value, UnknownValue | str) else -value
    if isinstance(part, Arithmetic):
        left, right = _number(part.left, observed, moment), _number(part.right, observed, moment)
        if isinstance(left, UnknownValue) or isinstance(right, UnknownValue):
            return left if isinstance(left, UnknownValue) else right
        if isinstance(left, str) or isinstance(right, str):
            return UnknownValue("no calculation is possible with a string")
        if part.operator == "/" and right == 0:
            return UnknownValue("a division by zero")
        return float(_OPERATIONS[part.operator](left, right))
    return UnknownValue(_not_judged(part))


def _unit(part: SignalRead | Aggregate) -> Unit | None:
    """The unit to print a value in; a difference of temperatures is not a temperature."""
    unit = part.signal.unit
    if isinstance(part, SignalRead) or unit is None:
        return unit
    if part.function == "count":
        return None
    return parse_unit("K") if unit.offset and part.function in ("change", "stddev") else unit


def _not_judged(part: object) -> str:
    """Names the construct that cannot be judged from logs."""
    if isinstance(part, ClassicScript):
        return "a script of the engine is not judged"
    return f"the parameter `{part.name}` has no value" if isinstance(part, ResolvedParameter) else "it is not judged"


_COMPARISONS: Final[dict[str, Callable[[object, object], bool]]] = {
    "<": operator.lt,  # type: ignore[dict-item]  # both operands have one type
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
_MEASURED: Final = (SignalRead, Aggregate, Age)
_BOUNDS: Final = (Quantity, ResolvedTable, SignalRead)
MIRRORED: Final = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
OPPOSITE: Final = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
_JUST: Final = 1e-9  # a measure equal to a strict bound violates it
