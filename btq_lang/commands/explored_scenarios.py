"""`btq explore -o case.btq`: the runs that answer questions, as scenarios."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Final

from btq_lang.commands.output import write_output
from btq_lang.exploration.report import Explored
from btq_lang.formatter import format_text
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.scenarios.asked import ENDS, expectations, is_start
from btq_lang.scenarios.witnessed import Expected, Witness, WitnessedScenario, as_scenario
from btq_lang.syntax.tree import quote, written
from btq_lang.util.text import counted
from btq_lang.workspace.loader import absolute


def write_scenarios(explored: Sequence[Explored], output: str, messages: CommandOutput) -> None:
    """Write the runs that were found to a file.

    Raises:
        Refused: several missions were explored, or the file cannot be written.
    """
    if len(explored) > 1:
        raise Refused(f"-o {output} takes the runs of one mission; name one")
    include = os.path.relpath(explored[0].mission.path, os.path.dirname(absolute(output))).replace(os.sep, "/")
    scenarios: list[WitnessedScenario] = []
    for witness in witnesses(explored[0]):
        scenario = as_scenario(explored[0].mission, witness, absolute(output), include)
        if scenario is None:
            messages.remark(f"btq explore: no scenario says what happens in the run of `{witness.title}`")
        else:
            scenarios.append(scenario)
    if not scenarios:
        messages.remark(f"btq explore: there is no run to write to {output}")
        return
    items = [text for scenario in scenarios for text in (scenario.requirement, scenario.text) if text]
    text = "\n".join([f"include {quote(include)}\n", *items])
    write_output(messages, output, format_text(text).text)
    messages.remark(f"{counted(len(scenarios), 'run')} in {output}: run with btq test {output}")


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


def _satisfied(requirement: str) -> tuple[Expected, ...]:
    return (Expected(written(requirement), holds=False),)


SCENARIO_SUFFIXES: Final = (".btq",)
