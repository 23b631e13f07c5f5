"""Judges logs in one call, with notes on what limits the verdicts."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from btq_lang.btcpp.export import xml_name
from btq_lang.btcpp.side_file import side_path
from btq_lang.evidence import write
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.judging import Judging, Means, judge, judge_all, rows_of
from btq_lang.evidence.notes import ignored_columns, missing_verdicts, missions_with_errors, other_times
from btq_lang.evidence.own_trees import NO_MISSION, OwnTree
from btq_lang.evidence.readers import SUFFIXES, samples_of_bags, whole_bags
from btq_lang.evidence.readers.bag import METADATA
from btq_lang.evidence.readers.samples import NoSamples
from btq_lang.evidence.readers.samples import read as read_samples
from btq_lang.evidence.readers.side import side_file_at
from btq_lang.evidence.repeats import notes, repeated, without_copies
from btq_lang.evidence.signal_sources import signal_sources
from btq_lang.util.record import Record, replace
from btq_lang.workspace.loader import IS_SPECIAL, absolute, collect, is_special, shown

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import VerdictReport
    from btq_lang.evidence.watching import Watched
    from btq_lang.workspace.config import Project
    from btq_lang.workspace.workspace import Workspace


class Verification(Record):
    """The verdicts of missions, from logs.

    Attributes:
        report: the verdicts, with notes about samples, and the runs of other missions.
        problems: why they may be incomplete: logs that cannot be read, missions with errors.
    """

    report: VerdictReport
    problems: tuple[str, ...]

    def write(self, form: str = "table", *, colour: bool = False, verbose: bool = False) -> str:
        """Write the verdicts as text.

        Args:
            form: `table`, `json`, `csv`, `junit` or `markdown`.
            colour: ANSI colours, for `table`.
            verbose: for `table`: show more violations of each clause.

        Raises:
            ValueError: there is no such format.
        """
        return write(self.report, form, colour=colour, verbose=verbose)


def verify_logs(
    workspace: Workspace, path: str, logs: str | Sequence[str], *, signals: str | None = None
) -> Verification:
    """Judge each requirement of a mission by logs of what robots did.

        >>> from btq_lang import Workspace, verify_logs
        >>> workspace = Workspace.of({"main.btq": "BehaviorTree Main\\n    Dock\\n"})
        >>> verify_logs(workspace, "main.btq", "gone.btlog").problems
        ('gone.btlog: cannot be read: No such file or directory',)

    Args:
        path: of the mission in the workspace.
        logs: files of FileLogger2 (`.btlog`) or SqliteLogger (`.db3`), ROS 2 bags (`.mcap`, `.db3`, folders), and
            folders of such; one that cannot be read is a problem of the result, and the others are judged.
        signals: samples as CSV or Parquet: seconds since the epoch, then one column for each signal or entry.

    Raises:
        KeyError: the workspace has no such file.
        OSError: the samples cannot be read.
        ValueError: the samples, or the sources in `[evidence.signals]` of the project, are not as expected.
    """
    side = side_file_at(side_path(xml_name(path)))
    is_side = side is not None and side.mission == absolute(path)
    name = os.path.splitext(os.path.basename(path))[0]
    mission = Candidate(workspace, path, name, side.nodes if side is not None and is_side else None)
    paths = [logs] if isinstance(logs, str) else logs
    readable, problems = logs_below(paths, workspace.project)
    try:
        samples = read_samples(signals) if signals is not None else {}
    except NoSamples as error:
        raise ValueError(f"{signals}: {error}") from error
    wrong: list[str] = []
    declared = signal_sources([mission], wrong)
    if wrong:
        raise ValueError("; ".join(wrong))
    verification = judged(readable, Means([mission], samples, declared), [path], signals or "")
    return replace(verification, problems=(*problems, *(verification.problems if readable else ())))


def logs_below(paths: Sequence[str], project: Project) -> tuple[Sequence[str], list[str]]:
    """The logs that paths denote, and problems with the paths."""
    files, unreachable = collect(paths, project, (*SUFFIXES, METADATA))
    logs = whole_bags(files)
    problems = [*map(str, unreachable), *(f"{shown(log)}: {IS_SPECIAL}" for log in logs if is_special(log))]
    if not logs and not problems:
        problems.append(f"no {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]} below {', '.join(paths)}")
    return [log for log in logs if not is_special(log)], problems


def judged(
    logs: Sequence[str],
    means: Means,
    requested: Sequence[str],
    file: str = "",
    jobs: int = 1,
    progress: Callable[[int, int], None] = lambda files, runs: None,
) -> Verification:
    """Judge missions, and add notes on what limits the verdicts.

    Args:
        requested: the missions as the command line names them; none: all that are known.
        file: the one that the samples are from.
        jobs, progress: as in `verify`.
    """
    report = verify(logs, means, jobs, progress)
    read_from = [(file, series) for series in means.samples.values()]
    files = {source.signal: source.file for source in means.declared.sources}
    of_files = (means.declared.of_files.get(mission.file, {}) for mission in report.missions)
    read_from += [(files[signal], series) for samples in of_files for signal, series in samples.items()]
    remarks = (*ignored_columns(file, means.samples, means.missions), *other_times(read_from, report))
    report = replace(report, remarks=(*remarks, *report.remarks))
    return _with_problems(report, means.missions, requested)


def verify(
    logs: Sequence[str],
    means: Means,
    jobs: int = 1,
    progress: Callable[[int, int], None] = lambda files, runs: None,
) -> VerdictReport:
    """Judge missions by logs; one that cannot be read is a problem of the report.

    Args:
        jobs: how many processes judge logs; the report is the same.
        progress: called with how many logs have been read, and how many runs have been judged.
    """
    of_bags, remarks, bags = samples_of_bags(logs, means.declared.sources)
    means = replace(means, of_bags=of_bags, remarks=remarks)
    wanted, copies = without_copies([log for log in logs if log not in bags])
    judging = _all(wanted, means, jobs, progress)
    report = judging.report()
    repeats = repeated(judging.sessions, partial(rows_of, means=means))
    if repeats:
        left_out = {
            (session.log, session.number): [(run, session.first[run], session.last[run]) for run in sorted(runs_there)]
            for session, runs_there in repeats
        }
        again = _all(wanted, replace(means, keeping=None, left_out=left_out), jobs, progress).report()
        report = replace(again, problems=report.problems, remarks=report.remarks)
    same = (
        f"{means.shown(log)} is the same log as {means.shown(first)}, so it is not counted"
        for log, first in copies.items()
    )
    return replace(report, remarks=(*same, *notes(repeats, judging.sessions, means.shown), *report.remarks))


def _all(logs: Sequence[str], means: Means, jobs: int, progress: Callable[[int, int], None]) -> Judging:
    """What was found in all logs."""
    judging = Judging(means)
    if jobs > 1 and len(logs) > 1:
        for number, of_log in enumerate(judge_all(logs, means, jobs), start=1):
            judging.add(of_log)
            progress(number, judging.runs)
    else:
        for number, log in enumerate(logs):
            judging.add(judge(log, means, partial(_progress, progress, number, judging.runs)))
    return judging


def _progress(progress: Callable[[int, int], None], files: int, runs: int, run: int) -> None:
    progress(files, runs + run)


def judged_live(running: Watched, address: str, means: Means, requested: Sequence[str]) -> Verification:
    """Judge missions by what a running robot does, until its sessions end.

    Args:
        address: of the robot.
        requested: as in `judged`.
    """
    # The limits must hold at every look, for verdicts are looked at after every run.
    means = replace(means, limits="every look", shown=str)
    of_robot = judge(address, means, running=running)
    judging = Judging(means)  # now all missions are known
    judging.add(of_robot)
    report = judging.report()
    if not (report.missions or report.foreign or report.problems):
        return Verification(report, (f"no robot answered at {address}, so there is nothing to judge",))
    return _with_problems(report, means.missions, requested)


def _with_problems(report: VerdictReport, missions: Sequence[Candidate], requested: Sequence[str]) -> Verification:
    """The report with what makes its verdicts incomplete."""
    written = [mission for mission in missions if not isinstance(mission, OwnTree)]
    if len(written) < len(missions):
        report = replace(report, remarks=(f"nothing is judged: {NO_MISSION}", *report.remarks))
    problems = (*report.problems, *missing_verdicts(report, requested), *missions_with_errors(report, written))
    return Verification(report, problems)
