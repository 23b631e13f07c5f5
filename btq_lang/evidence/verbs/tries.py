"""`tries at most m per P`: how often a node starts during an activation of another; without `per`, during a run."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from math import ceil, floor
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.limits import compared
from btq_lang.evidence.model import UNKNOWN_END, Activation
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement
from btq_lang.requirements.model import Claim, Target
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.over_run import OverRun


def judge_run(claim: Claim, run: OverRun) -> Iterator[Judgement | None]:
    """Judge the number of starts in each activation of the other node."""
    starts = run.starts()
    moments = [each.started for each, _ in starts]
    for period in run.observed.nodes.activations(claim.per) if isinstance(claim.per, Target) else [run.root]:
        inside = starts[bisect_left(moments, period.started) : bisect_right(moments, period.ended)]
        sure = [each for each, counts in inside if counts is True]
        least = _judged(claim, run, period, sure)
        most = _judged(claim, run, period, [each for each, _ in inside])
        may_break = most is not None and most.holds is False
        if (least is None and may_break) or (least is not None and most is not None and least.holds is not most.holds):
            why = next(counts.why for _, counts in inside if isinstance(counts, Unknown))
            yield Judgement(None, period.end, why)
        elif least is not None or period.outcome == "O":
            yield least


def _judged(claim: Claim, run: OverRun, period: Activation, starts: Sequence[Activation]) -> Judgement | None:
    """The judgement of a number of starts; None: undecided, because there may have been more."""
    assert claim.limit is not None, "a number of tries has a bound"
    number = len(starts)
    found = compared(claim.limit, float(number), run.observed.during(period), period.started)
    if isinstance(found, Unknown):
        return Judgement(None, period.end, found.why)
    holds = found.kept(period.outcome in ("S", "F"))
    if holds is None and (period.outcome == "O" or found.excess > 0):
        return None
    if holds is False and period.timing == "latest":
        return Judgement(None, period.end, UNKNOWN_END, found)
    at = period.end
    if holds is False and found.is_upper and starts:
        bound = found.bound.si
        at = starts[max(floor(bound) if claim.limit.relation != "<" else ceil(bound) - 1, 0)].begin
    sentence = VERBS["tries"].said.replace("{}", counted(number, "time"))
    found.unit = None
    return Judgement(holds is not False, at, sentence, found, period.begin, starts)
