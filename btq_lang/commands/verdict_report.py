"""Writes a report of `btq verify` as the command line asks for it: in a format of `evidence`, as the page that `trace`
draws, or as the summary that an editor loads.

One invariant of the summary: judging takes the processor only while nothing else wants it.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Sequence
from time import monotonic
from typing import TYPE_CHECKING, Any, Final

from btq_lang import evidence
from btq_lang.commands.output import form_of, is_coloured, terminal_width, write_file, write_output
from btq_lang.commands.verdict_events import write_events
from btq_lang.commands.verify_options import FORMATS, VerifyOptions
from btq_lang.evidence.folding import folded
from btq_lang.evidence.json_document import render
from btq_lang.evidence.notes import foreign_runs
from btq_lang.evidence.sentences import worst_violation
from btq_lang.evidence.verdicts import SATISFIED, VIOLATED
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import refuse
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.verdicts import ClauseVerdict, RequirementVerdict, VerdictReport
    from btq_lang.evidence.verifying import Verification


def finish(
    options: VerifyOptions,
    verification: Verification,
    missions: Sequence[Candidate],
    logs: Sequence[str],
    messages: CommandOutput,
) -> int:
    """Print the result; returns the exit code.

    Args:
        missions, logs: that were compared.
    """
    report = verification.report
    has_remarks = form_of(options.format, options.output, FORMATS) == "table"
    for note in folded((*(() if has_remarks else report.remarks), *foreign_runs(report))):
        messages.remark(f"btq verify: {note}")
    code = print_report(options, report, missions, messages)
    if options.events is not None:
        write_events(options.events, report, logs, messages)
    refuse(*folded(verification.problems))
    return code


def print_report(
    options: VerifyOptions, report: VerdictReport, missions: Sequence[Candidate], messages: CommandOutput
) -> int:
    """Write the verdicts as a command line asks for them; returns the exit code.

    Args:
        missions: as of `write`.
    """
    if options.summary is not None:
        write_summary(options.summary, report)
        return 0
    to_terminal = options.output is None and sys.stdout.isatty()
    form = form_of(options.format, options.output, FORMATS)
    text = write(
        report,
        missions,
        form,
        colour=is_coloured(options.color, to_terminal),
        verbose=options.verbose,
        width=terminal_width() if to_terminal else None,
    )
    write_output(messages, options.output, text, form)
    failing = report.verdicts - {SATISFIED} if options.strict else report.verdicts & {VIOLATED}
    return int(bool(failing) and not options.exit_zero)


def write(report: VerdictReport, missions: Sequence[Candidate], form: str, **options: Any) -> str:
    """Write the verdicts in one of FORMATS.

    Args:
        missions: all candidates, including those of the report.
        options: as of `evidence.write`.
    """
    if form != "html":
        return evidence.write(report, form, **options)
    from btq_lang.trace import page
    from btq_lang.trace.judged import judged_runs, together
    from btq_lang.trace.missions import trace_tables
    from btq_lang.trace.verdicts import outcomes

    requirements = {mission.file: mission.requirements for mission in report.missions}
    parts = [(mission.workspace, [mission.path]) for mission in missions if mission.path in requirements]
    table = trace_tables(parts, details_of=outcomes(report.missions), verdicts_of=requirements.__getitem__)
    # A table of the page has the verdicts, so the requirements need no column of them.
    judged = together(judged_runs(source for mission in report.missions for source in mission.sources))
    return page.render(replace(table.overview, has_evidence=False, judged=judged), report.missions)


def progress_to_editor(logs: int) -> Callable[[int, int], None]:
    """A function that prints how many logs have been read and how many runs have been judged, a JSON object a line:
    `done` of `of` logs, `runs`.
    """
    if hasattr(os, "nice"):
        os.nice(_NICE)
    due = [0.0]

    def reached(files: int, runs: int) -> None:
        if monotonic() >= due[0]:
            due[0] = monotonic() + _PAUSE
            print(json.dumps({"done": files, "of": logs, "runs": runs}), flush=True)

    return reached


def write_summary(path: str, report: VerdictReport) -> None:
    """Write the summary, whole or not at all, with few violations of each clause."""
    missions = (
        replace(mission, requirements=tuple(map(_shortened, mission.requirements))) for mission in report.missions
    )
    write_file(path, render(replace(report, missions=tuple(missions))))


def _shortened(requirement: RequirementVerdict) -> RequirementVerdict:
    return replace(requirement, clauses=tuple(map(_with_few_violations, requirement.clauses)))


def _with_few_violations(clause: ClauseVerdict) -> ClauseVerdict:
    if len(clause.violations) <= _VIOLATIONS:
        return clause
    worst = worst_violation(clause)
    others = [violation for violation in clause.violations if violation is not worst]
    return replace(clause, violations=(worst, *others[: _VIOLATIONS - 1]))


_VIOLATIONS: Final = 10
_NICE: Final = 10
_PAUSE: Final = 0.5  # seconds between two lines
