"""`btq verify`: judge what robots did, by their logs, against what the mission demands."""

from __future__ import annotations

import json
import os
import sys
from argparse import Namespace

from btq_lang.btcpp.export import xml_name
from btq_lang.btcpp.side_file import SIDE_SUFFIX, side_path
from btq_lang.checks import check
from btq_lang.commands.files import Files, usage_problem, write_stdout
from btq_lang.evidence import FORMATS, verify, write
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.readers import SUFFIXES
from btq_lang.evidence.readers.samples import NoSamples
from btq_lang.evidence.readers.samples import read as read_samples
from btq_lang.evidence.verdicts import SATISFIED, VIOLATED
from btq_lang.loader import absolute, collect, find_project, read, shown
from btq_lang.render.colour import wants_colour
from btq_lang.rules import Severity

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from btq_lang.evidence.model import Series
    from btq_lang.evidence.verdicts import Report

    Sides = dict[str, list[tuple[int, str]]]  # the nodes that side files list, by the mission


def run(options: Namespace) -> int:
    """Read the logs and print the verdicts."""
    problems: list[str] = []
    logs, missions, samples = _given(options, problems)
    if not problems:
        report = verify(logs, missions, samples, shown)
        problems += (*report.problems, *_without_verdicts(report), *_with_errors(report, missions))
        for each in report.foreign:
            runs = f"{each.runs} run{'' if each.runs == 1 else 's'}"
            print(f"btq verify: {each.file}: {runs} of another mission, not judged", file=sys.stderr)
        colour = options.color == "always" or (
            options.color == "auto" and wants_colour(sys.stdout.isatty(), os.environ)
        )
        write_stdout(write(report, options.format or FORMATS[0], colour=colour))
    for problem in problems:
        print(f"btq verify: {problem}", file=sys.stderr)
    if problems:
        return 2
    wrong = report.verdicts - {SATISFIED} if options.strict else report.verdicts & {VIOLATED}
    return int(bool(wrong))


def _given(options: Namespace, problems: list[str]) -> tuple[Sequence[str], Sequence[Candidate], dict[str, Series]]:
    """The logs, missions and samples of a command line; what is wrong with them is added to the problems."""
    if problem := usage_problem([*options.logs, *options.mission]):
        problems.append(problem)
        return (), (), {}
    logs, unreachable = collect(options.logs, find_project(".").project, SUFFIXES)
    problems += map(str, unreachable)
    if not logs and not unreachable:
        problems.append(f"no {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]} below {', '.join(options.logs)}")
    samples: dict[str, Series] = {}
    if options.signals is not None:
        try:
            samples = read_samples(options.signals)
        except NoSamples as error:
            problems.append(f"{options.signals}: {error}")
        except OSError as error:
            problems.append(f"{options.signals}: cannot be read: {error.strerror or error}")
    return logs, _missions(options.mission, logs, problems), samples


def _missions(asked: Sequence[str], logs: Sequence[str], problems: list[str]) -> Sequence[Candidate]:
    """The missions that logs may be of: those asked for, else those of the side files beside the logs and all of this
    folder's project."""
    sides = dict(_sides(logs))
    paths = list(asked) or [*filter(os.path.isfile, sides), find_project(".").project.root]
    groups, unreadable = Files().groups(paths)
    problems += map(str, unreadable)
    found: list[Candidate] = []
    for group in groups:
        workspace = group.workspace
        for path in group.given:
            if asked or path not in workspace.included_files:
                side = sides.get(path) or _nodes(side_path(xml_name(path))).get(path)
                name = os.path.splitext(os.path.basename(path))[0]
                found.append(Candidate(workspace, path, name, side))
    if not found and not problems:
        problems.append("no mission found; name one with --mission FILE")
    return found


def _sides(logs: Sequence[str]) -> Iterator[tuple[str, list[tuple[int, str]]]]:
    """The missions of the side files beside logs, each with the nodes that they list."""
    for folder in dict.fromkeys(os.path.dirname(absolute(log)) for log in logs):
        try:
            names = sorted(os.listdir(folder))
        except OSError:
            continue  # a log in it will tell
        for name in names:
            if name.endswith(SIDE_SUFFIX):
                yield from _nodes(f"{folder}/{name}").items()


def _nodes(side: str) -> Sides:
    """The mission of a side file with the nodes that it lists; nothing where there is no such file."""
    text = read(side)[0] if os.path.isfile(side) else None
    try:
        data = json.loads(text or "")
        mission = absolute(os.path.join(os.path.dirname(side), data["mission"]["file"]))
        return {mission: [(node["uid"], node["path"]) for node in data["nodes"]]}
    except (ValueError, RecursionError, KeyError, TypeError):
        return {}


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


def _without_verdicts(report: Report) -> Iterator[str]:
    if not report.missions and not report.problems:
        yield "no log matches a known mission; name the mission with --mission FILE"
    elif report.missions and not any(mission.runs for mission in report.missions):
        yield "no run in any log, so there is nothing to judge"
