"""Scenarios: the mission runs in the model of the engine, and what it does is compared with what is expected.

One invariant: what a scenario does not say is never guessed: a condition of which nothing is given is an error of the
scenario, and a value that is needed and not given makes it unknown; actions that are assumed to succeed are listed.

    mission.py     a tree with all that its program registers, as it is built
    plan.py        what a scenario says, resolved
    reading.py     the words of a scenario to its plan
    running.py     one run: the tree is ticked, the world changes as planned
    unused_lines.py   lines that had no effect on it
    judging.py     whether a run is as expected
    drawing.py     a run as lines of text
    recording.py   a run of a log as a scenario
    witnessed.py   a run of `btq explore` as a scenario
    explored.py    those of a mission as a file
    explored_page.py   what was asked of missions, with these runs, as a page
    asked.py       what was asked there as expectations
    btlog.py       a run as a log
    recorded_nodes.py   the words that name one node of it
    results.py     what came of scenarios, as data
    suite.py       the scenarios of files, run one by one
    parallel.py    the same in several processes
    process.py     a process that runs them for an editor; explore_process.py looks for runs that violate a requirement
    outcomes.py    what can happen to nodes, and what of it happened in a run
    coverage.py    what scenarios have met of that
    mutants.py     changes of a tree, as mistakes could have made them
    mutating.py    a loaded tree with a change in it
    mutation_testing.py   which changes no scenario notices
    thoroughness.py   both for all scenarios
    thoroughness_text.py   its lines
    tape.py        what happened in a run, so that it can be repeated
    replay.py      a run repeated in an installed engine
    installed_engine.py   finding it, and building the program in engine_program/
    rules.py       a scenario as substitution rules of the engine
    text.py, json_document.py, junit.py, page.py   the writers
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.scenarios.results import ScenarioReport

FORMATS: Final = ("text", "json", "junit", "html")
_MODULES: Final = {"json": "json_document", "html": "page"}  # named otherwise


def write(report: ScenarioReport, form: str, *, colour: bool = False) -> str:
    """Write the results in one of FORMATS; `colour`: ANSI colours, for `text`.

    Raises:
        ValueError: there is no such format.
    """
    if form not in FORMATS:
        raise ValueError(f"unknown format {form!r}; expected one of {', '.join(FORMATS)}")
    text: str = import_module(f"{__name__}.{_MODULES.get(form, form)}").render(report, colour)
    return text
