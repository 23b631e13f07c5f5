"""What clauses mean, once more: word for word as the design tells it, slow, over lists of a whole session.

What `btq_lang.evidence` says of a log is held against it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isclose, sqrt
from statistics import fmean, stdev
from typing import TYPE_CHECKING, Any

from literal_log import both, micros
from literal_over_runs import OF_RUNS, OverRuns, all_of
from literal_verbs import OPEN, OUT, Judged, counted

from btq_lang.evidence.model import ENOUGH, ROOT
from btq_lang.evidence.odds import lower_limit, upper_limit
from btq_lang.evidence.poisson import lower_number, upper_number
from btq_lang.evidence.student import quantile
from btq_lang.requirements.model import DurationSum, Interval, MissionRun, NodeTarget, Quantity, ResolvedEachEvent

if TYPE_CHECKING:
    from literal_log import Truth
    from literal_over_runs import Spent
    from literal_runs import Activation
    from literal_verbs import Part, Verdict

    from btq_lang.requirements.applied import Applied
    from btq_lang.requirements.model import ResolvedClaim, ResolvedRequirement


@dataclass(frozen=True)
class ClauseResult:
    """A clause at a node.

    Attributes:
        judged: all of its activations.
        experiments: what the odds count: these, or their result in each run.
    """

    verdict: str
    judged: tuple[Judged, ...]
    experiments: tuple[Verdict, ...]


class World(OverRuns):
    """A session, judged as if all began at their earliest, or at their latest."""

    def judged(self, applied: Applied, claim: ResolvedClaim, part: Part = None) -> list[Judged]:
        """What a claim at a node comes to, with its scopes, and with what its guards did.

        Args:
            part: the only end of `between` that counts.
        """
        requirement = applied.requirement
        assert isinstance(applied.subject, NodeTarget | MissionRun)
        found = []
        for uid in self.uids(applied.subject):
            if isinstance(applied.subject, MissionRun) and claim.verb == "succeeds":
                found += self.mission_succeeds(uid, claim, requirement)  # of a run whose start was refused, too
                continue
            if requirement.span is not None:
                found += self.kept_in_spans(uid, claim, requirement)
            elif claim.verb in OF_RUNS:
                found += self.over_runs(uid, claim, requirement)
            elif claim.verb not in ("starts", "ends"):
                found += self.of_activations(uid, claim, requirement, part)
            found += self.refused(uid, claim, requirement)
        return found


class Session:
    """A session, judged: what the earliest and the latest begins do not answer alike is unknown.

    Durations are intervals, and so are sums, spans and reactions: from the event's latest moment to its answer's
    earliest, and the reverse.  The order of the rows says which answer is the next one.
    """

    def __init__(self, *log: Any) -> None:
        """As `Log`, but for the end."""
        self.early, self.late = World("earliest", *log), World("latest", *log)
        self.worlds = self.early, self.late
        self.runs = self.late.runs
        self.activations = self.late.activations

    def judged(self, applied: Applied, claim: ResolvedClaim) -> list[Judged]:
        """What a claim comes to; of a run, if it is applicable."""
        found = self.anyhow(applied, claim)
        is_of_run = claim.verb in OVER_RUNS or applied.requirement.span is not None
        if not is_of_run and not isinstance(applied.subject, Interval | DurationSum):
            return found
        return [each for one in found if (each := self.in_run(one, applied.requirement)).verdict != OUT]

    def in_run(self, one: Judged, requirement: ResolvedRequirement) -> Judged:
        """A part of a run, which is not applicable unless each assumption holds all along in the run."""
        runs = [replace(world.runs[one.run], uid=one.uid) for world in self.worlds]
        verdicts = [
            world.applicable(run, one.verdict, requirement) for world, run in zip(self.worlds, runs, strict=True)
        ]
        return replace(one, verdict=alike(*verdicts))

    def anyhow(self, applied: Applied, claim: ResolvedClaim) -> list[Judged]:
        """What a claim comes to; of a run, also if that is not applicable."""
        if isinstance(applied.subject, Interval):
            found = self.spent(
                claim, [world.spans(applied.subject, claim, applied.requirement) for world in self.worlds]
            )
            return [each for each in found if each.verdict != OUT]
        if isinstance(applied.subject, ResolvedEachEvent):
            return self.followed(applied.subject, claim, applied.requirement)
        if isinstance(applied.subject, DurationSum):
            return self.total(applied.subject, claim, applied.requirement)
        found = self.at_both_ends(applied, claim)
        if claim.verb in ("takes", "uses") and claim.limit is not None and claim.limit.relation == "between":
            upper, lower = (self.at_both_ends(applied, claim, part) for part in ("upper", "lower"))
            return [both_parts(*each) for each in zip(upper, lower, strict=True)]
        if claim.verb in ("starts", "ends"):
            for uid in self.late.uids(applied.subject):
                found += self.spent(claim, [world.reactions(uid, claim, applied.requirement) for world in self.worlds])
        return [
            each
            for each in found
            if each.verdict != OUT or claim.verb not in ("starts", "ends", "follows", "keeps", "never")
        ]

    def rated(self, applied: Applied, claim: ResolvedClaim) -> list[tuple[Judged, tuple[int, int, int, int]]]:
        """fails at most m per d: what each run adds, if it has time for it."""
        uids = self.late.uids(applied.subject) if isinstance(applied.subject, NodeTarget | MissionRun) else []
        is_mission = isinstance(applied.subject, MissionRun)
        early, late = (
            world.rates(uids, is_mission, claim, applied.requirement) if uids else [] for world in self.worlds
        )
        found = []
        for run, ones, others in zip(self.runs, early, late, strict=False):
            (few, one_many, short, one_long), (other_few, many, other_short, long) = ones, others
            added = min(few, other_few), max(one_many, many), min(short, other_short), max(one_long, long)
            one = Judged(run.run, uids[0], True if added[3] else OUT, run.end)
            found.append((self.in_run(one, applied.requirement), added))
        return found

    def followed(self, each: ResolvedEachEvent, claim: ResolvedClaim, requirement: ResolvedRequirement) -> list[Judged]:
        """each e is followed by f: what both ends of the begins say of each e."""
        early, late = (world.followed(each, claim, requirement) for world in self.worlds)
        return [each for each in self.both_ends(early, late) if each.verdict != OUT]

    def at_both_ends(self, applied: Applied, claim: ResolvedClaim, part: Part = None) -> list[Judged]:
        """What it comes to, for each instance of the node and run, if the ends of the begins agree."""
        return self.both_ends(*(world.judged(applied, claim, part) for world in self.worlds))

    def both_ends(self, early: Sequence[Judged], late: Sequence[Judged]) -> list[Judged]:
        """What both say, for each instance of a node and run."""
        found = []
        for run, uid in dict.fromkeys((each.run, each.uid) for each in [*late, *early]):
            ones, others = ([each for each in judged if (each.run, each.uid) == (run, uid)] for judged in (early, late))
            if len(ones) == len(others):
                found += [
                    replace(other, verdict=alike(one.verdict, other.verdict), measures=ends(one, other))
                    for one, other in zip(ones, others, strict=True)
                ]
            elif any(each.verdict != OUT for each in (*ones, *others)):
                end = self.runs[run].end
                found.append(Judged(run, uid, None, end, end))
        return found

    def spent(self, claim: ResolvedClaim, found: Sequence[Sequence[Spent]]) -> list[Judged]:
        """Times between events, of both ends.  What is not answered is violated when the run has ended, and open when
        the log has."""
        judged = []
        for run in self.runs:
            early, late = ([each for each in of_world if each.at.run == run.run] for of_world in found)
            if len(early) == len(late):
                judged += [self.spent_between(claim, *each) for each in zip(early, late, strict=True)]
            elif any(each.counts is not False for each in (*early, *late)):
                judged.append(Judged(run.run, ROOT, None, run.end, run.end))
        return judged

    def spent_between(self, claim: ResolvedClaim, one: Spent, other: Spent) -> Judged:
        """One of them, at the earliest and at the latest begin."""
        run = self.runs[other.at.run]
        times = one.least, one.most, other.least, other.most
        kept = self.kept(times, claim, one.at, other.at)
        is_answered, unclear = other.is_answered, one.is_unclear or other.is_unclear
        verdict: Verdict = kept.copy().pop() if len(kept) == 1 else None
        is_known = one.is_sure and other.is_sure and one.is_answered == is_answered
        if not is_known or (unclear and not (verdict and is_answered)):
            verdict = None
        elif not is_answered and None not in kept and run.outcome != "O":
            verdict = False
        elif not is_answered and verdict:
            verdict = OPEN
        verdict = counted(one.counts if one.counts == other.counts else None, verdict)
        verdict = False if other.is_stopped else verdict
        decided = other.at.end if verdict is False and is_answered else other.until
        return Judged(run.run, other.at.uid, verdict, run.end, decided)

    def total(self, total: DurationSum, claim: ResolvedClaim, requirement: ResolvedRequirement) -> list[Judged]:
        """sum of X, Y: what they did in a run, together."""
        found: list[Judged] = []
        early, late = (world.parts(total, requirement) for world in self.worlds)
        for ones, others in zip(early, late, strict=True):
            run = self.runs[len(found)]
            one_run = self.early.runs[run.run]
            parts = [
                (one, other, counts)
                for (one, at_earliest), (other, at_latest) in zip(ones, others, strict=True)
                if (counts := alike(at_earliest, at_latest)) is not False
            ]
            most = sum(one.end - one.begin for one, _, _ in parts)
            least = sum(other.end - other.begin for _, other, counts in parts if counts and other.is_exact)
            kept: set[Verdict] = {*self.kept((least, most), claim, one_run, run)}
            if not any(counts for *_, counts in parts):
                kept = {OUT, *kept} if parts else {OUT}
            verdict = kept.pop() if len(kept) == 1 else None
            verdict = OPEN if verdict is True and run.outcome == "O" else verdict
            found.append(Judged(run.run, run.uid, verdict, run.end))
        return found

    def kept(self, times: Sequence[int], claim: ResolvedClaim, one: Activation, other: Activation) -> set[Truth]:
        """Whether durations keep a limit, as it is read at the earliest and at the latest begin."""
        return {
            world.within(max(spent, 0) / 1e6, claim.limit, at)[0]
            for spent in times
            for world, at in ((self.early, one), (self.late, other))
        }


OVER_RUNS = (*OF_RUNS, "starts", "ends", "followed")


def alike(one: Verdict, other: Verdict) -> Verdict:
    """What both say; unknown if they differ.  What is cut off if it counts is cut off."""
    return one if one == other else OPEN if {one, other} == {OPEN, OUT} else None


def ends(one: Judged, other: Judged) -> tuple[float, float]:
    """Between which a measure is; the lower one if they are nearly the same."""
    low, high = sorted((*one.measures, *other.measures))[:: len(one.measures) * 2 - 1]
    return (low, low) if high - low <= abs(low) * ENOUGH else (low, high)


def both_parts(upper: Judged, lower: Judged) -> Judged:
    """`between` by what its ends come to: what is cut off, or not counted, is so by the upper one."""
    if isinstance(upper.verdict, str) or isinstance(lower.verdict, str):
        return upper
    return replace(upper, verdict=both(upper.verdict, lower.verdict))


class Literal:
    """All sessions, judged together; their runs are numbered on."""

    def __init__(self, sessions: Sequence[Session]) -> None:
        self.sessions = sessions
        self.runs = [run for session in sessions for run in session.runs]
        self.activations = [each for session in sessions for each in session.activations]

    def clause(self, applied: Applied, claim: ResolvedClaim) -> ClauseResult:
        """A claim of an applied requirement, with its scopes, odds and window."""
        requirement = applied.requirement
        judged: list[Judged] = []
        before = 0
        if claim.verb == "fails per time":
            return self.rate(applied, claim)
        for session in self.sessions:
            judged += [replace(each, run=each.run + before) for each in session.judged(applied, claim)]
            before += len(session.runs)
        judged.sort(key=lambda each: (self.runs[each.run].begin, each.run, each.at, each.decided))
        judged = self.last(requirement, judged)
        if claim.verb.endswith(" on average"):
            return ClauseResult(self.mean(requirement, claim, judged), tuple(judged), tuple(x.verdict for x in judged))
        experiments = [each.verdict for each in judged]
        if requirement.odds is not None and requirement.odds.experiments == "runs":
            of_runs = [[each.verdict for each in judged if each.run == run] for run in range(len(self.runs))]
            experiments = [all_of(verdicts) for verdicts in of_runs]
        verdict = self.verdict(requirement, experiments)
        targets = applied.subject.targets if isinstance(applied.subject, DurationSum) else ()
        nodes = {uid for target in targets for uid in self.sessions[0].late.uids(target)} or {
            each.uid for each in judged
        }
        ran = {each.uid for each in self.activations} | {each.uid for each in judged if each.is_refused}
        if verdict == "satisfied" and not nodes & ran:
            verdict = "never exercised"  # where others ran that it might have run in, or after
        return ClauseResult(verdict, tuple(judged), tuple(experiments))

    def mean(self, requirement: ResolvedRequirement, claim: ResolvedClaim, judged: Sequence[Judged]) -> str:
        """takes, uses … on average: the least and the most that the mean of what counts may be."""
        assert claim.limit is not None
        assert isinstance(claim.limit.value, Quantity)
        verdicts = [each.verdict for each in judged]
        if None in verdicts:
            return "unknown"
        limits = [each.measures for each in judged if each.verdict is True]
        if not limits:
            return "never exercised"
        middles = [(low + high) / 2 for low, high in limits]
        halves = [(high - low) / 2 for low, high in limits]
        width = fmean(halves)
        if requirement.confidence is not None:
            if len(limits) < 2:
                return "undecided"
            deviation = stdev(middles) + sqrt(sum(half * half for half in halves) / (len(halves) - 1))
            width += quantile(requirement.confidence, len(limits) - 1) * deviation / sqrt(len(limits))
        low, high = fmean(middles) - width, fmean(middles) + width
        least = claim.limit.value.si if claim.limit.relation not in ("<=", "<") else float("-inf")
        most = claim.limit.value.si if claim.limit.relation in ("<=", "<") else float("inf")
        if isinstance(claim.limit.upper, Quantity):
            most = claim.limit.upper.si
        for bound in (least, most):
            low, high = (bound if isclose(end, bound, rel_tol=1e-12) else end for end in (low, high))
        is_strict = claim.limit.relation in ("<", ">")
        if (least < low and high < most) or (not is_strict and least <= low and high <= most):
            return "satisfied"
        if low > most or high < least or (is_strict and (low >= most or high <= least)):
            return "violated"
        return "undecided" if requirement.confidence is not None else "unknown"

    def rate(self, applied: Applied, claim: ResolvedClaim) -> ClauseResult:
        """fails at most m per d: the failures and the time of all runs."""
        requirement = applied.requirement
        added: dict[int, tuple[int, int, int, int]] = {}
        judged: list[Judged] = []
        before = 0
        for session in self.sessions:
            for each, amounts in session.rated(applied, claim):
                judged.append(replace(each, run=each.run + before))
                added[each.run + before] = amounts
            before += len(session.runs)
        judged.sort(key=lambda each: (self.runs[each.run].begin, each.run, each.at))
        judged = self.last(requirement, judged)
        counted = [added[each.run] for each in judged if each.verdict is True]
        few, many, short, long = (sum(column) for column in zip(*counted, strict=True)) if counted else (0, 0, 0, 0)
        one, other = self.of_rate(requirement, claim, many, short), self.of_rate(requirement, claim, few, long)
        verdict = "never exercised" if not counted else one if one == other else "unknown"
        verdict = "unknown" if any(each.verdict is None for each in judged) else verdict
        uids = {each.uid for each in judged}
        if isinstance(applied.subject, NodeTarget):
            uids = {*self.sessions[0].late.uids(applied.subject)}
        if verdict == "satisfied" and not uids & {each.uid for each in self.activations}:
            verdict = "never exercised"
        return ClauseResult(verdict, tuple(judged), tuple(each.verdict for each in judged))

    def of_rate(self, requirement: ResolvedRequirement, claim: ResolvedClaim, number: int, micros_: int) -> str:
        """What a number of failures in a time comes to."""
        assert claim.limit is not None
        assert isinstance(claim.per, Quantity)
        assert isinstance(claim.limit.value, Quantity)
        low, high = float("-inf"), float("inf")
        if claim.limit.relation in ("<=", "<"):
            high = claim.limit.value.si
        else:
            low = claim.limit.value.si
        if isinstance(claim.limit.upper, Quantity):
            high = claim.limit.upper.si
        is_strict = claim.limit.relation in ("<", ">")
        times = micros_ / 1e6 / claim.per.si
        confidence = requirement.confidence
        demanded = high if high < float("inf") else low
        if confidence is None and times < (1 / demanded if 0 < demanded < 1 else 1):
            return "unknown"
        fewest, most = (
            (number, number)
            if confidence is None
            else (lower_number(number, confidence), upper_number(number, confidence))
        )
        at_least, at_most = low * times if low > 0 else low, high * times if high < float("inf") else high
        is_kept = fewest > at_least and most < at_most if is_strict else fewest >= at_least and most <= at_most
        if is_kept:
            return "satisfied"
        return "violated" if confidence is None or fewest > at_most or most < at_least else "undecided"

    def verdict(self, requirement: ResolvedRequirement, experiments: Sequence[Verdict]) -> str:
        """What experiments come to together."""
        odds = requirement.odds
        yes, no, maybe = (sum(each is truth for each in experiments) for truth in (True, False, None))
        if yes + no + maybe == 0:
            return "never exercised"
        if odds is None:
            return "violated" if no else "unknown" if maybe else "satisfied"

        def judge(k: int, n: int) -> str:
            confidence = requirement.confidence
            if confidence is None:
                share = k / n
                is_enough = share > odds.probability if odds.relation == ">" else share >= odds.probability
                return "satisfied" if is_enough else "violated"
            if lower_limit(k, n, confidence) >= odds.probability:
                return "satisfied"
            return "violated" if upper_limit(k, n, confidence) < odds.probability else "undecided"

        verdicts = {judge(yes, yes + no + maybe), judge(yes + maybe, yes + no + maybe)}
        return verdicts.pop() if len(verdicts) == 1 else "unknown"

    def last(self, requirement: ResolvedRequirement, judged: list[Judged]) -> list[Judged]:
        """Those in the window."""
        window = requirement.window
        if window is None:
            return judged
        counted = [each for each in judged if each.verdict not in (OPEN, OUT)]
        if window.seconds is not None:
            since = max((run.end for run in self.runs), default=0) - micros(window.seconds)
            counted = [each for each in counted if each.at >= since]
        elif window.experiments == "runs":
            runs = [*dict.fromkeys(each.run for each in counted)][-(window.count or 0) :]
            counted = [each for each in counted if each.run in runs]
        else:
            counted = counted[-(window.count or 0) :]
        return counted + [each for each in judged if each.verdict is OPEN]
