"""Judges logs by all missions, each run with the mission it belongs to: one log, or many in several processes.

One invariant: a log is judged by itself, its runs numbered from 1, so that logs may be judged in any process and added
up in their order.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.evaluate import LogFindings, MissionEvaluation
from btq_lang.evidence.identity import Candidate, difference
from btq_lang.evidence.model import ROOT, LogSession, SampleSeries, Transition
from btq_lang.evidence.named_runs import joined_sessions
from btq_lang.evidence.odds import Limits
from btq_lang.evidence.readers import NotALog, read
from btq_lang.evidence.repeats import LoggedRows, LoggedRuns
from btq_lang.evidence.runs import activations
from btq_lang.evidence.signal_sources import Declared
from btq_lang.evidence.signals import by_signal
from btq_lang.evidence.verdicts import Foreign, VerdictReport
from btq_lang.evidence.wording import first_of
from btq_lang.util.record import Record, replace
from btq_lang.util.text import counted
from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.store.sets import Draft, Keeping
    from btq_lang.evidence.watching import Watched

NO_SERIES: Final[Mapping[str, SampleSeries]] = {}
NOTHING_DECLARED: Final = Declared()
NOTHING: Final[Mapping[tuple[str, int], Sequence[tuple[int, int, int]]]] = {}


class Means(Record):
    """What logs are judged by.

    Attributes:
        samples: by signal or entry.
        declared: where further samples come from, with lower priority.
        of_bags: the samples of those sources, by signal, in bags without a log of a tree.
        remarks: notes about these bags.
        with_timelines: include the run of the worst violation of each clause.
        with_measures: include what is needed to judge clauses with other bounds.
        keeping: where the findings in each log are kept; None: nowhere.
        limits: which limits of probabilities decide.
        left_out: the runs that are counted in another session, by log and number of the session: the number of each run
            there, from 0, and of its first and last row.
        shown: gives a path as people read it.
    """

    missions: Sequence[Candidate]
    samples: Mapping[str, SampleSeries] = NO_SERIES
    declared: Declared = NOTHING_DECLARED
    of_bags: Mapping[str, SampleSeries] = NO_SERIES
    remarks: Sequence[str] = ()
    with_timelines: bool = False
    with_measures: bool = False
    keeping: Keeping | None = None
    limits: Limits = "one look"
    shown: Callable[[str], str] = shown
    left_out: Mapping[tuple[str, int], Sequence[tuple[int, int, int]]] = NOTHING


class JudgedLog(Record):
    """The findings in a log.

    Attributes:
        runs: how many were judged.
        findings: with the path of the mission, for each of its robots.
        foreign: the runs of other missions.
        problems: why the log, or the rest of it, could not be read or kept.
        renamed: the label and the robot that the store had for it, as far as others are given now.
        sessions: where the runs are.
    """

    runs: int
    findings: tuple[tuple[str, LogFindings], ...]
    foreign: tuple[Foreign, ...]
    problems: tuple[str, ...]
    renamed: tuple[str, ...] = ()
    sessions: tuple[LoggedRuns, ...] = ()


def judge(
    log: str, means: Means, ran: Callable[[int], None] = lambda number: None, running: Watched | None = None
) -> JudgedLog:
    """Judge the runs of a log, and keep the findings in the store, if there is one.

    Args:
        ran: called with the number of each run after it is judged.
        running: the robot, if its log is not in a file.
    """
    if means.keeping is None:
        return _judged(log, means, ran, None, running)
    from btq_lang.evidence.store.sets import NotKept, draft

    judged: JudgedLog | None = None
    try:
        with draft(means.keeping, log, running.id if running is not None else None) as written:
            judged = _judged(log, means, ran, written, running)
            if judged.runs and not judged.problems:
                judged = replace(judged, renamed=written.publish(means.shown(log)))
    except NotKept as error:
        problem = f"{means.shown(log)}: {error}"
        judged = replace(judged, problems=(problem,)) if judged is not None else JudgedLog(0, (), (), (problem,))
    return judged


def _judged(
    log: str, means: Means, ran: Callable[[int], None], written: Draft | None, running: Watched | None
) -> JudgedLog:
    missions, shown = means.missions, means.shown
    evaluations: dict[tuple[str, str], MissionEvaluation] = {}
    foreign: dict[tuple[str, str], Foreign] = {}
    problems: tuple[str, ...] = ()
    logged: list[LoggedRuns] = []
    label = means.keeping.label_of(log) if means.keeping is not None else None
    runs = left_out = 0
    try:
        sessions = read(log, means.declared.sources) if running is None else running.sessions
        for source, session, joined in joined_sessions(sessions, missions, shown(log)):
            if isinstance(joined, str):
                if running is not None:
                    running.foreign(difference(missions, session.tree))
                number = sum(activation.uid == ROOT for activation in activations(session))
                foreign_runs = foreign.get((source, joined))
                if foreign_runs is None:
                    lacks = first_of(session.unlike) or difference(missions, session.tree)
                    foreign_runs = Foreign(source, 0, joined, lacks, tuple(session.unlike))
                foreign[source, joined] = replace(foreign_runs, runs=foreign_runs.runs + number)
            else:
                mission = joined.mission
                key = mission.path, session.robot
                if key not in evaluations:
                    parts = []
                    if written is not None:
                        parts.append(written.rows.part(mission.name, session.robot or written.robot))
                    evaluation = MissionEvaluation(
                        mission, means.with_timelines, ran, parts, means.limits, means.with_measures
                    )
                    evaluations[key] = evaluation
                    if running is not None:
                        running.judged_by(evaluation)
                signals = mission.requirements.signals.values()
                if problem := means.declared.problem(mission.path, (*session.signals, *means.of_bags)):
                    problems = tuple(dict.fromkeys((*problems, f"{shown(log)}: {problem}")))
                of_files = means.declared.of_files.get(mission.path, NO_SERIES)
                series = by_signal(signals, means.samples, of_files, session.signals, means.of_bags)
                session.remarks.extend(means.remarks)
                if joined.others:
                    others = ", ".join(map(shown, joined.others))
                    session.remarks.append(
                        f"judged by {shown(mission.path)}; the same nodes are in {others}: choose with --mission"
                    )
                left_out_here = means.left_out.get((log, len(logged)), ())
                logged.append(LoggedRuns(log, len(logged), (mission.path, label), session.robot))
                session = _without(session, left_out_here) if left_out_here else session
                before = runs + left_out
                runs += evaluations[key].read(session, joined, series, runs + 1, source, logged[-1].add)
                left_out += len(left_out_here)
                evaluations[key].findings.leave_out([before + run + 1 for run, *_ in left_out_here])
    except NotALog as error:
        problems += (f"{shown(log)}: {error}",)
    except OSError as error:
        problems += (f"{shown(log)}: cannot be read: {error.strerror or error}",)
    for evaluation in evaluations.values():
        evaluation.end()
    findings = tuple((path, evaluation.findings) for (path, _), evaluation in evaluations.items())
    return JudgedLog(runs, findings, tuple(foreign.values()), problems, sessions=tuple(logged))


def _without(session: LogSession, runs: Sequence[tuple[int, int, int]]) -> LogSession:
    """The session without the rows of some runs; samples in them remain."""

    def others() -> Iterator[Transition]:
        waiting = iter(runs)
        _, first, last = next(waiting)
        for number, row in enumerate(session.transitions, start=1):
            if number > last:
                _, first, last = next(waiting, _NONE)
            if not first <= number <= last:
                yield row

    return LogSession(session.tree, others(), session.samples, session.remarks, session.signals, session.robot)


def rows_of(log: str, means: Means) -> Sequence[LoggedRows]:
    """The rows of the sessions of a log that were judged."""
    rows = []
    try:
        for _, session, joined in joined_sessions(read(log), means.missions, log):
            if not isinstance(joined, str):
                rows.append(LoggedRows(session.transitions))
    except (NotALog, OSError):  # as when it was judged, which has said so
        pass
    return rows


class Judging:
    """Adds up the findings in logs, how many runs were judged, and where they are."""

    def __init__(self, means: Means) -> None:
        self.runs = 0
        self.sessions: Final[list[LoggedRuns]] = []
        of_all = partial(MissionEvaluation, limits=means.limits, with_measures=means.with_measures)
        self._evaluations: Final = {mission.path: of_all(mission, means.with_timelines) for mission in means.missions}
        self._foreign: Final[dict[tuple[str, str], Foreign]] = {}
        self._problems: Final[list[str]] = []
        self._renamed: Final[Counter[str]] = Counter()

    def add(self, log: JudgedLog) -> None:
        """Add the next log."""
        for path, findings in log.findings:
            self._evaluations[path].findings.add(findings, self.runs)
        self.runs += log.runs
        self.sessions.extend(log.sessions)
        for foreign in log.foreign:
            key = foreign.file, foreign.of
            runs = self._foreign[key].runs if key in self._foreign else 0
            self._foreign[key] = replace(self._foreign.get(key, foreign), runs=runs + foreign.runs)
        self._problems.extend(log.problems)
        self._renamed.update(log.renamed)

    def report(self) -> VerdictReport:
        """The report on all logs that were added."""
        missions = [evaluation.result() for evaluation in self._evaluations.values()]
        judged = tuple(mission for mission in missions if mission.sources)
        renamed = tuple(
            f"{counted(number, 'log')} had {names_before}" for names_before, number in self._renamed.items()
        )
        return VerdictReport(judged, tuple(self._foreign.values()), tuple(self._problems), renamed)


def judge_all(logs: Sequence[str], means: Means, jobs: int) -> Iterator[JudgedLog]:
    """The findings in each log, in order; if a process is ended from outside, a problem instead of the rest."""
    from concurrent.futures.process import BrokenProcessPool

    from btq_lang.util.processes import pool

    # DuckDB, which may have threads here already, does not work in a forked process.
    start = None if means.keeping is None else "spawn"
    try:
        processes = pool(min(jobs, len(logs)), _take_means, (means,), start)
    except NotImplementedError:  # there are no processes in a browser
        yield from (judge(log, means) for log in logs)
        return
    with processes:
        try:
            yield from processes.map(_judge_by_means, logs)
        except BrokenProcessPool:
            yield JudgedLog(0, (), (), (_ENDED,))


def _take_means(means: Means) -> None:
    """Begin a process, in which logs are judged by these means."""
    global _means
    _means = means


def _judge_by_means(log: str) -> JudgedLog:
    assert _means is not None, "every process begins with _take_means"
    return judge(log, _means)


_means: Means | None = None  # of a process that judges one log after another
_NONE: Final = (0, 1 << 63, 1 << 63)  # a run after all rows
_ENDED: Final = "a process that judges logs was ended from outside, perhaps for lack of memory"
