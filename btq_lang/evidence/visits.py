"""Judges `visits A, B`: whether nodes have succeeded in each activation of another one, perhaps in an order."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

from btq_lang.evidence.signals import UnknownValue
from btq_lang.evidence.verbs import OUT, Judgement
from btq_lang.requirements.model import ResolvedClaim, Visit
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation, Moment
    from btq_lang.evidence.over_run import OverRun


def visits(claim: ResolvedClaim, run: OverRun) -> Iterator[Judgement | None]:
    """`visits A, B [in order]`: in each activation that has ended, whether all of them have succeeded, and their first
    successes are in order.
    """
    for period in run.own:
        counts = run.counts_one(period)
        if counts is False or period.outcome == "H":
            yield OUT
        elif period.outcome == "O":
            yield None
        elif isinstance(counts, UnknownValue):
            yield Judgement(None, period.end, counts.why)
        else:
            yield _in_period(claim, run, period)


def _in_period(claim: ResolvedClaim, run: OverRun, period: Activation) -> Judgement:
    firsts: list[Moment] = []
    unclear = ""
    for visit in claim.visits:
        first, number, why = _first(visit, run, period)
        unclear = unclear or why
        if first is None and not why:
            how = f"did not succeed in {counted(number, 'start')}" if number else "did not start"
            return Judgement(False, period.end, f"`{visit.text}` {how}")
        firsts += [first] if first is not None else []
    if unclear:
        return Judgement(None, period.end, unclear)
    for (before, first), (after, second) in pairwise(zip(claim.visits, firsts, strict=True)):
        if claim.in_order and second < first:
            return Judgement(False, period.end, f"`{after.text}` succeeded before `{before.text}`")
    return Judgement(True, period.end, "")


def _first(visit: Visit, run: OverRun, period: Activation) -> tuple[Moment | None, int, str]:
    """The first success of what has to be visited, how often its nodes started, and why another success may have been
    before it; else empty.
    """
    first: Moment | None = None
    unclear: list[tuple[Moment, str]] = []
    number = 0
    for node in visit.nodes:
        for activation in run.observed.nodes.activations(node.target):
            if not period.shown <= activation.ended <= period.ended:
                continue
            begun = activation.begun(run.observed.is_early)
            readings = [(run.observed.reading(signal, begun), value) for signal, value in node.values]
            if any(not isinstance(reading, UnknownValue) and reading != value for reading, value in readings):
                continue
            number += 1
            unknown = next((reading.why for reading, _ in readings if isinstance(reading, UnknownValue)), "")
            if activation.outcome == "S" and unknown:
                unclear.append((activation.ended, unknown))
            elif activation.outcome == "S" and (first is None or activation.ended < first):
                first = activation.ended
    earlier = [why for ended, why in unclear if first is None or ended < first]
    return first, number, earlier[0] if earlier else ""
