"""What came of scenarios, as data.

One invariant: writers compute nothing from it, and it refers to no text, so it may go to another process.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from btq_lang.util.record import Record

Outcome: TypeAlias = Literal["passed", "failed", "unknown", "error"]


class Step(Record):
    """The first step of a run that differs from what is expected.

    Attributes:
        at: in seconds since the start of the run.
        node: its path in the engine; empty if there is none.
        file, line: where it is written; empty and 0 without a node.
        happened, expected: in words.
    """

    at: float
    node: str
    file: str
    line: int
    happened: str
    expected: str


class ExpectationResult(Record):
    """A line that says what is expected.

    Attributes:
        text: as typed, without `expect`.
        line: in the file of the scenario.
        why: why it is unknown; empty if it is not.
        step: None if it holds or is unknown.
    """

    text: str
    line: int
    outcome: Outcome
    why: str
    step: Step | None


class ScenarioResult(Record):
    """A scenario.

    Attributes:
        file, line: where it is written.
        tree: the one that it ran; empty if it is unknown which.
        verifies: the IDs of requirements.
        ended: how the run ended: `succeeds`, `fails`, `does not end` …; empty if there was none.
        seconds: how long it took there.
        why: why it failed as a whole, is unknown or wrong; empty otherwise.
        assumed: the actions of which nothing was given, which succeeded at once, by their paths.
        drawing: the run in lines, if it was wanted.
    """

    title: str
    file: str
    line: int
    tree: str
    verifies: tuple[str, ...]
    outcome: Outcome
    ended: str
    seconds: float
    why: str
    expectations: tuple[ExpectationResult, ...]
    assumed: tuple[str, ...]
    drawing: tuple[str, ...]


class ScenarioReport(Record):
    """All scenarios that ran."""

    scenarios: tuple[ScenarioResult, ...]

    def count(self, outcome: Outcome) -> int:
        """How many have an outcome."""
        return sum(scenario.outcome == outcome for scenario in self.scenarios)
