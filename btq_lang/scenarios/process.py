"""A process that runs scenarios or explores missions for an editor, whose texts count instead of those on the disk.

One invariant: it ends when its standard input does, however long a scenario takes, so it never outlives the server that
started it.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterator
from threading import Thread
from typing import Any

from btq_lang.projects.files import Files
from btq_lang.render.colour import painter
from btq_lang.scenarios.coverage import coverage
from btq_lang.scenarios.json_document import coverage_as_data
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.outcomes import NodeOutcomes
from btq_lang.scenarios.results import ExpectationResult, OutcomePlace, ScenarioResult
from btq_lang.scenarios.suite import Suite
from btq_lang.scenarios.text import scenario_lines, step_in_words


def print_answers(answers: Callable[..., Iterator[dict[str, Any]]]) -> None:
    """Read a line of JSON, the arguments of a function, and print a line of JSON for each answer."""
    asked = json.loads(sys.stdin.readline())
    Thread(target=_end_with_input, daemon=True).start()
    for answer in answers(**asked):
        print(json.dumps(answer), flush=True)


def run_titles(path: str, texts: dict[str, str], titles: list[str], is_covered: bool) -> Iterator[dict[str, Any]]:
    """The results of scenarios of a file as plain data.

    Args:
        texts: of open files, by path.
        titles: of the scenarios to run; empty: all.
        is_covered: whether coverage is wanted.

    Returns:
        Of each scenario its `number` in the file, its `outcome`, why it is so as a whole, the expectations that do not
        hold, and the run as `lines` of text; then, if it is wanted, the `coverage`, as `btq test --format json` has it.
        Files in them are relative to the current folder.
    """
    files = Files()
    files.overlay = texts
    groups, _ = files.groups([path])
    missions: dict[int, tuple[ScenarioMission, NodeOutcomes]] = {}
    met: list[frozenset[tuple[OutcomePlace, str]]] = []
    for group in groups:
        suite = Suite(group.workspace)
        for place, title in suite.places(path) if path in group.given else ():
            if titles and title not in titles:
                continue
            ran = suite.ran(place, is_drawn=True)
            yield _as_data(place.number, ran.result)
            if is_covered and ran.mission is not None and ran.run is not None:
                key = id(ran.mission)
                missions[key] = missions.get(key) or (ran.mission, NodeOutcomes(ran.mission))
                met.append(missions[key][1].met(ran.run))
    if is_covered:
        yield {"coverage": coverage_as_data(coverage([*missions.values()], met))}


def _as_data(number: int, result: ScenarioResult) -> dict[str, Any]:
    return {
        "number": number,
        "outcome": result.outcome,
        "why": result.why,
        "unmet": [_unmet(each) for each in result.expectations if each.outcome != "passed"],
        "lines": [*scenario_lines(result, painter(False))],
    }


def _unmet(expectation: ExpectationResult) -> dict[str, Any]:
    """An expectation that does not hold, or of which that is not known; its line is 0 if it is in none."""
    step = expectation.step
    return {
        "line": expectation.line,
        "outcome": expectation.outcome,
        "message": expectation.why if step is None else step_in_words(step),
        "file": step.file if step is not None else "",
        "file_line": step.line if step is not None else 0,
        "happened": f"{step.node}: {step.happened}" if step is not None else "",
    }


def _end_with_input() -> None:
    sys.stdin.read()
    os._exit(0)
