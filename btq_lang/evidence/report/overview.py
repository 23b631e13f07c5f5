"""The contents of the page, as data.

One invariant: what is loaded are counts and the worst violation of each clause.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from btq_lang.evidence.compare.comparison import UnknownSide, compare
from btq_lang.evidence.compare.model import RunComparison
from btq_lang.evidence.meanings import NO_MEANINGS, Meanings
from btq_lang.evidence.report.trends import MeasureTrend, Steps, Trends, measures, steps_of, trends
from btq_lang.evidence.store.queries import OVERVIEW, Ask, Row, only
from btq_lang.evidence.store.summary import parted
from btq_lang.evidence.store.tables import quoted
from btq_lang.evidence.verdicts import VIOLATED, MissionVerdicts
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record


class RunGroup(Record):
    """Runs of a mission: those with a label, or those of a robot.

    Attributes:
        name: the label or the robot; empty if the runs have none.
        failed: how many runs failed.
        exercised: how many nodes of the tree were active, and how many it has; None if these runs had several trees.
    """

    name: str
    robots: int
    failed: int
    exercised: tuple[int, int] | None
    verdicts: MissionVerdicts

    @property
    def runs(self) -> int:
        return self.verdicts.runs

    @property
    def violated(self) -> int:
        """How many requirements are."""
        return sum(requirement.verdict == VIOLATED for requirement in self.verdicts.requirements)


class ReportedNode(Record):
    """A node; runs: of each part of the mission, how many of its runs are counted."""

    name: str
    runs: tuple[int, ...]


class MissionOverview(Record):
    """A mission.

    Attributes:
        parts: its labels in the order of time, or all runs as one.
        robots: that ran the last of them, those with the most violated requirements first; empty if not asked for.
        failures: where failures began, with the most of the last part first.
        nodes: in how many runs each was active, the fewest of the last part first.
        measures: what clauses measured over time, in the order of the clauses.
    """

    name: str
    parts: tuple[RunGroup, ...]
    robots: tuple[RunGroup, ...]
    failures: tuple[ReportedNode, ...]
    nodes: tuple[ReportedNode, ...]
    trends: Trends
    measures: tuple[MeasureTrend, ...]


class StoreOverview(Record):
    """A store.

    Attributes:
        labels: in the order of time, with when the first run of each began.
        by: what the runs are parted by.
        sides: the last two labels; None if there is one.
        comparisons: what changed between them, for each mission that was run with both.
    """

    store: str
    by: tuple[str, ...]
    labels: tuple[tuple[str, int], ...]
    steps: Steps
    missions: tuple[MissionOverview, ...]
    sides: tuple[str, str] | None
    comparisons: tuple[RunComparison, ...]

    @property
    def is_worse(self) -> bool:
        """Whether something got worse between the last two labels."""
        return any(comparison.is_worse for comparison in self.comparisons)


def overview(
    ask: Ask, store: str, by: Sequence[str], sides: Sequence[str] = (), meanings: Meanings = NO_MEANINGS
) -> StoreOverview:
    """The overview of a store.

    Args:
        ask: gives an engine a question.
        store: its name, as people read it.
        by: `label`, `robot` or both.
        sides: two labels to compare, which count as the last ones; none: the two that began last.
        meanings: as of `parted`.

    Raises:
        Unknown: one of `sides` has no runs, or no mission in common with the other.
    """
    rows = ask(OVERVIEW["labels"])
    names = [row["label"] for row in rows]
    if sides:
        names = [*(name for name in names if name not in sides), *sides]
    last = (names[-2], names[-1]) if len(names) > 1 else None
    try:
        comparisons = compare(ask, "label", last) if last is not None else ()
    except UnknownSide:
        if sides:
            raise
        comparisons = ()  # each mission was run with one of them
    steps = steps_of(min(row["first_us"] for row in rows), max(row["last_us"] for row in rows))
    labels_at = tuple((row["label"], row["first_us"]) for row in rows)
    of_time, measured = trends(ask, steps), measures(ask, steps, labels_at)
    failures, active = (grouped((row["mission"], row) for row in ask(OVERVIEW[name])) for name in ("failures", "nodes"))
    missions = []
    for name, parts in _parts(ask, store, names if "label" in by else None, meanings).items():
        labels = [part.name for part in parts] if "label" in by else None
        began, ran = (_nodes(rows_of.get(name, ()), labels) for rows_of in (failures, active))
        missions.append(
            MissionOverview(
                name=name,
                parts=tuple(parts),
                robots=tuple(_robots(ask, store, name, labels)) if "robot" in by else (),
                failures=tuple(sorted(began, key=lambda node: ([-number for number in node.runs[::-1]], node.name))),
                nodes=tuple(sorted(ran, key=lambda node: (node.runs[-1], node.name))),
                trends=of_time[name],
                measures=tuple(measured.get(name, ())),
            )
        )
    return StoreOverview(store, tuple(by), labels_at, steps, tuple(missions), last, comparisons)


def _parts(ask: Ask, store: str, labels: Sequence[str] | None, meanings: Meanings) -> dict[str, list[RunGroup]]:
    """The parts of each mission.

    Args:
        labels: in their order; None: all runs are one part.
    """
    by = ("label",) if labels is not None else ()
    exercised = {
        (row["mission"], row.get("label", "")): int(row["nodes"])
        for row in ask(OVERVIEW["exercised"].format(by=", ".join(("mission", *by))))
    }
    parts_of: dict[str, list[RunGroup]] = {}
    for row, verdicts in parted(ask, store, by, 1, meanings=meanings):
        label = row.get("label", "")
        part = _part(row, verdicts, label, exercised.get((row["mission"], label), 0))
        parts_of.setdefault(row["mission"], []).append(part)
    for parts in parts_of.values():
        parts.sort(key=lambda part: labels.index(part.name) if labels is not None else 0)
    return parts_of


def _robots(ask: Ask, store: str, mission: str, labels: Sequence[str] | None) -> Sequence[RunGroup]:
    """The robots that ran a mission, with its last label, those with the most violated requirements first, then those
    with the most failures.
    """
    runs = f"mission = {quoted(mission)}" + (f" AND label = {quoted(labels[-1])}" if labels is not None else "")
    robots = [_part(row, verdicts, row["robot"]) for row, verdicts in parted(only(ask, runs), store, ("robot",), 1)]
    return sorted(robots, key=lambda robot: (-robot.violated, -robot.failed / robot.runs, robot.name))


def _part(row: Row, verdicts: MissionVerdicts, name: str, exercised: int = 0) -> RunGroup:
    nodes = (exercised, int(row["nodes"])) if row["trees"] == 1 else None
    return RunGroup(name, int(row["robots"]), int(row["failed"]), nodes, verdicts)


def _nodes(rows: Iterable[Row], labels: Sequence[str] | None) -> list[ReportedNode]:
    """The runs of each node, by label or all together."""
    places = {label: place for place, label in enumerate(labels or ())}
    runs_of: dict[str, list[int]] = {}
    for row in rows:
        runs = runs_of.setdefault(row["node"] or "", [0] * max(len(places), 1))
        runs[places.get(row["label"], 0)] += int(row["runs"])
    return [ReportedNode(name, tuple(runs)) for name, runs in runs_of.items()]
