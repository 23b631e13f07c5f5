"""The verbs that are judged over a run, word for word as the design tells them: counts, rates, events, sums."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

from literal_log import both, micros
from literal_runs import Activation
from literal_verbs import OPEN, OUT, Judged, OfActivations, counted, judged

from btq_lang.evidence.model import ROOT
from btq_lang.requirements.model import Value
from btq_lang.util import record

if TYPE_CHECKING:
    from literal_runs import Moment
    from literal_verbs import Verdict

    from btq_lang.requirements.model import Claim, Condition, Event, Requirement, Span, Total

    Decided = tuple[Verdict, int]  # and when that was


@dataclass(frozen=True)
class Happening:
    """An event: from when on and by when it happened, if it did; is_sure: it did, just then."""

    after: Moment
    by: Moment
    is_sure: bool = True
    has_happened: bool = True


class OverRuns(OfActivations):
    """A session, and what each run of it comes to."""

    def over_runs(self, uid: int, claim: Claim, requirement: Requirement) -> list[Judged]:
        """tries, runs, starts, ends, follows at one instance of a node."""
        judge = {"tries": self.tries, "runs": self.rate, "follows": self.follows}.get(claim.verb, self.reactions)
        found = []
        for run in self.runs:
            own = [each for each in self.of(uid) if each.run == run.run]
            verdicts = judge(uid, own, run, claim, requirement)
            found += [Judged(run.run, uid, verdict, run.end, decided) for verdict, decided in verdicts]
        return found

    def tries(
        self, uid: int, own: Sequence[Activation], run: Activation, claim: Claim, requirement: Requirement
    ) -> list[Decided]:
        """How many starts that count lie in each activation of the other node, or in the run."""
        around = [ROOT] if claim.per is None else self.nearest(uid, self.uids(claim.per))
        found: list[Decided] = []
        for p in (each for other in around for each in self.of(other) if each.run == run.run):
            inside = [(x, self.counts(x, requirement)) for x in own if p.start <= x.start <= p.stop]
            sure = [x for x, counts in inside if counts]
            numbers = {len(sure), sum(counts is not False for _, counts in inside)}
            verdicts = {self.tried(p, number, claim) for number in numbers}
            verdict = verdicts.pop() if len(verdicts) == 1 else None
            too_many = [x for number, x in enumerate(sure, 1) if self.within(number, claim.limit, p)[0] is False]
            found.append((verdict, too_many[0].begin if verdict is False and too_many else p.end))
        return found

    def tried(self, p: Activation, number: int, claim: Claim) -> Verdict:
        not_above, not_below = self.within(number, claim.limit, p)
        if p.outcome in ("S", "F"):
            return both(not_above, not_below)
        if p.outcome == "O":
            return not_above if not not_above else OPEN
        return not_above if not_above is not False or p.is_exact else None

    def rate(
        self, uid: int, own: Sequence[Activation], run: Activation, claim: Claim, requirement: Requirement
    ) -> list[Decided]:
        """runs every d, runs at least m per d: in each stretch of a run that counts."""
        scopes = [each.condition for each in requirement.scopes if each.word == "while"]
        when = record.replace(requirement, scopes=tuple(each for each in requirement.scopes if each.word == "when"))
        found: list[Decided] = []
        for stretch, is_sure in self.stretches(scopes, replace(run, uid=uid)):
            inside = [(x, self.counts(x, when)) for x in own if stretch.start <= x.start <= stretch.stop]
            inside = [(x, counts) for x, counts in inside if counts is not False]
            if not is_sure or any(counts is None for _, counts in inside):
                found.append((None, stretch.begin))
                continue
            times = [x.begin for x, _ in inside]
            is_open = run.outcome == "O" and stretch.stop == run.stop
            judge = self.evenly if claim.every else self.often
            found += judge(claim, replace(stretch, outcome="O" if is_open else "S"), times)
        return found

    def evenly(self, claim: Claim, stretch: Activation, times: list[int]) -> list[Decided]:
        """Each time between two starts, and from the last one to the end."""
        if not times:
            return []
        kept = [self.within((later - before) / 1e6, claim.limit, stretch)[0] for before, later in pairwise(times)]
        tail: Verdict = self.within((stretch.end - times[-1]) / 1e6, claim.limit, stretch)[0]
        return [*zip(kept, times[1:], strict=True), (OPEN if tail and stretch.outcome == "O" else tail, stretch.end)]

    def often(self, claim: Claim, stretch: Activation, times: list[int]) -> list[Decided]:
        """Each window of the length."""
        assert isinstance(claim.per, Value)
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

    def reactions(
        self, uid: int, own: Sequence[Activation], run: Activation, claim: Claim, requirement: Requirement
    ) -> list[Decided]:
        """starts within d after ev, ends within d after ev: the next start, or end, after each event."""
        assert claim.event is not None
        found: list[Decided] = []
        for event in self.events(claim.event, replace(run, uid=uid)):
            if claim.verb == "starts":
                answer = next((Happening(x.start, x.start) for x in own if x.start >= event.after), None)
            else:  # what does not run has nothing to end
                running = [x for x in own if x.start <= event.after <= x.stop][-1:]
                if not running:
                    continue
                answer = next((Happening(x.start, x.stop, x.is_exact) for x in running if x.outcome != "O"), None)
            by = answer.by if answer is not None else run.stop
            at = between(run, uid, event.after, by)
            kept = self.within((by[0] - event.after[0]) / 1e6, claim.limit, at)[0]
            bound = self.number(claim.limit.value, event.after, at) if claim.limit is not None else None
            until = by if bound is None else min(by, (event.after[0] + micros(bound), by[1]))
            counts = self.counts(between(run, uid, event.after, until), requirement)
            verdict: Verdict = kept
            if not event.is_sure or (kept is False and answer is not None and not answer.is_sure):
                verdict = None
            elif kept and answer is None:
                verdict = OPEN if run.outcome == "O" else None  # an open tail
            verdict = counted(counts, verdict)
            found.append((verdict, by[0] if verdict is False and answer is not None else until[0]))
        return [each for each in found if each[0] != OUT]

    def follows(
        self, uid: int, own: Sequence[Activation], run: Activation, claim: Claim, requirement: Requirement
    ) -> list[Decided]:
        """An event since the start before, or since the run began."""
        assert claim.event is not None
        events = self.events(claim.event, replace(run, uid=uid))
        before = (run.begin, -1)
        found: list[Decided] = []
        for x in own:
            maybe = [each for each in events if before < each.by and each.after <= x.start]
            is_sure = any(each.has_happened and before < each.after and each.by <= x.start for each in maybe)
            verdict: Verdict = True if is_sure else None if maybe else False
            verdict = OPEN if is_sure and x.outcome == "O" else verdict
            found.append((counted(self.counts(x, requirement), verdict), x.begin))
            before = x.start
        return [each for each in found if each[0] != OUT]

    def span(self, span: Span, claim: Claim, requirement: Requirement) -> list[Judged]:
        """from e1 to e2: each e1 opens one, the next e2 closes all that are open."""
        firsts = self.uids(span.first.subject) if span.first.condition is None else [ROOT]
        found = []
        for run in self.runs:
            for uid in firsts:
                lasts = self.events(span.last, replace(run, uid=uid))
                for first in self.events(span.first, replace(run, uid=uid), only=True):
                    after = first.after if span.first != span.last else (first.after[0], first.after[1] + 1)
                    closing = [each.by for each in lasts if each.has_happened and each.after >= after]
                    by = min(closing, default=run.stop)
                    unclear = any(not each.is_sure and each.by >= first.after and each.after <= by for each in lasts)
                    at = between(run, uid, first.after, by)
                    kept = self.within((by[0] - first.after[0]) / 1e6, claim.limit, at)[0]
                    verdict: Verdict = kept
                    if not first.is_sure or (unclear and not (kept and closing)):
                        verdict = None
                    elif kept and not closing:
                        verdict = OPEN if run.outcome == "O" else False
                    verdict = counted(self.counts(at, requirement), verdict)
                    found.append(Judged(run.run, uid, verdict, run.end, by[0]))
        return [each for each in found if each.verdict != OUT]

    def total(self, total: Total, claim: Claim, requirement: Requirement) -> list[Judged]:
        """sum of X, Y: what they did in a run, together."""
        uids = {uid for target in total.targets for uid in self.uids(target)}
        found = []
        for run in self.runs if uids else ():
            parts = [each for each in self.activations if each.uid in uids and each.run == run.run]
            may = [(each, counts) for each in parts if (counts := self.counts(each, requirement)) is not False]
            most = sum(each.end - each.begin for each, _ in may)
            least = sum(each.end - each.begin for each, counts in may if counts and each.is_exact)
            kept = {self.within(spent / 1e6, claim.limit, run)[0] for spent in (least, most)}
            verdict: Verdict = kept.pop() if len(kept) == 1 else None
            found.append(judged(run, OPEN if verdict and run.outcome == "O" else verdict))
        return found

    def stretches(self, conditions: Sequence[Condition], run: Activation) -> list[tuple[Activation, bool]]:
        """The longest parts of a run with conditions, and, not sure, those in which they may hold."""
        moments = self.moments(run)
        held = [both(*(self.holds(condition, moment, run) for condition in conditions)) for moment in moments]
        found: list[tuple[Activation, bool]] = []
        for index, now in enumerate(held):
            if now is False or (index and held[index - 1] is now):
                continue
            length = next((later for later, then in enumerate(held[index:]) if then is not now), None)
            end = moments[index + length] if length is not None else run.stop
            found.append((between(run, run.uid, moments[index], end), now is True))
        return found

    def events(self, event: Event, run: Activation, *, only: bool = False) -> list[Happening]:
        """An event in a run: of its nodes, those in the same use of a subtree as the run's uid; only: of this alone."""
        if event.condition is not None:
            found = []
            end: Moment | None = None
            for part, is_sure in self.stretches([event.condition], run):
                if not is_sure:
                    found.append(Happening(part.start, part.stop, False, False))
                elif part.start != end:
                    found.append(Happening(part.start, part.start))
                end = None if is_sure else part.stop
            return found
        uids = [run.uid] if only else self.nearest(run.uid, self.uids(event.subject))
        of = [each for each in self.activations if each.uid in uids and each.run == run.run]
        if event.happening == "starts":
            return [Happening(each.start, each.start) for each in of]
        outcomes = {"succeeds": "S", "fails": "F", "finishes": "SF", "halts": "H"}[event.happening]
        return [
            Happening(each.stop if each.is_exact else each.start, each.stop, each.is_exact)
            for each in of
            if each.outcome in outcomes
        ]


def between(run: Activation, uid: int, start: Moment, stop: Moment) -> Activation:
    """A part of a run, as seen from a node."""
    return Activation(uid, start[1], stop[1], start[0], stop[0], run.outcome, True, run.run)


def all_of(verdicts: Sequence[Verdict]) -> Verdict:
    """What several come to together."""
    return next((each for each in (False, None, True, OPEN) if any(each is verdict for verdict in verdicts)), OUT)
