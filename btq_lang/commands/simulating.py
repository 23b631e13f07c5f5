"""`btq simulate`: how likely a mission does what it must, by runs in which skills do what was declared or measured."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from btq_lang import prediction
from btq_lang.commands.given_evidence import is_store
from btq_lang.commands.output import form_of, form_problem, is_coloured, write_file, write_output
from btq_lang.commands.progress import Progress
from btq_lang.commands.recorded import verdict_of
from btq_lang.commands.simulate_options import SimulateOptions
from btq_lang.evidence.identity import without_number
from btq_lang.evidence.store.engine import NoEngine
from btq_lang.evidence.verifying import logs_below
from btq_lang.exploration.missions import explorable
from btq_lang.formatter import format_text
from btq_lang.prediction.measuring import Measurement, measured_in_logs, measured_in_store
from btq_lang.prediction.predicting import Predictor, Recipe, Unanswerable, predicted
from btq_lang.prediction.report import PredictedRequirement, Prediction
from btq_lang.prediction.shown_run import recorded_run, shown_run, signals_csv
from btq_lang.prediction.template import template
from btq_lang.projects.building import for_target
from btq_lang.projects.files import FileGroup, Files, logs_of, no_mission_below, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused, refuse
from btq_lang.scenarios.btlog import as_btlog
from btq_lang.scenarios.drawing import drawing
from btq_lang.scenarios.mission import NotRunnable, ScenarioMission, as_program, main_tree, with_named_tree
from btq_lang.scenarios.recording import as_scenario
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.workspace.loader import absolute, shown


def run(options: SimulateOptions, messages: CommandOutput) -> int:
    """Predict what a mission does."""
    refuse(_usage_problem(options))
    groups, problems = Files().groups(options.paths, options.stdin_filename, with_xml=True)
    messages.problems(problems)
    refuse(no_mission_below(options.paths, groups))
    if problems:
        return 2
    group, path = _mission(groups, options)
    recipe = _recipe(group, path, options, messages)
    try:
        predictor = Predictor(recipe)
    except NotRunnable as error:
        raise Refused(f"{shown(path)}: {error}") from None
    except EngineError as error:
        raise Refused(f"{shown(path)}: the engine refuses the tree: {error}") from None
    except NotModelled as error:
        raise Refused(f"{shown(path)}: what the tree does is not known: {error}") from None
    if predictor.problems:
        raise Refused(f"{shown(path)}: [simulate] of the project: {predictor.problems[0][0]}; run btq check")
    if options.template:
        return _write_template(predictor, options, messages)
    return _predict(predictor, options, messages)


def _usage_problem(options: SimulateOptions) -> str | None:
    if options.runs < 1:
        return f"--runs {options.runs}: expected at least one"
    if options.jobs < 0:
        return f"--jobs {options.jobs}: expected a number of processes, or 0 to let btq choose"
    if options.show is not None:
        if options.format is not None:
            return "--show draws a run; --format is for predictions"
        if options.output is not None and not options.output.endswith((".btlog", ".btq")):
            return f"-o {options.output}: --show writes a log, FILE.btlog, or a scenario, FILE.btq"
        return usage_problem(options.paths)
    problem = usage_problem(options.paths)
    if options.template:
        return problem
    return problem or form_problem(options.format, options.output, prediction.FORMATS)


def _mission(groups: Sequence[FileGroup], options: SimulateOptions) -> tuple[FileGroup, str]:
    """The only mission among the requested files.

    Raises:
        Refused: there is none, or there are several.
    """
    missions = [
        (group, path)
        for group in groups
        for path in (group.given if options.tree else tuple(explorable(group.workspace, group.given)))
    ]
    if len(missions) == 1:
        return missions[0]
    if missions:
        names = ", ".join(shown(path) for _, path in missions[:3])
        raise Refused(f"{len(missions)} missions; name one of them: {names}{' …' if len(missions) > 3 else ''}")
    single = [(group, path) for group in groups for path in group.given]
    if len(single) == 1 and main_tree(with_named_tree(single[0][0].workspace, single[0][1]), single[0][1]):
        return single[0]
    raise Refused("no mission has a main tree; choose one with --tree")


def _recipe(group: FileGroup, path: str, options: SimulateOptions, messages: CommandOutput) -> Recipe:
    workspace = with_named_tree(group.workspace, path)
    if options.target:
        workspace = for_target(workspace, options.target)
    tree = options.tree or main_tree(workspace, path)
    program = as_program(workspace, path, tree)
    measured = None
    if evidence := options.measured or _of_project(group):
        try:
            mission = ScenarioMission(program, path, tree, not options.no_enforce)
            measurement = _measured(mission, evidence, options.label)
        except NotRunnable as error:
            raise Refused(f"{shown(path)}: {error}") from None
        for remark in (*measurement.problems, *measurement.remarks):
            messages.remark(f"btq simulate: {remark}")
        if not measurement.skills.runs and options.measured:
            raise Refused(f"--from {' '.join(options.measured)}: no run of {shown(path)}")
        measured = measurement.skills if measurement.skills.runs else None
    return Recipe(program, path, tree, not options.no_enforce, measured, options.seed)


def _of_project(group: FileGroup) -> Sequence[str]:
    """The logs that a project names, else its store."""
    project = group.project
    if logs := logs_of(project):
        return logs
    evidence = project.evidence
    return [os.path.join(project.root, evidence.store)] if evidence is not None and evidence.store else []


def _measured(mission: ScenarioMission, paths: Sequence[str], label: str | None) -> Measurement:
    """What skills did in logs, or in a store."""
    stores = [path for path in paths if is_store(path)]
    if not stores:
        if label is not None:
            raise Refused("--label is for --from with a store")
        logs, problems = logs_below([absolute(path) for path in paths], mission.workspace.project)
        refuse(*problems[:1])
        return measured_in_logs(logs, mission)
    if len(paths) > 1:
        raise Refused("--from takes one store, or logs")
    name = os.path.splitext(os.path.basename(mission.path))[0]
    try:
        return measured_in_store(stores[0], name, label)
    except NoEngine as error:
        raise Refused(str(error)) from None


def _write_template(predictor: Predictor, options: SimulateOptions, messages: CommandOutput) -> int:
    sources = {each.path for each in predictor.prepared.sources if each.source != "ASSUMED"}
    have = {uid for uid, node in predictor.mission.tree.nodes.items() if node.path in sources}
    text = template(predictor.mission, have)
    if not text:
        messages.remark("btq simulate: something is said of every skill")
    write_output(messages, options.output, text)
    return 0


def _predict(predictor: Predictor, options: SimulateOptions, messages: CommandOutput) -> int:
    jobs = options.jobs or (os.cpu_count() or 1 if options.runs >= _MANY else 1)
    try:
        with Progress(options.runs, "simulating", "runs") as progress:
            label = options.label or ""
            report = predicted(predictor, options.runs, jobs, options.check, label, progress.reached)
    except Unanswerable as error:
        names = ", ".join(map(without_number, error.conditions))
        what = "this condition answers" if len(error.conditions) == 1 else "these conditions answer"
        raise Refused(f"nobody says what {what}: {names}; --template prints the lines for btq.toml") from None
    if report.is_stopped:
        messages.remark(f"btq simulate: stopped after {report.runs} of {options.runs} runs")
    if options.show is not None:
        return _show(predictor, report, options, messages)
    form = form_of(options.format, options.output, prediction.FORMATS)
    colour = form == "text" and options.output in (None, "-") and is_coloured(options.color, sys.stdout.isatty())
    write_output(messages, options.output, prediction.write(report, form, colour=colour), form)
    return int(options.check and report.has("will miss"))


def _show(predictor: Predictor, report: Prediction, options: SimulateOptions, messages: CommandOutput) -> int:
    """Draw the run of a requirement, and write it."""
    requirement = next((each for each in report.requirements if each.id == options.show), None)
    if requirement is None:
        raise Refused(f"--show {options.show}: no requirement has this ID")
    number = _run_of(requirement)
    if number is None:
        messages.remark(f"btq simulate: --show {options.show}: no run misses it, and nothing is measured")
        return 1
    full = predictor.full
    (drawn,) = predictor.again((number,))
    ran = shown_run(full, drawn)
    missed = any(clause.held < clause.counted for clause in requirement.clauses)
    how = "misses" if missed else "comes closest to missing"
    messages.add(
        f"run {number} {how} {requirement.id}: it {drawn.end}{f' ({drawn.why})' if drawn.why else ''}\n", "result"
    )
    messages.add("".join(f"{line}\n" for line in drawing(full.mission, ran)), "result")
    if options.output is None:
        return 0
    if options.output.endswith(".btlog"):
        write_file(options.output, as_btlog(full.mission.tree, ran))
        if samples := signals_csv(full, drawn):
            csv = f"{options.output.removesuffix('.btlog')}.csv"
            write_file(csv, samples)
            messages.remark(f"run {number} is in {options.output}: btq verify {options.output} --signals {csv}")
            return 0
    else:
        folder = os.path.dirname(absolute(options.output))
        include = os.path.relpath(full.mission.path, folder).replace(os.sep, "/")
        title = f"Run {number} of {requirement.id}"
        recorded = recorded_run(full, drawn)
        verdicts = [(requirement.id, verdict_of(recorded, requirement.id))]
        write_file(options.output, format_text(as_scenario(recorded, title, include, verdicts)).text)
    messages.remark(f"run {number} is in {options.output}")
    return 0


def _run_of(requirement: PredictedRequirement) -> int | None:
    """The number of a run in which a requirement fails, or that comes closest."""
    missed = [clause for clause in requirement.clauses if clause.held < clause.counted]
    return next((clause.worst_run for clause in (*missed, *requirement.clauses) if clause.worst_run is not None), None)


_MANY = 1000  # runs; for fewer, starting processes takes longer
