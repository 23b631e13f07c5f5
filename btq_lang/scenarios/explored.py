"""The runs that answer questions about what can happen, as the scenarios of a file."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence

from btq_lang.exploration.report import Explored
from btq_lang.formatter import format_text
from btq_lang.scenarios.asked import ENDS, expectations, is_start
from btq_lang.scenarios.witnessed import PossibleExpectation, Witness, WitnessedScenario, as_scenario
from btq_lang.syntax.tree import quote, written


def witnessed(explored: Explored, path: str) -> Iterator[tuple[Witness, WitnessedScenario | None]]:
    """The runs as scenarios in a file; None: no scenario says what happens in the run."""
    for witness in _witnesses(explored):
        yield witness, as_scenario(explored.mission, witness, path, _include(explored, path))


def scenario_file(explored: Explored, path: str, scenarios: Sequence[WitnessedScenario]) -> str:
    """The text of a file with such scenarios."""
    items = [text for scenario in scenarios for text in (scenario.requirement, scenario.text) if text]
    return format_text("\n".join([f"include {quote(_include(explored, path))}\n", *items])).text


def drawn(scenarios: Iterable[WitnessedScenario]) -> Iterator[str]:
    """Lines that draw the runs of scenarios, as `btq test --show` does."""
    for scenario in scenarios:
        yield from ("", scenario.title, *(f"  {line}" for line in scenario.drawing))


def _include(explored: Explored, path: str) -> str:
    """The path of the mission, seen from a file."""
    return os.path.relpath(explored.mission.path, os.path.dirname(path)).replace(os.sep, "/")


def _witnesses(explored: Explored) -> Iterator[Witness]:
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
