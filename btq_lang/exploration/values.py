"""Values that leaves have written: what is known of one, and how a comparison makes more known.

One invariant: a value of an entry is a number here that names what is known of it, so that copies of it are the same
value.  It does not know sums of such values: what needs one ends with `NotModelled`.
"""

from __future__ import annotations

from itertools import count
from math import ceil, floor, inf
from typing import Final, Protocol, TypeAlias

from btq_lang.simulator.blackboard import LIMITS, STRING, Unknown, Value
from btq_lang.simulator.errors import NotModelled
from btq_lang.simulator.scripts import NUMBER, compared
from btq_lang.util.record import Record, replace

Origin: TypeAlias = tuple[str | float | tuple[int], ...]


class Domain(Record):
    """What a value may be.

    Attributes:
        low, high: as a number.
        is_low_open, is_high_open: it is not the limit itself.
        is_whole: a number without a fraction.
        excluded: what it is not, numbers and texts.
        fixed: what it is; None: more than one value.
        is_derived: it is calculated from other such values, and what they are is not held against it.
        origin: the operator and the two operands, of which an unknown one is a number in brackets; empty: none.
    """

    low: float = -inf
    high: float = inf
    is_low_open: bool = False
    is_high_open: bool = False
    is_whole: bool = False
    excluded: frozenset[float | str] = frozenset()
    fixed: float | int | str | None = None
    is_derived: bool = False
    origin: Origin = ()


class Domains(Protocol):
    """What is known of all values, and who decides where more than one thing is possible."""

    domains: dict[int, Domain]

    def derived(self, origin: Origin) -> FreeValue:
        """The value that an operator makes of two."""

    def assume(self) -> None:
        """A derived value was taken to be something."""

    def choose(self, count: int) -> int:
        """A number below `count`."""


class FreeValue(Unknown):
    """A value that a leaf has written."""

    __slots__ = ("all", "number")

    def __init__(self, number: int, domains: Domains) -> None:
        self.number: Final = number
        self.all: Final = domains

    def __eq__(self, other: object) -> bool:
        return isinstance(other, FreeValue) and other.number == self.number

    def __hash__(self) -> int:
        return hash(self.number)

    def __repr__(self) -> str:
        return f"FreeValue({self.number})"

    def compared(self, operator: str, other: Value) -> bool:
        """Whether a comparison holds; where both is possible, one is chosen, and known from now on."""
        if isinstance(other, FreeValue) and other.number == self.number:
            return operator in ("==", "<=", ">=")
        domain = self.all.domains[self.number]
        if domain.fixed is not None:
            return compared(domain.fixed, operator, other)
        other = self._fixed(other)
        answers = [(answer, rest) for answer in (True, False) if (rest := _rest(domain, operator, answer, other))]
        answer, rest = answers[self.all.choose(len(answers))]
        if domain.is_derived and len(answers) > 1:
            self.all.assume()
        self.all.domains[self.number] = rest
        return answer

    def combined(self, operator: str, other: Value, is_left: bool) -> Value:
        """A value of which nothing is known but that the same operator makes the same of the same values."""
        mine: tuple[int] = (self.number,)
        its = (
            (other.number,) if isinstance(other, FreeValue) else str(other) if isinstance(other, str) else float(other)
        )
        return self.all.derived((operator, mine, its) if is_left else (operator, its, mine))

    def __float__(self) -> float:
        return float(self._value("read as a number"))

    def __int__(self) -> int:
        return int(self._value("read as a number"))

    def __str__(self) -> str:
        return str(self._value("read as a text"))

    def _value(self, what: str) -> float | int | str:
        fixed = self.all.domains[self.number].fixed
        if fixed is None:
            raise self.needed(what)
        return fixed

    def _fixed(self, other: Value) -> float | str:
        if isinstance(other, FreeValue):
            fixed = self.all.domains[other.number].fixed
            if fixed is None:
                raise NotModelled("two entries whose values are unknown are compared with each other")
            other = fixed
        if isinstance(other, Unknown):
            raise other.needed("compared")
        if not isinstance(other, str):
            return float(other)
        if other in ("true", "false"):
            return float(other == "true")
        return float(other) if NUMBER.fullmatch(other) else other


def domain_of(type_: str) -> Domain:
    """What a value of a type of C++ may be."""
    low, high = LIMITS.get(type_, (-inf, inf))
    return Domain(low, high, is_whole=type_ in LIMITS)


def sample(domain: Domain, type_: str) -> float | int | str:
    """A value that a domain has; `type_`: of the entry."""
    if domain.fixed is not None:
        return domain.fixed
    if type_ == STRING or any(isinstance(value, str) for value in domain.excluded):
        return next(text for number in count(1) if (text := f"text {number}") not in domain.excluded)
    middle = (domain.low + domain.high) / 2
    near = [limit + step for limit in (0, domain.low, domain.high) if abs(limit) < inf for step in (0, 1, -1)]
    values = [*near, *([middle] if abs(middle) < inf else []), *range(2, len(domain.excluded) + 3)]
    return next((_as_in(domain, value) for value in values if _has(domain, value)), middle)


def _rest(domain: Domain, operator: str, answer: bool, other: float | str) -> Domain | None:
    """What a value may still be if a comparison with it on the left has this answer; None: nothing."""
    if not answer:
        operator = _OPPOSITE[operator]
    if operator == "==":
        return replace(domain, fixed=_as_in(domain, other)) if _has(domain, other) else None
    if operator == "!=":
        return _narrowed(domain, excluded=domain.excluded | {other}) if _has(domain, other) else domain
    if isinstance(other, str):
        raise NotModelled("an entry whose value is unknown is compared with a text by its order")
    if operator in ("<", "<="):
        is_open = operator == "<"
        if (other, not is_open) >= (domain.high, not domain.is_high_open):
            return domain
        return _narrowed(domain, high=other, is_high_open=is_open)
    is_open = operator == ">"
    if (other, is_open) <= (domain.low, domain.is_low_open):
        return domain
    return _narrowed(domain, low=other, is_low_open=is_open)


def _has(domain: Domain, value: float | str) -> bool:
    """Whether a value is possible."""
    if value in domain.excluded:
        return False
    if isinstance(value, str):
        return (domain.low, domain.high) == (-inf, inf) and not domain.is_whole
    if domain.is_whole and value != floor(value):
        return False
    above = value > domain.low or (value == domain.low and not domain.is_low_open)
    return above and (value < domain.high or (value == domain.high and not domain.is_high_open))


def _narrowed(domain: Domain, **changes: object) -> Domain | None:
    """A domain with some changes; None if nothing is left."""
    domain = replace(domain, **changes)
    low, high = domain.low, domain.high
    if domain.is_whole:
        low = floor(low) + 1 if domain.is_low_open and low > -inf else ceil(low) if low > -inf else low
        high = ceil(high) - 1 if domain.is_high_open and high < inf else floor(high) if high < inf else high
        while low in domain.excluded:
            low += 1
        while high in domain.excluded and high >= low:
            high -= 1
        domain = replace(domain, low=float(low), high=float(high), is_low_open=False, is_high_open=False)
    if low > high or (low == high and (domain.is_low_open or domain.is_high_open or low in domain.excluded)):
        return None
    return replace(domain, fixed=_as_in(domain, low)) if low == high and domain.is_whole else domain


def _as_in(domain: Domain, value: float | str) -> float | int | str:
    """A value in the form that the engine gives it."""
    return int(value) if not isinstance(value, str) and (domain.is_whole or value == floor(value)) else value


_OPPOSITE: Final = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}
