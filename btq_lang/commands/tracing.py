"""`btq trace`: which requirements hold for which nodes, how they are enforced, and what is missing."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from btq_lang.commands.output import form_of, form_problem, is_coloured, terminal_width, write_output
from btq_lang.projects.files import Files, no_mission_below, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import refuse
from btq_lang.projects.scenario_files import with_scenario_files
from btq_lang.trace import FORMATS
from btq_lang.trace.judged import together
from btq_lang.trace.missions import trace_tables
from btq_lang.trace.overview import JudgedRuns
from btq_lang.trace.scenario_results import Results, WrittenResult, read_results, with_results
from btq_lang.trace.wording import incomplete
from btq_lang.util.record import Record, replace
from btq_lang.workspace.loader import absolute, read


class TraceOptions(Record):
    """The options of `btq trace`.

    Attributes:
        evidence: the paths of logs, stores and files of verdicts; none: those of the project.
        bundle: show what is enforced in builds with `--bundle`.
        priority, quality, state: show only requirements with one of these.
    """

    paths: Sequence[str]
    stdin_filename: str | None
    evidence: Sequence[str]
    bundle: bool
    priority: Sequence[str]
    quality: Sequence[str]
    state: Sequence[str]
    format: str | None
    output: str | None
    color: str


def run(options: TraceOptions, messages: CommandOutput) -> int:
    """Write the overview; for missions with errors, of all valid parts."""
    refuse(usage_problem(options.paths) or form_problem(options.format, options.output, FORMATS))
    from btq_lang.trace.selection import STATES, Selection, none_selected, selected  # as that below

    refuse(
        *(
            f"unknown state {state!r}; expected one of {', '.join(STATES)}"
            for state in options.state
            if state not in STATES
        )
    )
    from btq_lang.commands.given_evidence import builds_for, verdicts_for  # it imports the readers of logs

    files = Files()
    groups, problems = files.groups(options.paths, options.stdin_filename)
    messages.problems(problems)
    refuse(no_mission_below(options.paths, groups))
    if problems:
        return 2
    groups = with_scenario_files(files, groups)
    evidence_problems: list[str] = []
    runs: list[JudgedRuns] = []
    evidence, results = _scenario_results(options.evidence)
    verdicts_of = verdicts_for(evidence, groups, evidence_problems, runs)
    builds_of = builds_for(evidence, groups, evidence_problems) if not evidence_problems else None
    for problem in evidence_problems:
        messages.remark(f"btq trace: {problem}")
    parts = [(group.workspace, group.given) for group in groups]
    table = trace_tables(parts, options.bundle, verdicts_of=verdicts_of, builds_of=builds_of)
    overview = replace(table.overview, judged=together(runs) if verdicts_of is not None else None)
    overview = with_results(overview, results) if results else overview
    selection = Selection(options.priority, options.quality, options.state)
    table = replace(table, overview=selected(overview, selection))
    is_empty = bool(overview.requirements) and not table.overview.requirements
    to_terminal = options.output is None and sys.stdout.isatty()
    colour = is_coloured(options.color, to_terminal)
    form = form_of(options.format, options.output, FORMATS)
    if is_empty and form in ("table", "markdown"):
        text = none_selected(selection, len(overview.requirements))
    else:
        text = table.write(form, colour=colour, width=terminal_width() if to_terminal else 120)
    write_output(messages, options.output, text, form)
    if evidence_problems:
        return 2
    if why := incomplete(table.overview):
        messages.remark(f"btq trace: {why}")
    return int(table.errors > 0)


def _scenario_results(evidence: Sequence[str]) -> tuple[Sequence[str], Results]:
    """The evidence without the results of scenarios, and these; of one that ran twice, the last one."""
    others: list[str] = []
    results: dict[tuple[str, str], WrittenResult] = {}
    for path in evidence:
        of_file = read_results(read(absolute(path))[0] or "") if path.endswith(".json") else None
        others += [path] if of_file is None else []
        results |= of_file or {}
    return others, results
