"""`leaves φ`: a condition when an activation has succeeded."""

from __future__ import annotations

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.conditions import reading_of, truth
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement, Measure

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.signals import Signals
    from btq_lang.requirements.model import Claim, Condition


def judge(claim: Claim, activation: Activation, signals: Signals) -> Judgement | None:
    """Whether the condition holds when an activation has succeeded."""
    assert claim.condition is not None, "it leaves a condition"
    if activation.outcome != "S":
        return None
    return judged_at(claim.condition, activation.end, signals, VERBS["leaves"].said)


def judged_at(condition: Condition, time: int, signals: Signals, said: str) -> Judgement:
    """Whether a condition holds at a time.

    Args:
        said: the sentence that the measure becomes a part of.
    """
    found = truth(condition, signals, time)
    if isinstance(found, Unknown):
        return Judgement(None, time, found.why)
    reading = reading_of(condition, signals, time)
    if reading is None:
        return Judgement(found, time, said.replace("{}", f"the condition {'holds' if found else 'does not hold'}"))
    bound = reading.bound
    measure = Measure(reading.si, reading.signal.unit, bound.si, bound.text, reading.excess)
    return Judgement(found, time, said.replace("{}", f"`{reading.signal.name}` was {{}}"), measure)
