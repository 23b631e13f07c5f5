"""Claims that are judged of all runs together, as `fails at most 1 per 200 h`: what such a claim cannot have.

One invariant: a claim that goes on has one bound, whatever the situation, and no odds.
"""

from __future__ import annotations

from collections.abc import Sequence

from btq_lang.catalog.verbs import POOLED
from btq_lang.requirements import model
from btq_lang.requirements.reader import Reader


def judged_together(
    reader: Reader, claims: Sequence[model.ResolvedClaim], odds: object
) -> tuple[list[model.ResolvedClaim], list[str]]:
    """The claims that can be judged, and the texts of the others, of which it is reported why not."""
    kept: list[model.ResolvedClaim] = []
    others: list[str] = []
    for claim in claims:
        bounds = (claim.limit.value, claim.limit.upper) if claim.limit is not None else ()
        if claim.verb not in POOLED:
            kept.append(claim)
        elif any(isinstance(bound, model.ResolvedTable | model.SignalRead) for bound in bounds):
            message = "all runs are judged together, so the bound cannot depend on the situation"
            notes = ("write a requirement for each situation, with `while` and its condition",)
            reader.complain("impossible-bound", claim.place.span, message, notes=notes)
            others.append(claim.text)
        elif isinstance(odds, model.ResolvedOdds):
            message = "all runs are judged together, so no share of them can be demanded"
            reader.complain("impossible-odds", odds.place.span, message, notes=("write `confidence 95 %` without it",))
            others.append(claim.text)
        else:
            kept.append(claim)
    return kept, others
