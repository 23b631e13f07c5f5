"""What happened in each step of the time: minutes, hours, days or weeks, by the length of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final, TypeAlias

from btq_lang.evidence.store.queries import OVERVIEW, Ask, Row
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record
from btq_lang.util.text import counted

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
    found = {int(row["place"]): float(value(row)) for row in rows}
    return tuple(found.get(place) for place in range(steps.number))


_DAY: Final = 86_400_000_000  # µs
_LENGTHS: Final = ((_DAY // 1440, "minute"), (_DAY // 24, "hour"), (_DAY, "day"), (7 * _DAY, "week"))
_MOST: Final = 40  # steps
_MONDAY: Final = 4 * _DAY  # the first one of the epoch
