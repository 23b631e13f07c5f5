"""Compares a measure with its bound: which side is closer to being violated, and whether it is already."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.evidence.conditions import bound_at
from btq_lang.evidence.signals import Unknown
from btq_lang.requirements.model import Limit, Value

if TYPE_CHECKING:
    from btq_lang.catalog.units import Unit
    from btq_lang.evidence.model import Moment
    from btq_lang.evidence.observed import Observed


class Measure:
    """A measured value, and the side of its bound that it is closer to violating.

    Attributes:
        unit: to print both in; None for a number of starts.
        excess: how far the value is on the wrong side of the bound, in SI; negative on the right side.
        is_upper: the side is an upper bound.
    """

    # Not a Record: a log has as many as it has judgements, and a Record takes three times as long to make.
    __slots__ = ("bound", "excess", "is_upper", "si", "unit")

    def __init__(self, si: float, bound: Value, excess: float, is_upper: bool) -> None:
        self.si: Final = si
        self.unit: Unit | None = bound.unit
        self.bound: Final = bound
        self.excess: Final = excess
        self.is_upper: Final = is_upper

    def kept(self, is_complete: bool) -> bool | None:
        """Whether the bound is kept; None: undecided, because a measure that is not complete may grow."""
        if self.excess > 0:
            return False if self.is_upper or is_complete else None
        return True if is_complete else None


def compared(limit: Limit, si: float, observed: Observed, moment: Moment) -> Measure | Unknown:
    """Compare a measured value with its bound, which is evaluated at a moment."""
    relation = limit.relation
    bound = bound_at(limit.value, observed, moment)
    if isinstance(bound, Unknown):
        return bound
    is_upper = relation in ("<=", "<")
    excess = si - bound.si if is_upper else bound.si - si
    if limit.upper is not None:
        upper = bound_at(limit.upper, observed, moment)
        if isinstance(upper, Unknown):
            return upper
        if si - upper.si > excess:
            bound, excess, is_upper = upper, si - upper.si, True
    elif excess == 0 and relation in ("<", ">"):
        excess = _JUST
    return Measure(si, bound, excess, is_upper)


_JUST: Final = 1e-9  # a measure equal to a strict bound violates it
