"""The verbs that are judged over a run, word for word as the design tells them: counts, rates, events, sums."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from literal_log import both, micros
from literal_runs import Activation
from literal_verbs import OPEN, OUT, Judged, OfActivations, judged

from btq_lang.evidence.model import ROOT

if TYPE_CHECKING:
    from literal_verbs import Verdict

    from btq_lang.requirements.model import Claim, Event, Requirement, Span, Total


class OverRuns(OfActivations):
    """A session, and what each run of it comes to."""

    def over_runs(self, uid: int, claim: Claim, requirement: Requirement) -> list[Judged]:
        """tries, runs, starts, ends, follows at one instance of a node."""
        if claim.verb == "runs":
            return [judged(run, self.rate(uid, claim, requirement, run)) for run in self.runs]
        return {"tries": self.tries, "follows": self.follows}.get(claim.verb, self.reactions)(uid, claim, requirement)

    def tries(self, uid: int, claim: Claim, requirement: Requirement) -> list[Judged]:
        around = [ROOT] if claim.per is None else self.nearest(uid, self.uids(claim.per))
        found = []
        for p in (each for other in around for each in self.of(other)):
            number = sum(x.run == p.run and p.begin <= x.begin <= p.end for x in self.of(uid))
            not_above, not_below = self.within(number, claim.limit, p)
            verdict: Verdict = both(not_above, not_below)
            if p.outcome == "O" and not_above is not False:
                verdict = OPEN
            elif p.outcome == "H" and not_above is True and not_below is not True:
                verdict = OUT
            found.append(judged(p, self.scoped(p, verdict, requirement)))
        return found

    def rate(self, uid: int, claim: Claim, requirement: Requirement, run: Activation) -> Verdict:
        """runs every d, runs at least m per d: a run's starts in each stretch of time that counts."""
        starts = [each.begin for each in self.of(uid) if each.run == run.run]
        verdicts = [
            self.evenly(claim, run, [time for time in starts if begin <= time <= end], begin, end)
            for begin, end in self.stretches(requirement, run)
        ]
        is_sure = all(
            self.holds_all("while", requirement, time, run) is not None for time in self.moments(run.begin, run.end)
        )
        verdict = all_of(verdicts)
        return verdict if is_sure or verdict == OUT else None

    def evenly(self, claim: Claim, run: Activation, starts: list[int], begin: int, end: int) -> Verdict:
        if claim.every:
            gaps = [later - earlier for earlier, later in pairwise([*starts, end])]
            kept = [self.within(gap / 1e6, claim.limit, run)[0] for gap in gaps]
            if not starts:
                return OUT
        else:
            window, fewest = micros(claim.per.si), claim.limit.value.si
            if end - begin < window:
                return OUT
            marks = [begin, *starts, end]
            needed = int(fewest)
            kept = [later - earlier <= window for earlier, later in zip(marks, marks[needed:], strict=False)]
            kept += [False] if len(starts) < needed else []
        return False if False in kept else OPEN if run.outcome == "O" else both(*kept)

    def reactions(self, uid: int, claim: Claim, requirement: Requirement) -> list[Judged]:
        """starts within d after ev, ends within d after ev: an answer to each event."""
        answers = [
            each.begin if claim.verb == "starts" else each.end
            for each in self.of(uid)
            if claim.verb == "starts" or each.outcome != "O"
        ]
        found = []
        for run in self.runs:
            for time in self.events(claim.event, run, uid):
                at = Activation(uid, run.first, run.last, time, run.end, run.outcome, True, run.run)
                waits = [answer - time for answer in answers if time <= answer <= run.end]
                open_ = (run.end - time) / 1e6
                kept: Verdict = self.within(min(waits) / 1e6 if waits else open_, claim.limit, at)[0]
                if not waits and kept is True:
                    kept = OPEN if run.outcome == "O" else False
                found.append(judged(at, self.scoped(at, kept, requirement)))
        return found

    def follows(self, uid: int, claim: Claim, requirement: Requirement) -> list[Judged]:
        found = []
        for run in self.runs:
            events, before = self.events(claim.event, run, uid), run.begin - 1
            for each in self.of(uid):
                if each.run == run.run:
                    verdict = any(before < event <= each.begin for event in events)
                    before = each.begin
                    found.append(
                        judged(
                            each,
                            self.scoped(
                                each, verdict or OPEN if each.outcome == "O" and verdict else verdict, requirement
                            ),
                        )
                    )
        return found

    def span(self, span: Span, claim: Claim) -> list[Judged]:
        """from e1 to e2: each e1 opens one, the next e2 closes it."""
        found = []
        firsts = self.uids(span.first.subject) if span.first.subject is not None else [ROOT]
        for run in self.runs:
            for uid in firsts:
                ends = self.events(span.last, run, uid)
                for time in self.events(span.first, run, uid, only=True):
                    later = [end for end in ends if end >= time]
                    at = Activation(uid, run.first, run.last, time, run.end, run.outcome, True, run.run)
                    if later:
                        verdict: Verdict = both(*self.within((later[0] - time) / 1e6, claim.limit, at))
                    elif run.outcome == "O":
                        verdict = OPEN if self.within((run.end - time) / 1e6, claim.limit, at)[0] else False
                    else:
                        verdict = False
                    found.append(judged(at, verdict))
        return found

    def total(self, total: Total, claim: Claim) -> list[Judged]:
        """sum of X, Y: all of their activations in a run."""
        uids = {uid for target in total.targets for uid in self.uids(target)}
        found = []
        for run in self.runs:
            parts = [each for each in self.activations if each.uid in uids and each.run == run.run]
            spent = sum(each.end - each.begin for each in parts)
            sure = sum(each.end - each.begin for each in parts if each.is_exact)
            most, least = (self.within(micro / 1e6, claim.limit, run) for micro in (spent, sure))
            verdict: Verdict = both(*most) if spent == sure or both(*most) else False if least[0] is False else None
            if run.outcome == "O" and verdict is not False:
                verdict = OPEN
            found.append(judged(run, verdict))
        return found

    def stretches(self, requirement: Requirement, run: Activation) -> list[tuple[int, int]]:
        """The parts of a run that count."""
        if self.holds_all("when", requirement, run.begin, run) is not True:
            return []
        found: list[tuple[int, int]] = []
        since: int | None = None
        for time in self.moments(run.begin, run.end):
            if self.holds_all("while", requirement, time, run):
                since = time if since is None else since
            elif since is not None:
                found.append((since, time))
                since = None
        return found if since is None else [*found, (since, run.end)]

    def events(self, event: Event, run: Activation, near: int, *, only: bool = False) -> list[int]:
        """The times of an event in a run.

        Args:
            near: of the event's nodes, those of the same subtree instance as this one.
            only: of this one alone.
        """
        if event.happening == "when":
            moments = self.moments(run.begin, run.end)
            held = [self.holds(event.condition, time, run) is True for time in moments]
            return [
                time for time, before, now in zip(moments, [False, *held], held, strict=False) if now and not before
            ]
        uids = [near] if only else self.nearest(near, self.uids(event.subject))
        of = [each for each in self.activations if each.uid in uids and each.run == run.run]
        if event.happening == "starts":
            return sorted(each.begin for each in of)
        outcomes = {"succeeds": "S", "fails": "F", "finishes": "SF", "halts": "H"}[event.happening]
        return sorted(each.end for each in of if each.outcome in outcomes)


def all_of(verdicts: Sequence[Verdict]) -> Verdict:
    """What several come to together."""
    return next((each for each in (False, None, True, OPEN) if any(each is verdict for verdict in verdicts)), OUT)
