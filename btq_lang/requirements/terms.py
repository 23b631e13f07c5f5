"""Values in expressions, with what must be known to compare them: sorts, dimensions, levels of temperature.

Names are looked up by `reader`.
"""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

from btq_lang.catalog.units import Dimension, Unit, a_dimension, parse_unit
from btq_lang.requirements import model
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.tokens import NUMBER
from btq_lang.util.record import Record
from btq_lang.util.text import Span

Level: TypeAlias = Literal["level", "difference", "either"]


class Wanted(Record):
    """What a verb expects at a place.

    Attributes:
        what: in words, to follow "expected ".
        dimensions: any of these.
        unit: that a number without one may have meant; None if it needs no unit.
        level: for temperatures, whether a difference is expected.
    """

    what: str
    dimensions: tuple[Dimension, ...]
    unit: str | None
    level: Level = "either"


class Term(Record):
    """A value in an expression, with what must be known to compare it.

    Attributes:
        dimension: of a number; None if unknown.
        unit: in which a number compared with it would be written.
        span: its place, counted from the entry.
        word: if it is a literal.
    """

    value: model.Number
    sort: model.Sort
    dimension: Dimension | None
    unit: str | None
    span: Span
    level: Level = "either"
    word: syntax.Word | None = None

    @property
    def is_bare(self) -> bool:
        """Whether it is a number without a unit."""
        return self.word is not None and self.word.kind == NUMBER


def amounts(bounded: model.Bounded | None, written: syntax.Bounded) -> tuple[tuple[model.Simple, Span], ...]:
    """Each value with its place."""
    if bounded is None:
        return ()
    if isinstance(bounded, model.ResolvedTable) and isinstance(written, syntax.Table):
        amounts = (*(case.value for case in written.cases), written.otherwise)
        pairs = zip(bounded.cases, amounts, strict=True)
        return tuple((case.value, amount.word.span) for case, amount in pairs if amount is not None)
    assert not isinstance(bounded, model.ResolvedTable), "a table is read from a table"
    assert isinstance(written, syntax.Amount), "a table is read from a table"
    return ((bounded, written.word.span),)


def sort_of_value(value: model.Simple) -> model.Sort:
    if isinstance(value, model.SignalRead):
        return value.signal.sort
    if isinstance(value, model.ResolvedParameter):
        return value.sort
    return "number" if isinstance(value, model.Quantity) else "bool" if isinstance(value, model.Flag) else "text"


def simple(value: model.Number) -> model.Simple | None:
    return (
        value
        if isinstance(value, model.Quantity | model.Flag | model.TextValue | model.SignalRead | model.ResolvedParameter)
        else None
    )


def term_of(value: model.Number, kind: model.ResolvedSignal | model.ResolvedParameter, span: Span) -> Term:
    """A value of the sort and the unit of a signal or a parameter."""
    unit = kind.unit
    if kind.sort != "number" or unit is None:
        return Term(value, kind.sort, None, None, span)
    symbol = unit.symbol if unit.dimension != model.NO_DIMENSION else None
    return Term(value, "number", unit.dimension, symbol, span, "level" if unit.offset else "either")


def unit_beside(term: Term | None) -> str:
    """The unit with which a signal that is compared with this would be declared."""
    if term is None or (term.sort == "number" and term.unit is None):
        return "m" if term is None or not term.is_bare else "1"
    return term.unit or term.sort


def sum_level(operator: str, left: Level, right: Level) -> Level | None:
    """The level of a sum or difference of temperatures; None if it is meaningless."""
    if left != "level" and right != "level":
        return "difference" if "difference" in (left, right) else "either"
    if operator == "-":
        return None if left != "level" else "difference" if right == "level" else "level"
    return None if left == right else "level"


def is_count_of(term: Term, other: Term) -> bool:
    """Whether it is `count(…)`, which is both a plain number and a count."""
    is_count = isinstance(term.value, model.Aggregate) and term.value.function == "count"
    return is_count and other.dimension in (model.NO_DIMENSION, COUNT)


def in_words(term: Term) -> str:
    if term.sort != "number":
        return SORTS[term.sort]
    return a_dimension(Unit("", term.dimension, 1.0)) if term.dimension is not None else "a number"


def sort_of(written: syntax.Word | None) -> tuple[model.Sort, Unit | None]:
    """The meaning of the word after the `:` of a signal or a parameter."""
    if written is not None and written.text in ("bool", "text"):
        return ("bool" if written.text == "bool" else "text"), None
    return "number", parse_unit(written.text) if written is not None else None


OF_PYTHON: Final = ("True", "False")
SORTS: Final = {"bool": "true or false", "text": "a text"}
ONE: Final = Unit("1", model.NO_DIMENSION, 1.0)


def _dimension_of(symbol: str) -> Dimension:
    unit = parse_unit(symbol)
    assert unit is not None, "a symbol of the table"
    return unit.dimension


COUNT: Final = _dimension_of("times")
TIME: Final = _dimension_of("s")
PERCENT: Final = _dimension_of("%")
DURATION: Final = Wanted("a time", (TIME,), "s")
