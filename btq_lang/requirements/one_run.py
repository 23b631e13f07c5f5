"""What a single run cannot decide of a requirement, and which of its clauses it can show."""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.verbs import POOLED
from btq_lang.requirements.model import MissionRun, ResolvedClaim, ResolvedRequirement, Subject


def never_satisfied_by_one(requirement: ResolvedRequirement) -> str:
    """What of a requirement needs more runs than one before it can be satisfied; empty if one may be enough."""
    odds, confidence = requirement.odds, requirement.confidence
    if odds is not None and odds.experiments == "runs" and confidence is not None:
        limit = 1 - confidence  # of Clopper and Pearson, for one of one
        return needs_runs(requirement) if limit < odds.probability else ""
    if confidence is not None and any(_is_of_means(each) and _is_of_run(each.subject) for each in requirement.claims):
        return needs_runs(requirement)
    return ""


def needs_runs(requirement: ResolvedRequirement) -> str:
    """What of a requirement takes many runs, activations or hours to decide; empty if one run is judged as it is."""
    confidence = f" with confidence {requirement.confidence * 100:g} %" if requirement.confidence is not None else ""
    if requirement.odds is not None:
        return f"`{requirement.odds.text}`{confidence}" if confidence else ""
    pooled = (claim.text for claim in requirement.claims if claim.verb in POOLED)
    text = next((text for text in pooled if confidence or not text.endswith(_MEAN)), "")
    return f"`{text}`{confidence}" if text else ""


def shown_by_one(requirement: ResolvedRequirement) -> tuple[str, ...]:
    """The clauses without what needs many runs, as a scenario can expect them of the one that it is."""
    if requirement.scopes or requirement.span is not None or requirement.assumptions or requirement.parameters:
        return ()
    claims = [claim for claim in requirement.claims if claim.subject is not None]
    if requirement.odds is not None:
        return tuple(claim.text for claim in claims)
    return tuple(claim.text.removesuffix(_MEAN) for claim in claims if _is_of_means(claim))


def _is_of_means(claim: ResolvedClaim) -> bool:
    return claim.verb.endswith(_MEAN)


def _is_of_run(subject: Subject | None) -> bool:
    return isinstance(subject, MissionRun)


_MEAN: Final = " on average"
