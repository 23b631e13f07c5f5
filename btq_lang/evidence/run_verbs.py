"""Judges clauses whose verbs are about a whole run: how soon, how often and after what a node starts; for `takes`, also
the time between events, and sums.

One invariant: a run is judged when it has ended, and a judgement is None where the end of the log cuts it off.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate
from math import ceil, floor
from typing import Final, TypeAlias

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.conditions import Measure, compared
from btq_lang.evidence.model import UNKNOWN_END, Activation, Moment
from btq_lang.evidence.over_run import Happening, OverRun, Stretch
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.verbs import Judgement
from btq_lang.requirements.model import Claim, Span, Subject, Target, Total, Value
from btq_lang.util.text import counted

Judgements: TypeAlias = Iterator[Judgement | None]
RunJudge: TypeAlias = Callable[[Claim, OverRun], Judgements]


def run_judge(claim: Claim, subject: Subject | None) -> RunJudge | None:
    """The function that judges a clause for a subject when a run has ended; None: none does."""
    if isinstance(subject, Span | Total):
        of_several = _span if isinstance(subject, Span) else _total
        return of_several if VERBS[claim.verb].limits == "completion" else None
    return JUDGES.get(claim.verb)


# ---- reactions to events ----


def _starts(claim: Claim, run: OverRun) -> Judgements:
    """`starts within d after ev`: for each event, whether the next start comes in time."""
    assert claim.event is not None, "the clause names one"
    moments = [each.started for each in run.own]
    for event in run.happenings(claim.event):
        index = bisect_left(moments, event.at)
        answer = Happening(moments[index], moments[index]) if index < len(moments) else None
        yield from _answered(claim, run, event, answer, "had not started after {}")


def _ends(claim: Claim, run: OverRun) -> Judgements:
    """`ends within d after ev`: for each event that happens while the node is active, whether it ends in time."""
    assert claim.event is not None, "the clause names one"
    moments = [each.started for each in run.own]
    for event in run.happenings(claim.event):
        index = bisect_right(moments, event.at) - 1
        if index < 0 or run.own[index].ended < event.at:
            continue
        ended = run.own[index]
        answer = None
        if ended.outcome != "O":
            answer = Happening(ended.ended, ended.ended, UNKNOWN_END if ended.timing == "latest" else "")
        yield from _answered(claim, run, event, answer, "had not ended after {}")


def _answered(claim: Claim, run: OverRun, event: Happening, answer: Happening | None, never: str) -> Judgements:
    """The judgement of an event and its answer, if they count; None: the log ends before the deadline.

    Args:
        answer: None: there is none in the run.
        never: the sentence for its absence.
    """
    until = answer.until if answer is not None else run.root.ended
    found = compared(claim, (until[0] - event.at[0]) / 1e6, run.observed, event.at)
    deadline = until
    if not isinstance(found, Unknown):
        deadline = min(until, (event.at[0] + round(found.bound.si * 1e6), until[1]))
    counts = run.counts(event.at, deadline)
    if counts is False:
        return
    time = deadline[0]
    if event.why or isinstance(found, Unknown):
        yield Judgement(None, time, found.why if isinstance(found, Unknown) else event.why)
    elif answer is None and found.holds and run.is_cut_off:
        yield None
    elif isinstance(counts, Unknown):
        yield Judgement(None, time, counts.why)
    elif answer is not None and answer.why and not found.holds:
        yield Judgement(None, time, answer.why)
    elif answer is not None:
        yield Judgement(found.holds, until[0], VERBS[claim.verb].said, found, event.at[0])
    elif not found.holds:
        yield Judgement(False, time, never, found, event.at[0])
    else:
        yield Judgement(None, time, "the run ended before the time was over")


def _follows(claim: Claim, run: OverRun) -> Judgements:
    """`follows ev`: for each start, whether the event has happened in the run since the start before it."""
    assert claim.event is not None, "the clause names one"
    events = run.happenings(claim.event)
    name = claim.text.partition(" follows ")[2]
    before = (run.root.begin, -1)  # the beginning of the run
    for start in run.own:
        found = [each for each in events if each.until > before and each.at <= start.started]
        is_sure = any(each.is_certain and before < each.at and each.until <= start.started for each in found)
        since = "since its last start" if before[1] >= 0 else "before it in the run"
        before = start.started
        counts = run.counts_one(start)
        if counts is False:
            continue
        unclear = counts.why if isinstance(counts, Unknown) else found[0].why if found and not is_sure else ""
        if is_sure and start.outcome == "O":
            yield None
        elif unclear:
            yield Judgement(None, start.begin, unclear)
        else:
            sentence = f"followed `{name}`" if is_sure else f"`{name}` did not happen {since}"
            yield Judgement(is_sure, start.begin, VERBS[claim.verb].said.replace("{}", sentence))


# ---- numbers of starts ----


def _tries(claim: Claim, run: OverRun) -> Judgements:
    """`tries at most m per P`: how often a node starts in each activation of another; without `per`, in the run."""
    starts = run.starts()
    moments = [each.started for each, _ in starts]
    for period in run.observed.nodes.activations(claim.per) if isinstance(claim.per, Target) else [run.root]:
        inside = starts[bisect_left(moments, period.started) : bisect_right(moments, period.ended)]
        least = _number(claim, run, period, [each for each, counts in inside if counts is True])
        most = _number(claim, run, period, [each for each, _ in inside])
        may_break = most is not None and most.holds is False
        if (least is None and may_break) or (least is not None and most is not None and least.holds is not most.holds):
            why = next(counts.why for _, counts in inside if isinstance(counts, Unknown))
            yield Judgement(None, period.end, why)
        elif least is not None or period.outcome == "O":
            yield least


def _number(claim: Claim, run: OverRun, period: Activation, starts: Sequence[Activation]) -> Judgement | None:
    """The judgement of a number of starts; None: undecided, because there may have been more."""
    assert claim.limit is not None, "a number of tries has a bound"
    number = len(starts)
    found = compared(claim, float(number), run.observed.during(period), period.started)
    if isinstance(found, Unknown):
        return Judgement(None, period.end, found.why)
    holds = found.kept(period.outcome in ("S", "F"))
    if holds is None and (period.outcome == "O" or not found.holds):
        return None
    if holds is False and period.timing == "latest":
        return Judgement(None, period.end, UNKNOWN_END, found)
    at = period.end
    if holds is False and found.is_upper and starts:
        bound = found.bound.si
        at = starts[max(floor(bound) if claim.limit.relation != "<" else ceil(bound) - 1, 0)].begin
    sentence = VERBS[claim.verb].said.replace("{}", counted(number, "time"))
    found.unit = None
    return Judgement(holds is not False, at, sentence, found, period.begin, starts)


def _runs(claim: Claim, run: OverRun) -> Judgements:
    """`runs every d` and `runs at least m per d`: how a node's starts are spread over the time in scope, in each time
    between two starts, or in each period.
    """
    starts = run.starts()
    for stretch in run.stretches():
        inside = [(each, counts) for each, counts in starts if stretch.begin <= each.started <= stretch.end]
        unclear = [counts.why for _, counts in inside if isinstance(counts, Unknown)]
        if stretch.why or unclear:
            yield Judgement(None, stretch.begin[0], stretch.why or unclear[0])
            continue
        is_open = run.is_cut_off and stretch.end == run.observed.end
        found = [each for each, _ in inside]
        yield from (_between if claim.every else _in_windows)(claim, run, stretch, found, is_open)


def _between(claim: Claim, run: OverRun, stretch: Stretch, starts: Sequence[Activation], is_open: bool) -> Judgements:
    """Judge the times from each start to the next, and from the last to the end of the stretch."""
    said = VERBS[claim.verb].said.replace("{}", "{} after its last start")
    for index, start in enumerate(starts):
        is_last = index + 1 == len(starts)
        until = stretch.end[0] if is_last else starts[index + 1].begin
        found = compared(claim, (until - start.begin) / 1e6, run.observed, start.started)
        if isinstance(found, Unknown):
            yield Judgement(None, until, found.why)
        elif is_last and is_open and found.holds:
            yield None
        else:
            sentence = "had not run again after {}" if is_last else said
            yield Judgement(found.holds, until, sentence, found, start.begin)


def _in_windows(
    claim: Claim, run: OverRun, stretch: Stretch, starts: Sequence[Activation], is_open: bool
) -> Judgements:
    """Judge the windows with the fewest and the most starts; a stretch shorter than a window has none."""
    assert isinstance(claim.per, Value), "the starts are counted in a time"
    length = round(claim.per.si * 1e6)
    begin, last = stretch.begin[0], stretch.end[0] - length  # when the first and the last window begin
    if begin > last:
        return
    times = [each.begin for each in starts]

    def inside(window: int) -> slice:
        return slice(bisect_left(times, window), bisect_left(times, window + length))

    def number(window: int) -> int:
        return len(times[inside(window)])

    # Candidates are windows that a start has just left, or in which a start is the last; of equals, the first.
    fewest = min([begin, *[time + 1 for time in times if time < last]], key=lambda each: (number(each), each))
    fullest = max([begin, *[max(begin, min(time + 1 - length, last)) for time in times]], key=number)
    measures: list[tuple[Measure, int]] = []
    for window in (fewest, fullest):
        found = compared(claim, float(number(window)), run.observed, stretch.begin)
        if isinstance(found, Unknown):
            yield Judgement(None, stretch.begin[0], found.why)
            return
        measures.append((found, window))
    measure, window = max(measures, key=lambda each: each[0].excess)
    measure.unit = None
    if not measure.holds:
        broken = starts[inside(window)]
        sentence = VERBS[claim.verb].said.replace("{}", f"{counted(len(broken), 'time')} in {claim.per.text}")
        yield Judgement(False, window + length, sentence, measure, window, broken)
    elif is_open:
        yield None
    else:
        yield Judgement(True, stretch.end[0], "", measure)


# ---- the time between events, and sums ----


def _span(claim: Claim, run: OverRun) -> Judgements:
    """`from e₁ to e₂ takes at most d`: the time from each first event to the next last event in the run."""
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
        yield from _ended(claim, run, event, end, unclear)


def _ended(claim: Claim, run: OverRun, first: Happening, last: Moment | None, unclear: str) -> Judgements:
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
    found = compared(claim, (until[0] - first.at[0]) / 1e6, run.observed, first.at)
    if first.why or isinstance(found, Unknown):
        yield Judgement(None, until[0], found.why if isinstance(found, Unknown) else first.why)
        return
    is_late = found.is_upper and not found.holds
    if unclear and (is_late or last is None or not (found.is_upper and claim.limit.upper is None)):
        yield Judgement(None, until[0], unclear)
    elif last is None and not is_late and run.is_cut_off:
        yield None
    elif isinstance(counts, Unknown):
        yield Judgement(None, until[0], counts.why)
    elif last is not None:
        yield Judgement(found.holds, until[0], VERBS[claim.verb].said, found, first.at[0])
    elif is_late:
        yield Judgement(False, until[0], "had not come to an end after {}", found, first.at[0])
    elif claim.limit.relation not in (">=", ">"):
        yield Judgement(False, until[0], "its last event did not happen before the run ended")


def _total(claim: Claim, run: OverRun) -> Judgements:
    """`sum of X, Y takes at most d`: the durations of some nodes in a run, added up."""
    starts = run.starts()
    sure = [each for each, counts in starts if counts is True and each.timing == "exact"]
    unclear = next((counts.why for _, counts in starts if isinstance(counts, Unknown)), UNKNOWN_END)
    least, most = _sum(claim, run, sure), _sum(claim, run, [each for each, _ in starts])
    if least is not None and most is not None and least.holds is most.holds:
        yield least
    elif least is None and most is None:
        yield None
    else:
        yield Judgement(None, run.root.end, unclear)


def _sum(claim: Claim, run: OverRun, starts: Sequence[Activation]) -> Judgement | None:
    """The judgement of a sum of durations; None: undecided, because the log ends before the run does."""
    total = sum(each.end - each.begin for each in starts)
    found = compared(claim, total / 1e6, run.observed, run.observed.begin)
    if isinstance(found, Unknown):
        return Judgement(None, run.root.end, found.why)
    holds = found.kept(not run.is_cut_off)
    sentence = VERBS[claim.verb].said.replace("{}", "{} together")
    return Judgement(holds, run.root.end, sentence, found, run.root.begin, starts) if holds is not None else None


JUDGES: Final[dict[str, RunJudge]] = {
    "starts": _starts,
    "ends": _ends,
    "follows": _follows,
    "tries": _tries,
    "runs": _runs,
}
