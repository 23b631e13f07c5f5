"""`takes at most d`: how long an activation lasts.

Violated as soon as it lasts longer, however it ends; a lower bound is judged where it has come to its own end.
"""

from __future__ import annotations

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.conditions import bound_at
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement, Measure

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.signals import Signals
    from btq_lang.requirements.model import Claim, Limit


def judge(claim: Claim, activation: Activation, signals: Signals) -> Judgement | None:
    """Whether an activation is as long as it should be."""
    assert claim.limit is not None, "a time has a bound"
    completed = activation.outcome in ("S", "F")
    if not completed and claim.limit.relation in (">=", ">"):
        return None
    found = measure(claim.limit, activation, signals)
    if isinstance(found, Unknown):
        return Judgement(None, activation.end, found.why)
    is_upper, duration = found
    if duration.excess > 0 and (is_upper or completed):
        if activation.timing == "latest":
            return Judgement(None, activation.end, UNKNOWN_END)
        return Judgement(False, activation.end, VERBS["takes"].said, duration)
    if not completed:
        return None
    return Judgement(True, activation.end, VERBS["takes"].said, duration)


def measure(limit: Limit, activation: Activation, signals: Signals) -> tuple[bool, Measure] | Unknown:
    """How long an activation lasts beside the side of its bound that it is closer to breaking, and whether that is the
    upper one; unknown where the bound is, or the time."""
    if activation.timing == "broken":
        return Unknown("the clock was set back meanwhile")
    bounds = [bound_at(each, signals, activation.begin) for each in (limit.value, limit.upper) if each is not None]
    sides: list[tuple[bool, Measure]] = []
    for index, bound in enumerate(bounds):
        if isinstance(bound, Unknown):
            return bound
        is_upper = limit.relation in ("<=", "<") or index == 1
        seconds = activation.seconds
        excess = seconds - bound.si if is_upper else bound.si - seconds
        if excess == 0 and limit.relation in ("<", ">"):
            excess = _JUST
        sides.append((is_upper, Measure(seconds, bound.unit, bound.si, bound.text, excess)))
    return max(sides, key=lambda side: side[1].excess)


UNKNOWN_END = "the log does not say when it was halted"
_JUST = 1e-9  # what is as long as a bound that it must not reach breaks it
