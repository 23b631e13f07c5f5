"""`takes at most d`: how long an activation lasts.

An upper bound is violated as soon as the activation lasts longer, however it ends; a lower bound is judged only if it
has ended by itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.limits import Measure, compared
from btq_lang.evidence.model import CLOCK_SET_BACK, UNKNOWN_END, Activation
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement

if TYPE_CHECKING:
    from btq_lang.evidence.observed import Observed
    from btq_lang.requirements.model import Claim, Limit


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Judge the duration of an activation."""
    assert claim.limit is not None, "a time has a bound"
    return judged(claim.limit, duration(claim.limit, activation, observed), activation, VERBS["takes"].said)


def judged(limit: Limit, found: Measure | Unknown, activation: Activation, sentence: str) -> Judgement | None:
    """The judgement of a measure that grows during an activation: if it was halted, only a violation by then counts."""
    is_complete = activation.outcome in ("S", "F")
    if isinstance(found, Unknown):
        can_fail = is_complete or limit.relation not in (">=", ">")  # else it did not end by itself
        return Judgement(None, activation.end, found.why) if can_fail else None
    holds = found.kept(is_complete)
    if holds is None:
        return None
    if not holds and activation.timing == "latest":
        return Judgement(None, activation.end, UNKNOWN_END, found)
    return Judgement(holds, activation.end, sentence, found)


def duration(limit: Limit, activation: Activation, observed: Observed) -> Measure | Unknown:
    """The duration of an activation, compared with its bound; unknown if either is."""
    if activation.timing == "broken":
        return Unknown(CLOCK_SET_BACK)
    return compared(limit, activation.seconds, observed, activation.started)
