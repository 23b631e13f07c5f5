"""What happened in each step of the time, and what clauses measured: by run while there are few, else by step.

A step is a minute, an hour, a day or some weeks, by the length of the time.

One invariant: the engine counts; at most as many values of a clause are loaded as its drawing has places.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter
from typing import Final, Literal, TypeAlias

from btq_lang.catalog.units import ONE, Unit, parse_unit
from btq_lang.evidence.store.queries import OVERVIEW, Ask, Row
from btq_lang.evidence.wording import measured as written
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record, replace
from btq_lang.util.text import counted

MeasureKind: TypeAlias = Literal["worst", "mean", "rate"]
Values: TypeAlias = tuple[float | None, ...]  # of the steps in order; None where there is nothing to say


class Steps(Record):
    """How the time is parted.

    Attributes:
        origin: when the first step begins, in µs since the epoch.
        length: of a step, in µs.
        number: of steps.
        name: of a step: `day`.
    """

    origin: int
    length: int
    number: int
    name: str

    def begin(self, place: int) -> int:
        """When a step begins."""
        return self.origin + place * self.length


class Trends(Record):
    """A mission over time, each as a share or a number of each step.

    Attributes:
        failed: the share of runs that failed.
        retries, recoveries: of each run.
        violated: by requirement, the share of judgements that are violations.
    """

    runs: Values
    failed: Values
    retries: Values
    recoveries: Values
    violated: Mapping[str, Values]


def steps_of(first: int, last: int) -> Steps:
    """The steps between two times, in µs since the epoch: as short as their number allows."""
    fitting = ((length, name) for length, name in _LENGTHS if last - first < _MOST * length)
    week, _ = _LENGTHS[-1]
    weeks = -(-(last - first) // (_MOST * week))
    length, name = next(fitting, (week * weeks, counted(weeks, "week")))
    origin = first - (first - _MONDAY) % length
    return Steps(origin, length, (last - origin) // length + 1, name)


def trends(ask: Ask, steps: Steps) -> Mapping[str, Trends]:
    """The trends of each mission."""
    words = {"origin": steps.origin, "step": steps.length}
    runs, verdicts = (
        grouped((row["mission"], row) for row in ask(OVERVIEW[name].format(**words))) for name in ("runs", "verdicts")
    )
    return {mission: _trends(rows, verdicts.get(mission, ()), steps) for mission, rows in runs.items()}


def _trends(runs: Sequence[Row], verdicts: Sequence[Row], steps: Steps) -> Trends:
    return Trends(
        runs=_values(runs, steps, lambda row: row["runs"]),
        failed=_values(runs, steps, lambda row: row["failed"] / row["runs"]),
        retries=_values(runs, steps, lambda row: row["retries"] / row["runs"]),
        recoveries=_values(runs, steps, lambda row: row["recoveries"] / row["runs"]),
        violated={
            name: _values(rows, steps, lambda row: row["violated"] / row["judged"])
            for name, rows in grouped((row["requirement"], row) for row in verdicts).items()
        },
    )


def _values(rows: Sequence[Row], steps: Steps, value: Callable[[Row], float]) -> Values:
    by_place = {int(row["place"]): float(value(row)) for row in rows}
    return tuple(by_place.get(place) for place in range(steps.number))


class MeasureTrend(Record):
    """What a clause measured.

    Attributes:
        node: where it is judged.
        by: what each place is: `run`, or a step of the time: `day`.
        starts: of the places, in µs since the epoch.
        what: `worst`: of each place the value furthest beyond the bound, or closest to it; `mean`; `rate`: how many
            failures in the time that it is demanded for.
        values: of the places.
        medians: of each step; None by run.
        levels: the bounds and the goal, in SI, each with what it is.
        labels: in which place the first run of each begins.
        period: of a rate, the time that it is demanded for.
    """

    requirement: str
    clause: str
    node: str
    unit: Unit
    by: str
    starts: tuple[int, ...]
    what: MeasureKind
    values: Values
    medians: Values | None
    levels: tuple[tuple[str, float], ...]
    labels: tuple[tuple[str, float], ...]
    period: str = ""


def measures(ask: Ask, steps: Steps, labels: Sequence[tuple[str, int]]) -> Mapping[str, Sequence[MeasureTrend]]:
    """What the clauses of each mission measured, in the order of the clauses.

    Args:
        labels: in the order of time, with when the first run of each began.
    """
    words = {"origin": steps.origin, "step": steps.length, "runs": FEW_RUNS}
    of_clause = itemgetter("mission", "requirement", "clause", "node")
    runs, times, mean_runs, pooled = (
        grouped((of_clause(row), row) for row in ask(OVERVIEW[name].format(**words)))
        for name in ("measured_runs", "measured_steps", "mean_runs", "pooled_steps")
    )
    of_missions = []
    clauses = [*ask(OVERVIEW["measured"]), *ask(OVERVIEW["rates"])]
    for row in sorted(clauses, key=itemgetter("mission", "clause_index", "requirement", "clause", "node")):
        key = of_clause(row)
        trend: MeasureTrend | None = None
        if row.get("rate_seconds") is not None:
            trend = _rates(row, pooled.get(key, ()), steps, labels)
        elif row["mean_strict"] is not None and key in mean_runs:
            trend = _by_run(row, mean_runs[key], "mean")
        elif row["mean_strict"] is not None:
            trend = _by_step(row, pooled[key], steps, labels, "mean", "mean_si")
        elif key in runs:
            trend = _by_run(row, runs[key], "worst")
        elif key in times:
            trend = _by_step(row, times[key], steps, labels, "worst", "worst_si", "median_si")
        of_missions += [(row["mission"], trend)] if trend is not None else []
    return grouped(of_missions)


def _rates(clause: Row, rows: Sequence[Row], steps: Steps, labels: Sequence[tuple[str, int]]) -> MeasureTrend | None:
    """The failure rate of each step of the time; None without any time."""
    period = clause["rate_seconds"]
    of_steps = [{**row, "rate": row["number"] / row["seconds"] * period} for row in rows if row["seconds"]]
    trend = _by_step({**clause, "unit": None}, of_steps, steps, labels, "rate", "rate") if of_steps else None
    return replace(trend, period=written(period, parse_unit(clause["unit"] or "s"))) if trend is not None else None


def _by_run(clause: Row, rows: Sequence[Row], what: MeasureKind) -> MeasureTrend:
    rows = sorted(rows, key=itemgetter("run_start_us", "log", "run"))
    labels: dict[str, float] = {}
    for place, row in enumerate(rows):
        labels.setdefault(row["run_label"], place)
    starts, values = (tuple(row[name] for row in rows) for name in ("run_start_us", "measured_si"))
    return _measured(clause, "run", starts, what, values, None, tuple(labels.items()))


def _by_step(
    clause: Row,
    rows: Sequence[Row],
    steps: Steps,
    labels: Sequence[tuple[str, int]],
    what: MeasureKind,
    value: str,
    median: str | None = None,
) -> MeasureTrend:
    """The values of each step of the time.

    Args:
        value, median: their columns.
    """
    by_place = {int(row["place"]): row for row in rows}
    values, medians = (
        tuple(by_place[place][name] if place in by_place else None for place in range(steps.number)) if name else None
        for name in (value, median)
    )
    assert values is not None, "they have a column"
    starts = tuple(map(steps.begin, range(steps.number)))
    began = tuple((name, (start - steps.origin) / steps.length) for name, start in labels)
    return _measured(clause, steps.name, starts, what, values, medians, began)


def _measured(
    clause: Row,
    by: str,
    starts: tuple[int, ...],
    what: MeasureKind,
    values: Values,
    medians: Values | None,
    labels: tuple[tuple[str, float], ...],
) -> MeasureTrend:
    both = [("lower bound", clause["lower_si"]), ("upper bound", clause["upper_si"])]
    levels = [(kind, si) for kind, si in both if si is not None]
    if what == "rate" and len(levels) == 1:
        levels = [("bound", levels[0][1])]
    levels = levels or [("bound", si) for si in dict.fromkeys((clause["least_si"], clause["most_si"]))]
    if clause["goal_si"] is not None:
        levels.append(("goal", clause["goal_si"]))
    unit = parse_unit(clause["unit"]) if clause["unit"] else ONE
    assert unit is not None, "a unit of the table, as it was written"
    whose = clause["requirement"], clause["clause"], clause["node"], unit
    return MeasureTrend(*whose, by, starts, what, values, medians, tuple(levels), labels)


_DAY: Final = 86_400_000_000  # µs
_LENGTHS: Final = ((_DAY // 1440, "minute"), (_DAY // 24, "hour"), (_DAY, "day"), (7 * _DAY, "week"))
_MOST: Final = 40  # steps
_MONDAY: Final = 4 * _DAY  # the first one of the epoch
FEW_RUNS: Final = 60
