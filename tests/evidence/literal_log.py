"""What signals were, whether conditions held and which nodes ran, over lists of all samples and all activations.

Truth is three-valued: None is unknown.  Nothing of `btq_lang.evidence` is used but the shapes of what a log says.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

from literal_begins import Begins
from literal_runs import Activation, activations

from btq_lang.evidence.model import ROOT, LoggedTree
from btq_lang.requirements.model import (
    Age,
    Aggregate,
    All,
    Any,
    Arithmetic,
    Compare,
    Flag,
    InContext,
    Minus,
    Negation,
    NodeTarget,
    Quantity,
    ResolvedTable,
    Running,
    SignalRead,
    TextValue,
)

if TYPE_CHECKING:
    from literal_runs import Moment

    from btq_lang.evidence.model import SampleValue, Transition
    from btq_lang.requirements.model import Bounded, Condition, MissionRun, Number, ResolvedSignal

    Measure = Callable[[Sequence[float]], float]
    Truth = bool | None
    Samples = Mapping[str, Sequence[tuple[int, SampleValue]]]


class Log:
    """A session, all of it.

    Args:
        end: which end of the interval in which it began is the begin of an activation: all is judged at both.
        subtrees: which of the tree's nodes are SubTree nodes.
        delays: how long each Delay waits, in µs.
        samples: by signal, in SI, in the order of their times.
        signals: all of the mission, by name.
        instances: the uids of the instances of a written node.
        guards: the nodes that a build has put around others, with the requirement of each.
        ages: with which times, in µs, the age of each signal is compared.

    Attributes:
        changes: the moments at which anything changes: rows, samples, and samples that grow too old.
    """

    def __init__(
        self,
        end: Literal["earliest", "latest"],
        tree: LoggedTree,
        subtrees: frozenset[int],
        delays: Mapping[int, int],
        rows: Sequence[Transition],
        samples: Samples,
        signals: Mapping[str, ResolvedSignal],
        instances: Callable[[NodeTarget], list[int]],
        guards: Mapping[int, str],
        ages: Mapping[str, Collection[int]],
    ) -> None:
        self.ages = ages
        self.tree = tree
        self.subtrees = subtrees
        self.samples = samples
        self.instances = instances
        self.guards = guards
        self.activations = activations(tree, rows)
        Begins(tree, subtrees, delays, rows, self.activations).set()
        for each in self.activations:
            each.start = each.earliest if end == "earliest" else each.latest
        self.runs = self.of(ROOT)
        self.changes = {each.start for each in self.activations}
        self.changes |= {just_after(each.start) for each in self.activations}
        self.changes |= {just_after(each.stop) for each in self.activations}
        for name, series in samples.items():
            self.changes.update((time, -1) for time, _ in series)
            self.changes.update((time + age, -1) for time, _ in series for age in self.passed(name))
            if (fresh := signals[name].fresh) is not None:
                self.changes.update((time + micros(fresh) + 1, -1) for time, _ in series)

    def moments(self, a: Activation) -> list[Moment]:
        """Those of an activation at which something may change: rows, samples, and samples that grow too old."""
        old = {(a.begin + age, -1) for name in self.ages for age in self.passed(name)}
        return sorted({a.start, *(each for each in self.changes | old if a.start < each <= a.stop)})

    def passed(self, name: str) -> set[int]:
        """The ages of a signal at which it has reached, and passed, what it is compared with."""
        return {age + more for age in self.ages.get(name, ()) for more in (0, 1)}

    def holds(self, condition: Condition | None, moment: Moment, a: Activation, *, initially: bool = False) -> Truth:
        """Whether a condition holds at a time of an activation; initially: see `sample`.

        What a clause itself demands never reads `initially`, whatever the names of its contexts: `initially` is no
        measurement.  What says which time or which activations are asked about does: `while`, `when`, the cases of a
        value table, and events.
        """
        match condition:
            case Flag(value):
                return value
            case SignalRead(signal):
                sample = self.sample(signal, moment[0], initially=initially)
                return None if sample is None else bool(sample)
            case InContext(_, inner):
                return self.holds(inner, moment, a, initially=initially)
            case Negation(inner):
                return negated(self.holds(inner, moment, a, initially=initially), True)
            case All(parts):
                return both(*(self.holds(part, moment, a, initially=initially) for part in parts))
            case Any(parts):
                return either(*(self.holds(part, moment, a, initially=initially) for part in parts))
            case Running(target):
                near = [each for uid in self.nearest(a.uid, self.uids(target)) for each in self.of(uid)]
                return either(*(self.is_running(each, moment) for each in near))
            case Compare(operators, operands):
                values = [self.number(operand, moment, a, initially=initially) for operand in operands]
                return both(
                    *(compare(operator, *pair) for operator, pair in zip(operators, pairwise(values), strict=True))
                )
        raise AssertionError(condition)

    def is_running(self, a: Activation, moment: Moment) -> Truth:
        """Whether an activation is open, from its begin to its last row."""
        if not a.start <= moment <= a.stop:
            return False
        return True if a.is_exact or moment == a.start else None

    def number(
        self, number: Number | Bounded | None, moment: Moment, a: Activation, *, initially: bool = False
    ) -> SampleValue | None:
        """A value in SI, at a time; initially: see `sample`."""
        match number:
            case Quantity(_, si):
                return si
            case Flag(value) | TextValue(value):
                return value
            case SignalRead(signal):
                return self.sample(signal, moment[0], initially=initially)
            case Minus(operand):
                amount = self.amount(operand, moment, a, initially=initially)
                return None if amount is None else -amount
            case Arithmetic(operator, left, right):
                one, other = (self.amount(each, moment, a, initially=initially) for each in (left, right))
                if one is None or other is None or (operator == "/" and other == 0):
                    return None
                return {"+": one + other, "-": one - other, "*": one * other, "/": other and one / other}[operator]
            case ResolvedTable(cases):
                for case in cases:
                    holds = case.condition is None or self.holds(case.condition, moment, a, initially=True)
                    if holds is None:
                        return None
                    if holds:
                        return self.number(case.value, moment, a, initially=True)
            case Age(signal):
                series = [time for time, _ in self.samples.get(signal.name, ())]
                since = max((time for time in series if time <= moment[0]), default=a.begin)
                return (moment[0] - since) / 1e6 if series else None
            case Aggregate(function, signal):
                return self.aggregate(function, signal, a)
        raise AssertionError(number)

    def amount(
        self, number: Number | Bounded, moment: Moment, a: Activation, *, initially: bool = False
    ) -> float | None:
        """`number`, of what is counted with."""
        value = self.number(number, moment, a, initially=initially)
        return None if value is None else as_amount(value)

    def sample(self, signal: ResolvedSignal, time: int, *, initially: bool = False) -> SampleValue | None:
        """The last sample up to a time, unless it is too old.

        Args:
            initially: before the first of the samples, which there are, it is what `initially` says.
        """
        series = self.samples.get(signal.name, ())
        earlier = [each for each in series if each[0] <= time]
        if not earlier:
            may_read = initially and series and signal.initially is not None
            return self.number(signal.initially, (time, 0), self.runs[0]) if may_read else None
        at, value = earlier[-1]
        return None if signal.fresh is not None and time - at > micros(signal.fresh) else value

    def aggregate(self, function: str, signal: ResolvedSignal, a: Activation) -> float | None:
        """Over what a signal was in an activation: as it began, if a sample tells that, and each sample since; `count`
        of samples alone."""
        if function == "count":
            counted = {time for time, _ in self.samples.get(signal.name, ()) if a.begin <= time <= a.end}
            is_unclear = not a.is_exact and any(time > a.begin for time in counted)
            return None if is_unclear or not self.samples.get(signal.name) else len(counted)
        sampled = [time for time, _ in self.samples.get(signal.name, ()) if a.begin < time <= a.end]
        times = sorted({a.begin, *(time for time, _ in self.changes if a.begin < time <= a.end)})
        known = [(time, self.sample(signal, time)) for time in times]
        while known and known[0][1] is None:
            known.pop(0)
        values = [as_amount(value) for time, value in known if value is not None and time in (a.begin, *sampled)]
        if not values or any(value is None for _, value in known) or (sampled and not a.is_exact):
            return None
        if function == "change":
            return values[-1] - values[0]
        if function == "p95":
            return sorted(values)[-(-len(values) * 95 // 100) - 1]
        measures: dict[str, Measure] = {"max": max, "min": min, "mean": statistics.fmean, "stddev": statistics.pstdev}
        return measures[function](values)

    def uids(self, subject: NodeTarget | MissionRun | None) -> list[int]:
        """The instances of a node; the mission is the written root, never a wrapper."""
        if isinstance(subject, NodeTarget):
            return self.instances(subject)
        return next([uid] for uid in self.tree.nodes if uid not in self.guards)

    def of(self, uid: int) -> list[Activation]:
        """What one of them did."""
        return [each for each in self.activations if each.uid == uid]

    def nearest(self, uid: int, others: Sequence[int]) -> list[int]:
        """Those that share the most subtree instances with a node."""
        shared = {other: len(self.inside(uid) & self.inside(other)) for other in others}
        return [other for other in others if shared[other] == max(shared.values())]

    def inside(self, uid: int) -> set[int]:
        """The SubTree nodes that a node is inside of."""
        found: set[int] = set()
        while uid := self.tree.parent[uid]:
            found |= {uid} & self.subtrees
        return found


def just_after(moment: Moment) -> Moment:
    """A moment with nothing between it and that one."""
    return moment[0], moment[1] + 0.1


def both(*truths: Truth) -> Truth:
    return False if False in truths else None if None in truths else True


def either(*truths: Truth) -> Truth:
    return True if True in truths else None if None in truths else False


def negated(truth: Truth, is_negated: bool) -> Truth:
    return truth if truth is None or not is_negated else not truth


def compare(operator: str, one: SampleValue | None, other: SampleValue | None) -> Truth:
    if one is None or other is None:
        return None
    if operator in ("==", "!="):
        return (one == other) == (operator == "==")
    left, right = as_amount(one), as_amount(other)
    return {"<": left < right, "<=": left <= right, ">": left > right, ">=": left >= right}[operator]


def as_amount(value: SampleValue) -> float:
    """A value that is counted with; texts are compared alone."""
    assert not isinstance(value, str)
    return value


def micros(seconds: float) -> int:
    return round(seconds * 1e6)
