"""Judges clauses whose verbs are about a whole run: how soon, how often and after what a node starts; for `takes`, also
the time between events, and sums.

One invariant: a run is judged when it has ended, and a judgement is None where the end of the log cuts it off; what
does not count is judged `OUT`, so that the judgements of one run, with earlier and with later begins, correspond.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import ceil, floor
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.conditions import Measure, compared, truth
from btq_lang.evidence.exposure import rate
from btq_lang.evidence.kept_spans import kept_in_spans
from btq_lang.evidence.model import UNKNOWN_BEGIN, UNKNOWN_END, Activation
from btq_lang.evidence.over_run import Happening, NextOf, OverRun, Stretch, is_never_at_once, next_finder
from btq_lang.evidence.signals import UnknownValue
from btq_lang.evidence.time_shares import of_time
from btq_lang.evidence.verbs import OUT, Judgement, between, is_same
from btq_lang.evidence.visits import visits
from btq_lang.requirements.model import (
    Condition,
    DurationSum,
    Interval,
    MissionRun,
    NodeTarget,
    Quantity,
    ResolvedClaim,
    ResolvedEachEvent,
    Subject,
)
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.guards import RefusedStart
    from btq_lang.evidence.model import Moment
    from btq_lang.evidence.observed import Observed

Judgements: TypeAlias = Iterator[Judgement | None]
RunJudge: TypeAlias = Callable[[ResolvedClaim, OverRun], Judgements]
_Times: TypeAlias = tuple[Measure, Measure]  # the shortest and the longest that a time may be


def run_judge(claim: ResolvedClaim, subject: Subject | None, *, has_span: bool = False) -> RunJudge | None:
    """The function that judges a clause for a subject when a run has ended; None: none does.

    Args:
        has_span: it holds only from an event until another one.
    """
    if has_span:
        is_kept = VERBS[claim.verb].is_of_moments and isinstance(subject, NodeTarget | MissionRun)
        return kept_in_spans if is_kept else None
    if isinstance(subject, Interval | DurationSum):
        of_several = _span if isinstance(subject, Interval) else _total
        return of_several if VERBS[claim.verb].limits == "completion" else None
    return JUDGES.get(claim.verb)


# ---- reactions to events ----


def _starts(claim: ResolvedClaim, run: OverRun) -> Judgements:
    """`starts within d after ev`: for each event, whether the next start comes in time."""
    assert claim.event is not None, "the clause names one"
    moments = run.begins(claim.event)
    for event in run.happenings(claim.event):
        index = bisect_left(moments, event.first)
        answer = _begin(run.own[index], run) if index < len(moments) else None
        yield from _answered(claim, run, event, answer, "had not started")


def _ends(claim: ResolvedClaim, run: OverRun) -> Judgements:
    """`ends within d after ev`: for each event that happens while the node is active, whether it ends in time."""
    assert claim.event is not None, "the clause names one"
    moments = run.begins(claim.event)
    for event in run.happenings(claim.event):
        index = bisect_right(moments, event.first) - 1
        if index < 0 or run.own[index].ended < event.first:
            run.missed.append(event.at)
            continue
        ended = run.own[index]
        answer = None
        if ended.outcome != "O":
            answer = Happening(ended.ended, ended.ended, UNKNOWN_END if ended.timing == "latest" else "")
        yield from _answered(claim, run, event, answer, "had not ended")


def _answered(
    claim: ResolvedClaim, run: OverRun, event: Happening, answer: Happening | None, missing: str
) -> Judgements:
    """The judgement of an event and its answer; None: the log ends before the deadline.

    Args:
        answer: None: there is none in the run.
        missing: what the node had not done, in words, if there is none.
    """
    times, until, deadline = _time_to(claim, run, event, answer)
    time, counts = deadline[0], run.counts(event.read, deadline)
    if (unjudged := _unjudged(event, counts, times, time)) is not None:
        yield unjudged
        return
    assert isinstance(times, tuple), "the clause has a deadline"
    least, most = times
    if answer is None and least.holds and run.is_cut_off:
        yield None if most.holds else Judgement(None, time, UNKNOWN_BEGIN)
    elif isinstance(counts, UnknownValue):
        yield Judgement(None, time, counts.why)
    elif answer is None:
        late = f"{missing} after {{}}" if not least.holds else f"{missing} when the run ended"
        yield Judgement(False, time, late, least if not least.holds else None, event.at[0])
    elif answer.why and not most.holds:
        yield Judgement(None, time, answer.why)
    else:
        yield _timed(claim, times, until[0], event.until[0])


def _time_to(
    claim: ResolvedClaim, run: OverRun, event: Happening, answer: Happening | None
) -> tuple[_Times | UnknownValue | None, Moment, Moment]:
    """The time from an event to its answer, or to the end of the run, None without a deadline; its end; and the
    deadline, if that is earlier."""
    end = answer or Happening(run.root.ended, run.root.ended)
    times = _between_limits(claim, run.observed, event, end) if claim.limit is not None else None
    deadline = end.read
    if isinstance(times, tuple):
        deadline = min(deadline, (event.read[0] + round(times[1].bound.si * 1e6), deadline[1]))
    return times, end.read, deadline


def _unjudged(
    event: Happening, counts: bool | UnknownValue, times: _Times | UnknownValue | None, time: int
) -> Judgement | None:
    """The judgement of an event whose time does not count or is unknown; None for any other."""
    if event.why:  # whether it is in scope is unknown, too
        return Judgement(None, time, event.why)
    if counts is False:
        return OUT
    return Judgement(None, time, times.why) if isinstance(times, UnknownValue) else None


def _between_limits(
    claim: ResolvedClaim, observed: Observed, first: Happening, last: Happening
) -> _Times | UnknownValue:
    """The shortest and the longest time from one event to another, compared with the bound of a claim."""
    shortest = compared(claim, max(last.at[0] - first.until[0], 0) / 1e6, observed, first.read)
    longest = compared(claim, (last.until[0] - first.at[0]) / 1e6, observed, first.read)
    if isinstance(shortest, UnknownValue):
        return shortest
    return longest if isinstance(longest, UnknownValue) else (shortest, longest)


def _timed(claim: ResolvedClaim, times: _Times, moment: int, since: int, what: str = "") -> Judgement:
    """The judgement of a time between two limits; unknown unless both limits give the same."""
    least, most = times
    sentence = what or VERBS[claim.verb].said
    judgement = Judgement(least.holds, moment, sentence, least, since)
    if not is_same(judgement, Judgement(most.holds, moment, "", most)):
        return Judgement(None, moment, UNKNOWN_BEGIN)
    return between(judgement, least, most)


def _begin(activation: Activation, run: OverRun) -> Happening:
    return Happening(activation.begun(True), activation.started, judged=activation.begun(run.observed.is_early))


def _followed(claim: ResolvedClaim, run: OverRun) -> Judgements:
    """`each e is followed by f within d`: for each event, whether the other one happens, or the condition holds, in
    time."""
    occurrences, answer = claim.subject, claim.event
    assert isinstance(occurrences, ResolvedEachEvent), "the verb has no other subject"
    if answer is None:
        assert claim.condition is not None, "an event or a condition follows"
        next_of = _next_true(claim.condition, run)
        events = [
            Happening(event.read, event.read, event.why) for event in run.happenings(occurrences.event, is_own=True)
        ]
    else:
        is_by_row = occurrences.event.condition is None and answer.condition is None
        is_later = is_never_at_once(occurrences.event, answer)
        next_of = next_finder(run.happenings(answer, is_by_row=is_by_row), run, is_later=is_later)
        events = run.happenings(occurrences.event, is_own=True, is_by_row=is_by_row)
    for event in events:
        yield from _followed_by(claim, run, event, *next_of(event))


def _next_true(condition: Condition, run: OverRun) -> NextOf:
    """Finds when a demanded condition holds next; `initially` does not count, for it is not measured."""
    stretches = [
        Happening(part.begin, part.begin, part.why, not part.why)
        for part in run.with_all_along(condition, run.observed)
    ]
    next_of = next_finder(stretches, run, is_later=True)

    def next_true(event: Happening) -> tuple[Happening | None, Sequence[Happening]]:
        now = truth(condition, run.observed, event.at)
        if now is True:
            return event, ()
        later, unclear = next_of(event)
        if isinstance(now, UnknownValue):
            unclear = [Happening(event.at, event.at, now.why), *unclear]
        return later, unclear

    return next_true


def _followed_by(
    claim: ResolvedClaim, run: OverRun, event: Happening, answer: Happening | None, unclear: Sequence[Happening]
) -> Judgements:
    """The judgement of an event and what follows it; None: the log ends before the deadline."""
    times, until, deadline = _time_to(claim, run, event, answer)
    time, counts = deadline[0], run.counts(event.read, deadline)
    if (unjudged := _unjudged(event, counts, times, time)) is not None:
        yield unjudged
        return
    assert not isinstance(times, UnknownValue), "it cannot be judged"
    is_late, is_surely_in_time = times is not None and not times[0].holds, times is None or times[1].holds
    # The condition may hold after the run, before the time is over.
    is_open = claim.condition is not None and times is not None and times[0].excess < 0
    is_of_limits = answer is None and times is not None and times[0].si != times[1].si
    if unclear or is_of_limits or (answer is None and claim.condition is not None and not run.is_cut_off):
        run.unsettled.append(event.at)
    earlier = [other.why for other in unclear if times is None or _may_be_in_time(claim, run, event, other)]
    if earlier and (answer is None or not is_surely_in_time):
        yield Judgement(None, time, earlier[0])
    elif answer is None and not is_late and (run.is_cut_off or is_open):
        left_out = None if run.is_cut_off else OUT
        yield left_out if is_surely_in_time else Judgement(None, time, UNKNOWN_BEGIN)
    elif isinstance(counts, UnknownValue):
        yield Judgement(None, time, counts.why)
    elif answer is not None and times is not None:
        yield _timed(claim, times, until[0], event.until[0])
    elif answer is not None:
        yield Judgement(True, until[0], "")
    elif times is not None and is_late:
        yield Judgement(False, time, "had not been followed after {}", times[0], event.at[0])
    else:
        yield Judgement(False, time, "had not been followed when the run ended", since=event.at[0])


def _may_be_in_time(claim: ResolvedClaim, run: OverRun, event: Happening, other: Happening) -> bool:
    """Whether something that may have happened was before the deadline, if it happened."""
    least = compared(claim, max(other.at[0] - event.until[0], 0) / 1e6, run.observed, event.read)
    return isinstance(least, Measure) and least.holds


def _follows(claim: ResolvedClaim, run: OverRun) -> Judgements:
    """`follows ev`: for each start, whether the event has happened in the run since the start before it."""
    assert claim.event is not None, "the clause names one"
    events = run.happenings(claim.event)
    name = claim.text.partition(" follows ")[2]
    before = (run.root.begin, -1)  # the beginning of the run
    for start, moment in zip(run.own, run.begins(claim.event), strict=True):
        between = [happening for happening in events if before < happening.last and happening.first <= moment]
        is_sure = any(
            happening.is_certain and before < happening.first and happening.last <= moment for happening in between
        )
        since = "since its last start" if before[1] >= 0 else "before it in the run"
        before = moment
        counts = run.counts_one(start)
        if counts is False:
            yield OUT
            continue
        unclear = counts.why if isinstance(counts, UnknownValue) else between[0].why if between and not is_sure else ""
        if is_sure and start.outcome == "O":
            yield None
        elif unclear:
            yield Judgement(None, start.begin, unclear)
        else:
            sentence = f"followed `{name}`" if is_sure else f"`{name}` did not happen {since}"
            yield Judgement(is_sure, start.begin, VERBS[claim.verb].said.replace("{}", sentence))


# ---- numbers of starts ----


def _tries(claim: ResolvedClaim, run: OverRun) -> Judgements:
    """`tries at most m per P`, `fails at most m per P`: how often a node starts, or ends in this way, in each
    activation of another; without `per`, in the run.
    """
    assert claim.limit is not None, "a number of tries has a bound"
    is_upper = claim.limit.relation in ("<=", "<")
    results = _RESULTS.get(claim.verb)
    every = run.starts()
    starts = [start for start in every if start[0].outcome in results] if results is not None else every
    moments = [start.ended if results is not None else start.shown for start, _ in starts]
    periods = run.observed.nodes.activations(claim.per) if isinstance(claim.per, NodeTarget) else [run.root]
    for refusal in run.refused:
        if not any(period.shown <= refusal.at <= period.ended for period in periods):
            yield Judgement(False, refusal.at[0], f"its start was refused by its guard at {refusal.guard.path}")
    for period in periods:
        inside = starts[bisect_left(moments, period.shown) : bisect_right(moments, period.ended)]
        refused = [refusal for refusal in run.refused if period.shown <= refusal.at <= period.ended]
        active = inside
        if results is not None:  # without any result, too
            active = [each for each in every if each[0].shown <= period.ended and period.shown <= each[0].ended]
        if not active and not refused and is_upper:
            yield OUT
            continue
        least = _number(claim, run, period, [start for start, counts in inside if counts is True], refused)
        most = _number(claim, run, period, [start for start, _ in inside], refused)
        reasons = [counts.why for _, counts in active if isinstance(counts, UnknownValue)]
        has_none = is_upper and not refused and len(reasons) == len(active)  # perhaps: then the period does not count
        is_open = least is None or most is None or least.holds is most.holds
        if has_none or (least is None and most is not None) or not is_open:
            yield Judgement(None, period.end, reasons[0])
        else:
            yield least if least is not None or period.outcome == "O" else OUT


def _number(
    claim: ResolvedClaim,
    run: OverRun,
    period: Activation,
    starts: Sequence[Activation],
    refused: Sequence[RefusedStart],
) -> Judgement | None:
    """The judgement of a number of starts; None: undecided, because there may have been more.

    Args:
        refused: further ones that the clause's own guard refused.
    """
    assert claim.limit is not None, "a number of tries has a bound"
    number = len(starts) + len(refused)
    tried = compared(claim, float(number), run.observed.during(period), period.started)
    if isinstance(tried, UnknownValue):
        return Judgement(None, period.end, tried.why)
    holds = tried.kept(period.outcome in ("S", "F"))
    if refused:
        holds, tried = False, tried.beyond()
    if holds is None and (period.outcome == "O" or not tried.holds):
        return None
    if holds is False and not refused and period.timing == "latest":
        return Judgement(None, period.end, UNKNOWN_END, tried)
    decided_at = period.end
    bound = tried.bound.si
    breaking = max(floor(bound) if claim.limit.relation != "<" else ceil(bound) - 1, 0)
    if holds is False and tried.is_upper and breaking < len(starts):
        decided_at = starts[breaking].end if claim.verb in _RESULTS else starts[breaking].begin
    sentence = VERBS[claim.verb].said.replace("{}", counted(len(starts), "time"))
    if refused:
        sentence += f", and its guard at {refused[0].guard.path} refused {len(refused)} more"
    tried.unit = None
    return Judgement(holds is not False, decided_at, sentence, tried, period.begin, starts)


def _runs(claim: ResolvedClaim, run: OverRun) -> Judgements:
    """`runs every d` and `runs at least m per d`: how a node's starts are spread over the time in scope, in each time
    between two starts, or in each period.
    """
    starts = run.starts()
    for stretch in run.stretches():
        is_early = run.observed.is_early
        inside = [(start, counts) for start, counts in starts if stretch.begin <= start.begun(is_early) <= stretch.end]
        unclear = [counts.why for _, counts in inside if isinstance(counts, UnknownValue)]
        if stretch.why or unclear:
            yield Judgement(None, stretch.begin[0], stretch.why or unclear[0])
            continue
        is_open = run.is_cut_off and stretch.end == run.observed.end
        counted_starts = [start for start, _ in inside]
        yield from (_between if claim.every else _in_windows)(claim, run, stretch, counted_starts, is_open)


def _between(
    claim: ResolvedClaim, run: OverRun, stretch: Stretch, starts: Sequence[Activation], is_open: bool
) -> Judgements:
    """Judge the times from each start to the next, and from the last to the end of the stretch."""
    sentence_until_next = VERBS[claim.verb].said.replace("{}", "{} after its last start")
    moments = [_begin(start, run) for start in starts]
    for start, after in pairwise([*moments, Happening(stretch.end, stretch.end)]):
        is_last = start is moments[-1]
        until = after.until[0]
        times = _between_limits(claim, run.observed, start, after)
        if isinstance(times, UnknownValue):
            yield Judgement(None, until, times.why)
        elif is_last and is_open and times[0].holds:
            yield None
        else:
            sentence = "had not run again after {}" if is_last else sentence_until_next
            yield _timed(claim, times, until, start.until[0], sentence)


def _in_windows(
    claim: ResolvedClaim, run: OverRun, stretch: Stretch, starts: Sequence[Activation], is_open: bool
) -> Judgements:
    """Judge the windows with the fewest and the most starts; a stretch shorter than a window has none."""
    assert isinstance(claim.per, Quantity), "the starts are counted in a time"
    length = round(claim.per.si * 1e6)
    begin, last = stretch.begin[0], stretch.end[0] - length  # when the first and the last window begin
    if begin > last:
        return
    times = [start.begun(run.observed.is_early)[0] for start in starts]

    def inside(window: int) -> slice:
        return slice(bisect_left(times, window), bisect_left(times, window + length))

    def number(window: int) -> int:
        return len(times[inside(window)])

    # Candidates are windows that a start has just left, or in which a start is the last; of equals, the first.
    fewest = min([begin, *[time + 1 for time in times if time < last]], key=lambda each: (number(each), each))
    fullest = max([begin, *[max(begin, min(time + 1 - length, last)) for time in times]], key=number)
    measures: list[tuple[Measure, int]] = []
    for window in (fewest, fullest):
        reading = compared(claim, float(number(window)), run.observed, stretch.begin)
        if isinstance(reading, UnknownValue):
            yield Judgement(None, stretch.begin[0], reading.why)
            return
        measures.append((reading, window))
    measure, window = max(measures, key=lambda pair: pair[0].excess)
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


def _span(claim: ResolvedClaim, run: OverRun) -> Judgements:
    """`from e₁ to e₂ takes at most d`: the time from each first event to the next last event in the run."""
    span = claim.subject
    assert isinstance(span, Interval), "the time between two events"
    first = span.first
    is_by_row = first.condition is None and span.last.condition is None
    # An event does not follow itself.
    next_of = next_finder(run.happenings(span.last, is_by_row=is_by_row), run, is_later=first == span.last)
    for event in run.happenings(first, is_own=True, is_by_row=is_by_row):
        last, others = next_of(event)
        until = last.last if last is not None else run.root.ended
        if any(stopped.shown <= event.first <= stopped.ended <= until for stopped in run.stopped):
            yield Judgement(False, until[0], "its guard stopped it before it came to an end", since=event.read[0])
            continue
        yield from _ended(claim, run, event, last, others[0].why if others else "")


def _ended(claim: ResolvedClaim, run: OverRun, first: Happening, last: Happening | None, unclear: str) -> Judgements:
    """The judgement of a span; None: the log ends before it does.

    Args:
        last: when it ended; None: not in the run.
        unclear: why it may have ended before; else empty.
    """
    assert claim.limit is not None, "a time has a bound"
    end = last or Happening(run.root.ended, run.root.ended)
    until = end.read
    if first.why:  # whether it is in scope is unknown, too
        yield Judgement(None, until[0], first.why)
        return
    counts = run.counts(first.read, until)
    if counts is False:
        yield OUT
        return
    times = _between_limits(claim, run.observed, first, end)
    if isinstance(times, UnknownValue):
        yield Judgement(None, until[0], times.why)
        return
    least, most = times
    is_late = least.is_upper and not least.holds
    is_in_time = most.is_upper and most.holds and claim.limit.upper is None
    if unclear and (last is None or not is_in_time):
        yield Judgement(None, until[0], unclear)
    elif last is None and not is_late and run.is_cut_off:
        yield None if most.holds or not most.is_upper else Judgement(None, until[0], UNKNOWN_BEGIN)
    elif isinstance(counts, UnknownValue):
        yield Judgement(None, until[0], counts.why)
    elif last is not None:
        yield _timed(claim, times, until[0], first.until[0])
    elif is_late:
        yield Judgement(False, until[0], "had not come to an end after {}", least, first.at[0])
    elif claim.limit.relation not in (">=", ">"):
        yield Judgement(False, until[0], "its last event did not happen before the run ended")


def _total(claim: ResolvedClaim, run: OverRun) -> Judgements:
    """`sum of X, Y takes at most d`: the durations of some nodes in a run, added up."""
    starts = run.starts()
    if not starts:
        return
    every = [start for start, _ in starts]
    sure = [start for start, counts in starts if counts is True and start.timing == "exact"]
    reasons = [counts.why for _, counts in starts if isinstance(counts, UnknownValue)]
    if len(reasons) == len(starts):  # perhaps none counts
        yield Judgement(None, run.root.end, reasons[0])
        return
    unclear = reasons[0] if reasons else UNKNOWN_END if sure != every else UNKNOWN_BEGIN
    least = _sum(claim, run, sure, sum(start.end - start.begin for start in sure))
    most = _sum(claim, run, every, sum(start.end - start.earliest for start in every))
    if least is not None and most is not None and is_same(least, most):
        yield between(least, least.measure, most.measure)
    elif least is None and most is None:
        yield None
    else:
        yield Judgement(None, run.root.end, unclear)


def _sum(claim: ResolvedClaim, run: OverRun, starts: Sequence[Activation], total: int) -> Judgement | None:
    """The judgement of a sum of durations, in µs; None: undecided, because the log ends before the run does."""
    summed = compared(claim, total / 1e6, run.observed, run.observed.begin)
    if isinstance(summed, UnknownValue):
        return Judgement(None, run.root.end, summed.why)
    holds = summed.kept(not run.is_cut_off)
    sentence = VERBS[claim.verb].said.replace("{}", "{} together")
    return Judgement(holds, run.root.end, sentence, summed, run.root.begin, starts) if holds is not None else None


# The outcomes that are counted, where starts are not.
_RESULTS: Final = {"succeeds per": "S", "fails per": "F", "finishes per": "SF"}
JUDGES: Final[dict[str, RunJudge]] = {
    "starts": _starts,
    "ends": _ends,
    "follows": _follows,
    "followed": _followed,
    **dict.fromkeys(("tries", "starts per", *_RESULTS), _tries),
    "runs": _runs,
    "visits": visits,
    "fails per time": rate,
    "keeps of time": of_time,
    "never of time": of_time,
}
