"""The result as data: a verdict for each requirement, with its evidence.

One invariant: writers compute nothing from it, so a table, JSON and a page agree.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from btq_lang.requirements.verifying import other_ways
from btq_lang.util.record import Record, as_dict

if TYPE_CHECKING:
    from btq_lang.catalog.units import Unit
    from btq_lang.evidence.margins import Margins
    from btq_lang.evidence.model import Outcome, SampleValue
    from btq_lang.evidence.odds import Limits
    from btq_lang.requirements.model import Quantity, ResolvedRequirement, Sort
    from btq_lang.workspace.resolved import ResolvedNode

Verdict: TypeAlias = Literal["violated", "unknown", "undecided", "satisfied", "never exercised", "open"]
VIOLATED: Final = "violated"
UNKNOWN: Final = "unknown"
UNDECIDED: Final = "undecided"
SATISFIED: Final = "satisfied"
NEVER: Final = "never exercised"
OPEN: Final = "open"
WORST_FIRST: Final[tuple[Verdict, ...]] = (VIOLATED, UNKNOWN, UNDECIDED, SATISFIED, NEVER, OPEN)
OUTCOMES: Final[dict[Outcome, str]] = {"S": "succeeded", "F": "failed", "H": "halted", "O": "interrupted"}


class CauseLink(Record):
    """Something that led to a violation.

    Attributes:
        kind: `part`: a node that took a share of the time; `self`: the node, which took all of it; `origin`: where a
            failure began; `sample`: a sample that a condition read; `failure`: a leaf that had failed before in the
            run, or below the node; `starts`: how the counted activations ended; `event`: what the node of an event last
            did instead.
        path: of the node; for a sample, of the leaf that ran when it was taken, empty if none did.
        text: in words.
        seconds: how long the node ran; for a sample, its age.
        activations, failed: counts of the node meanwhile.
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
        measured, bound: in the bound's unit; empty if there is no number to compare.
        why: what happened, in words.
        chain: what led to it, the most important first.
        passed: when a duration became longer than its bound, in seconds since the run's start; None for all else.
    """

    run: int
    source: str
    path: str
    start: int
    at: float
    measured: str
    bound: str
    why: str
    chain: tuple[CauseLink, ...]
    passed: float | None = None


class Worst(Record):
    """The measure closest to the bound, or furthest beyond it; run: None in the summary of a store, where it holds."""

    si: float
    text: str
    run: int | None


class RunValue(Record):
    """The value of a clause in a run.

    Attributes:
        run: its number; in the summary of a store, that in its log.
        start: when it began, in µs since the epoch.
        verdict: `satisfied`, `violated` or `unknown`.
        si: the measure closest to the bound, or furthest beyond it; None if none is known.
    """

    run: int
    start: int
    verdict: Verdict
    si: float | None


class Bounded(Record):
    """Judgements whose measure has only known limits, because the log does not say when something began.

    Attributes:
        number: how many.
        si, text: the largest upper limit.
    """

    number: int
    si: float
    text: str


class Pooled(Record):
    """What all runs come to together, in a clause that is not about each of them.

    Attributes:
        low, high: limits of a rate, per second, or of a mean, in SI, with the confidence that the requirement names, if
            any; None: unknown.
        more: how many more seconds decide it, if it does not happen again; None: no known time does.
    """

    text: str
    low: float | None
    high: float | None
    more: float | None


class Histogram(Record):
    """The distribution of the measured values, in SI.

    Attributes:
        low, step: where the first step begins, and how large each is.
        counts: how many values are in each step.
        marks: `bound`, or `lower bound` and `upper bound`, and perhaps `goal`, to compare them with, by these names.
        unit: of the bound, to print values in.
    """

    low: float
    step: float
    counts: tuple[int, ...]
    marks: Mapping[str, Quantity]
    unit: Unit | None


class Bar(Record):
    """An activation in a run.

    Attributes:
        depth: of its node in the tree.
        begin, end: in seconds since the run's start; `begin`: at the latest.
        took: how long that was, in words; empty if the log shows no time.
    """

    path: str
    depth: int
    begin: float
    end: float
    outcome: Outcome
    took: str


class SignalLine(Record):
    """The values of a signal in a run.

    Attributes:
        unit: of a number; None if unknown.
        points: seconds since the run's start, and the value from then on, numbers in SI; None: it is unknown.
        bounds: the numbers that it is compared with, each with the name of the requirement or the context that does.
        left_out: how many later changes are omitted.
    """

    name: str
    unit: Unit | None
    sort: Sort
    points: tuple[tuple[float, SampleValue | None], ...]
    bounds: tuple[tuple[str, Quantity], ...]
    left_out: int


class Timeline(Record):
    """A run.

    Attributes:
        start: in µs since the epoch.
        length: in seconds.
        bars: in the order of the nodes' uids.
        left_out: how many activations are omitted.
        signals: those that the mission's requirements and contexts read.
    """

    run: int
    source: str
    start: int
    length: float
    bars: tuple[Bar, ...]
    left_out: int
    signals: tuple[SignalLine, ...]


class Measures(Record):
    """What is needed to judge a clause again after its bound or its odds have been edited.

    Attributes:
        key, place: what it demands apart from them, and where: as in `edges.key_of` and `outline.Demand`.
        bound: in SI; None: it has none that can be moved.
        odds: the relation and the probability that the requirement asks for.
        missing: why it cannot be judged at all its nodes; empty if it can.
        has_run: whether one of its nodes has.
        margins: the counts by the bound; None: unknown.
    """

    key: str
    place: str
    bound: float | None
    odds: tuple[str, float] | None
    missing: str
    has_run: bool
    margins: Margins | None


class ClauseVerdict(Record):
    """A clause at a written node.

    Attributes:
        text: as typed, with its scopes and odds; empty if an open requirement has no clause.
        path: of the node, as the engine names it; all paths for a subtree that is used several times.
        of: its subject if that is more than a node: `from … to …`, `sum of …`; else empty.
        why: why the verdict is unknown, never exercised or open, or why parts of an undecided one are unknown; else
            empty.
        unit: what is counted: `activations` or `runs`.
        counted: how many activations (or runs, for odds of runs, sums, and tries in a run) were judged true or false.
        violated, unknown: how many of these are violations, and how many more are unknown.
        cut_off: activations left out because the log ends while they are open.
        worst: of the measures that are known, and of violations.
        bounded: judgements that are true or false although their measure is not known; None: there are none.
        interval: the lower and the upper limit of the probability that it holds; None without odds.
        limits: which ones these are, as in `odds.py`.
        confidence: that the requirement names; None if it names none, and each limit has 95 %.
        more: how many more runs (or activations) without a violation would decide; None: no known number would.
        violations: the first thousand of them.
        histogram: of the measures; None without any.
        timeline: the run of the worst violation; None without any.
        measures: to judge it again; None: not kept.
        by_run: the last 60 runs with a judgement, the earliest first.
        failed, halted: activations left out because the clause is about those that succeed.
        idle: in how many runs its node did not start, if it is about activations of one.
        not_applicable: how many activations, or runs, were left out because an assumption did not hold.
        pooled: of a clause about all runs together, from which its verdict follows; else None.
    """

    text: str
    path: str
    of: str
    verdict: Verdict
    why: str
    unit: Literal["activations", "runs", "occurrences"]
    counted: int
    violated: int
    unknown: int
    cut_off: int
    worst: Worst | None
    interval: tuple[float, float] | None
    limits: Limits
    confidence: float | None
    more: int | None
    violations: tuple[Violation, ...]
    histogram: Histogram | None
    timeline: Timeline | None = None
    measures: Measures | None = None
    bounded: Bounded | None = None
    by_run: tuple[RunValue, ...] = ()
    failed: int = 0
    halted: int = 0
    idle: int = 0
    pooled: Pooled | None = None
    not_applicable: int = 0


class RequirementLinks(Record):
    """What a requirement is connected with.

    Attributes:
        sources: where it is from.
        refines, mitigates: the IDs of requirements and of hazards.
        priority: empty without one.
        verified_by: the ways to verify it: `test TC-12`; a scenario is a test with its title.
    """

    sources: tuple[str, ...] = ()
    refines: tuple[str, ...] = ()
    mitigates: tuple[str, ...] = ()
    priority: str = ""
    verified_by: tuple[str, ...] = ()

    @classmethod
    def of(cls, requirement: ResolvedRequirement, scenarios: Sequence[str]) -> RequirementLinks:
        """Those of a requirement; scenarios: the titles of those that verify it."""
        declared = (f"{way.method} {way.id or ''}".rstrip() for way in other_ways(requirement, scenarios))
        ways = tuple(dict.fromkeys((*declared, *(f"test {title}" for title in scenarios))))
        sources = tuple(" ".join(source.split()) for source in requirement.sources)
        return cls(sources, requirement.refines, requirement.mitigates, requirement.priority or "", ways)

    @property
    def named(self) -> dict[str, str | tuple[str, ...]]:
        """Those that there are, by their names."""
        return {name: value for name, value in as_dict(self).items() if value}


class RequirementVerdict(Record):
    """A requirement; its verdict is the worst of its clauses.

    Attributes:
        links: unknown, and so empty, by a store.
        fingerprints: of what it meant when it was judged, by a store perhaps several; empty: unknown.
        is_suspect: whether it means something else now.
    """

    id: str
    title: str
    verdict: Verdict
    clauses: tuple[ClauseVerdict, ...]
    links: RequirementLinks = RequirementLinks()
    fingerprints: tuple[str, ...] = ()
    is_suspect: bool = False


class EvidenceFile(Record):
    """A file that was read.

    Attributes:
        runs, first_run: how many runs of the mission are in it, and the number of the first.
        begin, end: of the first and the last of them, in µs since the epoch; None without any.
        identity: how the nodes were found in the mission.
        joined, nodes: how many of the log's nodes were found, and how many there are.
        remarks: notes about the file.
        left_out: the numbers in the file of runs that are counted in another one.
        unjoined: the nodes of the log and of the mission that were not found in the other, in words.
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
    left_out: tuple[int, ...] = ()
    unjoined: tuple[str, ...] = ()


class NodeSummary(Record):
    """A node of the logs.

    Attributes:
        path, kind: the engine's path of it, and the ID it is registered under.
        runs: in how many runs it was active.
        succeeded, failed, halted, interrupted: how many of its activations.
        failures_began: in how many failed runs the failure began at it.
        p50, p95: percentiles of the known durations of its activations with a result, in seconds; None without any.
        bounded, longest: how many more have a result and no known duration, and how long any of those took at most, in
            seconds; None if the log does not say.
        tick_p95, tick_worst: durations of its `tick()`, in seconds, if the log shows them; else None.
        written: the written node; None if the mission does not have it.
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
    bounded: int
    longest: float | None
    tick_p95: float | None
    tick_worst: float | None
    written: ResolvedNode | None


class Repeats(Record):
    """How often something was repeated: in total, in the run with the most, and that run; None if it never was."""

    total: int
    most: int
    run: int | None


class ContextSummary(Record):
    """In how many runs a context held, and in how many others that is unknown."""

    name: str
    runs: int
    unknown: int


class MissionVerdicts(Record):
    """A mission with the logs by which it was judged.

    Attributes:
        file: of the mission.
        outcomes: how many runs had each outcome.
        ended_by: how many of the failed ones the guard of each requirement ended; `*`: a halt, where the log does not
            say what asked for it.
        nodes: of the logs, in the order of their uids.
        contexts: of the mission, in the order of definition.
        retries: by Retry nodes and Nav2's RecoveryNodes.
        recoveries: by RecoveryNodes between two tries.
        outline: of its trees; empty without measures.
    """

    name: str
    file: str
    sources: tuple[EvidenceFile, ...]
    requirements: tuple[RequirementVerdict, ...]
    outcomes: tuple[tuple[str, int], ...]
    nodes: tuple[NodeSummary, ...]
    contexts: tuple[ContextSummary, ...]
    retries: Repeats
    recoveries: Repeats
    outline: str = ""
    ended_by: tuple[tuple[str, int], ...] = ()

    @property
    def runs(self) -> int:
        """How many runs were judged."""
        return sum(source.runs for source in self.sources)

    @property
    def medians(self) -> dict[str, float]:
        """The median durations of nodes, in seconds by path."""
        return {node.path: node.p50 for node in self.nodes if node.p50 is not None}


class Foreign(Record):
    """Runs that are not judged.

    Attributes:
        of: what they belong to: another mission, or one of several.
        difference: how the nearest mission and the tree of the log differ; empty if one of them is unknown.
        unjoined: the nodes that have other names there, in words, where the log has no tree.
    """

    file: str
    runs: int
    of: str
    difference: str
    unjoined: tuple[str, ...] = ()


class VerdictReport(Record):
    """All that `btq verify` found.

    Attributes:
        missions: those that have logs.
        problems: the files that could not be read, each with the reason.
        remarks: notes about the samples, and about labels that the store had.
    """

    missions: tuple[MissionVerdicts, ...]
    foreign: tuple[Foreign, ...]
    problems: tuple[str, ...]
    remarks: tuple[str, ...] = ()

    @property
    def verdicts(self) -> frozenset[Verdict]:
        """The verdicts that occur."""
        return frozenset(requirement.verdict for mission in self.missions for requirement in mission.requirements)


def worst_of(verdicts: Iterable[Verdict]) -> Verdict:
    """The worst of several verdicts; `never exercised` only if all of them are."""
    return min(verdicts, key=WORST_FIRST.index, default=NEVER)
