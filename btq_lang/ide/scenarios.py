"""Scenarios in a text: which there are, and where the lines are of which a run tells."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from btq_lang.syntax.scenarios import Expect, Scenario
from btq_lang.syntax.tree import Entry
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.loader import absolute
from btq_lang.workspace.workspace import Workspace


class ListedScenario(Record):
    """A scenario that can be run.

    Attributes:
        title: empty without one.
        span: of all of it.
        head: of its title, or of its first word.
        expectations: the span of each, by its line, from 1.
    """

    title: str
    span: Span
    head: Span
    expectations: dict[int, Span]


class ScenarioFailure(Record):
    """Something that a run shows to be other than a scenario expects.

    Attributes:
        span: of the expectation, or of the title if it is about all of the scenario.
        is_error: False: it is not known.
        place: the path and the line, from 1, of the node at which the run differs first; None without one.
        happened: what the node did.
    """

    span: Span
    is_error: bool
    message: str
    place: tuple[str, int] | None = None
    happened: str = ""


def listed(workspace: Workspace, path: str) -> tuple[ListedScenario, ...]:
    """The scenarios of a file, in their order."""
    file = workspace.files[path]
    if file.is_foreign or "scenario" not in file.text:  # most files have none, and need not be parsed for that
        return ()
    return tuple(
        _listed(workspace, path, entry, entry.item) for entry in file.parsed.entries if isinstance(entry.item, Scenario)
    )


def failures(scenario: ListedScenario, folder: str, ran: Mapping[str, Any]) -> list[ScenarioFailure]:
    """What a run of a scenario shows.

    Args:
        folder: from which its paths count.
        ran: as `scenarios/process.py` tells of it.
    """
    is_known = ran["outcome"] != "unknown"
    why = [ScenarioFailure(scenario.head, is_known, ran["why"])] if ran["why"] else []
    return [*why, *(_failure(scenario, folder, unmet) for unmet in ran["unmet"])]


def _failure(scenario: ListedScenario, folder: str, unmet: Mapping[str, Any]) -> ScenarioFailure:
    place = (absolute(os.path.join(folder, unmet["file"])), unmet["file_line"]) if unmet["file"] else None
    span = scenario.expectations.get(unmet["line"], scenario.head)
    return ScenarioFailure(span, unmet["outcome"] == "failed", unmet["message"], place, unmet["happened"])


def _listed(workspace: Workspace, path: str, entry: Entry, scenario: Scenario) -> ListedScenario:
    lines = workspace.files[path].lines
    first = Span(scenario.start, scenario.start + len("scenario"))
    expectations = [
        Span(step.start, step.end).shifted(entry.start) for step in scenario.steps if isinstance(step, Expect)
    ]
    return ListedScenario(
        scenario.title.text if scenario.title is not None else "",
        Span(scenario.start, scenario.end).shifted(entry.start),
        (scenario.title.span if scenario.title is not None else first).shifted(entry.start),
        {lines.position(span.start)[0] + 1: span for span in expectations},
    )
