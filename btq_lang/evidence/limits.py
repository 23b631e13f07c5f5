"""A measure beside its bound: which side of it is closer to being broken, and whether that is so already."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.evidence.conditions import bound_at
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Measure
from btq_lang.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.model import Moment
    from btq_lang.evidence.observed import Observed
    from btq_lang.requirements.model import Limit


class Compared(Record):
    """A measure and the side of its bound that it is closer to breaking.

    Attributes:
        is_upper: of a measure that must not be larger.
        is_lone: the bound has no other side.
    """

    measure: Measure
    is_upper: bool
    is_lone: bool

    def kept(self, is_complete: bool) -> bool | None:
        """Whether the bound is kept; None: that is not decided while the measure may grow.

        Args:
            is_complete: it does not grow any more.
        """
        if self.measure.excess > 0:
            return False if self.is_upper or is_complete else None
        return True if is_complete else None


def compared(limit: Limit, si: float, observed: Observed, moment: Moment) -> Compared | Unknown:
    """A measure beside its bound, which is read at a moment.

    Args:
        si: what was measured.
    """
    sides: list[Compared] = []
    for index, each in enumerate((limit.value, limit.upper)):
        if each is None:
            continue
        bound = bound_at(each, observed, moment)
        if isinstance(bound, Unknown):
            return bound
        is_upper = limit.relation in ("<=", "<") or index == 1
        excess = si - bound.si if is_upper else bound.si - si
        if excess == 0 and limit.relation in ("<", ">"):
            excess = _JUST
        measure = Measure(si, bound.unit, bound.si, bound.text, excess)
        sides.append(Compared(measure, is_upper, limit.upper is None))
    return max(sides, key=lambda side: side.measure.excess)


_JUST: Final = 1e-9  # what is as large as a bound that it must not reach breaks it
