"""`btq test`: run the scenarios of missions in the model of the engine."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from btq_lang import scenarios
from btq_lang.commands.output import form_of, form_problem, is_coloured, write_file, write_output
from btq_lang.commands.testing_options import ScenarioOptions
from btq_lang.projects.building import for_target
from btq_lang.projects.files import Files, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import refuse
from btq_lang.scenarios.parallel import result_of, results
from btq_lang.scenarios.results import ScenarioReport, ScenarioResult
from btq_lang.scenarios.suite import ScenarioPlace, Suite
from btq_lang.util.record import replace
from btq_lang.workspace.config import is_engine
from btq_lang.workspace.file import SUFFIXES, XML_SUFFIXES
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.scenarios.installed_engine import InstalledEngine


def run(options: ScenarioOptions, messages: CommandOutput) -> int:
    """Run the scenarios once, or again and again with `--watch`."""
    refuse(_usage_problem(options))
    files = Files()
    code, watched = _run(options, files, messages)
    if options.watch:
        from btq_lang.commands.watch_mode import run_on_changes

        suffixes = (*SUFFIXES, *XML_SUFFIXES)
        run_on_changes(lambda: _run(options, files, messages)[1], options.paths, watched, suffixes)
    return code


def _usage_problem(options: ScenarioOptions) -> str | None:
    if options.jobs < 0:
        return f"--jobs {options.jobs}: expected a number of processes, or 0 to let btq choose"
    if options.mutants is not None and options.mutants < 0:
        return f"--mutants {options.mutants}: expected how many at most, or no number for all"
    unwritable = form_problem(options.format, options.output, scenarios.FORMATS)
    return usage_problem(options.paths, options.watch) or unwritable


def _run(options: ScenarioOptions, files: Files, messages: CommandOutput) -> tuple[int, tuple[str, ...]]:
    """Run the scenarios once; returns the exit code and the files that another run depends on."""
    groups, problems = files.groups(options.paths, options.stdin_filename)
    messages.problems(problems)
    watched = tuple(path for group in groups for path in group.watched)
    engine = _engine(options.engine)
    workspaces = [_targeted(group.workspace, options.target, engine) for group in groups]
    suites = [Suite(each, not options.no_enforce, engine) for each in workspaces]
    wanted = [
        (index, place)
        for index, group in enumerate(groups)
        for path in group.given
        for place, title in suites[index].places(path)
        if options.title.casefold() in title.casefold()
    ]
    if not wanted:
        messages.remark("btq test: no scenario" + (f" whose title contains `{options.title}`" if options.title else ""))
        return 2, watched
    if options.rules is not None:
        return _write_rules(suites, wanted, options.rules, messages), watched
    jobs = options.jobs or (os.cpu_count() or 1 if len(wanted) >= _MANY else 1)
    report = replace(_report(suites, wanted, options, jobs), engine=engine.version if engine is not None else "")
    form = form_of(options.format, options.output, scenarios.FORMATS)
    colour = form == "text" and options.output in (None, "-") and is_coloured(options.color, sys.stdout.isatty())
    write_output(messages, options.output, scenarios.write(report, form, colour=colour), form)
    if problems or report.count("error"):
        return 2, watched
    return int(report.count("passed") < len(report.scenarios)), watched


def _engine(prefix: str | None) -> InstalledEngine | None:
    """The installed engine that is wanted; None if none is."""
    if prefix is None:
        return None
    from btq_lang.scenarios.installed_engine import NoInstalledEngine, installed_engine

    try:
        return installed_engine(prefix)
    except NoInstalledEngine as reason:
        refuse(f"--engine: {reason}")
        return None


def _targeted(workspace: Workspace, target: str | None, engine: InstalledEngine | None) -> Workspace:
    """A workspace for one version: the given one, or that of the engine if the project allows it."""
    if target is None and engine is not None:
        project = workspace.project
        if is_engine(engine.line) and (engine.line in project.engines or not project.pinned):
            target = engine.line
    return for_target(workspace, target) if target else workspace


def _write_rules(
    suites: Sequence[Suite], wanted: Sequence[tuple[int, ScenarioPlace]], path: str, messages: CommandOutput
) -> int:
    """Write the rules of the only scenario; returns the exit code."""
    from btq_lang.scenarios.rules import NoRules, substitution_rules

    if len(wanted) > 1:
        refuse(f"--rules {path}: {len(wanted)} scenarios; choose one with -k")
    ((index, place),) = wanted
    planned = suites[index].planned(place)
    if isinstance(planned, ScenarioResult):
        refuse(f"--rules {path}: {planned.why}")
        return 2
    try:
        rules = substitution_rules(*planned[1:])
    except NoRules as reason:
        refuse(f"--rules {path}: {reason}")
        return 2
    write_file(path, rules.text)
    messages.result(f"wrote {path}")
    for entry in rules.entries:
        messages.remark(f"set the entry {entry} before the first tick")
    for node in rules.without:
        messages.remark(f"no rule for {node}: nothing says what it answers")
    return 0


def _report(
    suites: Sequence[Suite], wanted: Sequence[tuple[int, ScenarioPlace]], options: ScenarioOptions, jobs: int
) -> ScenarioReport:
    if not options.coverage and options.mutants is None:
        return ScenarioReport(tuple(results(suites, partial(result_of, options.show), wanted, jobs)))
    from btq_lang.scenarios.thoroughness import thorough_report

    all_jobs = options.jobs or os.cpu_count() or 1
    return thorough_report(suites, wanted, options.show, options.coverage, options.mutants, all_jobs)


_MANY = 50  # scenarios; for fewer, starting processes takes longer
