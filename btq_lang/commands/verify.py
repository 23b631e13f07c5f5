"""`btq verify`: judge what robots did, by their logs, against what the mission demands."""

from __future__ import annotations

import json
import os
import sys
from argparse import Namespace
from collections.abc import Iterable, Iterator, Sequence
from glob import glob
from typing import TYPE_CHECKING, Final

from btq_lang.btcpp.as_built import as_built
from btq_lang.btcpp.export import xml_name
from btq_lang.btcpp.side_file import SIDE_SUFFIX, side_path, xml_path
from btq_lang.checks import check
from btq_lang.commands.disk import Disk
from btq_lang.commands.files import Files, usage_problem
from btq_lang.commands.output import form_of, form_problem, write_output
from btq_lang.commands.progress import Progress
from btq_lang.commands.signal_sources import signal_sources
from btq_lang.commands.verdict_formats import FORMATS, WRITERS, Judged
from btq_lang.evidence import verify
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.readers import SUFFIXES, whole_bags
from btq_lang.evidence.readers.bag import METADATA
from btq_lang.evidence.readers.samples import NoSamples
from btq_lang.evidence.readers.samples import read as read_samples
from btq_lang.evidence.verdicts import SATISFIED, VIOLATED
from btq_lang.evidence.wording import period
from btq_lang.loader import IS_SPECIAL, absolute, collect, find_project, is_special, read, shown
from btq_lang.name_kinds import Kind
from btq_lang.near import did_you_mean, near
from btq_lang.record import Record, replace
from btq_lang.render.colour import wants_colour
from btq_lang.rules import Severity
from btq_lang.syntax import Signal

if TYPE_CHECKING:
    from btq_lang.evidence.model import Series
    from btq_lang.evidence.verdicts import Report
    from btq_lang.project import Project


def run(options: Namespace) -> int:
    """Read the logs and print the verdicts."""
    problems: list[str] = []
    logs, missions, samples = _given(options, problems)
    sources, of_files = signal_sources(missions, problems)
    if not problems:
        form = form_of(options, FORMATS)
        with Progress(len(logs), "read") as progress:
            report = verify(
                logs,
                missions,
                samples,
                shown,
                sources,
                of_files,
                with_timelines=form == "html",
                told=lambda files, runs: progress.reached(files, f", {runs} run{'' if runs == 1 else 's'} judged"),
            )
        problems += (*report.problems, *_without_verdicts(report, options.mission), *_with_errors(report, missions))
        read_from = [(options.signals, each) for each in samples.values()]
        read_from += [(source.file, of_files[source.signal]) for source in sources if source.signal in of_files]
        remarks = (*_ignored(options.signals, samples, missions), *_of_other_times(read_from, report))
        report = replace(report, remarks=remarks)
        for remark in remarks if form != "table" else ():  # which has them
            print(f"btq verify: {remark}", file=sys.stderr)
        for each in report.foreign:
            runs = f"{each.runs} run{'' if each.runs == 1 else 's'}"
            print(f"btq verify: {each.file}: {runs} {each.of}, not judged", file=sys.stderr)
        to_terminal = options.output is None and sys.stdout.isatty()
        colour = options.color == "always" or (options.color == "auto" and wants_colour(to_terminal, os.environ))
        text = WRITERS[form](Judged(report, missions, options.verbose, colour))
        if code := write_output("verify", options.output, text):
            return code
    for problem in problems:
        print(f"btq verify: {problem}", file=sys.stderr)
    if problems:
        return 2
    wrong = report.verdicts - {SATISFIED} if options.strict else report.verdicts & {VIOLATED}
    return int(bool(wrong))


def _given(options: Namespace, problems: list[str]) -> tuple[Sequence[str], Sequence[Candidate], dict[str, Series]]:
    """The logs, missions and samples of a command line; what is wrong with them is added to the problems."""
    if problem := usage_problem([*options.logs, *options.mission]) or form_problem(options, FORMATS):
        problems.append(problem)
        return (), (), {}
    home = find_project(".")
    project = home.project
    asked = options.logs or _logs_of(project)
    if not asked:
        untold = "no log given; name one, or set `logs` in [evidence] of btq.toml"
        problems += map(str, home.problems) if home.problems else [untold]
        return (), (), {}
    files, unreachable = collect(asked, project, (*SUFFIXES, METADATA))
    logs = whole_bags(files)
    problems += map(str, unreachable)
    if not logs and not unreachable:
        problems.append(f"no {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]} below {', '.join(asked)}")
    special = [path for path in (*logs, *filter(None, [options.signals])) if is_special(path)]
    problems += [f"{shown(path)}: {IS_SPECIAL}" for path in special]
    samples: dict[str, Series] = {}
    if options.signals is not None and options.signals not in special:
        try:
            samples = read_samples(options.signals)
        except NoSamples as error:
            problems.append(f"{options.signals}: {error}")
        except OSError as error:
            problems.append(f"{options.signals}: cannot be read: {error.strerror or error}")
    return logs, _missions(options.mission, logs, problems), samples


def _logs_of(project: Project) -> Sequence[str]:
    """The paths that the project's patterns match; a pattern that matches none is itself, to be reported."""
    found: list[str] = []
    for pattern in project.evidence.logs if project.evidence is not None else ():
        path = os.path.join(project.root, pattern)
        found += sorted(glob(path, recursive=True)) or [path]
    return found


def _missions(asked: Sequence[str], logs: Sequence[str], problems: list[str]) -> Sequence[Candidate]:
    """The missions that logs may be of: those asked for, else those of the side files beside the logs and all of this
    folder's project."""
    sides = {side.mission: side for side in _sides(logs)}
    there = [mission for mission in sides if os.path.isfile(mission)]
    found = [] if asked else [each for side in sides.values() if side.mission not in there for each in _restored(side)]
    groups, unreadable = Files().groups(asked or [*there, find_project(".").project.root])
    problems += map(str, unreadable)
    for group in groups:
        for path in group.given:
            side = sides.get(path) or _side(side_path(xml_name(path)))
            if path.endswith(".xml") and side is not None and (built := [*_restored(side)]):
                found += built
            elif asked or path not in group.workspace.included_files:
                nodes = side.nodes if side is not None and side.mission == path else None
                found.append(Candidate(group.workspace, path, _name(path), nodes))
    if not found and not problems:
        problems.append("no mission found; name one with --mission FILE, a .btq file or XML")
    return found


def _restored(side: _Side) -> Iterator[Candidate]:
    """The mission as it was built, where only the XML and the side file are there."""
    built = as_built(xml_path(side.path), Disk())
    if built is not None:
        yield Candidate(built.workspace, built.path, _name(side.mission), side.nodes)


def _name(path: str) -> str:
    return os.path.splitext(os.path.basename(path))[0]


class _Side(Record):
    """A side file, the mission that it says it is of, and the nodes that it lists."""

    path: str
    mission: str
    nodes: list[tuple[int, str]]


def _sides(logs: Sequence[str]) -> Iterator[_Side]:
    """The side files beside logs."""
    for folder in dict.fromkeys(os.path.dirname(absolute(log)) for log in logs):
        try:
            names = sorted(os.listdir(folder))
        except OSError:
            continue  # reading the log reports that
        for name in names:
            if name.endswith(SIDE_SUFFIX) and (side := _side(f"{folder}/{name}")) is not None:
                yield side


def _side(path: str) -> _Side | None:
    """A side file; None where there is none, or it is damaged."""
    text = read(path)[0] if os.path.isfile(path) else None
    try:
        data = json.loads(text or "")
        mission = absolute(os.path.join(os.path.dirname(path), data["mission"]["file"]))
        return _Side(path, mission, [(node["uid"], node["path"]) for node in data["nodes"]])
    except (ValueError, RecursionError, KeyError, TypeError):
        return None


def _ignored(path: str | None, samples: Iterable[str], missions: Sequence[Candidate]) -> Iterator[str]:
    """The columns that no mission reads, each with the names that may be meant."""
    scopes = [mission.workspace.scope(mission.path) for mission in missions]
    found = [each for scope in scopes for name in scope.names(Kind.SIGNAL) for each in scope.all(Kind.SIGNAL, name)]
    signals = [each.symbol.target for each in found if isinstance(each.symbol.target, Signal)]
    words = [word for each in signals for word in (each.name, each.source) if word is not None]
    known = {word.text.strip("{} ").removeprefix("@") for word in words}
    for name in samples:
        if name not in known:
            meant = did_you_mean(near(name, known))
            yield f"{path}: column `{name}` is ignored, because no signal or entry has this name{meant}"


def _of_other_times(read_from: Iterable[tuple[str, Series]], report: Report) -> Iterator[str]:
    """The files with samples long before or after all runs, as where their times are no seconds since the epoch.

    A single sample may be of something that does not change.
    """
    times: dict[str, set[int]] = {}
    for file, series in read_from:
        times.setdefault(file, set()).update(series.times)
    sources = [each for mission in report.missions for each in mission.sources]
    begin = min((each.begin for each in sources if each.begin is not None), default=None)
    end = max((each.end for each in sources if each.end is not None), default=None)
    for file, found in times.items():
        if begin is None or end is None or len(found) < 2:
            continue
        if max(found) < begin - _NEAR or min(found) > end + _NEAR:
            yield (
                f"{file}: its samples are from {period(min(found), max(found))}, and the runs from"
                f" {period(begin, end)}; expected times in seconds since the epoch"
            )


def _with_errors(report: Report, missions: Sequence[Candidate]) -> Iterator[str]:
    """The missions of the report in which something is wrong, so that a clause may not have been understood."""
    judged = {mission.file for mission in report.missions}
    for mission in missions:
        if mission.path in judged:
            found = (
                each for file in mission.workspace.closure(mission.path) for each in check(mission.workspace, file)
            )
            if any(each.effective_severity is Severity.ERROR for each in found):
                yield f"{shown(mission.path)} has errors, so clauses may be missing; run btq check"


def _without_verdicts(report: Report, asked: Sequence[str]) -> Iterator[str]:
    if not report.missions and not report.problems:
        differences = dict.fromkeys(each.difference for each in report.foreign if asked and each.difference)
        if differences:
            yield from (f"no log matches {', '.join(asked)}: {each}" for each in differences)
        else:
            yield "no log matches a known mission; name the mission with --mission FILE"
    elif report.missions and not any(mission.runs for mission in report.missions):
        yield "no run in any log, so there is nothing to judge"


_NEAR: Final = 60_000_000  # µs: a robot may log a minute before its tree starts, or after it has ended
