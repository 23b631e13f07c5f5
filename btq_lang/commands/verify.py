"""`btq verify`: judge by logs whether robots did what the mission demands."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.commands.candidates import candidates, strict_problem
from btq_lang.commands.output import form_of, form_problem
from btq_lang.commands.progress import Progress
from btq_lang.commands.stored import opened, reads_store, store_problem, summarise, with_store
from btq_lang.commands.verdict_events import events_problem, overwrite_problem
from btq_lang.commands.verdict_report import finish, progress_to_editor
from btq_lang.commands.verify_options import FORMATS, VerifyOptions
from btq_lang.evidence.judging import Means
from btq_lang.evidence.one_run import one_run
from btq_lang.evidence.readers import NotALog
from btq_lang.evidence.readers.samples import NoSamples
from btq_lang.evidence.readers.samples import read as read_samples
from btq_lang.evidence.signal_sources import signal_sources
from btq_lang.evidence.verifying import judged, logs_below
from btq_lang.projects.files import logs_of, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused, refuse
from btq_lang.util.record import as_dict
from btq_lang.util.text import counted
from btq_lang.workspace.loader import IS_SPECIAL, find_project, is_special, shown

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.model import SampleSeries


def run(options: VerifyOptions, messages: CommandOutput) -> int:
    """Read the logs, or a store, or watch a robot, and print the verdicts."""
    if options.live is not None:
        from btq_lang.commands.live import verify_live

        return verify_live(options, options.live, messages)
    is_summary = reads_store(options)
    options = with_store(options)
    paths = [*options.logs, *options.mission]
    refuse(usage_problem(paths) or store_problem(options, is_summary) or events_problem(options.events))
    if is_summary and options.store is not None:
        return summarise(options, options.store, messages)
    problems: list[str] = []
    logs, missions, samples = _inputs(options, problems)
    if options.events is not None and (problem := overwrite_problem(options.events, [*options.logs, *logs])):
        problems.append(problem)
    if options.run is not None and options.show is None and not problems:
        return _print_run(logs, missions, options.run, messages)
    declared = signal_sources(missions, problems)
    keeping = opened(options, problems)
    refuse(*problems)
    with Progress(len(logs), "read") as progress:
        to_editor = progress_to_editor(len(logs)) if options.summary is not None else None
        means = Means(
            missions,
            samples,
            declared,
            with_timelines=form_of(options.format, options.output, FORMATS) == "html",
            with_measures=options.summary is not None,
            keeping=keeping,
        )
        reached = to_editor or (lambda files, runs: progress.reached(files, f", {counted(runs, 'run')} judged"))
        verification = judged(logs, means, options.mission, options.signals or "", options.jobs, reached)
    if options.show is not None:
        from btq_lang.commands.recorded import show_run

        refuse(*verification.problems)
        return show_run(verification.report, means, logs, options, messages)
    return finish(options, verification, missions, logs, messages)


def _inputs(
    options: VerifyOptions, problems: list[str]
) -> tuple[Sequence[str], Sequence[Candidate], dict[str, SampleSeries]]:
    """The logs, missions and samples of a command line; problems are appended."""
    problem = form_problem(options.format, options.output, FORMATS) if options.show is None else None
    if options.jobs < 1:
        problem = problem or f"--jobs {options.jobs}: expected a number of processes"
    if problem:
        problems.append(problem)
        return (), (), {}
    home = find_project(".")
    project = home.project
    requested = options.logs or logs_of(project)
    if not requested:
        no_log = "no log given; name one, or set `logs` in [evidence] of btq.toml"
        problems += map(str, home.problems) if home.problems else [no_log]
        return (), (), {}
    logs, log_problems = logs_below(requested, project)
    problems += log_problems
    samples: dict[str, SampleSeries] = {}
    if options.signals is not None and is_special(options.signals):
        problems.append(f"{shown(options.signals)}: {IS_SPECIAL}")
    elif options.signals is not None:
        try:
            samples = read_samples(options.signals)
        except NoSamples as error:
            problems.append(f"{options.signals}: {error}")
        except OSError as error:
            problems.append(f"{options.signals}: cannot be read: {error.strerror or error}")
    missions = candidates(options.mission, logs, problems)
    problems += strict_problem(options.strict, missions)
    return logs, missions, samples


def _print_run(logs: Sequence[str], missions: Sequence[Candidate], number: int, messages: CommandOutput) -> int:
    """Print, as JSON for editors, the first mission's run with a number in the log; returns the exit code."""
    if len(logs) != 1 or len(missions) != 1 or number < 1:
        raise Refused("--run N goes with one log and one --mission")
    (log,), (mission,) = logs, missions
    try:
        run = one_run(log, mission, number)
    except (NotALog, OSError) as error:
        raise Refused(f"{shown(log)}: {error}") from error
    if run is None:
        raise Refused(f"{shown(log)} has no run {number} of {mission.name}")
    messages.add(json.dumps({**as_dict(run), "steps": [*map(as_dict, run.steps)]}) + "\n", "document")
    return 0
