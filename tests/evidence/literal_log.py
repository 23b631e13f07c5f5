"""What signals were, whether conditions held and which nodes ran, over lists of all samples and all activations.

Truth is three-valued: None is unknown.  Nothing of `btq_lang.evidence` is used but the shapes of what a log says.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from literal_runs import Activation, activations

from btq_lang.evidence.model import ROOT, LoggedTree
from btq_lang.requirements.model import (
    Aggregate,
    All,
    Any,
    Arithmetic,
    Compare,
    Flag,
    InContext,
    Minus,
    Not,
    Read,
    Running,
    Table,
    Target,
    Text,
    Value,
)

if TYPE_CHECKING:
    from btq_lang.evidence.model import SampleValue, Transition
    from btq_lang.requirements.model import Bounded, Condition, Mission, Number, Signal

    Truth = bool | None
    Samples = Mapping[str, Sequence[tuple[int, SampleValue]]]


class Log:
    """A session, all of it.

    Args:
        subtrees: which of the tree's nodes are SubTree nodes.
        samples: by signal, in SI, in the order of their times.
        signals: all of the mission, by name.
        instances: the uids of the instances of a written node.

    Attributes:
        changes: the times at which anything changes: rows, samples, and samples that grow too old.
    """

    def __init__(
        self,
        tree: LoggedTree,
        subtrees: frozenset[int],
        rows: Sequence[Transition],
        samples: Samples,
        signals: Mapping[str, Signal],
        instances: Callable[[Target], list[int]],
    ) -> None:
        self.tree = tree
        self.subtrees = subtrees
        self.samples = samples
        self.instances = instances
        self.activations = activations(tree, rows)
        self.runs = self.of(ROOT)
        self.changes = {time for each in self.activations for time in (each.begin, each.end)}
        for name, series in samples.items():
            self.changes.update(time for time, _ in series)
            if (fresh := signals[name].fresh) is not None:
                self.changes.update(time + micros(fresh) + 1 for time, _ in series)

    def moments(self, begin: int, end: int) -> list[int]:
        """The times in [begin, end] at which something may change: samples, ones that grow too old, and rows."""
        return sorted({begin, *(time for time in self.changes if begin < time <= end)})

    def holds(self, condition: Condition | None, time: int, a: Activation) -> Truth:
        """Whether a condition holds at a time of an activation."""
        match condition:
            case Flag(value):
                return value
            case Read(signal):
                value = self.sample(signal, time)
                return None if value is None else bool(value)
            case InContext(_, inner):
                return self.holds(inner, time, a)
            case Not(inner):
                return negated(self.holds(inner, time, a), True)
            case All(parts):
                return both(*(self.holds(part, time, a) for part in parts))
            case Any(parts):
                return either(*(self.holds(part, time, a) for part in parts))
            case Running(target):
                return any(
                    each.begin <= time < each.end or (each.outcome == "O" and time == each.end)
                    for uid in self.uids(target)
                    for each in self.of(uid)
                )
            case Compare(operators, operands):
                values = [self.number(operand, time, a) for operand in operands]
                return both(
                    *(compare(operator, *pair) for operator, pair in zip(operators, pairwise(values), strict=True))
                )
        raise AssertionError(condition)

    def number(self, number: Number | Bounded | None, time: int, a: Activation) -> SampleValue | None:
        """A value in SI, at a time."""
        match number:
            case Value(_, si):
                return si
            case Flag(value) | Text(value):
                return value
            case Read(signal):
                return self.sample(signal, time)
            case Minus(operand):
                value = self.number(operand, time, a)
                return None if value is None else -value
            case Arithmetic(operator, left, right):
                one, other = self.number(left, time, a), self.number(right, time, a)
                if one is None or other is None or (operator == "/" and other == 0):
                    return None
                return {"+": one + other, "-": one - other, "*": one * other, "/": other and one / other}[operator]
            case Table(cases):
                for case in cases:
                    holds = True if case.condition is None else self.holds(case.condition, time, a)
                    if holds is None:
                        return None
                    if holds:
                        return self.number(case.value, time, a)
            case Aggregate(function, signal):
                return self.aggregate(function, signal, a)
        raise AssertionError(number)

    def sample(self, signal: Signal, time: int) -> SampleValue | None:
        """The last sample up to a time, unless it is too old; before the first `initially`."""
        earlier = [each for each in self.samples.get(signal.name, ()) if each[0] <= time]
        if not earlier:
            return self.number(signal.initially, time, self.runs[0]) if signal.initially is not None else None
        at, value = earlier[-1]
        return None if signal.fresh is not None and time - at > micros(signal.fresh) else value

    def aggregate(self, function: str, signal: Signal, a: Activation) -> float | None:
        """Over the samples of an activation."""
        values = sorted(value for time, value in self.samples.get(signal.name, ()) if a.begin <= time <= a.end)
        if function == "count":
            return len(values)
        if function == "change":
            one, other = self.sample(signal, a.begin), self.sample(signal, a.end)
            return None if one is None or other is None else other - one
        if not values:
            return None
        if function == "p95":
            return values[-(-len(values) * 95 // 100) - 1]
        return {"max": max, "min": min, "mean": statistics.fmean, "stddev": statistics.pstdev}[function](values)

    def uids(self, subject: Target | Mission | None) -> list[int]:
        """The instances of a node."""
        return self.instances(subject) if isinstance(subject, Target) else [ROOT]

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


def both(*truths: Truth) -> Truth:
    return False if False in truths else None if None in truths else True


def either(*truths: Truth) -> Truth:
    return True if True in truths else None if None in truths else False


def negated(truth: Truth, is_negated: bool) -> Truth:
    return truth if truth is None or not is_negated else not truth


def compare(operator: str, one: SampleValue | None, other: SampleValue | None) -> Truth:
    if one is None or other is None:
        return None
    return {
        "<": lambda: one < other,
        "<=": lambda: one <= other,
        ">": lambda: one > other,
        ">=": lambda: one >= other,
        "==": lambda: one == other,
        "!=": lambda: one != other,
    }[operator]()


def micros(seconds: float) -> int:
    return round(seconds * 1e6)
