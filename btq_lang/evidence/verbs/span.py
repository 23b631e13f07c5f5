"""`from e₁ to e₂ takes at most d`: the time from each first event to the next last event in the run."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from itertools import accumulate
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.limits import compared
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement
from btq_lang.requirements.model import Claim, Span

if TYPE_CHECKING:
    from btq_lang.evidence.model import Moment
    from btq_lang.evidence.over_run import Happening, OverRun


def judge_run(claim: Claim, run: OverRun) -> Iterator[Judgement | None]:
    """Judge the duration of each span."""
    span = claim.subject
    assert isinstance(span, Span), "the time between two events"
    first = span.first
    lasts = run.happenings(span.last)
    certain = [each for each in lasts if each.is_certain]
    moments = [each.at for each in certain]
    ends = [*accumulate((each.until for each in reversed(certain)), min)][::-1]  # the first end from each index on
    unsure = [each for each in lasts if each.why]
    next_after = bisect_right if first == span.last else bisect_left  # an event does not follow itself
    for event in run.happenings(first, run.own if first.condition is None else None):
        index = next_after(moments, event.at)
        end = ends[index] if index < len(ends) else None
        until = end if end is not None else run.root.ended
        unclear = next((each.why for each in unsure if each.until >= event.at and each.at <= until), "")
        yield from _judged(claim, run, event, end, unclear)


def _judged(
    claim: Claim, run: OverRun, first: Happening, last: Moment | None, unclear: str
) -> Iterator[Judgement | None]:
    """The judgement of a span, if it counts.

    Args:
        last: when it ended; None: not in the run.
        unclear: why it may have ended before; else empty.
    """
    assert claim.limit is not None, "a time has a bound"
    until = last if last is not None else run.root.ended
    counts = run.counts(first.at, until)
    if counts is False:
        return
    found = compared(claim.limit, (until[0] - first.at[0]) / 1e6, run.observed, first.at)
    if first.why or isinstance(found, Unknown):
        yield Judgement(None, until[0], found.why if isinstance(found, Unknown) else first.why)
        return
    is_late = found.is_upper and found.excess > 0
    if unclear and (is_late or last is None or not (found.is_upper and claim.limit.upper is None)):
        yield Judgement(None, until[0], unclear)
    elif last is None and not is_late and run.is_cut_off:
        yield None
    elif isinstance(counts, Unknown):
        yield Judgement(None, until[0], counts.why)
    elif last is not None:
        yield Judgement(found.excess <= 0, until[0], VERBS["takes"].said, found, first.at[0])
    elif is_late:
        yield Judgement(False, until[0], "had not come to an end after {}", found, first.at[0])
    elif claim.limit.relation not in (">=", ">"):
        yield Judgement(False, until[0], "its last event did not happen before the run ended")
