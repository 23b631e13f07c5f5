"""The verbs that are judged over a run, word for word as the design tells them: counts, rates, events, sums."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

from literal_log import both, either, just_after, micros, negated
from literal_runs import Activation
from literal_verbs import OPEN, OUT, Judged, OfActivations, counted

from btq_lang.evidence.model import ROOT
from btq_lang.requirements.model import Quantity
from btq_lang.util import record

if TYPE_CHECKING:
    from literal_log import Truth
    from literal_runs import Moment
    from literal_verbs import Verdict

    from btq_lang.requirements.model import (
        Condition,
        DurationSum,
        Interval,
        ResolvedAnyEvent,
        ResolvedClaim,
        ResolvedEachEvent,
        ResolvedEvent,
        ResolvedRequirement,
        ResolvedSpan,
    )

    Decided = tuple[Verdict, int]  # and when that was


@dataclass(frozen=True)
class Happening:
    """An event.

    Attributes:
        after, by: the rows from which on and by which it happened, if it did.
        moment: when that was.
        is_sure: it did, just then.
        of: what started.
        is_of_node: it is no condition.
    """

    after: Moment
    by: Moment
    moment: Moment
    is_sure: bool = True
    has_happened: bool = True
    of: Activation | None = None
    is_of_node: bool = False

    @property
    def times(self) -> tuple[int, int]:
        """From when on and by when it happened."""
        return (self.of.earliest[0], self.of.latest[0]) if self.of is not None else (self.moment[0], self.moment[0])


@dataclass(frozen=True)
class KeptTime:
    """A span.

    Attributes:
        begin: if it has begun at all.
        maybe: when it may have begun.
        end: the first moment after it.
        unsure_from: the first moment at which it may have ended before.
    """

    begin: Moment | None
    maybe: Moment
    end: Moment | None
    unsure_from: Moment | None


@dataclass(frozen=True)
class Spent:
    """The time from an event to its answer.

    Attributes:
        at: from the event to its answer, or to the end of the run.
        until: when it was decided if it was not answered, or in time.
        counts: whether its scopes let it count; unknown if it is when it happened.
        is_sure: the event happened just then.
        is_answered: its answer has happened.
        is_unclear: that may have happened before.
        least, most: how long that may have been, in µs.
        is_stopped: the guard that enforces it has stopped it.
    """

    at: Activation
    until: int
    counts: Truth
    is_sure: bool
    is_answered: bool
    is_unclear: bool
    least: int
    most: int
    is_stopped: bool = False


@dataclass(frozen=True)
class InRun:
    """What a verb of OF_RUNS is judged by.

    Attributes:
        uid: of the instance of a node.
        own: its activations in the run.
    """

    uid: int
    own: Sequence[Activation]
    run: Activation
    claim: ResolvedClaim
    requirement: ResolvedRequirement


class OverRuns(OfActivations):
    """A session, and what each run of it comes to."""

    def over_runs(self, uid: int, claim: ResolvedClaim, requirement: ResolvedRequirement) -> list[Judged]:
        """A verb of OF_RUNS at one instance of a node."""
        judge = getattr(self, OF_RUNS[claim.verb])
        found = []
        for run in self.runs:
            own = [each for each in self.of(uid) if each.run == run.run]
            verdicts = judge(InRun(uid, own, run, claim, requirement))
            found += [Judged(run.run, uid, verdict, run.end, decided) for verdict, decided in verdicts]
        return found

    def tries(self, at: InRun) -> list[Decided]:
        """How many starts, or results of a kind, lie in each activation of the other node, or in the run."""
        assert not isinstance(at.claim.per, Quantity)
        around = [ROOT] if at.claim.per is None else self.nearest(at.uid, self.uids(at.claim.per))
        refused = [
            check
            for verb, guard, check in self.refusals(at.uid)
            if verb == at.claim.verb and self.guards[guard.uid] == at.requirement.name and check.run == at.run.run
        ]
        found: list[Decided] = []
        for p in (each for other in around for each in self.of(other) if each.run == at.run.run):
            counted_outcomes = COUNTED.get(at.claim.verb, "SFHO")
            moments = {id(x): x.stop if at.claim.verb in COUNTED else x.shown for x in at.own}
            of_kind = [x for x in at.own if x.outcome in counted_outcomes]
            inside = [(x, self.counts(x, at.requirement)) for x in of_kind if p.shown <= moments[id(x)] <= p.stop]
            meanwhile = [self.counts(x, at.requirement) for x in at.own if x.shown <= p.stop and p.shown <= x.stop]
            sure = [x for x, counts in inside if counts]
            numbers = {len(sure), sum(counts is not False for _, counts in inside)}
            verdicts = {self.tried(p, number, at.claim) for number in numbers}
            if at.claim.verb in COUNTED and at.claim.limit is not None and at.claim.limit.relation in ("<", "<="):
                # that it did not come to such a result counts where it was active
                at_none = self.within(0, at.claim.limit, p)[0]
                none: list[Verdict] = [OPEN if at_none and p.outcome == "O" else at_none]
                verdicts = {
                    each for number in numbers for each in ([self.tried(p, number, at.claim)] if number else none)
                }
                if True not in meanwhile:
                    verdicts = {OUT} if not any(each is None for each in meanwhile) else {*verdicts, OUT}
            verdict = verdicts.pop() if len(verdicts) == 1 else None
            one_more = [each for each in refused if p.first <= each.first <= p.last]
            if one_more:
                refused = [each for each in refused if each not in one_more]
                found.append((False, one_more[0].end))
                continue
            too_many = [x for number, x in enumerate(sure, 1) if self.within(number, at.claim.limit, p)[0] is False]
            found.append((verdict, too_many[0].shown[0] if verdict is False and too_many else p.end))
        return [*found, *((False, each.end) for each in refused)]  # those that no activation holds: a case each

    def tried(self, p: Activation, number: int, claim: ResolvedClaim) -> Verdict:
        """What an activation comes to that holds a number of starts that count: without any, no upper bound."""
        assert claim.limit is not None
        if number == 0 and claim.limit.relation in ("<", "<="):
            return OUT
        not_above, not_below = self.within(number, claim.limit, p)
        if p.outcome in ("S", "F"):
            return both(not_above, not_below)
        if p.outcome == "O":
            return not_above if not not_above else OPEN
        if not_below is False and not_above:  # there might have been more
            return OUT
        return not_above if not_above is not False or p.is_exact else None

    def visits(self, at: InRun) -> list[Decided]:
        """Whether each of the nodes has succeeded in an activation that has ended, their first successes in order."""
        found: list[Decided] = []
        for p in at.own:
            firsts = []
            for visit in at.claim.visits:
                (node,) = visit.nodes
                assert not node.values, "random ports have none"
                of = [each for near in self.nearest(at.uid, self.uids(node.target)) for each in self.of(near)]
                ends = [each.stop for each in of if each.outcome == "S" and p.shown <= each.stop <= p.stop]
                firsts.append(min(ends, default=None))
            times = [first for first in firsts if first is not None]
            verdict: Verdict = len(times) == len(firsts) and (not at.claim.in_order or times == sorted(times))
            verdict = OPEN if p.outcome == "O" else OUT if p.outcome == "H" else verdict
            found.append((counted(self.counts(p, at.requirement), verdict), p.end))
        return found

    def rate(self, at: InRun) -> list[Decided]:
        """runs every d, runs at least m per d: in each stretch of a run that counts."""
        scopes = [each.condition for each in at.requirement.scopes if each.word == "while"]
        when = record.replace(
            at.requirement, scopes=tuple(each for each in at.requirement.scopes if each.word == "when")
        )
        found: list[Decided] = []
        for stretch, is_sure in self.stretches(scopes, replace(at.run, uid=at.uid)):
            inside = [(x, self.counts(x, when)) for x in at.own if stretch.start <= x.start <= stretch.stop]
            inside = [(x, counts) for x, counts in inside if counts is not False]
            if not is_sure or any(counts is None for _, counts in inside):
                found.append((None, stretch.begin))
                continue
            times = [x.begin for x, _ in inside]
            is_open = at.run.outcome == "O" and stretch.stop == at.run.stop
            part = replace(stretch, outcome="O" if is_open else "S")
            found += (
                self.evenly(at.claim, part, [x for x, _ in inside])
                if at.claim.every
                else self.often(at.claim, part, times)
            )
        return found

    def evenly(self, claim: ResolvedClaim, stretch: Activation, starts: list[Activation]) -> list[Decided]:
        """Each time between two starts, and from the last one to the end: the shortest and the longest it may be."""
        if not starts:
            return []
        begins = [(each.earliest[0], each.latest[0]) for each in starts]
        found: list[Decided] = []
        for (first, last), (next_first, next_last) in pairwise([*begins, (stretch.end, stretch.end)]):
            times = max(next_first - last, 0), next_last - first
            kept = [self.within(time / 1e6, claim.limit, stretch)[0] for time in times]
            found.append((kept[0] if kept[0] is kept[1] else None, next_last))
        tail, end = found[-1]
        if stretch.outcome == "O" and tail is not False:
            found[-1] = (OPEN, end)
        return found

    def often(self, claim: ResolvedClaim, stretch: Activation, times: list[int]) -> list[Decided]:
        """Each window of the length."""
        assert isinstance(claim.per, Quantity)
        length = micros(claim.per.si)
        last = stretch.end - length
        if last < stretch.begin:
            return []
        begins = {stretch.begin, last, *(time + shift for time in times for shift in (0, 1, -length, 1 - length))}
        inside = sorted(begin for begin in begins if stretch.begin <= begin <= last)
        numbers = [sum(begin <= time < begin + length for time in times) for begin in inside]
        kept = both(*(both(*self.within(number, claim.limit, stretch)) for number in numbers))
        if kept is None:
            return [(None, stretch.begin)]
        if kept:
            return [(OPEN if stretch.outcome == "O" else True, stretch.end)]
        is_above = self.within(max(numbers), claim.limit, stretch)[0] is False
        worst = numbers.index(max(numbers) if is_above else min(numbers))
        return [(False, inside[worst] + length)]

    def share(self, at: InRun) -> list[Decided]:
        """keeps φ in at least p of time: each piece of the time counts, may count, or does not."""
        pieces = [
            (time, counts, negated(self.holds(at.claim.condition, moment, seen), at.claim.verb == "never of time"))
            for a in at.own
            for time, counts, moment, seen in self.pieces(a, at.requirement)
        ]
        if not pieces:
            return [(OUT, at.run.end)]
        if at.run.outcome == "O":
            return [(OPEN, at.run.end)]
        if not any(counts for _, counts, _ in pieces):
            return [(None, at.run.end)]
        shares = []
        for doubt in (False, True):  # what is in doubt is against the clause, or for it
            supposed = [(time, counts, doubt if holds is None else holds) for time, counts, holds in pieces]
            counted_ones = [(time, holds) for time, counts, holds in supposed if counts or holds is doubt]
            shares.append(sum(time for time, holds in counted_ones if holds) / sum(time for time, _ in counted_ones))
        verdicts = {both(*self.within(share, at.claim.limit, at.run)) for share in shares}
        return [(verdicts.pop() if len(verdicts) == 1 else None, at.run.end)]

    def pieces(self, a: Activation, requirement: ResolvedRequirement) -> list[tuple[int, Truth, Moment, Activation]]:
        """The time of an activation between two changes: how long, whether it counts, when, and as it is seen then."""
        found: list[tuple[int, Truth, Moment, Activation]] = []
        early = replace(a, start=a.earliest)
        when = self.holds_all("when", requirement, a.start, a)
        for moment, following in pairwise(sorted({*self.moments(early), a.latest, a.stop})):
            seen = a if moment >= a.start else early
            now = self.holds_all("while", requirement, moment, seen)
            counts = both(when, now, moment >= a.latest or None, a.is_exact or None)
            if counts is not False and following[0] > moment[0]:
                found.append((following[0] - moment[0], counts, moment, seen))
        return found

    def rates(
        self, uids: Sequence[int], is_mission: bool, claim: ResolvedClaim, requirement: ResolvedRequirement
    ) -> list[tuple[int, int, int, int]]:
        """fails at most m per d: of each run the failures, fewest and most, and the time for them, least and most."""
        found = []
        for run in self.runs:
            around = self.nearest(uids[0], self.uids(claim.of)) if claim.of is not None else [ROOT]
            exposed = [each for uid in around for each in self.of(uid) if each.run == run.run]
            times = [piece for a in exposed for piece in self.pieces(a, requirement)]
            own = (
                [run] if is_mission else [each for each in self.activations if each.uid in uids and each.run == run.run]
            )
            failed = [
                both(self.holds_all("when", requirement, x.start, x), self.holds_all("while", requirement, x.stop, x))
                for x in own
                if x.outcome == "F"
            ]
            found.append(
                (
                    sum(counts is True for counts in failed),
                    sum(counts is not False for counts in failed),
                    sum(time for time, counts, *_ in times if counts),
                    sum(time for time, *_ in times),
                )
            )
        return found

    def reactions(self, uid: int, claim: ResolvedClaim, requirement: ResolvedRequirement) -> list[Spent]:
        """starts within d after ev, ends within d after ev: the next start, or end, after each event."""
        assert claim.event is not None
        by_rows = claim.event.condition is None
        found: list[Spent] = []
        for run in self.runs:
            own = [each for each in self.of(uid) if each.run == run.run]
            for event in self.events(claim.event, replace(run, uid=uid)):
                if claim.verb == "starts":
                    answers = [(x, x.start, True) for x in own if x.placed(by_rows) >= event.after][:1]
                    ends = [(x.earliest[0], x.latest[0]) for x, *_ in answers]
                else:  # what does not run has nothing to end
                    running = [x for x in own if x.placed(by_rows) <= event.after <= x.stop][-1:]
                    if not running:
                        continue
                    answers = [(x, x.stop, x.is_exact) for x in running if x.outcome != "O"]
                    ends = [(x.end, x.end) for x, *_ in answers]
                _, by, is_exact = answers[0] if answers else (None, run.stop, True)
                least, most = spent(event.times, ends[0] if ends else (run.end, run.end))
                at = between(run, uid, event.moment, by)
                bound = self.amount(claim.limit.value, at.start, at) if claim.limit is not None else None
                until = by if bound is None else min(by, (at.begin + micros(bound), by[1]))
                counts = self.counts(between(run, uid, at.start, until), requirement) if event.is_sure else None
                found.append(Spent(at, until[0], counts, event.is_sure, bool(answers), not is_exact, least, most))
        return found

    def follows(self, at: InRun) -> list[Decided]:
        """An event since the start before, or since the run began."""
        assert at.claim.event is not None
        by_rows = at.claim.event.condition is None
        events = self.events(at.claim.event, replace(at.run, uid=at.uid))
        before: Moment = (at.run.begin, -2)  # also what happens as it begins
        found: list[Decided] = []
        for x in at.own:
            start = x.placed(by_rows)
            maybe = [each for each in events if before < each.by and each.after <= start]
            is_sure = any(each.has_happened and before < each.after and each.by <= start for each in maybe)
            verdict: Verdict = True if is_sure else None if maybe else False
            verdict = OPEN if is_sure and x.outcome == "O" else verdict
            found.append((counted(self.counts(x, at.requirement), verdict), x.shown[0]))
            before = start
        return found

    def spans(self, span: Interval, claim: ResolvedClaim, requirement: ResolvedRequirement) -> list[Spent]:
        """from e1 to e2: each e1 opens one, the next e2 closes all that are open."""
        firsts = self.places(span.first)
        by_rows = span.first.condition is None and span.last.condition is None
        found = []
        for run in self.runs:
            for uid in firsts:
                lasts = self.events(span.last, replace(run, uid=uid), by_rows=by_rows)
                for first in self.events(span.first, replace(run, uid=uid), only=True, by_rows=by_rows):
                    after = first.after if span.first != span.last else just_after(first.after)
                    closing = [each for each in lasts if each.has_happened and each.after >= after]
                    last = min(closing, key=lambda each: each.by, default=None)
                    by, moment = (last.by, last.moment) if last is not None else (run.stop, run.stop)
                    unclear = any(not each.is_sure and each.by >= first.after and each.after <= by for each in lasts)
                    at = between(run, uid, first.moment, moment)
                    counts = self.counts(at, requirement) if first.is_sure else None
                    found.append(
                        Spent(
                            *(at, at.end, counts, first.is_sure, last is not None, unclear),
                            *spent(first.times, last.times if last is not None else (run.end, run.end)),
                            is_stopped=any(
                                each.shown <= first.after <= each.stop <= by
                                and self.is_stopped(each, claim, requirement)
                                for each in self.of(self.written_above(uid))
                            ),
                        )
                    )
        return found

    def followed(self, each: ResolvedEachEvent, claim: ResolvedClaim, requirement: ResolvedRequirement) -> list[Judged]:
        """each e is followed by f: after each e the next f, or the first moment from then on at which f is true."""
        by_rows = each.event.condition is None and claim.condition is None
        by_rows = by_rows and (claim.event is None or claim.event.condition is None)
        found = []
        for run in self.runs:
            for uid in self.places(each.event):
                here = replace(run, uid=uid)
                for e in self.events(each.event, here, only=True, by_rows=by_rows):
                    verdict, decided = self.answered(e, each, claim, requirement, here)
                    found.append(Judged(run.run, uid, verdict, run.end, decided))
        return found

    def answered(
        self,
        e: Happening,
        each: ResolvedEachEvent,
        claim: ResolvedClaim,
        requirement: ResolvedRequirement,
        run: Activation,
    ) -> Decided:
        """What one e comes to: the times to f, at the least and at the most, and what may have been f before."""
        at = between(run, run.uid, e.moment, run.stop)
        end, times = run.stop, e.times
        is_answered = False
        if claim.event is not None:
            is_later = each.event == claim.event or (has_node(each.event) and has_node(claim.event))
            by_rows = each.event.condition is None and claim.event.condition is None
            events = self.events(claim.event, run, by_rows=by_rows)
            later = [one for one in events if one.after >= e.after and not (is_later and one.by == e.after)]
            certain = [one for one in later if one.has_happened]
            f = min(certain, key=lambda one: one.by, default=None)
            by, end = (f.by, f.moment) if f is not None else (run.stop, run.stop)
            maybe = [one.after[0] for one in events if not one.is_sure and one.by >= e.after and one.after <= by]
            until, is_answered = (f.times, True) if f is not None else ((run.end, run.end), False)
        else:
            times = e.moment[0], e.moment[0]
            moments = self.moments(at)
            held = [self.holds(claim.condition, moment, run) for moment in moments]
            is_answered = True in held
            end = moments[held.index(True)] if is_answered else run.stop
            maybe = [moment[0] for moment, now in zip(moments, held, strict=True) if now is None and moment <= end]
            until = end[0], end[0]
        least, most = spent(times, until)
        limit = claim.limit
        bound = self.amount(limit.value, at.start, at) if limit is not None else None
        deadline = end if bound is None else min(end, (at.begin + micros(bound), end[1]))
        if not e.is_sure:
            return None, deadline[0]
        counts = self.counts(between(run, run.uid, at.start, deadline), requirement)
        kept: list[Truth] = [True, True]
        if limit is not None:
            kept = [self.within(time / 1e6, limit, at)[0] for time in (least, most)]
            since = times[1]
            maybe = [time for time in maybe if self.within(max(time - since, 0) / 1e6, limit, at)[0]]
        if counts is False:
            return OUT, deadline[0]
        if None in kept:
            return None, deadline[0]
        if maybe and not (is_answered and kept[1]):
            return None, deadline[0]
        if is_answered:
            verdict: Verdict = kept[0] if kept[0] is kept[1] else None
            return counted(counts, verdict), end[0]
        if kept[0] and run.outcome == "O":
            return (OPEN if kept[1] else None), deadline[0]
        if bound is not None and claim.condition is not None and least / 1e6 < bound:
            return counted(counts, OUT if kept[1] else None), deadline[0]
        return counted(counts, False), deadline[0]

    def kept_in_spans(self, uid: int, claim: ResolvedClaim, requirement: ResolvedRequirement) -> list[Judged]:
        """keeps, never … from e until f: each span in each activation of the node."""
        found: list[Judged] = []
        for run in self.runs:
            spans = self.kept_times(requirement.span, replace(run, uid=uid))
            for a in (each for each in self.of(uid) if each.run == run.run):
                pieces = [self.kept_in_span(a, span, claim, requirement) for span in spans]
                is_stopped = self.is_stopped(a, claim, requirement) or self.is_refuted(a, claim, requirement)
                for verdict, decided, is_last in pieces:
                    is_guarded, is_stopped = is_stopped and is_last, is_stopped and not is_last
                    found.append(
                        Judged(run.run, uid, *((False, run.end, a.end) if is_guarded else (verdict, run.end, decided)))
                    )
                if is_stopped:
                    found.append(Judged(run.run, uid, False, run.end, a.end))
        return found

    def kept_times(self, span: ResolvedSpan | None, run: Activation) -> list[KeptTime]:
        """From an e to the next f: what may have begun or ended is not sure.

        What happens at an unknown time begins or ends a span for sure by its latest moment, if nothing of the other
        kind may happen in that time.
        """
        assert span is not None
        by_rows = span.first.condition is None and span.last.condition is None
        begins, ends = (self.events(each, run, by_rows=by_rows) for each in (span.first, span.last))
        is_later = span.first == span.last or (has_node(span.first) and has_node(span.last))
        at_once = {each.after for each in ends if each.is_sure}
        marks = [
            (moment, kind, each, is_sure)
            for kind, events, others in (("end", ends, begins), ("begin", begins, ends))
            for each in events
            for moment, is_sure in (
                *([] if each.is_sure else [(each.after, False)]),
                *(
                    [(each.by, True)]
                    if each.is_sure or (each.has_happened and not any(meets(each, one) for one in others))
                    else []
                ),
            )
        ]
        found: list[KeptTime] = []
        now: KeptTime | None = None
        for moment, kind, each, is_sure in sorted(marks, key=lambda mark: (mark[0], mark[1] == "begin")):
            if kind == "begin" and not is_later and moment in at_once:
                continue
            doubtful = [one for one in (ends if kind == "begin" else begins) if not one.is_sure]
            is_doubtful = any(one.after <= moment < one.by for one in doubtful)
            at = each.moment if is_sure else each.after
            if kind == "begin" and is_sure and each.is_of_node:
                at = just_after(at)
            if kind == "begin" and is_sure and (now is None or now.begin is None or now.unsure_from is not None):
                may_have = now.maybe if now is not None and now.begin is None else at
                if now is not None and now.begin is not None:
                    found.append(replace(now, end=at))
                now = KeptTime(at, may_have, None, at if is_doubtful else None)
            elif kind == "begin" and not is_sure and now is None:
                now = KeptTime(None, at, None, None)
            elif kind == "end" and is_sure and now is not None:
                found.append(replace(now, end=at))
                now = KeptTime(None, at, None, None) if is_doubtful else None
            elif kind == "end" and not is_sure and now is not None and now.begin and now.unsure_from is None:
                now = replace(now, unsure_from=at)
        return [*found, *([now] if now is not None else [])]

    def kept_in_span(
        self, a: Activation, span: KeptTime, claim: ResolvedClaim, requirement: ResolvedRequirement
    ) -> tuple[Verdict, int, bool]:
        """What a span comes to in an activation, and whether it lasts until its end: all of it, and the sure part."""
        is_last = span.end is None or span.end > a.stop
        decided = a.stop[0] if span.end is None else min(span.end, a.stop)[0]
        whole = self.moments_in(a, span.maybe, span.end)
        if not whole:
            return OUT, 0, False
        ends = [each for each in (span.end, span.unsure_from) if each is not None]
        sure = self.moments_in(a, span.begin, min(ends, default=None)) if span.begin is not None else []
        if not sure or (not a.is_exact and sure[0] > just_after(a.start)):
            return None, decided, is_last
        counts, verdict = self.kept_at(a, sure, claim, requirement)
        if counts is False:
            return OUT, decided, is_last
        verdict = verdict if verdict is self.kept_at(a, whole, claim, requirement)[1] else None
        if verdict and a.outcome == "O" and is_last:
            return OPEN, decided, is_last
        return counted(counts, verdict), decided, is_last

    def moments_in(self, a: Activation, begin: Moment, end: Moment | None) -> list[Moment]:
        """The moments of an activation from a beginning on and before an end, at which something may change."""
        first = max(begin, a.start)
        moments = {first, *(each for each in self.moments(a) if each >= first)}
        return sorted(each for each in moments if each <= a.stop and (end is None or each < end))

    def kept_at(
        self, a: Activation, moments: Sequence[Moment], claim: ResolvedClaim, requirement: ResolvedRequirement
    ) -> tuple[Truth, Verdict]:
        """Whether these moments count, and whether the condition is kept in them, where it has to be."""
        time = replace(a, start=moments[0], stop=moments[-1])
        counts = [self.holds_all("while", requirement, each, time) for each in moments]
        holds = [negated(self.holds(claim.condition, each, time), claim.verb == "never") for each in moments]
        is_known = [a.is_exact or index == 0 for index in range(len(moments))]  # it may have ended by then
        kept = [
            either(negated(count if is_known else count and None, True), hold)
            for count, hold, is_known in zip(counts, holds, is_known, strict=True)
        ]
        counts[1:] = [each if a.is_exact else each and None for each in counts[1:]]
        return both(self.holds_all("when", requirement, moments[0], time), either(*counts)), both(*kept)

    def written_above(self, uid: int) -> int:
        """The nearest node above another that is no guard: around it stands what enforces a span of its children."""
        while (uid := self.tree.parent[uid]) in self.guards:
            pass
        return uid

    def parts(self, total: DurationSum, requirement: ResolvedRequirement) -> list[list[tuple[Activation, Truth]]]:
        """sum of X, Y: in each run their activations, and whether they count."""
        uids = {uid for target in total.targets for uid in self.uids(target)}
        return [
            [
                (each, self.counts(each, requirement))
                for each in self.activations
                if each.uid in uids and each.run == run.run
            ]
            for run in (self.runs if uids else ())
        ]

    def stretches(self, conditions: Sequence[Condition], run: Activation) -> list[tuple[Activation, bool]]:
        """The longest parts of a run with conditions, and, not sure, those in which they may hold."""
        moments = self.moments(run)
        held = [both(*(self.holds(each, moment, run, initially=True) for each in conditions)) for moment in moments]
        found: list[tuple[Activation, bool]] = []
        for index, now in enumerate(held):
            if now is False or (index and held[index - 1] is now):
                continue
            length = next((later for later, then in enumerate(held[index:]) if then is not now), None)
            end = moments[index + length] if length is not None else run.stop
            found.append((between(run, run.uid, moments[index], end), now is True))
        return found

    def places(self, event: ResolvedEvent | ResolvedAnyEvent) -> list[int]:
        """The instances of the nodes of an event; the root for a condition."""
        uids = [
            uid for each in event.atoms for uid in ([ROOT] if each.condition is not None else self.uids(each.subject))
        ]
        return [*dict.fromkeys(uids)]

    def events(
        self, event: ResolvedEvent | ResolvedAnyEvent, run: Activation, *, only: bool = False, by_rows: bool = True
    ) -> list[Happening]:
        """Those of any of several events, in order, each once."""
        by_rows = by_rows and event.condition is None
        found: list[Happening] = []
        for each in event.atoms:
            if not only or run.uid in self.places(each):
                found += [one for one in self.event(each, run, only=only, by_rows=by_rows) if one not in found]
        return sorted(found, key=lambda one: one.after)

    def event(self, event: ResolvedEvent, run: Activation, *, only: bool, by_rows: bool) -> list[Happening]:
        """An event in a run: of its nodes, those in the same use of a subtree as the run's uid; only: of this alone;
        by_rows: see `placed`."""
        if event.condition is not None:
            found = []
            end: Moment | None = None
            for part, is_sure in self.stretches([event.condition], run):
                if not is_sure:
                    found.append(Happening(part.start, part.stop, part.stop, False, False))
                elif part.start != end:
                    found.append(Happening(part.start, part.start, part.start))
                end = None if is_sure else part.stop
            return found
        uids = [run.uid] if only else self.nearest(run.uid, self.uids(event.subject))
        of = [each for each in self.activations if each.uid in uids and each.run == run.run]
        if event.happening == "starts":
            return [
                Happening(each.placed(by_rows), each.placed(by_rows), each.start, of=each, is_of_node=True)
                for each in of
            ]
        outcomes = {"succeeds": "S", "fails": "F", "finishes": "SF", "halts": "H"}[event.happening]
        return [
            Happening(each.stop if each.is_exact else each.shown, each.stop, each.stop, each.is_exact, is_of_node=True)
            for each in of
            if each.outcome in outcomes
        ]


COUNTED = {"succeeds per": "S", "fails per": "F", "finishes per": "SF"}
OF_RUNS = {
    **dict.fromkeys((*COUNTED, "starts per"), "tries"),
    "tries": "tries",
    "runs": "rate",
    "visits": "visits",
    "follows": "follows",
    **dict.fromkeys(("keeps of time", "never of time"), "share"),
}


def between(run: Activation, uid: int, start: Moment, stop: Moment) -> Activation:
    """A part of a run, as seen from a node."""
    return Activation(uid, run.first, run.last, start, start, stop, run.outcome, True, run.run)


def spent(since: tuple[int, int], until: tuple[int, int]) -> tuple[int, int]:
    """The shortest and the longest time from one moment to another, of which only limits are known."""
    return max(until[0] - since[1], 0), until[1] - since[0]


def has_node(event: ResolvedEvent | ResolvedAnyEvent) -> bool:
    """Whether something that a node does is among several events."""
    return any(each.condition is None for each in event.atoms)


def meets(one: Happening, other: Happening) -> bool:
    """Whether the order of two events is unknown."""
    return one.after <= other.by and other.after <= one.by


def all_of(verdicts: Sequence[Verdict]) -> Verdict:
    """What several come to together."""
    return next((each for each in (False, None, True, OPEN) if any(each is verdict for verdict in verdicts)), OUT)
