"""What was observed during an activation or a run: the values of signals, and which nodes ran.

One invariant: an answer is a value in SI, or the reason why it is unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import fsum, sqrt
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.model import UNKNOWN_END, Activation, Moment, SampleValue
from btq_lang.evidence.signals import Signals, UnknownValue
from btq_lang.requirements.model import (
    Age,
    Compare,
    InContext,
    Quantity,
    ResolvedSignal,
    Running,
    SignalRead,
    parts_in,
)

if TYPE_CHECKING:
    from btq_lang.evidence.history import Nearby


class Observed:
    """The observations from one moment to another.

    Attributes:
        nodes: complete only when the run has ended.
        begin, end: of the activation, or of the run.
        is_end_known: otherwise the activation ended at `end` or before.
        is_early: all nodes began as early as they may have, not as late.
        reads_initial: signals have their values `initially` before their first samples.
    """

    __slots__ = (
        "_contexts",
        "_in_scope",
        "begin",
        "end",
        "is_early",
        "is_end_known",
        "nodes",
        "reads_initial",
        "signals",
    )

    def __init__(
        self,
        signals: Signals,
        nodes: Nearby,
        begin: Moment,
        end: Moment,
        is_end_known: bool = True,
        *,
        is_early: bool = False,
        reads_initial: bool = False,
    ) -> None:
        self.signals: Final = signals
        self.is_early: Final = is_early
        self.reads_initial: Final = reads_initial
        self._in_scope: Observed | None = None
        self.nodes: Final = nodes
        self._contexts: dict[tuple[str, Moment], bool | UnknownValue] | None = None
        self.begin: Final = begin
        self.end: Final = end
        self.is_end_known: Final = is_end_known

    @property
    def in_scope(self) -> Observed:
        """The same, where signals have their values `initially` before their first samples: for conditions that say
        what a requirement is about, not whether it is satisfied.
        """
        if self.reads_initial:
            return self
        if self._in_scope is None:
            same = self.signals, self.nodes, self.begin, self.end, self.is_end_known
            self._in_scope = Observed(*same, is_early=self.is_early, reads_initial=True)
        return self._in_scope

    def during(self, activation: Activation) -> Observed:
        """The observations during an activation."""
        begin, is_end_known = activation.begun(self.is_early), activation.timing != "latest"
        return Observed(self.signals, self.nodes, begin, activation.ended, is_end_known, is_early=self.is_early)

    def beside(self, uid: int) -> Observed:
        """The same, as seen from another of the clause's own nodes."""
        same = self.begin, self.end, self.is_end_known
        nodes = self.nodes.beside(uid)
        return Observed(self.signals, nodes, *same, is_early=self.is_early, reads_initial=self.reads_initial)

    def earlier(self, begin: Moment) -> Observed:
        """The same from an earlier moment, as if all nodes had begun as early as they may have."""
        return Observed(self.signals, self.nodes, begin, self.end, self.is_end_known, is_early=True)

    def between(self, begin: Moment, end: Moment) -> Observed:
        """The observations from one moment to another, within these."""
        return Observed(self.signals, self.nodes, begin, end, is_early=self.is_early)

    def reading(self, signal: ResolvedSignal, moment: Moment) -> SampleValue | UnknownValue:
        """The value of a signal at a moment."""
        return self.signals.reading(signal, moment[0], self.reads_initial)

    def age(self, signal: ResolvedSignal, moment: Moment) -> float | UnknownValue:
        """How old the last sample of a signal is at a moment, in seconds."""
        renewed = self.signals.renewed(signal, self.begin[0], moment[0])
        return renewed if isinstance(renewed, UnknownValue) else (moment[0] - renewed) / 1e6

    def oldest(self, signal: ResolvedSignal, moment: Moment) -> Moment:
        """The last moment before the next sample of a signal after another moment, or before the end."""
        later = self.signals.renewals(signal, moment[0], self.end[0])
        return (later[1] - 1, 0) if not isinstance(later, UnknownValue) and len(later) > 1 else (self.end[0], 0)

    def summary(self, function: str, signal: ResolvedSignal) -> float | UnknownValue:
        """An aggregate of the samples from beginning to end, including the value at the beginning."""
        begin, end = self.begin[0], self.end[0]
        if not self.is_end_known and self.signals.changes(signal, begin, end):
            return UnknownValue(UNKNOWN_END)
        if function == "count":
            return self.signals.number(signal, begin, end)
        values = self.signals.values(signal, begin, end)
        return values if isinstance(values, UnknownValue) else _FUNCTIONS[function](values)

    def holds(
        self, context: InContext, moment: Moment, truth: Callable[[], bool | UnknownValue]
    ) -> bool | UnknownValue:
        """Whether a context holds, cached: else contexts that name others twice would take exponential time."""
        if self._contexts is None:
            self._contexts = {}
        key = context.name, moment
        if key not in self._contexts:
            self._contexts[key] = truth()
        return self._contexts[key]

    def moments(self, *parts: object) -> list[Moment]:
        """The moments, from the beginning to the end, at which conditions and bounds may change."""
        moments = {self.begin}
        begin, end = self.begin, self.end
        for part in parts:
            for read in parts_in(part):
                if isinstance(read, SignalRead):
                    moments.update([(time, 0) for time in self.signals.changes(read.signal, begin[0], end[0])])
                elif isinstance(read, Running):
                    for activation in self.nodes.activations(read.target):
                        stopped = activation.end, activation.ended[1] + 1
                        started = activation.begun(self.is_early)
                        since = started[0], started[1] + 1  # unknown from then on if the end is
                        moments.update([moment for moment in (started, since, stopped) if begin < moment <= end])
                elif isinstance(read, Compare) and any(isinstance(operand, Age) for operand in read.operands):
                    moments.update([(time, 0) for time in self._ages(read) if begin[0] < time <= end[0]])
        return sorted(moments)

    def _ages(self, compare: Compare) -> Iterator[int]:
        """The times at which an age reaches or passes what it is compared with, at which it is 0 again after that, and
        at which it is largest."""
        bounds = [round(part.si * 1e6) for part in parts_in(compare.operands) if isinstance(part, Quantity)]
        for age in compare.operands:
            if not isinstance(age, Age):
                continue
            renewals = self.signals.renewals(age.signal, self.begin[0], self.end[0])
            if isinstance(renewals, UnknownValue):
                continue
            periods = [*pairwise([*renewals, self.end[0] + 1])]
            for sampled, following in periods:
                passed = [sampled + bound for bound in bounds if sampled + bound < following]
                yield from (*passed, *[time + 1 for time in passed if time + 1 < following])
                yield following if passed else self.begin[0]
            yield max(periods, key=lambda period: period[1] - period[0])[1] - 1


def _mean(values: Sequence[float]) -> float:
    return fsum(values) / len(values)


def _p95(values: Sequence[float]) -> float:
    """The 95th percentile: the smallest value that 95 % of them do not exceed."""
    return sorted(values)[-(-len(values) * 95 // 100) - 1]


def _stddev(values: Sequence[float]) -> float:
    """The standard deviation of the values themselves (population, not sample)."""
    middle = _mean(values)
    return sqrt(_mean([(value - middle) ** 2 for value in values]))


_FUNCTIONS: Final[dict[str, Callable[[Sequence[float]], float]]] = {
    "max": max,
    "min": min,
    "mean": _mean,
    "p95": _p95,
    "stddev": _stddev,
    "change": lambda values: values[-1] - values[0],
}
