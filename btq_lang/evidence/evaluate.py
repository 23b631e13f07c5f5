"""Judges every clause at every node that it holds for, while logs are read.

One invariant: the only state is open activations, the current run, and counts.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Final, Protocol

from btq_lang.evidence.clause import ClauseFindings, JudgedClause
from btq_lang.evidence.contexts import Contexts
from btq_lang.evidence.coverage import Coverage
from btq_lang.evidence.explain import Explainer
from btq_lang.evidence.guards import Guards
from btq_lang.evidence.history import History, Nearby
from btq_lang.evidence.model import ROOT
from btq_lang.evidence.observed import Observed
from btq_lang.evidence.outline import demands, outline
from btq_lang.evidence.runs import activations
from btq_lang.evidence.signals import Signals
from btq_lang.evidence.tally import Run
from btq_lang.evidence.timeline import Timelines
from btq_lang.evidence.verdicts import (
    OUTCOMES,
    VIOLATED,
    ClauseVerdict,
    MissionVerdicts,
    RequirementVerdict,
    Source,
    worst_of,
)
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate, Joined
    from btq_lang.evidence.model import Activation, Outcome, Series, Session
    from btq_lang.evidence.odds import Limits
    from btq_lang.evidence.verdicts import Timeline


class Findings(Record):
    """What was found in some logs of a mission.

    Attributes:
        clauses: in the order in which a `MissionEvaluation` has them.
        contexts: as of `Contexts.counts`.
        timelines: of the runs that broke clauses worst, by the clause's index.
    """

    clauses: tuple[ClauseFindings, ...]
    sources: tuple[Source, ...]
    outcomes: Counter[Outcome]
    coverage: Coverage
    contexts: tuple[Counter[str], Counter[str]]
    timelines: dict[int, Timeline]


class Listener(Protocol):
    """Something that is given all that is found while it is found."""

    def join(self, joined: Joined, clauses: Sequence[JudgedClause]) -> None:
        """A session begins."""

    def see(self, activation: Activation) -> None:
        """An activation has ended."""

    def end_run(self, root: Activation, retries: int, recoveries: int, failure: int | None) -> None:
        """The open run has ended, and is judged; `failure`: the node where its failure began, if it failed."""

    def end(self, clauses: Sequence[JudgedClause]) -> None:
        """The log has been read."""


class MissionEvaluation:
    """Judges a mission's requirements while its logs are read; gives listeners all that is found."""

    def __init__(
        self,
        mission: Candidate,
        with_timelines: bool = False,
        ran: Callable[[int], None] = lambda number: None,
        listeners: Sequence[Listener] = (),
        limits: Limits = "one look",
        with_measures: bool = False,
    ) -> None:
        """Judge nothing yet.

        Args:
            ran: called with the number of each run after it is judged.
            with_timelines, limits, with_measures: as of `judging.Means`.
        """
        self._ran: Final = ran
        self.listeners: Final = [*listeners]
        self.mission: Final = mission
        found = mission.requirements
        clauses = [JudgedClause(each, limits, with_measures) for each in demands(found)]
        self._with_measures: Final = with_measures
        self._clauses: Final = clauses
        self._sources: Final[list[Source]] = []
        self._outcomes: Final[Counter[Outcome]] = Counter(dict.fromkeys(OUTCOMES, 0))
        self._coverage: Final = Coverage()
        self._contexts: Final = Contexts(found.contexts)
        self._timelines: Final = Timelines() if with_timelines else None

    def read(self, session: Session, joined: Joined, given: Mapping[str, Series], first_run: int, source: str) -> int:
        """Judge the runs of a session; returns how many there are.

        Args:
            given: samples by signal, which override the log's own.
            first_run: the number of the first run.
            source: the file, as people read it.
        """
        tree = session.tree
        signals = Signals(given, session.samples)
        history = History()
        nearby = cache(lambda uid: Nearby(uid, joined, history))
        at: dict[int, list[JudgedClause]] = {}
        for clause in self._clauses:
            for uid in clause.join(joined, signals, history, nearby):
                at.setdefault(uid, []).append(clause)
        judged = {uid: (clauses, tree.nodes[uid].path, nearby(uid)) for uid, clauses in at.items()}
        guards = Guards(tree, joined.enforcing(), at)
        over_runs = any(clause.is_over_run for clause in self._clauses)
        explainer = Explainer(tree, at, signals, has_clauses_over_runs=over_runs)
        for clause in self._clauses:
            clause.explainer = explainer
        for listener in self.listeners:
            listener.join(joined, self._clauses)
        self._contexts.join(joined, signals, history)
        self._coverage.expect(tree, joined.written())
        begin: int | None = None
        end = 0
        runs = 0
        log = self._coverage.timed(session)
        for activation in activations(log):
            self._coverage.count(activation)
            origin = explainer.see(activation)
            history.add(activation)
            if self._timelines is not None:
                self._timelines.see(activation)
            for listener in self.listeners:
                listener.see(activation)
            if activation.uid in guards.concerned:  # few nodes are
                for refusal in guards.refused(activation):
                    clauses, path, _ = judged[refusal.uid]
                    for clause in clauses:
                        clause.refuse(refusal, path)
                for ended, guard in guards.settled(activation):
                    clauses, path, others = judged[ended.uid]
                    observed = Observed(signals, others, ended.started, ended.ended, ended.timing != "latest")
                    for clause in clauses:
                        clause.judge(ended, guard, observed, path)
            if activation.uid == ROOT:
                run = Run(first_run + runs, source, activation.begin, activation.end)
                runs += 1
                begin = activation.begin if begin is None else begin
                end = activation.end
                self._outcomes[activation.outcome] += 1
                began = origin.uid if origin is not None else None
                repeats = self._coverage.retries.now, self._coverage.recoveries.now
                self._coverage.end_run(run.number, began)
                for clause in self._clauses:
                    clause.end_run(run, activation)
                for listener in self.listeners:
                    listener.end_run(activation, *repeats, began)
                self._contexts.end_run(activation)
                history.clear()
                explainer.end_run()
                if self._timelines is not None:
                    self._timelines.end_run(run, tree, [each for each in self._clauses if each.is_worst_in(run)])
                signals.forget_before(end)
                self._ran(run.number)
        session.remarks.extend([found for each in self._clauses if (found := each.remark(tree, log.keeping))])
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

    def end(self) -> None:
        """Tell the listeners that the log has been read."""
        for listener in self.listeners:
            listener.end(self._clauses)

    def findings(self) -> Findings:
        """What the verdicts need of the logs so far; refers to no text, and may go to another process."""
        kept = self._timelines.kept if self._timelines is not None else {}
        return Findings(
            tuple(clause.findings() for clause in self._clauses),
            tuple(self._sources),
            self._outcomes,
            self._coverage,
            self._contexts.counts(),
            {index: kept[clause] for index, clause in enumerate(self._clauses) if clause in kept},
        )

    def add(self, findings: Findings, runs: int) -> None:
        """Add what was found in later logs, whose runs are numbered by themselves, after so many runs."""
        for index, timeline in findings.timelines.items():
            clause = self._clauses[index]
            if self._timelines is not None and clause.is_worse_in(findings.clauses[index], timeline.run):
                self._timelines.kept[clause] = replace(timeline, run=timeline.run + runs)
        for clause, found in zip(self._clauses, findings.clauses, strict=True):
            clause.add(found, runs)
        for source in findings.sources:
            self._add(replace(source, first_run=source.first_run + runs))
        self._outcomes.update(findings.outcomes)
        self._coverage.add_all(findings.coverage, runs)
        self._contexts.add_all(findings.contexts)

    def verdicts(self, open_run: Run | None = None) -> tuple[RequirementVerdict, ...]:
        """The verdict on each requirement so far, with the open run if that is given."""
        found = self.mission.requirements
        by_requirement: dict[str, list[ClauseVerdict]] = {name: [] for name in found.all}
        for clause in self._clauses:
            by_requirement[clause.requirement.name].append(self._verdict(clause, open_run))
        return tuple(
            RequirementVerdict(
                name,
                " ".join((found.all[name].title or "").split()),
                worst_of(each.verdict for each in clauses),
                tuple(clauses),
            )
            for name, clauses in by_requirement.items()
            if clauses
        )

    def result(self) -> MissionVerdicts:
        """All that was found so far."""
        found = self.mission.requirements
        return MissionVerdicts(
            name=self.mission.name,
            file=self.mission.path,
            sources=tuple(self._sources),
            requirements=self.verdicts(),
            outcomes=tuple((OUTCOMES[outcome], number) for outcome, number in self._outcomes.items() if number),
            nodes=self._coverage.summary(found.nodes.all),
            contexts=self._contexts.summary(),
            retries=self._coverage.retries.summary(),
            recoveries=self._coverage.recoveries.summary(),
            by_people=tuple(each.name for each in found.all.values() if each.claims and each.is_verified_by_people),
            outline=outline(found) if self._with_measures else "",
        )

    def _verdict(self, clause: JudgedClause, open_run: Run | None) -> ClauseVerdict:
        verdict = clause.verdict(open_run)
        if self._timelines is None or verdict.verdict != VIOLATED:
            return verdict
        return replace(verdict, timeline=self._timelines.kept.get(clause))

    def _add(self, source: Source) -> None:
        """Merge a session's counts into those of its file."""
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
