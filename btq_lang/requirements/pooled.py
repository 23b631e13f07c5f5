"""Claims that are judged of all runs together, `fails at most 1 per 200 h` and `on average`: what they cannot have.

One invariant: a claim that passes has one bound in all situations, and no odds.
"""

from __future__ import annotations

from collections.abc import Sequence

from btq_lang.catalog.verbs import POOLED
from btq_lang.requirements import model
from btq_lang.requirements.reader import Reader
from btq_lang.util.record import replace
from btq_lang.util.text import Span


def on_average(
    reader: Reader, claims: Sequence[model.ResolvedClaim], span: Span
) -> tuple[list[model.ResolvedClaim], list[str]]:
    """The claims with `on average`, and the texts of those that measure nothing, which is reported.

    Args:
        span: of `on average`.
    """
    demanded: list[model.ResolvedClaim] = []
    others: list[str] = []
    for claim in claims:
        if f"{claim.verb} on average" in POOLED:
            demanded.append(replace(claim, verb=f"{claim.verb} on average", text=f"{claim.text} on average"))
            continue
        message = f"`on average` is for `takes` and `uses`, and `{claim.head}` has no mean"
        notes = ("write it in a requirement with `takes` or `uses`; `mean(force)` is the mean of a signal",)
        reader.complain("impossible-odds", span, message, notes=notes)
        others.append(claim.text)
    return demanded, others


def judged_together(
    reader: Reader, claims: Sequence[model.ResolvedClaim], odds: object
) -> tuple[list[model.ResolvedClaim], list[str]]:
    """The claims that can be judged, and the texts of the others; why these cannot is reported."""
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
