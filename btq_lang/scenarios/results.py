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
        note: which clauses of a requirement nothing in the run exercised; empty: none.
    """

    text: str
    line: int
    outcome: Outcome
    why: str
    step: Step | None
    note: str = ""


class ScenarioResult(Record):
    """A scenario.

    Attributes:
        file, line: where it is written.
        tree: the one that it ran; empty if it is unknown which.
        verifies: the IDs of requirements.
        fingerprint: of its text, by which a later text is known to differ.
        ended: how the run ended: `succeeds`, `fails`, `does not end` …; empty if there was none.
        seconds: how long it took there.
        why: why it failed as a whole, is unknown or wrong; empty otherwise.
        assumed: the actions of which nothing was given, which succeeded at once, by their paths.
        drawing: the run in lines, if it was wanted.
        notes: the lines of the scenario that had no effect.
    """

    title: str
    file: str
    line: int
    tree: str
    verifies: tuple[str, ...]
    fingerprint: str
    outcome: Outcome
    ended: str
    seconds: float
    why: str
    expectations: tuple[ExpectationResult, ...]
    assumed: tuple[str, ...]
    drawing: tuple[str, ...]
    notes: tuple[str, ...] = ()


class OutcomePlace(Record):
    """A written node, or a guard at one; line and column: from 1."""

    file: str
    line: int
    column: int
    node: str

    @property
    def position(self) -> tuple[str, int, int]:
        """By which places are in the order of the text."""
        return self.file, self.line, self.column


class CoveredOutcome(Record):
    """An outcome that a node may have; `scenarios`: how many have met it."""

    outcome: str
    scenarios: int


class CoveredNode(Record):
    """What scenarios have met at a node."""

    place: OutcomePlace
    outcomes: tuple[CoveredOutcome, ...]

    @property
    def unmet(self) -> tuple[str, ...]:
        """The outcomes that no scenario has met."""
        return tuple(each.outcome for each in self.outcomes if not each.scenarios)


class CoverageReport(Record):
    """What scenarios have met; `unused`: the trees that none of them runs, with their places."""

    nodes: tuple[CoveredNode, ...]
    unused: tuple[OutcomePlace, ...]


class MutantResult(Record):
    """What came of a mutant.

    Attributes:
        what: was changed at the node.
        is_reached: the node began in a scenario that is as expected without the change.
        noticed_by: the title of the first scenario that is not as expected with it; empty if there is none.
    """

    place: OutcomePlace
    what: str
    is_reached: bool
    noticed_by: str


class MutantReport(Record):
    """What came of mutants; `number`: of those that there are, of which these are an even sample."""

    number: int
    mutants: tuple[MutantResult, ...]


class ScenarioReport(Record):
    """All scenarios that ran.

    Attributes:
        coverage, mutants: if they were wanted.
        engine: the version of the engine in which they ran, too; empty: in none.
    """

    scenarios: tuple[ScenarioResult, ...]
    coverage: CoverageReport | None = None
    mutants: MutantReport | None = None
    engine: str = ""

    def count(self, outcome: Outcome) -> int:
        """How many have an outcome."""
        return sum(scenario.outcome == outcome for scenario in self.scenarios)
