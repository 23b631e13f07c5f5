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
    from literal_runs import Moment

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
        guards: the nodes that a build has put around others, with the requirement of each.

    Attributes:
        changes: the moments at which anything changes: rows, samples, and samples that grow too old.
    """

    def __init__(
        self,
        tree: LoggedTree,
        subtrees: frozenset[int],
        rows: Sequence[Transition],
        samples: Samples,
        signals: Mapping[str, Signal],
        instances: Callable[[Target], list[int]],
        guards: Mapping[int, str],
    ) -> None:
        self.tree = tree
        self.subtrees = subtrees
        self.samples = samples
        self.instances = instances
        self.guards = guards
        self.activations = activations(tree, rows)
        self.runs = self.of(ROOT)
        self.changes = {each.start for each in self.activations}
        self.changes |= {(each.begin, each.first + 1) for each in self.activations}
        self.changes |= {(each.end, each.last + 1) for each in self.activations}
        for name, series in samples.items():
            self.changes.update((time, -1) for time, _ in series)
            if (fresh := signals[name].fresh) is not None:
                self.changes.update((time + micros(fresh) + 1, -1) for time, _ in series)

    def moments(self, a: Activation) -> list[Moment]:
        """Those of an activation at which something may change: rows, samples, and samples that grow too old."""
        return sorted({a.start, *(each for each in self.changes if a.start < each <= a.stop)})

    def holds(self, condition: Condition | None, moment: Moment, a: Activation) -> Truth:
        """Whether a condition holds at a time of an activation."""
        match condition:
            case Flag(value):
                return value
            case Read(signal):
                value = self.sample(signal, moment[0])
                return None if value is None else bool(value)
            case InContext(_, inner):
                return self.holds(inner, moment, a)
            case Not(inner):
                return negated(self.holds(inner, moment, a), True)
            case All(parts):
                return both(*(self.holds(part, moment, a) for part in parts))
            case Any(parts):
                return either(*(self.holds(part, moment, a) for part in parts))
            case Running(target):
                near = [each for uid in self.nearest(a.uid, self.uids(target)) for each in self.of(uid)]
                return either(*(self.is_running(each, moment) for each in near))
            case Compare(operators, operands):
                values = [self.number(operand, moment, a) for operand in operands]
                return both(
                    *(compare(operator, *pair) for operator, pair in zip(operators, pairwise(values), strict=True))
                )
        raise AssertionError(condition)

    def is_running(self, a: Activation, moment: Moment) -> Truth:
        """Whether an activation is open, from its first row to its last one."""
        if not a.start <= moment <= a.stop:
            return False
        return True if a.is_exact or moment == a.start else None

    def number(self, number: Number | Bounded | None, moment: Moment, a: Activation) -> SampleValue | None:
        """A value in SI, at a time."""
        match number:
            case Value(_, si):
                return si
            case Flag(value) | Text(value):
                return value
            case Read(signal):
                return self.sample(signal, moment[0])
            case Minus(operand):
                value = self.number(operand, moment, a)
                return None if value is None else -value
            case Arithmetic(operator, left, right):
                one, other = self.number(left, moment, a), self.number(right, moment, a)
                if one is None or other is None or (operator == "/" and other == 0):
                    return None
                return {"+": one + other, "-": one - other, "*": one * other, "/": other and one / other}[operator]
            case Table(cases):
                for case in cases:
                    holds = True if case.condition is None else self.holds(case.condition, moment, a)
                    if holds is None:
                        return None
                    if holds:
                        return self.number(case.value, moment, a)
            case Aggregate(function, signal):
                return self.aggregate(function, signal, a)
        raise AssertionError(number)

    def sample(self, signal: Signal, time: int) -> SampleValue | None:
        """The last sample up to a time, unless it is too old; before the first `initially`."""
        earlier = [each for each in self.samples.get(signal.name, ()) if each[0] <= time]
        if not earlier:
            return self.number(signal.initially, (time, 0), self.runs[0]) if signal.initially is not None else None
        at, value = earlier[-1]
        return None if signal.fresh is not None and time - at > micros(signal.fresh) else value

    def aggregate(self, function: str, signal: Signal, a: Activation) -> float | None:
        """Over what a signal was in an activation: as it began, if that is known, and each sample since; `count` of
        samples alone."""
        if function == "count":
            times = {time for time, _ in self.samples.get(signal.name, ()) if a.begin <= time <= a.end}
            is_unclear = not a.is_exact and any(time > a.begin for time in times)
            return None if is_unclear or not self.samples.get(signal.name) else len(times)
        sampled = [time for time, _ in self.samples.get(signal.name, ()) if a.begin < time <= a.end]
        times = sorted({a.begin, *(time for time, _ in self.changes if a.begin < time <= a.end)})
        known = [(time, self.sample(signal, time)) for time in times]
        while known and known[0][1] is None:
            known.pop(0)
        values = [value for time, value in known if time == a.begin or time in sampled]
        if not values or any(value is None for _, value in known) or (sampled and not a.is_exact):
            return None
        if function == "change":
            return values[-1] - values[0]
        if function == "p95":
            return sorted(values)[-(-len(values) * 95 // 100) - 1]
        return {"max": max, "min": min, "mean": statistics.fmean, "stddev": statistics.pstdev}[function](values)

    def uids(self, subject: Target | Mission | None) -> list[int]:
        """The instances of a node; the mission is the written root, never a wrapper."""
        if isinstance(subject, Target):
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
