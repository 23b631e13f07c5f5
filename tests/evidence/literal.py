"""What clauses mean, once more: word for word as the design tells it, slow, over lists of a whole session.

What `btq_lang.evidence` says of a log is held against it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from literal_log import micros
from literal_over_runs import OverRuns, all_of
from literal_verbs import OPEN, OUT, Judged

from btq_lang.evidence.odds import lower_limit, upper_limit
from btq_lang.requirements.model import Span, Total

if TYPE_CHECKING:
    from literal_verbs import Verdict

    from btq_lang.requirements.model import Applied, Claim, Requirement


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


class Session(OverRuns):
    """A session, judged."""

    def judged(self, applied: Applied, claim: Claim) -> list[Judged]:
        """What it comes to, with its scopes, and with what its guards did."""
        requirement = applied.requirement
        nodes = [] if isinstance(applied.subject, Span | Total) else self.uids(applied.subject)
        refused = [each for uid in nodes for each in self.refused(uid, claim, requirement)]
        return [*self.unguarded(applied, claim), *refused]

    def unguarded(self, applied: Applied, claim: Claim) -> list[Judged]:
        """What it comes to, but for the starts that a guard refused."""
        requirement = applied.requirement
        if isinstance(applied.subject, Span):
            return self.span(applied.subject, claim, requirement)
        if isinstance(applied.subject, Total):
            return self.total(applied.subject, claim, requirement)
        judge = self.over_runs if claim.verb in _OVER_RUNS else self.of_activations
        return [each for uid in self.uids(applied.subject) for each in judge(uid, claim, requirement)]


class Literal:
    """All sessions, judged together; their runs are numbered on."""

    def __init__(self, sessions: Sequence[Session]) -> None:
        self.sessions = sessions
        self.runs = [run for session in sessions for run in session.runs]
        self.activations = [each for session in sessions for each in session.activations]

    def clause(self, applied: Applied, claim: Claim) -> ClauseResult:
        """A claim of an applied requirement, with its scopes, odds and window."""
        requirement = applied.requirement
        judged: list[Judged] = []
        before = 0
        for session in self.sessions:
            judged += [replace(each, run=each.run + before) for each in session.judged(applied, claim)]
            before += len(session.runs)
        judged.sort(key=lambda each: (self.runs[each.run].begin, each.run, each.at, each.decided))
        judged = self.last(requirement, judged)
        experiments = [each.verdict for each in judged]
        if requirement.odds is not None and requirement.odds.experiments == "runs":
            of_runs = [[each.verdict for each in judged if each.run == run] for run in range(len(self.runs))]
            experiments = [all_of(verdicts) for verdicts in of_runs]
        verdict = self.verdict(requirement, experiments)
        targets = applied.subject.targets if isinstance(applied.subject, Total) else ()
        nodes = {uid for target in targets for uid in self.sessions[0].uids(target)} or {each.uid for each in judged}
        ran = {each.uid for each in self.activations} | {each.uid for each in judged if each.is_refused}
        if verdict == "satisfied" and not nodes & ran:
            verdict = "never exercised"  # where others ran that it might have run in, or after
        return ClauseResult(verdict, tuple(judged), tuple(experiments))

    def verdict(self, requirement: Requirement, experiments: Sequence[Verdict]) -> str:
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

    def last(self, requirement: Requirement, judged: list[Judged]) -> list[Judged]:
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


_OVER_RUNS = ("tries", "runs", "starts", "ends", "follows")
