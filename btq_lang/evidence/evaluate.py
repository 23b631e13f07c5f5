"""Judges every clause at every node that it holds for, while logs are read.

One invariant: the only state is open activations, the current run, and counts.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Final, Protocol

from btq_lang.evidence.clause import JudgedClause
from btq_lang.evidence.clause_findings import ClauseFindings
from btq_lang.evidence.coverage import Contexts, Coverage
from btq_lang.evidence.explain import Explainer, FailureOrigin
from btq_lang.evidence.guards import Guards
from btq_lang.evidence.history import History, Nearby
from btq_lang.evidence.model import ROOT, Activation, LoggedTree, LogSession, Outcome, SampleSeries
from btq_lang.evidence.observed import Observed
from btq_lang.evidence.odds import Limits
from btq_lang.evidence.outline import demands, open_clauses, outline, unread_clauses
from btq_lang.evidence.runs import activations
from btq_lang.evidence.signals import Signals
from btq_lang.evidence.tally import Run
from btq_lang.evidence.timeline import OpenRun, read_signals
from btq_lang.evidence.verdicts import (
    OUTCOMES,
    ClauseVerdict,
    ContextSummary,
    EvidenceFile,
    MissionVerdicts,
    RequirementLinks,
    RequirementVerdict,
    worst_of,
)
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate, Joined


class LogFindings:
    """The findings in some logs of a mission; they refer to no text, so they may go to another process.

    Attributes:
        clauses: in the order in which a `MissionEvaluation` has them.
        contexts: in how many runs each context held, and in how many others that is unknown.
        ended_by: how many failed runs the guard of each requirement ended.
    """

    def __init__(self, clauses: Sequence[ClauseFindings], contexts: tuple[Counter[str], Counter[str]]) -> None:
        self.clauses: Final = clauses
        self.contexts: Final = contexts
        self.sources: Final[list[EvidenceFile]] = []
        self.outcomes: Final[Counter[Outcome]] = Counter(dict.fromkeys(OUTCOMES, 0))
        self.ended_by: Final[Counter[str]] = Counter()
        self.coverage: Final = Coverage()

    def add(self, other: LogFindings, runs: int) -> None:
        """Add the findings of later logs, whose runs have numbers of their own; `runs`: how many runs were before
        them.
        """
        for clause, findings in zip(self.clauses, other.clauses, strict=True):
            clause.add(findings, runs)
        for own, theirs in zip(self.contexts, other.contexts, strict=True):
            own.update(theirs)
        self.outcomes.update(other.outcomes)
        self.ended_by.update(other.ended_by)
        for source in other.sources:
            self.add_source(replace(source, first_run=source.first_run + runs))
        self.coverage.add_all(other.coverage, runs)

    def leave_out(self, runs: Sequence[int]) -> None:
        """Note which runs of the last file, by their numbers there, are left out because another file has them."""
        self.sources[-1] = replace(self.sources[-1], left_out=(*self.sources[-1].left_out, *runs))

    def add_source(self, source: EvidenceFile) -> None:
        """Merge a session's counts into those of its file."""
        last = self.sources[-1] if self.sources else None
        if last is None or (last.file, last.identity) != (source.file, source.identity):
            self.sources.append(source)
            return
        self.sources[-1] = replace(
            last,
            runs=last.runs + source.runs,
            begin=last.begin if last.begin is not None else source.begin,
            end=source.end if source.end is not None else last.end,
            remarks=tuple(dict.fromkeys((*last.remarks, *source.remarks))),
            unjoined=tuple(dict.fromkeys((*last.unjoined, *source.unjoined))),
        )


class EvaluationListener(Protocol):
    """Receives what an evaluation finds, as soon as it is found."""

    def join(self, joined: Joined, clauses: Sequence[JudgedClause]) -> None:
        """A session begins."""

    def see(self, activation: Activation) -> None:
        """An activation has ended."""

    def end_run(self, root: Activation, retries: int, recoveries: int, failure: int | None) -> None:
        """The open run has ended, and is judged; `failure`: the node where its failure began, if it failed."""

    def end(self, clauses: Sequence[JudgedClause]) -> None:
        """The log has been read."""


class MissionEvaluation:
    """Judges a mission's requirements while its logs are read, and tells listeners what it finds.

    Attributes:
        findings: what the verdicts need of the logs so far.
    """

    def __init__(
        self,
        mission: Candidate,
        with_timelines: bool = False,
        ran: Callable[[int], None] = lambda number: None,
        listeners: Sequence[EvaluationListener] = (),
        limits: Limits = "one look",
        with_measures: bool = False,
    ) -> None:
        """Judge nothing yet.

        Args:
            ran: called with the number of each run after it is judged.
            with_timelines, limits, with_measures: as in `judging.Means`.
        """
        self._ran: Final = ran
        self.listeners: Final = [*listeners]
        self.mission: Final = mission
        requirements = mission.requirements
        clauses = [JudgedClause(demand, limits, with_measures) for demand in demands(requirements)]
        self._with_measures: Final = with_measures
        self._signals: Final = requirements.signals
        self._clauses: Final = clauses
        self._contexts: Final = Contexts(requirements.contexts)
        self.findings: Final = LogFindings([clause.findings for clause in clauses], self._contexts.counts)
        self._open_run: Final = OpenRun(read_signals(_reading(mission, clauses))) if with_timelines else None

    def read(
        self,
        session: LogSession,
        joined: Joined,
        samples: Mapping[str, SampleSeries],
        first_run: int,
        source: str,
        run_ended: Callable[[Activation], None] = lambda root: None,
    ) -> int:
        """Judge the runs of a session; returns how many there are.

        Args:
            samples: by signal; they override the log's own.
            first_run: the number of the first run.
            source: the file, as people read it.
            run_ended: called with the root's activation at the end of each run.
        """
        opened = _OpenSession(self._clauses, session.tree, joined, Signals(samples, session.samples))
        explainer, history, concerned = opened.explainer, opened.history, opened.guards.concerned
        for listener in self.listeners:
            listener.join(joined, self._clauses)
        self._contexts.join(joined, opened.signals, history)
        coverage = self.findings.coverage
        coverage.expect(session.tree, joined.written())
        times: tuple[int, int] | None = None  # when the first run began, and when the last one ended
        runs = 0
        for activation in activations(session):
            coverage.count(activation)
            origin = explainer.see(activation)
            history.add(activation)
            if self._open_run is not None:
                self._open_run.see(activation)
            for listener in self.listeners:
                listener.see(activation)
            if activation.uid in concerned:  # few nodes are
                opened.judge(activation)
            if activation.uid == ROOT:
                run = Run(first_run + runs, source, activation.begin, activation.end)
                runs += 1
                times = times[0] if times is not None else run.begin, run.end
                self._end_run(run, activation, origin, opened)
                run_ended(activation)
        begin, end = times or (0, 0)
        session.remarks.extend(
            remark for clause in self._clauses for remark in clause.remarks(session.tree, session.keeping)
        )
        session.remarks.extend(coverage.clock_remarks())
        session.remarks.extend(opened.signals.remarks(self._signals, begin, end))
        self.findings.add_source(
            EvidenceFile(
                file=source,
                runs=runs,
                first_run=first_run,
                begin=begin if runs else None,
                end=end if runs else None,
                identity=joined.how,
                joined=joined.number,
                nodes=len(session.tree.nodes),
                remarks=tuple(session.remarks),
                unjoined=tuple(joined.differences()),
            )
        )
        return runs

    def _end_run(self, run: Run, root: Activation, origin: FailureOrigin | None, opened: _OpenSession) -> None:
        """Judge the open run, which has ended.

        Args:
            root: the activation of its root.
            origin: where its failure began, if it failed.
        """
        began = origin.uid if origin is not None else None
        self.findings.outcomes[root.outcome] += 1
        if began in opened.enforcing:
            self.findings.ended_by[opened.guards.last or opened.enforcing[began]] += 1
        coverage = self.findings.coverage
        repeats = coverage.retries.now, coverage.recoveries.now
        coverage.end_run(run.number, began)
        for clause in self._clauses:
            clause.end_run(run, root)
        for listener in self.listeners:
            listener.end_run(root, *repeats, began)
        self._contexts.end_run(root)
        if self._open_run is not None:
            self._open_run.end(run, opened.tree, self.findings.clauses, opened.signals)
        opened.end_run(run.end)
        self._ran(run.number)

    def end(self) -> None:
        """Tell the listeners that the log has been read."""
        for listener in self.listeners:
            listener.end(self._clauses)

    def verdicts(self, open_run: Run | None = None) -> tuple[RequirementVerdict, ...]:
        """The verdict on each requirement so far, with the open run if that is given, without links."""
        requirements = self.mission.requirements
        by_requirement: dict[str, list[ClauseVerdict]] = {name: [] for name in requirements.all}
        for clause in self._clauses:
            by_requirement[clause.requirement.name].append(clause.verdict(open_run))
        for name, clauses in by_requirement.items():
            clauses.extend(unread_clauses(requirements.all[name]))
            clauses.extend(() if clauses else open_clauses(requirements.all[name]))
        return tuple(
            RequirementVerdict(
                name,
                " ".join((requirements.all[name].title or "").split()),
                worst_of(clause_verdict.verdict for clause_verdict in clauses),
                tuple(clauses),
                fingerprints=tuple(filter(None, (self.mission.fingerprints.get(name),))),
            )
            for name, clauses in by_requirement.items()
        )

    def _links(self, name: str) -> RequirementLinks:
        return RequirementLinks.of(self.mission.requirements.all[name], self.mission.scenarios(name))

    def result(self) -> MissionVerdicts:
        """The verdicts and statistics so far."""
        requirements, findings = self.mission.requirements, self.findings
        held, unknown = findings.contexts
        return MissionVerdicts(
            name=self.mission.name,
            file=self.mission.path,
            sources=tuple(findings.sources),
            requirements=tuple(replace(verdict, links=self._links(verdict.id)) for verdict in self.verdicts()),
            outcomes=tuple((OUTCOMES[outcome], number) for outcome, number in findings.outcomes.items() if number),
            ended_by=tuple(findings.ended_by.items()),
            nodes=findings.coverage.summary(requirements.nodes.all),
            contexts=tuple(ContextSummary(name, runs, unknown[name]) for name, runs in held.items()),
            retries=findings.coverage.retries.summary(),
            recoveries=findings.coverage.recoveries.summary(),
            outline=outline(requirements) if self._with_measures else "",
        )


class _OpenSession:
    """A session while it is judged.

    Attributes:
        enforcing: the guards among its nodes, each with its requirement.
    """

    def __init__(self, clauses: Sequence[JudgedClause], tree: LoggedTree, joined: Joined, signals: Signals) -> None:
        """Join the clauses with the nodes of the session."""
        self.tree: Final = tree
        self.signals: Final = signals
        self.history: Final = History()
        nearby = cache(lambda uid: Nearby(uid, joined, self.history))
        clauses_of = grouped(
            (uid, clause) for clause in clauses for uid in clause.join(joined, signals, self.history, nearby)
        )
        self._judged: Final = {uid: (own, tree.nodes[uid].path, nearby(uid)) for uid, own in clauses_of.items()}
        self.enforcing: Final = joined.enforcing()
        self.guards: Final = Guards(tree, self.enforcing, clauses_of, joined.unjoined())
        over_runs = any(clause.is_over_run for clause in clauses)
        self.explainer: Final = Explainer(tree, clauses_of, signals, has_clauses_over_runs=over_runs)
        for clause in clauses:
            clause.explainer = self.explainer

    @property
    def judged(self) -> Iterable[int]:
        """The nodes whose activations clauses judge."""
        return self._judged

    def judge(self, activation: Activation) -> None:
        """Judge by their clauses the activations that this one settles; it is of a node that guards concern."""
        settled, refusal = self.guards.see(activation)
        if refusal is not None:
            clauses, path, _ = self._judged[refusal.uid]
            for clause in clauses:
                clause.refuse(refusal, path)
        for ended, guard in settled:
            clauses, path, others = self._judged[ended.uid]
            observed = Observed(self.signals, others, ended.started, ended.ended, ended.timing != "latest")
            for clause in clauses:
                clause.judge(ended, guard, observed, path)

    def end_run(self, end: int) -> None:
        """Forget the open run, which has ended at this time."""
        self.guards.end_run()
        self.history.clear()
        self.explainer.end_run()
        self.signals.forget_before(end)


class NeededNodes(Record):
    """The nodes of a tree on whose rows verdicts depend, where all rows to RUNNING are written.

    Attributes:
        all: of them.
        guards: those whose activations need not be shown if they succeed.
    """

    all: frozenset[int]
    guards: frozenset[int]


def needed_nodes(mission: Candidate, joined: Joined) -> NeededNodes:
    """The nodes of a tree on whose rows the verdicts of a mission depend."""
    clauses = [JudgedClause(demand) for demand in demands(mission.requirements)]
    signals = Signals({}, {})
    opened = _OpenSession(clauses, joined.tree, joined, signals)
    Contexts(mission.requirements.contexts).join(joined, signals, opened.history)
    shown = frozenset((*opened.judged, *opened.history.watched, ROOT))
    return NeededNodes(shown | opened.guards.needed, frozenset(opened.guards.needed) - shown)


def _reading(mission: Candidate, clauses: Sequence[JudgedClause]) -> Iterator[tuple[str, object]]:
    """The parts of the model that read signals, each with the name of its requirement or context."""
    for clause in clauses:
        requirement = clause.requirement
        yield requirement.name, (clause.claim, requirement.scopes, requirement.span, requirement.assumptions)
    yield from ((name, context) for name, context in mission.requirements.contexts.items() if context is not None)
