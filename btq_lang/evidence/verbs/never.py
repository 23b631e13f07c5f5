"""`never φ`: keeps `not φ`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.verbs.keeps import judged_all_along
from btq_lang.requirements.model import Claim, Not

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.observed import Observed
    from btq_lang.evidence.verbs import Judgement


def judge(claim: Claim, activation: Activation, observed: Observed) -> Judgement | None:
    """Judge whether the condition holds at no time."""
    assert claim.condition is not None, "something must not be"
    return judged_all_along(Not(claim.condition), activation, observed, VERBS["never"].said)
