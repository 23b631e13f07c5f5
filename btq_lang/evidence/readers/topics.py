"""Samples of signals from topics of a bag, as `[evidence.signals]` of the project file names them.

One invariant: a sample is placed on the clock of the tree's log: at its header's stamp if that is on this clock, else
at its time of reception; if neither works, it is an error, not a guess.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Final

from btq_lang.evidence.model import SampleSeries, SampleValue, is_sample
from btq_lang.evidence.readers.samples import scaled
from btq_lang.evidence.readers.tree import NotALog
from btq_lang.util.spelling import did_you_mean, near

if TYPE_CHECKING:
    from numpy import int64
    from numpy.typing import NDArray

    from btq_lang.workspace.project_evidence import SignalSource

    Times = NDArray[int64]


class Clock:
    """The clock of a tree's log, in µs since the epoch, and how it and a bag's times of reception map to each other.

    Computed from each message of the log: when it was received, and the newest stamp in it.
    """

    def __init__(self, received: array[int], stamped: array[int]) -> None:
        from numpy import array as numbers
        from numpy import median

        self._received: Final[Times] = numbers(received, "int64")
        self._stamped: Final[Times] = numbers(stamped, "int64")
        apart = abs(self._received - self._stamped)
        self.is_of_the_bag: Final = len(apart) == 0 or float(median(apart)) < _FAR_APART

    def of_reception(self, times: Times) -> Times | None:
        """Converts times of reception to this clock; None if that is impossible."""
        return times if self.is_of_the_bag else _mapped(times, self._received, self._stamped)

    def to_reception(self, times: Sequence[int]) -> Sequence[int]:
        """Converts times of this clock to times of reception; where that is impossible, it leaves them as they are."""
        from numpy import array as numbers

        mapped = None if self.is_of_the_bag else _mapped(numbers(times, "int64"), self._stamped, self._received)
        return times if mapped is None else [int(time) for time in mapped]

    def overlaps(self, times: Times) -> bool:
        """Whether times are close to when the tree ran."""
        begin, end = int(self._stamped.min()) - _FAR_APART, int(self._stamped.max()) + _FAR_APART
        return begin <= int(times.max()) and int(times.min()) <= end


def _mapped(times: Times, from_clock: Times, to_clock: Times) -> Times | None:
    """Converts times of one clock to another, by moments that are known on both; None if they are too few."""
    from numpy import argsort, interp, unique

    order = argsort(from_clock, kind="stable")
    sources, first = unique(from_clock[order], return_index=True)
    targets = to_clock[order][first]
    if len(sources) < 2:
        return times + (targets[0] - sources[0]) if len(from_clock) == 1 else None
    rate = (targets[-1] - targets[0]) / (sources[-1] - sources[0])
    placed = interp(times, sources, targets)
    placed[times < sources[0]] = targets[0] + (times[times < sources[0]] - sources[0]) * rate
    placed[times > sources[-1]] = targets[-1] + (times[times > sources[-1]] - sources[-1]) * rate
    return placed.astype("int64")


class Topics:
    """The samples on some topics of a bag, with notes about them."""

    def __init__(self, sources: Iterable[SignalSource], topics: Iterable[str], namespaces: Iterable[str]) -> None:
        """Find those of a bag's topics that sources name, first in the namespaces of its robots."""
        present = set(topics)
        self._of: Final[dict[str, list[_Field]]] = {}
        self._sources: Final = [source for source in sources if source.topic]
        for source in self._sources:
            for topic in {_inside(namespace, source.topic) for namespace in ("", *namespaces)} & present:
                self._of.setdefault(topic, []).append(_Field(source, topic))
        self.names: Final = frozenset(self._of)
        self.remarks: Final[list[str]] = []

    def add(self, topic: str, received: int, message: Any) -> None:
        """Add the samples of a message; received: in ns.

        Raises:
            NotALog: it has no such field.
        """
        for field in self._of[topic]:
            field.add(received, message)

    def series(self, namespace: str, clock: Clock) -> dict[str, SampleSeries]:
        """The samples of a robot by signal.

        Raises:
            NotALog: they cannot be placed on the clock.
        """
        series_by_signal: dict[str, SampleSeries] = {}
        for source in self._sources:
            for topic in (_inside(namespace, source.topic), source.topic):
                fields = [field for field in self._of.get(topic, ()) if field.source is source]
                if fields:
                    series_by_signal[source.signal] = fields[0].series(clock, self.remarks)
                    break
            else:
                self.remarks.append(f"no topic {source.topic}, where the samples of `{source.signal}` should be")
        return series_by_signal


def _inside(namespace: str, topic: str) -> str:
    return f"{namespace}/{topic.removeprefix('/')}"


class _Field:
    """A field of the messages on a topic, with its values."""

    def __init__(self, source: SignalSource, topic: str) -> None:
        self.source: Final = source
        self._topic: Final = topic
        self._path: Final = [int(index) if index else name for index, name in _STEP.findall(source.field)]
        self._received: Final = array("q")
        self._stamped: Final = array("q")  # 0 where there is no header
        self._values: Final[list[SampleValue]] = []

    def add(self, received: int, message: Any) -> None:
        value = message
        for step in self._path:
            if isinstance(step, int):
                if not hasattr(value, "__len__"):
                    raise NotALog(self._about(f"`{self.source.field}` needs a list"))
                if step >= len(value):
                    return
                value = value[step]
            else:
                value = self._attribute(value, step)
        value = value.item() if hasattr(value, "item") and getattr(value, "ndim", 0) == 0 else value
        if not isinstance(value, bool | int | float | str):
            raise NotALog(self._about(f"`{self.source.field}` is not a number, a bool or a text"))
        if not is_sample(value):
            return
        self._received.append(received // 1000)
        self._stamped.append(_stamp(message))
        self._values.append(value)

    def series(self, clock: Clock, remarks: list[str]) -> SampleSeries:
        """The samples in the order of their times."""
        from numpy import argsort

        series = SampleSeries(self.source.unit)
        if self._values:
            times = self._placed(clock, remarks)
            for index in argsort(times, kind="stable").tolist():
                series.add(int(times[index]), scaled(self._values[index], self.source))
        return series

    def _placed(self, clock: Clock, remarks: list[str]) -> Times:
        from numpy import array as numbers
        from numpy import median

        received: Times = numbers(self._received, "int64")
        stamped: Times = numbers(self._stamped, "int64")
        placed = None if len(received) > 1 and received.min() == received.max() else clock.of_reception(received)
        if 0 in self._stamped:  # there is no header
            if placed is None:
                raise NotALog(self._about("has no stamps on the clock of the tree's log, and no times of reception"))
            if not clock.is_of_the_bag:
                remarks.append(self._about(f"the bag is {_OTHER_CLOCK}"))
            return placed
        if placed is None:
            if not clock.overlaps(stamped):
                raise NotALog(
                    self._about(
                        "its stamps are on another clock than the tree's log, and there are no times of"
                        " reception to join them by"
                    )
                )
            return stamped
        lasted = stamped[-1] - stamped[0]
        drift = abs((placed[-1] - placed[0]) - lasted)
        if float(median(abs(placed - stamped))) < _FAR_APART and drift <= max(_DRIFT, abs(lasted) * _DRIFT_RATE):
            return stamped
        remarks.append(self._about(f"its stamps are {_OTHER_CLOCK}"))
        return placed

    def _attribute(self, value: Any, name: str) -> Any:
        fields = [field for field in getattr(value, "__dataclass_fields__", ()) if field != "__msgtype__"]
        if name not in fields:
            names = did_you_mean(near(name, fields, 1)) or (f"; it has {', '.join(fields)}" if fields else "")
            raise NotALog(self._about(f"no field `{name}` for `{self.source.signal}`{names}"))
        return getattr(value, name)

    def _about(self, what: str) -> str:
        return f"{self._topic}: {what}"


def _stamp(message: Any) -> int:
    """The time in a message's header, in µs; 0 where there is none."""
    try:
        stamp = message.header.stamp
        time = (stamp.sec * 1_000_000_000 + stamp.nanosec) // 1000
    except (AttributeError, TypeError):
        return 0
    return int(time) if abs(time) < _LATEST else 0


_LATEST: Final = 1 << 61  # µs
_STEP: Final = re.compile(r"\[(\d+)\]|([^.\[\]]+)")
_OTHER_CLOCK: Final = "on another clock than the tree's log, so samples count at their times of reception"
_FAR_APART: Final = 60_000_000  # µs: no message takes that long
_DRIFT: Final = 1_000_000  # µs
_DRIFT_RATE: Final = 0.02
