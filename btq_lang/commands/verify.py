"""`btq verify`: judge by logs whether robots did what the mission demands."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Iterator, Sequence
from glob import glob
from typing import TYPE_CHECKING

from btq_lang.btcpp.as_built import as_built
from btq_lang.btcpp.export import xml_name
from btq_lang.btcpp.side_file import side_path, xml_path
from btq_lang.commands.disk import Disk
from btq_lang.commands.files import Files, usage_problem
from btq_lang.commands.output import form_of, form_problem
from btq_lang.commands.progress import Progress
from btq_lang.commands.stored import opened, reads_store, store_problem, summarise
from btq_lang.commands.verdict_events import events_problem, overwrites, write_events
from btq_lang.commands.verdict_formats import FORMATS
from btq_lang.commands.verdict_report import print_report
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.notes import foreign_runs
from btq_lang.evidence.readers.samples import NoSamples
from btq_lang.evidence.readers.samples import read as read_samples
from btq_lang.evidence.readers.side import SideFile, side_file_at, side_files_beside
from btq_lang.evidence.signal_sources import signal_sources
from btq_lang.evidence.verifying import judged, logs_below
from btq_lang.util.text import counted
from btq_lang.workspace.loader import IS_SPECIAL, find_project, is_special, shown

if TYPE_CHECKING:
    from btq_lang.evidence.model import Series
    from btq_lang.workspace.config import Project


def run(options: Namespace) -> int:
    """Read the logs, or a store, and print the verdicts."""
    named = [*options.logs, *options.mission]
    is_summary = reads_store(options)
    if problem := usage_problem(named) or store_problem(options, is_summary) or events_problem(options):
        print(f"btq verify: {problem}", file=sys.stderr)
        return 2
    if is_summary:
        return summarise(options)
    problems: list[str] = []
    logs, missions, samples = _given(options, problems)
    if options.events is not None and (problem := overwrites(options.events, [*options.logs, *logs])):
        problems.append(problem)
    roots = (each.workspace.project.root for each in missions if each.workspace.project.evidence)
    home = find_project(next(roots, "."))
    sources, of_files = signal_sources(home.project, shown(home.path or home.project.root), missions, problems)
    keeping = opened(options, problems)
    if not problems:
        form = form_of(options, FORMATS)
        with Progress(len(logs), "read") as progress:
            found = judged(
                logs,
                missions,
                (options.signals or "", samples),
                sources,
                of_files,
                options.mission,
                with_timelines=form == "html",
                jobs=options.jobs,
                keeping=keeping,
                progress=lambda files, runs: progress.reached(files, f", {counted(runs, 'run')} judged"),
            )
        report = found.report
        problems += found.problems
        remarks = report.remarks if form != "table" else ()  # the table has them
        for note in (*remarks, *foreign_runs(report)):
            print(f"btq verify: {note}", file=sys.stderr)
        code = print_report(options, report, missions)
        if options.events is not None:
            code = max(code, write_events(options.events, report, logs))
    for problem in problems:
        print(f"btq verify: {problem}", file=sys.stderr)
    return 2 if problems else code


def _given(options: Namespace, problems: list[str]) -> tuple[Sequence[str], Sequence[Candidate], dict[str, Series]]:
    """The logs, missions and samples of a command line; errors are appended to the problems."""
    problem = form_problem(options, FORMATS)
    if options.jobs < 1:
        problem = problem or f"--jobs {options.jobs}: expected a number of processes"
    if problem:
        problems.append(problem)
        return (), (), {}
    home = find_project(".")
    project = home.project
    requested = options.logs or logs_of(project)
    if not requested:
        untold = "no log given; name one, or set `logs` in [evidence] of btq.toml"
        problems += map(str, home.problems) if home.problems else [untold]
        return (), (), {}
    logs, wrong = logs_below(requested, project)
    problems += wrong
    samples: dict[str, Series] = {}
    if options.signals is not None and is_special(options.signals):
        problems.append(f"{shown(options.signals)}: {IS_SPECIAL}")
    elif options.signals is not None:
        try:
            samples = read_samples(options.signals)
        except NoSamples as error:
            problems.append(f"{options.signals}: {error}")
        except OSError as error:
            problems.append(f"{options.signals}: cannot be read: {error.strerror or error}")
    return logs, _missions(options.mission, logs, problems), samples


def logs_of(project: Project) -> Sequence[str]:
    """The paths that the project's patterns match; a pattern that matches none is kept, to be reported."""
    found: list[str] = []
    for pattern in project.evidence.logs if project.evidence is not None else ():
        path = os.path.join(project.root, pattern)
        found += sorted(glob(path, recursive=True)) or [path]
    return found


def _missions(requested: Sequence[str], logs: Sequence[str], problems: list[str]) -> Sequence[Candidate]:
    """The missions that logs may belong to: the requested ones, else those of side files beside the logs and of this
    folder's project.
    """
    sides = {side.mission: side for side in side_files_beside(logs)}
    there = [mission for mission in sides if os.path.isfile(mission)]
    found = (
        [] if requested else [each for side in sides.values() if side.mission not in there for each in _restored(side)]
    )
    groups, unreadable = Files().groups(requested or [*there, find_project(".").project.root])
    problems += map(str, unreadable)
    for group in groups:
        for path in group.given:
            side = sides.get(path) or side_file_at(side_path(xml_name(path)))
            if path.endswith(".xml") and side is not None and (built := [*_restored(side)]):
                found += built
            elif requested or path not in group.workspace.included_files:
                nodes = side.nodes if side is not None and side.mission == path else None
                found.append(Candidate(group.workspace, path, _name(path), nodes))
    if not found and not problems:
        problems.append("no mission found; name one with --mission FILE, a .btq file or XML")
    return found


def _restored(side: SideFile) -> Iterator[Candidate]:
    """The mission as built, if only the XML and the side file are available."""
    built = as_built(xml_path(side.path), Disk())
    if built is not None:
        yield Candidate(built.workspace, built.path, _name(side.mission), side.nodes)


def _name(path: str) -> str:
    return os.path.splitext(os.path.basename(path))[0]
