"""`succeeds [within d]`: an activation's result, and how long it takes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.model import UNKNOWN_END, Activation
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement
from btq_lang.evidence.verbs.takes import duration

if TYPE_CHECKING:
    from btq_lang.evidence.observed import Observed
    from btq_lang.requirements.model import Claim


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Judge whether an activation succeeds in time; if it is halted or cut off before, it does not count."""
    sentence = VERBS["succeeds"].said
    if claim.limit is None:
        if activation.outcome in ("S", "F"):
            holds = activation.outcome == "S"
            return Judgement(holds, activation.end, sentence.replace("{}", "succeeded" if holds else "failed"))
        return None
    if activation.outcome == "F":
        return Judgement(False, activation.end, sentence.replace("{}", "failed"))
    found = duration(claim.limit, activation, observed)
    if isinstance(found, Unknown):
        return Judgement(None, activation.end, found.why)
    if found.excess > 0:
        if activation.timing == "latest":
            return Judgement(None, activation.end, UNKNOWN_END, found)
        how = "succeeded after {}" if activation.outcome == "S" else "had not succeeded after {}"
        return Judgement(False, activation.end, sentence.replace("{}", how), found)
    if activation.outcome == "S":
        return Judgement(True, activation.end, sentence.replace("{}", "succeeded after {}"), found)
    return None
