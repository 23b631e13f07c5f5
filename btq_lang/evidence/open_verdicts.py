"""Requirements that no log can show: those that people verify, and those without a clause; and clauses with mistakes.

One invariant: what `outline.demands` leaves out of a mission is open, or unknown where that is due to a mistake.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.evidence.outline import Demand
from btq_lang.evidence.tally import Tally
from btq_lang.evidence.verdicts import OPEN, UNKNOWN, ClauseVerdict

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import Verdict
    from btq_lang.requirements.model import ResolvedRequirement


def open_reason(requirement: ResolvedRequirement) -> str:
    """Why no log can show it; empty if logs can."""
    if requirement.is_verified_by_people:
        return f"verified by {requirement.method}"
    return "" if requirement.claims or requirement.unread else "it has no clause that can be measured"


def open_clauses(requirement: ResolvedRequirement) -> tuple[ClauseVerdict, ...]:
    """What a report has of an open requirement: each clause, or one without text if there is none."""
    texts = [Demand(requirement, claim, None, "").text for claim in requirement.claims]
    return tuple(_without_evidence(requirement, text, OPEN, open_reason(requirement)) for text in texts or [""])


def unread_clauses(requirement: ResolvedRequirement) -> tuple[ClauseVerdict, ...]:
    """The clauses of a requirement that were not understood."""
    texts = requirement.unread if not requirement.is_verified_by_people else ()
    return tuple(_without_evidence(requirement, text, UNKNOWN, "it has a mistake; run btq check") for text in texts)


def _without_evidence(requirement: ResolvedRequirement, text: str, verdict: Verdict, why: str) -> ClauseVerdict:
    return ClauseVerdict(
        text=text,
        path="",
        of="",
        verdict=verdict,
        why=why,
        unit="activations",
        confidence=requirement.confidence,
        histogram=None,
        **Tally(None, None).fields(),
    )
