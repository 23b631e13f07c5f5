"""Timelines of the runs with the worst violation of each clause, with the values of signals.

One invariant: it keeps the activations of the open run, at most a thousand, and one run for each clause, with at most
a thousand points of each signal: of a number the first, the extreme and the last ones in each of equal parts of the
run, of others the first changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby, islice
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.evidence.signals import Signals, UnknownValue
from btq_lang.evidence.verdicts import Bar, SignalLine, Timeline
from btq_lang.evidence.wording import took
from btq_lang.requirements.model import Aggregate, Compare, Quantity, ResolvedSignal, SignalRead, parts_in, signals_in

if TYPE_CHECKING:
    from btq_lang.evidence.clause_findings import ClauseFindings
    from btq_lang.evidence.model import Activation, LoggedTree, SampleValue
    from btq_lang.evidence.tally import Run

    # The numbers that a signal is compared with, each with the name of the requirement or the context that does.
    Bounds: TypeAlias = tuple[tuple[str, Quantity], ...]
    Point: TypeAlias = tuple[float, SampleValue | None]


class OpenRun:
    """The activations of the open run."""

    def __init__(self, read: Mapping[ResolvedSignal, Bounds]) -> None:
        """See nothing yet; `read`: the signals to be drawn, with the numbers that they are compared with."""
        self._read: Final = read
        self._activations: Final[list[Activation]] = []
        self._left_out = 0

    def see(self, activation: Activation) -> None:
        """Record an activation that has ended."""
        if len(self._activations) < _MOST_BARS:
            self._activations.append(activation)
        else:
            self._left_out += 1

    def end(self, run: Run, tree: LoggedTree, clauses: Sequence[ClauseFindings], signals: Signals) -> None:
        """Close the run, and keep it as the timeline of the clauses of which it has the worst violation so far."""
        if broken := [clause for clause in clauses if clause.tally.is_worst_in(run)]:
            timeline = self._timeline(run, tree, signals)
            for clause in broken:
                clause.timeline = timeline
        self._activations.clear()
        self._left_out = 0

    def _timeline(self, run: Run, tree: LoggedTree, signals: Signals) -> Timeline:
        bars = sorted(self._activations, key=lambda activation: (activation.uid, activation.begin))
        return Timeline(
            run.number,
            run.source,
            run.begin,
            (run.end - run.begin) / 1e6,
            tuple(
                Bar(
                    tree.nodes[activation.uid].path,
                    sum(1 for _ in tree.above(activation.uid)),
                    (activation.begin - run.begin) / 1e6,
                    (activation.end - run.begin) / 1e6,
                    activation.outcome,
                    took(activation),
                )
                for activation in bars
            ),
            self._left_out,
            _signal_lines(self._read, signals, run.begin, run.end),
        )


def read_signals(parts: Iterable[tuple[str, object]]) -> dict[ResolvedSignal, Bounds]:
    """The signals that requirements and contexts read, with the numbers that each is compared with.

    Args:
        parts: of the model, each with the name of its requirement or context.
    """
    read: dict[ResolvedSignal, dict[tuple[str, Quantity], None]] = {}
    for name, part in parts:
        for signal in signals_in(part):
            read.setdefault(signal, {})
        for condition in parts_in(part):
            for signal, value in _compared(condition):
                read[signal][name, value] = None
    return {signal: tuple(bounds) for signal, bounds in read.items()}


def _signal_lines(
    read: Mapping[ResolvedSignal, Bounds], signals: Signals, begin: int, end: int
) -> tuple[SignalLine, ...]:
    """The lines of those signals of which a value is known in a run, from its begin to its end in µs."""
    lines = []
    for signal, bounds in read.items():
        points, left_out = _points(signal, signals, begin, end)
        if any(value is not None for _, value in points):
            lines.append(SignalLine(signal.name, signal.unit, signal.sort, points, bounds, left_out))
    return tuple(lines)


def _compared(part: object) -> Iterator[tuple[ResolvedSignal, Quantity]]:
    """The signals that a comparison compares with numbers of their own scale."""
    if isinstance(part, Compare):
        for pair in zip(part.operands, part.operands[1:], strict=False):
            for operand, other in (pair, pair[::-1]):
                is_of_scale = isinstance(operand, SignalRead) or (
                    isinstance(operand, Aggregate) and operand.function in _OF_SCALE
                )
                if is_of_scale and isinstance(operand, SignalRead | Aggregate) and isinstance(other, Quantity):
                    yield operand.signal, other


def _points(signal: ResolvedSignal, signals: Signals, begin: int, end: int) -> tuple[tuple[Point, ...], int]:
    """The points of a line, and how many changes are left out."""
    times = dict.fromkeys((begin, *sorted(signals.changes(signal, begin, end))))
    values = ((time, signals.reading(signal, time)) for time in times)
    points = _changes(
        ((time - begin) / 1e6, None if isinstance(value, UnknownValue) else value) for time, value in values
    )
    if signal.sort == "number" and len(times) > _MOST_POINTS:
        return tuple(_thinned(points, (end - begin) / 1e6)), 0
    kept = tuple(islice(points, _MOST_POINTS))
    return kept, sum(1 for _ in points)


def _changes(points: Iterable[Point]) -> Iterator[Point]:
    """The first point, and those whose values differ from the ones before them."""
    last: SampleValue | None = None
    for place, (time, value) in enumerate(points):
        if not place or value != last:
            yield time, value
        last = value


def _thinned(points: Iterable[Point], length: float) -> Iterator[Point]:
    """Of each of equal parts of the time the first point, the extreme ones, one without a value, and the last."""
    for _, inside in groupby(points, lambda point: int(point[0] / length * _PARTS)):
        of_part = [*inside]
        values = sorted((float(value), place) for place, (_, value) in enumerate(of_part) if value is not None)
        places = {0, len(of_part) - 1, *(place for _, place in (*values[:1], *values[-1:]))}
        places.update([place for place, (_, value) in enumerate(of_part) if value is None][:1])
        yield from (of_part[place] for place in sorted(places))


_MOST_BARS: Final = 1000
_MOST_POINTS: Final = 1000  # points
_PARTS: Final = _MOST_POINTS // 5
_OF_SCALE: Final = ("max", "min", "mean", "p95")
