"""`takes at most d`: how long an activation lasts.

An upper bound is violated as soon as the activation lasts longer, however it ends; a lower bound is judged only if it
has ended by itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.limits import Measure, compared
from btq_lang.evidence.model import CLOCK_SET_BACK, UNKNOWN_END
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.observed import Observed
    from btq_lang.requirements.model import Claim, Limit


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Judge the duration of an activation."""
    assert claim.limit is not None, "a time has a bound"
    if is_left_out(claim.limit, activation):
        return None
    found = duration(claim.limit, activation, observed)
    if isinstance(found, Unknown):
        return Judgement(None, activation.end, found.why)
    return judged(found, activation, VERBS["takes"].said)


def is_left_out(limit: Limit, activation: Activation) -> bool:
    """Whether an activation cannot violate a bound: one that was halted, or is open, cannot fall short of a lower
    bound.
    """
    return limit.relation in (">=", ">") and activation.outcome not in ("S", "F")


def judged(found: Measure, activation: Activation, sentence: str) -> Judgement | None:
    """The judgement of a measure that grows during an activation: if it was halted, only a violation by then counts."""
    holds = found.kept(activation.outcome in ("S", "F"))
    if holds is None:
        return None
    if not holds and activation.timing == "latest":
        return Judgement(None, activation.end, UNKNOWN_END)
    return Judgement(holds, activation.end, sentence, found)


def duration(limit: Limit, activation: Activation, observed: Observed) -> Measure | Unknown:
    """The duration of an activation, compared with its bound; unknown if either is."""
    if activation.timing == "broken":
        return Unknown(CLOCK_SET_BACK)
    return compared(limit, activation.seconds, observed, activation.started)
