"""Requirements that no log can show: those that people verify, and those without a clause.

One invariant: what `outline.demands` leaves out of a mission is open.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.evidence.outline import Demand
from btq_lang.evidence.tally import Tally
from btq_lang.evidence.verdicts import OPEN, ClauseVerdict

if TYPE_CHECKING:
    from btq_lang.requirements.model import Requirement


def open_reason(requirement: Requirement) -> str:
    """Why no log can show it; empty if logs can."""
    if requirement.is_verified_by_people:
        return f"verified by {requirement.method}"
    return "" if requirement.claims else "it has no clause that can be measured"


def open_clauses(requirement: Requirement) -> tuple[ClauseVerdict, ...]:
    """What a report has of an open requirement: each clause, or one without text if there is none."""
    texts = [Demand(requirement, claim, None, "").text for claim in requirement.claims]
    return tuple(
        ClauseVerdict(
            text=text,
            path="",
            of="",
            verdict=OPEN,
            why=open_reason(requirement),
            unit="activations",
            confidence=requirement.confidence,
            histogram=None,
            **Tally(None, None).fields(),
        )
        for text in texts or [""]
    )
