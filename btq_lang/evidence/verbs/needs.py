"""`needs φ`: a condition at the start of an activation, however it ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.verbs.leaves import judged_at

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.observed import Observed
    from btq_lang.evidence.verbs import Judgement
    from btq_lang.requirements.model import Claim


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Judge whether the condition holds when an activation starts."""
    assert claim.condition is not None, "it needs a condition"
    return judged_at(claim.condition, activation.started, observed, VERBS["needs"].said)
