"""`starts within d after ev`: how long it takes until a node starts after each event."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.limits import compared
from btq_lang.evidence.over_run import Happening, OverRun
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement

if TYPE_CHECKING:
    from btq_lang.requirements.model import Claim


def judge_run(claim: Claim, run: OverRun) -> Iterator[Judgement | None]:
    """Judge, for each event, whether the next start comes in time."""
    assert claim.event is not None, "the clause names one"
    moments = [each.started for each in run.own]
    for event in run.happenings(claim.event):
        index = bisect_left(moments, event.at)
        answer = Happening(moments[index], moments[index]) if index < len(moments) else None
        yield from judged(claim, run, event, answer, VERBS["starts"].said, "had not started after {}")


def judged(
    claim: Claim, run: OverRun, event: Happening, answer: Happening | None, sentence: str, never: str
) -> Iterator[Judgement | None]:
    """The judgement of an event and its answer, if they count; None: the log ends before the deadline.

    Args:
        answer: None: there is none in the run.
        sentence, never: those for an answer, and for its absence.
    """
    assert claim.limit is not None, "an answer has a time"
    until = answer.until if answer is not None else run.root.ended
    found = compared(claim.limit, (until[0] - event.at[0]) / 1e6, run.observed, event.at)
    deadline = until
    if not isinstance(found, Unknown):
        deadline = min(until, (event.at[0] + round(found.bound.si * 1e6), until[1]))
    counts = run.counts(event.at, deadline)
    if counts is False:
        return
    time = deadline[0]
    if event.why or isinstance(found, Unknown):
        yield Judgement(None, time, found.why if isinstance(found, Unknown) else event.why)
        return
    is_late = found.excess > 0
    if answer is None and not is_late and run.is_cut_off:
        yield None
    elif isinstance(counts, Unknown):
        yield Judgement(None, time, counts.why)
    elif answer is not None and answer.why and is_late:
        yield Judgement(None, time, answer.why)
    elif answer is not None:
        yield Judgement(not is_late, until[0], sentence, found, event.at[0])
    elif is_late:
        yield Judgement(False, time, never, found, event.at[0])
    else:
        yield Judgement(None, time, "the run ended before the time was over")
