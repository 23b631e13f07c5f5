"""Judges `fails at most 1 per 200 h`: the failures that a run adds to a rate, and the time for them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.evidence.amounts import Amounts
from btq_lang.evidence.conditions import truth
from btq_lang.evidence.time_shares import pieces
from btq_lang.evidence.verbs import OUT, Judgement
from btq_lang.requirements.model import All, MissionRun, ResolvedClaim

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.over_run import OverRun
    from btq_lang.evidence.signals import UnknownValue


def rate(claim: ResolvedClaim, run: OverRun) -> Iterator[Judgement]:
    """`fails at most m per d of P`: a run, also one that the log cuts off; the exposure is its time, or that of P."""
    exposed = [run.root] if claim.of is None else run.observed.nodes.activations(claim.of)
    times = [piece for activation in exposed for piece in pieces(run, activation)]
    if not times:
        yield OUT
        return
    own = [run.root] if isinstance(claim.subject, MissionRun) else run.own
    failures = [_counts(run, activation) for activation in own if activation.outcome == "F"]
    amounts = Amounts(
        sum(counts is True for counts in failures),
        sum(counts is not False for counts in failures),
        sum(time for time, counts, _ in times if counts is True),
        sum(time for time, *_ in times),
    )
    yield Judgement(True, run.root.end, "", amounts=amounts)


def _counts(run: OverRun, activation: Activation) -> bool | UnknownValue:
    """Whether the end of an activation is in scope, or its start for `when`."""
    observed = run.during(activation).in_scope
    starts, meanwhile = ([scope.condition for scope in run.scopes if scope.word == word] for word in ("when", "while"))
    is_about_it = truth(All(tuple(starts)), observed, observed.begin)
    counts = truth(All(tuple(meanwhile)), observed, observed.end)
    return counts if counts is False or is_about_it is True else is_about_it
