"""The changes between two sides of a store, as data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

from btq_lang.catalog.units import parse_unit
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.compare.requirements import Edited, Newly

Over: TypeAlias = Literal["runs", "runs of each robot", "robots"]
Finding: TypeAlias = Literal["", "slower", "faster", "higher", "lower", "less reliable", "more reliable"]


class Key(NamedTuple):
    """What is compared: a node, or a clause at a node.

    Attributes:
        requirement, clause: empty where it is about the node alone.
    """

    requirement: str
    clause: str
    node: str

    @property
    def name(self) -> str:
        """The node, or the clause with its node."""
        if not self.requirement:
            return self.node
        return f"{self.requirement}: {self.clause}" + (f" at {self.node}" if self.node else "")


class ComparedNumber(Record):
    """A number that is compared.

    Attributes:
        requirement, clause, node: as in `Key`.
        what: `mean` of a measure, by run; `failures`: the share of runs with a failure or a violation; `rate`: of
            failures, per second.
        unit: that the measure is shown in, or of a rate its time; values are in SI.
        before, after: the number on each side; of several robots, the average over those that ran both.
        interval: the 95 % interval of the difference, `after` less `before`; None where the spread is unknown.
        counts: how many values, or runs, each side has.
        units: how many runs, groups of runs or robots with such values each side has.
        failed: in how many of the runs it failed, or was violated; of a rate how often; None for a measure.
        p_alone: the probability of such a difference by chance, if nothing else were compared.
        p: the same after Holm.
        too_few: so few runs or robots cannot show any change.
        finding: what is certain and large enough to be called a change; else empty.
        same: what was closed by the same completions, and so is the same comparison.
        cause: what explains the difference, inside of this node; None where nothing does.
        exposures: of a rate, how long each side might have failed, in seconds; `period`: the time that it is for.
    """

    requirement: str
    clause: str
    node: str
    what: Literal["mean", "failures", "rate"]
    unit: str
    before: float
    after: float
    interval: tuple[float, float] | None
    counts: tuple[int, int]
    units: tuple[int, int]
    failed: tuple[int, int] | None
    p_alone: float
    p: float
    too_few: bool
    finding: Finding
    same: tuple[Key, ...]
    cause: Key | None
    exposures: tuple[float, float] | None = None
    period: float | None = None

    @property
    def key(self) -> Key:
        return Key(self.requirement, self.clause, self.node)

    @property
    def name(self) -> str:
        return self.key.name

    @property
    def difference(self) -> float:
        return self.after - self.before

    def is_at_least(self, share: float) -> bool:
        """Whether the numbers differ by such a share of the first."""
        return abs(self.difference) >= share * abs(self.before) * (1 - _ROUNDING) and self.before != self.after

    @property
    def direction(self) -> Finding:
        """The word for the difference if it is a change."""
        is_more = self.after > self.before
        if self.what != "mean":
            return "less reliable" if is_more else "more reliable"
        if is_time(self.unit):
            return "slower" if is_more else "faster"
        return "higher" if is_more else "lower"


class RunComparison(Record):
    """The changes in a mission; one that only one side ran has no comparison.

    Attributes:
        runs, robots: how many each side has.
        times: when the first run of each side began and its last one ended, in µs since the epoch; None without runs.
        labels: how many runs of each label each side has, if robots are compared that ran several; else empty.
        over: what is shuffled.  Where a side has several robots, `runs of each robot`, as far as they ran both sides;
            `robots` where each side has some of its own.
        group: how many runs are shuffled together; 1 without groups.
        at_least: the share of the first side's number from which on a difference is called a change.
        one_sided: how many nodes were active on each side and not on the other, so that nothing compares them.
        newly, no_longer: the requirements that only the second side violates, and only the first.
        only: the requirements that only the first side has, and only the second.
        unknown: the requirements of both sides that the logs of neither could judge.
        edited: the clauses whose bounds differ, so that their verdicts are no changes.
        changes: all that was compared.
    """

    mission: str
    runs: tuple[int, int]
    robots: tuple[int, int]
    times: tuple[tuple[int, int] | None, tuple[int, int] | None]
    labels: tuple[Mapping[str, int], ...]
    over: Over
    group: int
    at_least: float
    one_sided: tuple[int, int]
    newly: tuple[Newly, ...]
    no_longer: tuple[Newly, ...]
    only: tuple[tuple[str, ...], tuple[str, ...]]
    unknown: tuple[str, ...]
    edited: tuple[Edited, ...]
    changes: tuple[ComparedNumber, ...]

    @property
    def is_worse(self) -> bool:
        """Whether something is slower, less reliable, or newly violated and not by chance."""
        return not all(each.may_be_chance for each in self.newly) or any(each.finding in WORSE for each in self.changes)


def is_time(symbol: str) -> bool:
    """Whether a unit is one of time."""
    unit, second = parse_unit(symbol), parse_unit("s")
    return unit is not None and second is not None and unit.dimension == second.dimension


WORSE: Final = ("slower", "less reliable")
AT_LEAST: Final = 0.05
_ROUNDING: Final = 1e-9
