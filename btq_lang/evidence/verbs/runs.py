"""`runs every d` and `runs at least m per d`: how a node's starts are spread over the time in scope."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from operator import itemgetter
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.limits import Measure, compared
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement
from btq_lang.requirements.model import Claim, Value
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.over_run import OverRun, Stretch


def judge_run(claim: Claim, run: OverRun) -> Iterator[Judgement | None]:
    """Judge whether it starts often enough, and not too often: each time between two starts, or each period."""
    starts = run.starts()
    for stretch in run.stretches():
        inside = [(each, counts) for each, counts in starts if stretch.begin <= each.started <= stretch.end]
        unclear = [counts.why for _, counts in inside if isinstance(counts, Unknown)]
        if stretch.why or unclear:
            yield Judgement(None, stretch.begin[0], stretch.why or unclear[0])
            continue
        is_open = run.is_cut_off and stretch.end == run.observed.end
        found = [each for each, _ in inside]
        if claim.every:
            yield from _between(claim, run, stretch, found, is_open)
        else:
            yield from _in_windows(claim, run, stretch, found, is_open)


def _between(
    claim: Claim, run: OverRun, stretch: Stretch, starts: Sequence[Activation], is_open: bool
) -> Iterator[Judgement | None]:
    """Judge the times from each start to the next, and from the last to the end of the stretch."""
    assert claim.limit is not None, "`every` has a bound"
    for index, start in enumerate(starts):
        is_last = index + 1 == len(starts)
        until = stretch.end[0] if is_last else starts[index + 1].begin
        found = compared(claim.limit, (until - start.begin) / 1e6, run.observed, start.started)
        if isinstance(found, Unknown):
            yield Judgement(None, until, found.why)
            continue
        holds = found.excess <= 0
        sentence = (
            "had not run again after {}" if is_last else VERBS["runs"].said.replace("{}", "{} after its last start")
        )
        yield None if is_last and is_open and holds else Judgement(holds, until, sentence, found, start.begin)


def _in_windows(
    claim: Claim, run: OverRun, stretch: Stretch, starts: Sequence[Activation], is_open: bool
) -> Iterator[Judgement | None]:
    """Judge the windows with the fewest and the most starts; a stretch shorter than a window has none."""
    assert claim.limit is not None, "a number of starts has a bound"
    assert isinstance(claim.per, Value), "and a time"
    length = round(claim.per.si * 1e6)
    begin, last = stretch.begin[0], stretch.end[0] - length  # when the first and the last window begin
    if begin > last:
        return
    times = [each.begin for each in starts]

    def number(window: int) -> int:
        return bisect_left(times, window + length) - bisect_left(times, window)

    # Candidates are windows that a start has just left, or in which a start is the last; of equals, the first.
    fewest = min([(number(each), each) for each in [begin, *[time + 1 for time in times if time < last]]])
    fullest = [begin, *[max(begin, min(time + 1 - length, last)) for time in times]]
    most = max([(number(each), each) for each in fullest], key=itemgetter(0))
    worst: tuple[Measure, int] | None = None
    for count, window in (fewest, most):
        found = compared(claim.limit, float(count), run.observed, stretch.begin)
        if isinstance(found, Unknown):
            yield Judgement(None, stretch.begin[0], found.why)
            return
        if worst is None or found.excess > worst[0].excess:
            worst = found, window
    assert worst is not None, "there are two"
    measure, window = worst
    measure.unit = None
    if measure.excess > 0:
        inside = starts[bisect_left(times, window) : bisect_left(times, window + length)]
        sentence = VERBS["runs"].said.replace("{}", f"{counted(len(inside), 'time')} in {claim.per.text}")
        yield Judgement(False, window + length, sentence, measure, window, inside)
    elif is_open:
        yield None
    else:
        yield Judgement(True, stretch.end[0], "", measure)
