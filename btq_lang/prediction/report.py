"""What is predicted, as data.

One invariant: writers compute nothing from it; and a prediction is not called a verdict: it has other words.
"""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

from btq_lang.prediction.prepared import SkillSource
from btq_lang.util.record import Record

Word: TypeAlias = Literal["will miss", "unknown", "too close to say", "never run", "will hold"]
WORST_FIRST: Final[tuple[Word, ...]] = ("will miss", "unknown", "too close to say", "never run", "will hold")


class Cause(Record):
    """Why most of the runs that miss a demand do.

    Attributes:
        text: in words.
        share: of these runs; of as many of them as were looked at.
        looked: how many these are.
    """

    text: str
    share: float
    looked: int


class PredictedClause(Record):
    """A clause at a written node.

    Attributes:
        text: as typed, with its scopes and odds.
        path: of the node.
        of: its subject if that is more than a node.
        why: why it is unknown or never run, or why parts are unknown.
        unit: what is counted.
        held, counted: how many of these hold.
        unknown: how many more are unknown.
        runs: in how many runs its node starts, of those that were made; None if it is not about a node.
        share: of them that hold; None: nothing was counted, or all runs are judged together.
        interval: of the share in any number of runs, with 95 %; None as above, or without odds.
        pooled: what all runs come to together, in words; empty for others.
        worst: the measure closest to the bound, or furthest beyond it, in words; empty if nothing is measured.
        worst_run: the run with it, or the first that misses the demand; None if there is none.
        cause: the main cause of misses.
    """

    text: str
    path: str
    of: str
    word: Word
    why: str
    unit: str
    held: int
    counted: int
    unknown: int
    share: float | None
    interval: tuple[float, float] | None
    pooled: str
    worst: str
    worst_run: int | None
    cause: Cause | None


class PredictedRequirement(Record):
    """A requirement; its word is the worst of its clauses."""

    id: str
    title: str
    word: Word
    clauses: tuple[PredictedClause, ...]


class Ended(Record):
    """How runs ended: how many of them so, and of those that were looked at the reason of the first; empty: none."""

    end: str
    runs: int
    why: str


class Prediction(Record):
    """What is predicted of a mission.

    Attributes:
        file: of the mission.
        tree: that runs.
        engine: its version.
        is_enforced: as it is built, with the guards that enforce requirements.
        runs, wanted: how many were made, and how many there were to be.
        sources: of each leaf.
        label: of the runs that were measured; empty without one.
        measured: how many runs were measured; 0: none.
        median, p95: how long runs take that succeed, in seconds; None: none does.
        guessed: the skills that did what was never measured, each with the number of runs.
        is_stopped: Ctrl+C has ended the runs.
    """

    file: str
    tree: str
    engine: str
    is_enforced: bool
    runs: int
    wanted: int
    seed: int
    sources: tuple[SkillSource, ...]
    label: str
    measured: int
    ends: tuple[Ended, ...]
    median: float | None
    p95: float | None
    guessed: tuple[tuple[str, int], ...]
    requirements: tuple[PredictedRequirement, ...]
    is_stopped: bool = False

    def has(self, word: Word) -> bool:
        """Whether a requirement has a word."""
        return any(requirement.word == word for requirement in self.requirements)
