"""The scenarios that verify requirements: each is one of the tests of these."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Final, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.diagnostics.model import Place
from btq_lang.requirements.model import ResolvedRequirement, ResolvedWay
from btq_lang.syntax.scenarios import Expect, ExpectedVerdict
from btq_lang.syntax.tree import Given, Scenario
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Span
from btq_lang.workspace.workspace import Workspace

# A requirement by the file that defines it and its name; the file of one that another tool keeps is NO_FILE.
RequirementKey: TypeAlias = tuple[str, str]
NO_FILE: Final = ""


class VerifyingScenario(Record):
    """A scenario that verifies a requirement.

    Attributes:
        title: with single blanks.
        place: of the title.
        expects: which verdict on the requirement, other than satisfied; empty: none.
        fingerprint: of its text.
    """

    title: str
    place: Place
    expects: str = ""
    fingerprint: str = ""


def verifying_scenarios(
    workspace: Workspace, requested: Iterable[str]
) -> Mapping[RequirementKey, Sequence[VerifyingScenario]]:
    """The scenarios that verify each requirement, in the order of files and lines.

    Args:
        requested: paths; scenarios count in files that include one of these, or that these include.
    """
    missions = {*requested}
    included = {path for mission in missions for path in workspace.closure(mission)}
    with_scenarios = [path for path, file in workspace.files.items() if "scenario" in file.text]
    return grouped(
        pair
        for path in sorted(with_scenarios)
        if path in included or not missions.isdisjoint(workspace.closure(path))
        for pair in _in_file(workspace, path)
    )


def other_ways(requirement: ResolvedRequirement, titles: Collection[str]) -> Iterator[ResolvedWay]:
    """The ways to verify a requirement, without the tests that are scenarios: those with the title of one, and `test`
    alone, which any scenario answers.

    Args:
        titles: of the scenarios that verify it.
    """
    for way in requirement.ways:
        if way.method != "test" or not titles or (way.id is not None and _folded(way.id) not in titles):
            yield way


def scenario_fingerprint(workspace: Workspace, path: str, scenario: Scenario) -> str:
    """A digest of the text of a scenario and of what is given for all of its file, whatever the layout."""
    file = workspace.files[path]
    counted = (entry for entry in file.parsed.entries if entry.item is scenario or isinstance(entry.item, Given))
    texts = (_folded(file.text[entry.start : entry.start + entry.item.end]) for entry in counted)
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:_DIGITS]


def _in_file(workspace: Workspace, path: str) -> Iterator[tuple[RequirementKey, VerifyingScenario]]:
    scope = workspace.scope(path)
    for scenario in workspace.files[path].of_type(Scenario):
        title = scenario.title
        span = title.span if title is not None else Span(scenario.start, scenario.start)
        verifying = VerifyingScenario(
            _folded(title.text) if title is not None else "",
            Place(span, path, scenario),
            fingerprint=scenario_fingerprint(workspace, path, scenario),
        )
        for name in dict.fromkeys(word.text for word in scenario.verifies):
            definition = scope.find(Kind.REQUIREMENT, name)
            yield (
                (definition.path if definition is not None else NO_FILE, name),
                replace(verifying, expects=_expected(scenario, name)),
            )


def _expected(scenario: Scenario, name: str) -> str:
    """Which verdict on a requirement a scenario expects, other than satisfied; empty: none."""
    for step in scenario.steps:
        expected = step.expectation if isinstance(step, Expect) else None
        if isinstance(expected, ExpectedVerdict) and expected.name.text == name:
            words = " ".join(word.raw for word in expected.words)
            if words not in ("", "satisfied"):
                return words
    return ""


def _folded(text: str) -> str:
    return " ".join(text.split())


_DIGITS: Final = 16
