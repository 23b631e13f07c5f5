"""Logs against requirements: every clause at every node that it holds for, judged as the log is read.

One invariant: state is kept only for what is open, the current run, and what has been counted; a clause that cannot be
judged is unknown with the reason, and never left out.
"""

from __future__ import annotations

from array import array

from btq_lang.evidence.conditions import signals_in, truth
from btq_lang.evidence.guards import Guards
from btq_lang.evidence.model import ROOT, Activation
from btq_lang.evidence.runs import activations
from btq_lang.evidence.signals import Signals, Unknown
from btq_lang.evidence.tally import Run, Tally
from btq_lang.evidence.verbs import Judgement, judge_of
from btq_lang.evidence.verdicts import (
    NEVER,
    UNKNOWN,
    VIOLATED,
    ClauseVerdict,
    MissionVerdicts,
    NodeTimes,
    RequirementVerdict,
    Source,
    worst_of,
)
from btq_lang.evidence.wording import duration
from btq_lang.record import replace
from btq_lang.requirements.model import All, Any, Mission, Not, Span, Target, Total

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import Final

    from btq_lang.evidence.guards import Guard, Refusal
    from btq_lang.evidence.identity import Joined
    from btq_lang.evidence.identity import Mission as GivenMission
    from btq_lang.evidence.model import Outcome, Series, Session
    from btq_lang.requirements.model import Applied, Claim, Requirement, Scope


class MissionEvaluation:
    """A mission's requirements, while logs of it are read."""

    def __init__(self, mission: GivenMission) -> None:
        self.mission: Final = mission
        found = mission.requirements
        clauses = [
            _Clause(applied.requirement, claim, applied)
            for applied in found.applied
            for claim in applied.requirement.claims
            if not _is_by_people(applied.requirement)
        ]
        used = {(clause.requirement.name, clause.claim.text) for clause in clauses}
        clauses += [
            _Clause(requirement, claim, None)
            for requirement in found.all.values()
            for claim in requirement.claims
            if not _is_by_people(requirement) and (requirement.name, claim.text) not in used
        ]
        self._clauses: Final = clauses
        self._sources: Final[list[Source]] = []
        self._outcomes: Final[dict[Outcome, int]] = dict.fromkeys(_OUTCOMES, 0)
        self._exercised: Final[dict[tuple[int, str], bool]] = {}  # by uid and path
        self._leaves: Final[dict[str, array[float]]] = {}

    def read(self, session: Session, joined: Joined, given: Mapping[str, Series], first_run: int, source: str) -> int:
        """Judge the runs of a session; how many there are.

        Args:
            given: the samples of `--signals`, by signal or entry.
            first_run: the number of the first run.
            source: the file, as people read it.
        """
        tree = session.tree
        signals = Signals(given, session.samples)
        at: dict[int, list[_Clause]] = {}
        for clause in self._clauses:
            for uid in clause.join(joined):
                at.setdefault(uid, []).append(clause)
        guards = Guards(tree, joined.enforcing(), at)
        names = {uid: tree.nodes[uid].path for uid in tree.nodes}
        leaves = {uid for uid, node in tree.nodes.items() if node.last == uid}
        for node in names.items():
            self._exercised.setdefault(node, False)
        begin: int | None = None
        end = 0
        runs = 0
        for activation in activations(session):
            uid = activation.uid
            path = names[uid]
            self._exercised[uid, path] = True
            if uid in leaves and activation.outcome in ("S", "F"):
                self._leaves.setdefault(path, array("d")).append(activation.seconds)
            if at:
                for refusal in guards.refused(activation):
                    for clause in at[refusal.uid]:
                        clause.refuse(refusal, names[refusal.uid])
                for each, guard in guards.settled(activation):
                    for clause in at.get(each.uid, ()):
                        clause.judge(each, guard, signals, names[each.uid])
            if uid == ROOT:
                run = Run(first_run + runs, source, activation.begin)
                runs += 1
                begin = activation.begin if begin is None else begin
                end = activation.end
                self._outcomes[activation.outcome] += 1
                for clause in self._clauses:
                    clause.tally.end_run(run)
                signals.forget_before(end)
        self._add(
            Source(
                file=source,
                runs=runs,
                first_run=first_run,
                begin=begin,
                end=end if runs else None,
                identity=joined.how,
                joined=joined.number,
                nodes=len(tree.nodes),
                remarks=tuple(session.remarks),
            )
        )
        return runs

    def result(self) -> MissionVerdicts:
        """What it has come to."""
        found = self.mission.requirements
        by_requirement: dict[str, list[ClauseVerdict]] = {name: [] for name in found.all}
        for clause in self._clauses:
            by_requirement[clause.requirement.name].append(clause.verdict())
        return MissionVerdicts(
            name=self.mission.name,
            file=self.mission.path,
            sources=tuple(self._sources),
            requirements=tuple(
                RequirementVerdict(
                    name,
                    " ".join((found.all[name].title or "").split()),
                    worst_of(each.verdict for each in clauses),
                    tuple(clauses),
                )
                for name, clauses in by_requirement.items()
                if clauses
            ),
            outcomes=tuple((_OUTCOMES[outcome], number) for outcome, number in self._outcomes.items() if number),
            exercised=sum(self._exercised.values()),
            nodes=len(self._exercised),
            slowest=_slowest(self._leaves),
            by_people=tuple(each.name for each in found.all.values() if each.claims and _is_by_people(each)),
        )

    def _add(self, source: Source) -> None:
        """Add what was read of a session to what was read of its file."""
        last = self._sources[-1] if self._sources else None
        if last is None or (last.file, last.identity) != (source.file, source.identity):
            self._sources.append(source)
            return
        self._sources[-1] = replace(
            last,
            runs=last.runs + source.runs,
            begin=last.begin if last.begin is not None else source.begin,
            end=source.end if source.end is not None else last.end,
            remarks=tuple(dict.fromkeys((*last.remarks, *source.remarks))),
        )


class _Clause:
    """A clause at a written node, with what it has come to.

    Attributes:
        tally: what was counted.
    """

    def __init__(self, requirement: Requirement, claim: Claim, applied: Applied | None) -> None:
        self.requirement: Final = requirement
        self.claim: Final = claim
        self.tally: Final = Tally(requirement.odds, requirement.confidence)
        self._target: Final = _target(applied)
        self._not_judged: Final = _not_judged(requirement, claim, applied, self._target)
        self._judge: Final = judge_of(claim.verb)
        self._judged: Final = _within(claim, requirement.scopes)
        self._paths: Final[dict[str, None]] = {}
        self._missing = ""

    def join(self, joined: Joined) -> list[int]:
        """The nodes of a log that it holds for."""
        if self._target is None or self._not_judged:
            return []
        found: list[int] = []
        for path, uid in joined.instances(self._target):
            self._paths[path] = None
            if uid is not None:
                found.append(uid)
            else:
                self._missing = self._missing or f"`{path}` was not found in a log of another version of the mission"
        return found

    def judge(self, activation: Activation, guard: Guard | None, signals: Signals, path: str) -> None:
        """Count an activation of one of its nodes.

        Args:
            guard: what stopped it.
        """
        assert self._judge is not None, "a clause that cannot be judged is joined with no node"
        is_stopped = guard is not None and guard.requirement == self.requirement.name
        if is_stopped and guard is not None and self.claim.verb in _STOPPED_BY.get(guard.kind, ()):
            said = f"stopped by its own guard after {duration(activation.seconds)}"
            judgement: Judgement | None = Judgement(False, activation.end, said)
        else:
            judgement = self._judge(self._judged, activation, signals)
        if judgement is None:
            self.tally.cut_off += activation.outcome == "O"
            return
        counts = _in_scope(self.requirement.scopes, self.claim.verb, activation, signals)
        if isinstance(counts, Unknown):
            judgement = Judgement(None, judgement.at, counts.why)
        if counts:
            self.tally.add(judgement, path)

    def refuse(self, refusal: Refusal, path: str) -> None:
        """Count a start that was refused for what a requirement needs: that breaks what it needs, and no node succeeds
        that does not start."""
        own = self.claim.verb == "needs" and self.requirement.name == refusal.requirement
        if own or self.claim.verb == "succeeds":
            self.tally.add(Judgement(False, refusal.time, f"its start was refused by {refusal.requirement}"), path)

    def verdict(self) -> ClauseVerdict:
        """What it has come to."""
        tally = self.tally
        verdict = tally.verdict()
        why = ""
        if self._not_judged or (self._missing and verdict != VIOLATED):
            verdict, why = UNKNOWN, self._not_judged or self._missing
        elif verdict == UNKNOWN:
            why = tally.why
        elif verdict == NEVER:
            why = "it did not start in any run" if not tally.cut_off else "it was open when the log ended"
        said = [self.claim.text, *(scope.text for scope in self.requirement.scopes)]
        said += [self.requirement.odds.text] if self.requirement.odds is not None else []
        return ClauseVerdict(
            text=" ".join(said),
            path=", ".join(self._paths),
            verdict=verdict,
            counted=tally.counted,
            violated=tally.violated,
            unknown=tally.unknown,
            cut_off=tally.cut_off,
            unit="runs" if tally.counts_runs else "activations",
            worst=tally.worst,
            interval=tally.interval(),
            confidence=self.requirement.confidence,
            more=tally.more(),
            violations=tuple(tally.violations),
            why=why,
        )


def _target(applied: Applied | None) -> Target | None:
    """The node that is judged."""
    subject = applied.subject if applied is not None else None
    if isinstance(subject, Mission):
        return Target(subject.node) if subject.node is not None else None
    return subject if isinstance(subject, Target) else None


def _not_judged(requirement: Requirement, claim: Claim, applied: Applied | None, target: Target | None) -> str:
    """Why a clause cannot be judged from logs; empty where it can."""
    if applied is None:
        return "it holds for no node"
    if isinstance(applied.subject, Span):
        return "the time from one event to another is not judged yet"
    if isinstance(applied.subject, Total):
        return "sums of durations are not judged yet"
    if target is None:
        return "nobody can say which tree is the mission"
    if judge_of(claim.verb) is None:
        return f"`{claim.verb}` is not judged yet"
    return "`over last` is not judged yet" if requirement.window is not None else ""


def _is_by_people(requirement: Requirement) -> bool:
    return requirement.method in ("review", "test", "analysis")


# ---- scopes ----


def _within(claim: Claim, scopes: Sequence[Scope]) -> Claim:
    """A claim about all of an activation, which with `while C` is about the time with C alone."""
    for scope in scopes:
        condition = claim.condition
        if scope.word == "while" and condition is not None and claim.verb == "keeps":
            claim = replace(claim, condition=Any((Not(scope.condition), condition)))
        elif scope.word == "while" and condition is not None and claim.verb == "never":
            claim = replace(claim, condition=All((scope.condition, condition)))
    return claim


def _in_scope(scopes: Sequence[Scope], verb: str, activation: Activation, signals: Signals) -> bool | Unknown:
    """Whether an activation counts."""
    result: bool | Unknown = True
    for scope in scopes:
        if scope.word == "when":
            times = [activation.begin]
        else:
            times = signals.moments(signals_in(scope.condition), activation.begin, activation.end)
        found = [truth(scope.condition, signals, time) for time in times]
        unknown = next((each for each in found if isinstance(each, Unknown)), None)
        if scope.word == "while" and verb in ("keeps", "never"):  # some of its time counts
            if True in found:
                continue
            counts = unknown or False
        else:
            counts = False if False in found else unknown or True
        if counts is False:
            return False
        result = counts if isinstance(counts, Unknown) else result
    return result


# ---- nodes ----


def _slowest(leaves: Mapping[str, array[float]]) -> NodeTimes | None:
    """The leaf that takes longest in 95 of 100 activations."""
    times = [(path, sorted(each)) for path, each in leaves.items()]
    found = [NodeTimes(path, each[(len(each) - 1) // 2], each[-(-len(each) * 95 // 100) - 1]) for path, each in times]
    slowest = max(found, key=lambda each: each.p95, default=None)
    return slowest if slowest is not None and slowest.p95 > 0 else None


_OUTCOMES: Final[dict[Outcome, str]] = {"S": "succeeded", "F": "failed", "H": "halted", "O": "interrupted"}
_STOPPED_BY: Final = {
    "Timeout": frozenset(("takes", "succeeds")),
    "ReactiveSequence": frozenset(("keeps", "never", "succeeds")),
}
