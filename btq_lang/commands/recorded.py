"""`btq verify --show`: a run of a log as a scenario, which `btq test` runs."""

from __future__ import annotations

import os
from collections.abc import Sequence

from btq_lang.commands.output import write_output
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.judging import NO_SERIES, Means
from btq_lang.evidence.model import ROOT, Activation
from btq_lang.evidence.named_runs import joined_sessions
from btq_lang.evidence.readers import read
from btq_lang.evidence.runs import activations
from btq_lang.evidence.sentences import worst_violation
from btq_lang.evidence.signals import by_signal
from btq_lang.evidence.verdicts import VIOLATED, VerdictReport
from btq_lang.formatter import format_text
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.scenarios.recording import RecordedRun, as_scenario
from btq_lang.workspace.loader import absolute, shown


def show_run(
    report: VerdictReport, means: Means, logs: Sequence[str], name: str, output: str | None, messages: CommandOutput
) -> int:
    """Write the run with the worst violation of a requirement as a scenario; without one, the first run.

    Args:
        name: the ID of the requirement.

    Raises:
        Refused: there is no such requirement or no run, or the file cannot be written.
    """
    judged = [(mission, each) for mission in report.missions for each in mission.requirements if each.id == name]
    if not judged:
        raise Refused(f"--show {name}: no requirement of a mission in these logs has this ID")
    verdicts, requirement = judged[0]
    clauses = [clause for clause in requirement.clauses if clause.verdict == VIOLATED and clause.violations]
    number = worst_violation(clauses[0]).run if clauses else 1
    mission = next(each for each in means.missions if each.path == verdicts.file)
    found = run_of(logs, mission, means, number)
    if found is None:
        raise Refused(f"--show {name}: the logs have no run {number} of {mission.name}")
    log, run = found
    folder = os.path.dirname(absolute(output)) if output is not None and output != "-" else absolute(".")
    include = os.path.relpath(mission.path, folder).replace(os.sep, "/")
    title = f"Run {number} of {os.path.basename(log)}"
    text = as_scenario(run, title, include, [(name, VIOLATED if clauses else "satisfied")])
    write_output(messages, output, format_text(text).text)
    if output is not None and output != "-":
        messages.remark(f"run {number} of {shown(log)} is in {output}: run it with btq test {output}")
    return 0


def run_of(logs: Sequence[str], mission: Candidate, means: Means, number: int) -> tuple[str, RecordedRun] | None:
    """A run of a mission by its number among its runs in all logs, with the log that has it."""
    for log in logs:
        for _, session, joined in joined_sessions(read(log, means.declared.sources), means.missions, shown(log)):
            if isinstance(joined, str) or joined.mission.path != mission.path:
                continue
            of_files = means.declared.of_files.get(mission.path, NO_SERIES)
            recorded: list[Activation] = []
            for activation in activations(session):
                recorded.append(activation)
                if activation.uid != ROOT:
                    continue
                number -= 1
                if number == 0:
                    signals = mission.requirements.signals.values()
                    series = by_signal(signals, means.samples, of_files, session.signals, session.samples)
                    return log, RecordedRun(joined, recorded, series)
                recorded = []
    return None
