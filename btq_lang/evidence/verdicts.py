"""What comes out: a verdict for each requirement, with what it rests on, as data.

One invariant: nothing in here has to be worked out again, so a table, JSON and a page say the same.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.catalog.units import Unit
    from btq_lang.evidence.model import Outcome
    from btq_lang.requirements.model import SourceNode

    Verdict: TypeAlias = Literal["violated", "unknown", "undecided", "satisfied", "never exercised"]

VIOLATED: Final = "violated"
UNKNOWN: Final = "unknown"
UNDECIDED: Final = "undecided"
SATISFIED: Final = "satisfied"
NEVER: Final = "never exercised"
WORST_FIRST: Final[tuple[Verdict, ...]] = (VIOLATED, UNKNOWN, UNDECIDED, SATISFIED, NEVER)


class Link(Record):
    """Something that led to a violation.

    Attributes:
        kind: `part`: a node that took a share of the time; `self`: the node, which took all of it; `origin`: where a
            failure began; `sample`: what a condition was judged by; `failure`: a leaf that had failed before in the
            run, or below the node; `starts`: how the activations that are counted ended; `event`: what the node of an
            event did last instead.
        path: of the node; of a sample the leaf that ran when it was taken, empty where none did.
        text: in words.
        seconds: how long the node ran; of a sample its age.
        activations, failed: of the node meanwhile.
    """

    kind: Literal["part", "self", "origin", "sample", "failure", "starts", "event"]
    path: str
    text: str
    seconds: float
    activations: int
    failed: int


class Violation(Record):
    """An activation that breaks a clause.

    Attributes:
        run: its number; runs count from 1, over all files in their order.
        source: the file.
        path: of the node, as the engine names it.
        start: when the run began, in µs since the epoch.
        at: how far into the run the clause was broken, in seconds.
        measured, bound: in the bound's unit; empty where there is no number to compare.
        why: what happened, in words.
        chain: what led to it, what matters most first.
    """

    run: int
    source: str
    path: str
    start: int
    at: float
    measured: str
    bound: str
    why: str
    chain: tuple[Link, ...]


class Worst(Record):
    """What came closest to the bound, or went furthest beyond it."""

    si: float
    text: str
    run: int


class Histogram(Record):
    """How the values that were measured are distributed, in SI.

    Attributes:
        low, step: where the first step begins, and how large each is.
        counts: how many values are in each.
        bound, goal: beside which they are seen; goal: None for none.
        unit: of the bound, to say values in.
    """

    low: float
    step: float
    counts: tuple[int, ...]
    bound: float
    bound_text: str
    goal: float | None
    goal_text: str
    unit: Unit | None


class Bar(Record):
    """An activation in a run.

    Attributes:
        depth: of its node in the tree.
        begin, end: in seconds since the run's start.
    """

    path: str
    depth: int
    begin: float
    end: float
    outcome: Outcome


class Timeline(Record):
    """A run.

    Attributes:
        start: in µs since the epoch.
        bars: in the order of the nodes.
        left_out: how many activations are not among them.
    """

    run: int
    source: str
    start: int
    bars: tuple[Bar, ...]
    left_out: int


class ClauseVerdict(Record):
    """A clause at a written node.

    Attributes:
        text: as typed, with its scopes and odds.
        path: of the node, as the engine names it; of a subtree that is used several times all of them.
        of: what it measures where that is more than a node: `from … to …`, `sum of …`; else empty.
        counted: how many activations, or of odds of runs, sums and tries in a run how many runs, were judged true or
            false.
        violated, unknown: how many of them, and of those beside them.
        cut_off: activations that were left out, for the log ends while they are open.
        unit: what is counted: `activations` or `runs`.
        interval: the lower and the upper limit of the probability that it holds; None without odds.
        confidence: that the requirement asks for; None where it asks for none, and each limit has 95 %.
        more: how many more runs (or activations) without a violation decide; None: no number is known to.
        violations: the first thousand of them.
        why: why the verdict is unknown or never exercised; of an undecided one why some are unknown; else empty.
        histogram: of what was measured; None where nothing was.
        timeline: the run of the worst violation; None without any.
    """

    text: str
    path: str
    of: str
    verdict: Verdict
    counted: int
    violated: int
    unknown: int
    cut_off: int
    unit: Literal["activations", "runs"]
    worst: Worst | None
    interval: tuple[float, float] | None
    confidence: float | None
    more: int | None
    violations: tuple[Violation, ...]
    why: str
    histogram: Histogram | None
    timeline: Timeline | None = None


class RequirementVerdict(Record):
    """A requirement; its verdict is the worst of its clauses."""

    id: str
    title: str
    verdict: Verdict
    clauses: tuple[ClauseVerdict, ...]


class Source(Record):
    """What was read of a file.

    Attributes:
        runs, first_run: how many runs of the mission are in it, and the number of the first.
        begin, end: of the first and the last of them, in µs since the epoch; None where there are none.
        identity: how the nodes were found in the mission.
        joined, nodes: how many of the log's nodes were found, of how many.
        remarks: what is to be known of the file.
    """

    file: str
    runs: int
    first_run: int
    begin: int | None
    end: int | None
    identity: str
    joined: int
    nodes: int
    remarks: tuple[str, ...]


class NodeSummary(Record):
    """A node of the logs.

    Attributes:
        path, kind: as the engine names it, and the ID it is registered under.
        runs: in how many it ran.
        succeeded, failed, halted, interrupted: how many of its activations.
        failures_began: in how many failed runs the failure began at it.
        p50, p95: what half, and 95 of 100, of its activations to a result do not exceed, in seconds; None without any.
        tick_p95, tick_worst: how long its `tick()` takes, likewise, where the log shows it.
        written: as what; None of a node that the mission does not have.
    """

    path: str
    kind: str
    is_leaf: bool
    runs: int
    succeeded: int
    failed: int
    halted: int
    interrupted: int
    failures_began: int
    p50: float | None
    p95: float | None
    tick_p95: float | None
    tick_worst: float | None
    written: SourceNode | None


class Repeats(Record):
    """How often something was done again: in all runs, at most in one, and in which; None where it never was."""

    total: int
    most: int
    run: int | None


class ContextSummary(Record):
    """In how many runs a context held, and in how many others it is not known whether it did."""

    name: str
    runs: int
    unknown: int


class MissionVerdicts(Record):
    """A mission with the files that it was judged by.

    Attributes:
        file: of the mission.
        outcomes: how many runs ended how.
        nodes: of the logs, in the order of their numbers.
        contexts: of the mission, in the order of their definitions.
        retries: of what Retry nodes and Nav2's RecoveryNodes repeat.
        recoveries: of what RecoveryNodes do between two tries.
        by_people: the requirements that are verified by review, test or analysis, and not judged here.
    """

    name: str
    file: str
    sources: tuple[Source, ...]
    requirements: tuple[RequirementVerdict, ...]
    outcomes: tuple[tuple[str, int], ...]
    nodes: tuple[NodeSummary, ...]
    contexts: tuple[ContextSummary, ...]
    retries: Repeats
    recoveries: Repeats
    by_people: tuple[str, ...]

    @property
    def runs(self) -> int:
        """How many runs were judged."""
        return sum(source.runs for source in self.sources)

    @property
    def medians(self) -> dict[str, float]:
        """How long nodes take to a result, in seconds by path."""
        return {each.path: each.p50 for each in self.nodes if each.p50 is not None}


class Foreign(Record):
    """Runs that are not judged.

    Attributes:
        of: what they are of: another mission, or one of several.
        difference: what the nearest mission and the tree of the log differ in; empty where one of them is unknown.
    """

    file: str
    runs: int
    of: str
    difference: str


class Report(Record):
    """All that `btq verify` found.

    Attributes:
        missions: those that some log is of.
        problems: the files that could not be read, each with the reason.
        remarks: what is to be known of the samples.
    """

    missions: tuple[MissionVerdicts, ...]
    foreign: tuple[Foreign, ...]
    problems: tuple[str, ...]
    remarks: tuple[str, ...] = ()

    @property
    def verdicts(self) -> frozenset[Verdict]:
        """Those that occur."""
        return frozenset(each.verdict for mission in self.missions for each in mission.requirements)


def worst_of(verdicts: Iterable[Verdict]) -> Verdict:
    """The verdict of several together: `never exercised` only where all of them are."""
    return min(verdicts, key=WORST_FIRST.index, default=NEVER)
