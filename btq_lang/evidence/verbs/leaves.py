"""`leaves φ`: a condition at the end of an activation that succeeded."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.conditions import Reading, reading_of, truth
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation, Moment
    from btq_lang.evidence.observed import Observed
    from btq_lang.requirements.model import Claim, Condition


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Judge whether the condition holds when an activation has succeeded."""
    assert claim.condition is not None, "it leaves a condition"
    if activation.outcome != "S":
        return None
    return judged_at(claim.condition, activation.ended, observed, VERBS["leaves"].said)


def judged_at(condition: Condition, moment: Moment, observed: Observed, sentence: str) -> Judgement:
    """Judge a condition at a moment; `{}` in the sentence is the measure."""
    return judged(result_at(condition, moment, observed), moment[0], sentence)


def result_at(condition: Condition, moment: Moment, observed: Observed) -> Reading | bool | Unknown:
    """Whether a condition holds at a moment, as a reading if it compares a signal with a bound."""
    reading = reading_of(condition, observed, moment)
    return reading if reading is not None else truth(condition, observed, moment)


def judged(result: Reading | bool | Unknown, time: int, sentence: str) -> Judgement:
    """The judgement of a condition evaluated at a time; `{}` in the sentence is the measure."""
    if isinstance(result, Reading):
        said = "" if result.holds else sentence.replace("{}", f"`{result.name}` was {{}}")
        return Judgement(result.holds, time, said, result)
    if isinstance(result, Unknown):
        return Judgement(None, time, result.why)
    return Judgement(result, time, sentence.replace("{}", f"the condition {'holds' if result else 'does not hold'}"))
