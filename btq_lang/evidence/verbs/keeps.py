"""`keeps φ`: a condition from the start of an activation to its end, at each moment at which it may change."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.conditions import Reading
from btq_lang.evidence.observed import Observed, parts_in
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement
from btq_lang.evidence.verbs.leaves import judged, result_at
from btq_lang.requirements.model import Aggregate, Claim, Condition

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation, Moment


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Judge whether the condition holds all the time."""
    assert claim.condition is not None, "it keeps a condition"
    return judged_all_along(claim.condition, activation, observed, VERBS["keeps"].said)


def judged_all_along(condition: Condition, activation: Activation, observed: Observed, sentence: str) -> Judgement:
    """Judge a condition at every moment of an activation: the first violation decides, else a moment at which it is
    unknown, else the moment closest to a violation.
    """
    unknown: tuple[Unknown, Moment] | None = None
    closest: tuple[Reading | bool, Moment] | None = None
    most = float("-inf")
    for moment in observed.moments(condition):
        found = result_at(condition, moment, observed)
        if isinstance(found, Unknown):
            unknown = unknown or (found, moment)
        elif found is False or (isinstance(found, Reading) and not found.holds):
            if activation.timing != "exact" and moment != observed.begin:
                return Judgement(None, moment[0], "the log does not say whether it was still running")
            is_of_all = any(isinstance(each, Aggregate) for each in parts_in(condition))  # known only at the end
            return judged(found, activation.end if is_of_all else moment[0], sentence)
        else:
            excess = found.excess if isinstance(found, Reading) else most
            if closest is None or excess > most:
                closest, most = (found, moment), excess
    result = unknown or closest
    assert result is not None, "the start is one of the moments"
    return judged(result[0], result[1][0], sentence)
