"""Compares a measure with its bound: which side is closer to being violated, and whether it is already."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.evidence.conditions import bound_at
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Measure
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.conditions import Bound
    from btq_lang.evidence.model import Moment
    from btq_lang.evidence.observed import Observed
    from btq_lang.requirements.model import Limit, Value


class Compared(Record):
    """A measure and the side of its bound that it is closer to violating.

    Attributes:
        is_upper: the side is an upper bound.
        is_lone: the bound has no other side.
    """

    measure: Measure
    is_upper: bool
    is_lone: bool

    def kept(self, is_complete: bool) -> bool | None:
        """Whether the bound is kept; None: undecided while the measure may grow.

        Args:
            is_complete: the measure does not grow any more.
        """
        if self.measure.excess > 0:
            return False if self.is_upper or is_complete else None
        return True if is_complete else None


def compared(limit: Limit, si: float, observed: Observed, moment: Moment) -> Compared | Unknown:
    """Compare a measure with its bound, which is evaluated at a moment.

    Args:
        si: the measured value.
    """
    first = _beside(limit, limit.relation in ("<=", "<"), si, bound_at(limit.value, observed, moment))
    if limit.upper is None or isinstance(first, Unknown):
        return first
    second = _beside(limit, True, si, bound_at(limit.upper, observed, moment))
    if isinstance(second, Unknown):
        return second
    return first if first.measure.excess >= second.measure.excess else second


def _beside(limit: Limit, is_upper: bool, si: float, bound: Value | Bound | Unknown) -> Compared | Unknown:
    """Compare a measure with one side of its bound."""
    if isinstance(bound, Unknown):
        return bound
    excess = si - bound.si if is_upper else bound.si - si
    if excess == 0 and limit.relation in ("<", ">"):
        excess = _JUST
    measure = Measure(si, bound.unit, bound.si, bound.text, excess)
    return Compared(measure, is_upper, limit.upper is None)


_JUST: Final = 1e-9  # a measure equal to a strict bound violates it
