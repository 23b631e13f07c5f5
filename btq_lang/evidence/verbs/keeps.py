"""`keeps φ`: a condition from the start of an activation to its end, at each moment at which it may change."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.observed import parts_in
from btq_lang.evidence.verbs import Judgement
from btq_lang.evidence.verbs.leaves import judged_at
from btq_lang.record import replace
from btq_lang.requirements.model import Aggregate

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.observed import Observed
    from btq_lang.requirements.model import Claim, Condition


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Whether the condition holds all the time."""
    assert claim.condition is not None, "it keeps a condition"
    return judged_all_along(claim.condition, activation, observed, VERBS["keeps"].said)


def judged_all_along(condition: Condition, activation: Activation, observed: Observed, said: str) -> Judgement:
    """Whether a condition holds at every moment of an activation: the first at which it does not decides, else one at
    which it is unknown, else the one that came closest to breaking it."""
    unknown: Judgement | None = None
    closest: Judgement | None = None
    for moment in observed.moments(condition):
        found = judged_at(condition, moment, observed, said)
        if found.holds is False:
            if activation.timing == "exact" or moment == observed.begin:
                is_of_all = any(isinstance(each, Aggregate) for each in parts_in(condition))  # so known only at the end
                return replace(found, at=activation.end) if is_of_all else found
            return Judgement(None, found.at, "the log does not say whether it was still running")
        if found.holds is None:
            unknown = unknown or found
        elif closest is None or _excess(found) > _excess(closest):
            closest = found
    result = unknown or closest
    assert result is not None, "the start is one of the moments"
    return result


def _excess(judgement: Judgement) -> float:
    return judgement.measure.excess if judgement.measure is not None else float("-inf")
