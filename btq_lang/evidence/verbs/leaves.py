"""`leaves φ`: a condition when an activation has succeeded."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.conditions import reading_of, truth
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement, Measure

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation, Moment
    from btq_lang.evidence.observed import Observed
    from btq_lang.requirements.model import Claim, Condition


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Whether the condition holds when an activation has succeeded."""
    assert claim.condition is not None, "it leaves a condition"
    if activation.outcome != "S":
        return None
    return judged_at(claim.condition, activation.ended, observed, VERBS["leaves"].said)


def judged_at(condition: Condition, moment: Moment, observed: Observed, said: str) -> Judgement:
    """Whether a condition holds at a moment.

    Args:
        said: the sentence that the measure becomes a part of.
    """
    time = moment[0]
    found = truth(condition, observed, moment)
    if isinstance(found, Unknown):
        return Judgement(None, time, found.why)
    reading = reading_of(condition, observed, moment)
    if reading is None:
        return Judgement(found, time, said.replace("{}", f"the condition {'holds' if found else 'does not hold'}"))
    bound = reading.bound
    measure = Measure(reading.si, reading.unit, bound.si, bound.text, reading.excess)
    return Judgement(found, time, said.replace("{}", f"`{reading.name}` was {{}}"), measure)
