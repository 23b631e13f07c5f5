"""`btq verify --show`: a run of a log as a scenario, which `btq test` runs."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from btq_lang.commands.output import write_output
from btq_lang.evidence.evaluate import MissionEvaluation
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.judging import NO_SERIES, Means
from btq_lang.evidence.model import PLACES, ROOT, Activation, LogSession, Transition
from btq_lang.evidence.named_runs import joined_sessions
from btq_lang.evidence.readers import read
from btq_lang.evidence.runs import activations
from btq_lang.evidence.sentences import worst_violation
from btq_lang.evidence.signals import by_signal
from btq_lang.evidence.verdicts import VIOLATED, RequirementVerdict, VerdictReport
from btq_lang.formatter import format_text
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.scenarios.judging import verdict_in_words
from btq_lang.scenarios.recording import RecordedRun, as_scenario
from btq_lang.workspace.loader import absolute, shown
from btq_lang.workspace.loader import read as read_text

if TYPE_CHECKING:
    from btq_lang.commands.verify_options import VerifyOptions


def show_run(
    report: VerdictReport,
    means: Means,
    logs: Sequence[str],
    options: VerifyOptions,
    messages: CommandOutput,
) -> int:
    """Write the run with the worst violation of the requirement `show` as a scenario, or the one that came closest, or
    the `run` with a number; returns the exit code.

    Raises:
        Refused: there is no such requirement or no such run, or the file cannot be written.
    """
    name, output = options.show or "", options.output
    judged = [(mission, each) for mission in report.missions for each in mission.requirements if each.id == name]
    if not judged:
        raise Refused(f"--show {name}: no requirement of a mission in these logs has this ID")
    verdicts, requirement = judged[0]
    number, how = (options.run, "") if options.run is not None else _worst_run(requirement)
    if number is None:
        messages.remark(f"btq verify: --show {name}: no run violates it ({requirement.verdict}); name one with --run N")
        return 1
    mission = next(each for each in means.missions if each.path == verdicts.file)
    recorded = run_of(logs, mission, means, number)
    if recorded is None:
        raise Refused(f"--show {name}: the logs have no run {number} of {mission.name}")
    log, run = recorded
    folder = os.path.dirname(absolute(output)) if output is not None and output != "-" else absolute(".")
    include = os.path.relpath(mission.path, folder).replace(os.sep, "/")
    title = f"Run {number} of {os.path.basename(log)}"
    text = format_text(as_scenario(run, title, include, [(name, verdict_of(run, name))])).text
    if output is None or output == "-":
        write_output(messages, output, text)
        return 0
    if not options.force and os.path.exists(absolute(output)) and read_text(absolute(output))[0] != text:
        raise Refused(f"{output} is there and differs; write to another file, or overwrite it with --force")
    write_output(messages, output, text)
    command = f"btq test {output}{' --no-enforce' if run.is_bare else ''}"
    messages.remark(f"run {number} of {shown(log)}{how} is in {output}: run it with {command}")
    return 0


def _worst_run(requirement: RequirementVerdict) -> tuple[int | None, str]:
    """The number of the run with the worst violation, as the table names it, or the run that came closest to one, with
    words for that; None if nothing is measured."""
    violated = [clause for clause in requirement.clauses if clause.violations]
    if violated:
        first = next((clause for clause in violated if clause.verdict == VIOLATED), violated[0])
        return worst_violation(first).run, ""
    closest = next((clause.worst.run for clause in requirement.clauses if clause.worst is not None), None)
    return closest, ", which comes closest to a violation,"


def verdict_of(run: RecordedRun, name: str) -> str:
    """The verdict of a requirement by one run alone."""
    evaluation = MissionEvaluation(run.joined.mission)
    evaluation.read(run.session(), run.joined, run.samples, 1, "the run")
    return verdict_in_words(next(each for each in evaluation.verdicts() if each.id == name))


def run_of(logs: Sequence[str], mission: Candidate, means: Means, number: int) -> tuple[str, RecordedRun] | None:
    """A run of a mission by its number among its runs in all logs, with the log that has it."""
    for log in logs:
        for _, session, joined in joined_sessions(read(log, means.declared.sources), means.missions, shown(log)):
            if isinstance(joined, str) or joined.mission.path != mission.path:
                continue
            of_files = means.declared.of_files.get(mission.path, NO_SERIES)
            rows: list[Transition] = []
            recorded: list[Activation] = []
            first_row = 0
            for activation in activations(_noting(session, rows)):
                recorded.append(activation)
                if activation.uid != ROOT:
                    continue
                number -= 1
                last_row = activation.ended[1] // PLACES
                if number == 0:
                    signals = mission.requirements.signals.values()
                    series = by_signal(signals, means.samples, of_files, session.signals, session.samples)
                    return log, RecordedRun(joined, recorded, series, rows[first_row:last_row])
                recorded, first_row = [], last_row
    return None


def _noting(session: LogSession, rows: list[Transition]) -> LogSession:
    """The session, whose transitions are appended to `rows` as they are read."""

    def noted() -> Iterator[Transition]:
        for row in session.transitions:
            rows.append(row)
            yield row

    return LogSession(session.tree, noted(), session.samples, session.remarks, session.signals, session.robot)
