"""`btq explore -o case.btq` and `--show`: the runs that answer questions, as scenarios, logs and drawings."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Final

from btq_lang.commands.output import write_file, write_output
from btq_lang.exploration.report import Explored
from btq_lang.formatter import format_text
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.render.cells import printable
from btq_lang.scenarios.asked import ENDS, expectations, is_start
from btq_lang.scenarios.btlog import as_btlog
from btq_lang.scenarios.witnessed import PossibleExpectation, Witness, WitnessedScenario, as_scenario
from btq_lang.syntax.tree import quote, written
from btq_lang.util.text import counted
from btq_lang.workspace.loader import absolute


def write_runs(explored: Sequence[Explored], output: str, messages: CommandOutput) -> None:
    """Write the runs that were found as scenarios, or the only one as a log.

    Raises:
        Refused: several missions were explored, or several runs found for a log, or the file cannot be written.
    """
    if len(explored) > 1:
        raise Refused(f"-o {output} takes the runs of one mission; name one")
    scenarios = _scenarios(explored[0], absolute(output), messages)
    if not scenarios:
        messages.remark(f"btq explore: there is no run to write to {output}")
    elif output.endswith(_LOG):
        if len(scenarios) > 1:
            raise Refused(f"-o {output} takes one run, and there are {len(scenarios)}; ask one question")
        write_file(output, as_btlog(scenarios[0].mission.tree, scenarios[0].run))
    else:
        items = [text for scenario in scenarios for text in (scenario.requirement, scenario.text) if text]
        text = "\n".join([f"include {quote(_include(explored[0], absolute(output)))}\n", *items])
        write_output(messages, output, format_text(text).text)
        messages.remark(f"{counted(len(scenarios), 'run')} in {output}: run with btq test {output}")


def drawn_runs(explored: Sequence[Explored], messages: CommandOutput) -> str:
    """The runs that were found, as `btq test --show` draws them."""
    lines: list[str] = []
    for each in explored:
        for scenario in _scenarios(each, f"{each.mission.path}.runs.btq", messages):
            lines += ["", scenario.title, *(f"  {line}" for line in scenario.drawing)]
    return "".join(f"{printable(line)}\n" for line in lines)


def _scenarios(explored: Explored, path: str, messages: CommandOutput) -> list[WitnessedScenario]:
    """The runs as scenarios in a file."""
    scenarios: list[WitnessedScenario] = []
    for witness in witnesses(explored):
        scenario = as_scenario(explored.mission, witness, path, _include(explored, path))
        if scenario is None:
            messages.remark(f"btq explore: no scenario says what happens in the run of `{witness.title}`")
        else:
            scenarios.append(scenario)
    return scenarios


def _include(explored: Explored, path: str) -> str:
    """The path of the mission, seen from a file."""
    return os.path.relpath(explored.mission.path, os.path.dirname(path)).replace(os.sep, "/")


def witnesses(explored: Explored) -> Iterator[Witness]:
    """The runs that answer what was asked of a mission."""
    number = 0
    for asked in explored.asked:
        answer = asked.answer
        if answer.witness or answer.circle:
            number += 1
            expected = tuple(expectations(asked.question, asked.is_wanted, number))
            title = f"{'can' if asked.is_wanted else 'never'} {asked.question.text}"
            ticks = (*answer.witness, *answer.circle)
            yield Witness(title, ticks, bool(answer.circle), expected, is_start=is_start(asked.question))
    for clause in explored.clauses:
        if clause.answer.witness:
            name = clause.requirement
            yield Witness(f"{name} is violated", clause.answer.witness, False, _satisfied(name), name)
    for finding in explored.survey.findings if explored.survey is not None else ():
        if finding.witness:
            yield Witness(finding.text, finding.witness, False, (ENDS,))


def _satisfied(requirement: str) -> tuple[PossibleExpectation, ...]:
    return (PossibleExpectation(written(requirement), holds=False),)


_LOG: Final = ".btlog"
RUN_SUFFIXES: Final = (".btq", _LOG)
