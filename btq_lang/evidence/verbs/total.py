"""`sum of X, Y takes at most d`: the durations of some nodes in a run, added up."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.limits import compared
from btq_lang.evidence.model import UNKNOWN_END, Activation
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement

if TYPE_CHECKING:
    from btq_lang.evidence.over_run import OverRun
    from btq_lang.requirements.model import Claim


def judge_run(claim: Claim, run: OverRun) -> Iterator[Judgement | None]:
    """Judge the sum of the durations."""
    starts = run.starts()
    sure = [each for each, counts in starts if counts is True and each.timing == "exact"]
    unclear = next((counts.why for _, counts in starts if isinstance(counts, Unknown)), UNKNOWN_END)
    least = _judged(claim, run, sure)
    most = _judged(claim, run, [each for each, _ in starts])
    if least is not None and most is not None and least.holds is most.holds:
        yield least
    elif least is None and most is None:
        yield None
    else:
        yield Judgement(None, run.root.end, unclear)


def _judged(claim: Claim, run: OverRun, starts: Sequence[Activation]) -> Judgement | None:
    """The judgement of a sum of durations; None: undecided, because the log ends before the run does."""
    assert claim.limit is not None, "a time has a bound"
    total = sum(each.end - each.begin for each in starts)
    found = compared(claim.limit, total / 1e6, run.observed, run.observed.begin)
    if isinstance(found, Unknown):
        return Judgement(None, run.root.end, found.why)
    holds = found.kept(not run.is_cut_off)
    sentence = VERBS["takes"].said.replace("{}", "{} together")
    if holds is None:
        return None
    return Judgement(holds, run.root.end, sentence, found, run.root.begin, starts)
