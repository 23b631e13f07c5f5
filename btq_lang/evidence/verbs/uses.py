"""`uses at most x of k`: how much a level falls, or a counter rises, during an activation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.limits import compared
from btq_lang.evidence.model import CLOCK_SET_BACK, Activation
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs.takes import judged

if TYPE_CHECKING:
    from btq_lang.evidence.observed import Observed
    from btq_lang.evidence.verbs import Judgement
    from btq_lang.requirements.model import Claim, Signal


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Judge how much an activation uses."""
    assert claim.limit is not None, "the use has a bound"
    assert claim.signal is not None, "the clause names what is used"
    used = _used(claim.signal, activation, observed)
    found = used if isinstance(used, Unknown) else compared(claim.limit, used, observed, activation.started)
    return judged(claim.limit, found, activation, VERBS["uses"].said)


def _used(signal: Signal, activation: Activation, observed: Observed) -> float | Unknown:
    if activation.timing == "broken":
        return Unknown(CLOCK_SET_BACK)
    if signal.behaviour == "gauge":
        return Unknown(f"`{signal.name}` is neither a level nor a counter")
    levels: list[float] = []
    for moment in (activation.started, activation.ended):
        value = observed.reading(signal, moment)
        if isinstance(value, Unknown):
            return value
        assert not isinstance(value, str), "what is used is a number"
        levels.append(float(value))
    before, after = levels
    return before - after if signal.behaviour == "level" else after - before
