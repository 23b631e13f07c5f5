"""Values of signals at a moment, from the samples of `--signals`, `[evidence.signals]` or the log's own entries.

One invariant: an answer is a value in SI, or the reason why it is unknown; a value holds until the next sample, or
until `fresh within` is over.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Final

from btq_lang.catalog.units import Unit, to_si
from btq_lang.evidence.model import SampleSeries, SampleValue
from btq_lang.evidence.wording import duration
from btq_lang.requirements.model import Quantity, ResolvedSignal
from btq_lang.util.record import Record


class UnknownValue(Record):
    """A value that cannot be determined, and why."""

    why: str


class Signals:
    """The samples of a session: those given for a signal, else the log's own, by entry."""

    def __init__(self, given: Mapping[str, SampleSeries], logged: Mapping[str, SampleSeries]) -> None:
        self._given: Final = given
        self.logged: Final = logged
        self._last: Final[dict[str, tuple[SampleValue, SampleValue | UnknownValue]]] = {}  # of each signal: read, in SI

    def reading(self, signal: ResolvedSignal, time: int, with_initial: bool = False) -> SampleValue | UnknownValue:
        """The value of a signal at a time, in SI.

        Args:
            with_initial: before its first sample it has its value `initially`.
        """
        series = self._series(signal)
        last_sample = series.at(time)
        if last_sample is None:
            return _before_samples(signal, bool(series.times), with_initial)
        sampled, value = last_sample
        if value is None:
            return UnknownValue(series.lacking or f"`{signal.name}` was not on the blackboard")
        if signal.fresh is not None and time - sampled > round(signal.fresh * 1e6):
            return UnknownValue(f"the last sample of `{signal.name}` is too old")
        last = self._last.get(signal.name)
        if last is None or last[0] is not value:
            last = self._last[signal.name] = value, _as_declared(signal, value, series.unit)
        return last[1]

    def sampled(self, signal: ResolvedSignal, time: int) -> int | None:
        """The time of the sample that gives a signal its value at a time."""
        sample = self._series(signal).at(time)
        return sample[0] if sample is not None else None

    def renewals(self, signal: ResolvedSignal, begin: int, end: int) -> list[int] | UnknownValue:
        """From when on the age of a signal counts: the last sample up to `begin`, or else `begin` itself, and those
        after it, up to `end`."""
        series = self._series(signal)
        if not series.times:
            return UnknownValue(_none_of(signal))
        before = series.at(begin)
        return [before[0] if before is not None else begin, *series.between(begin, end)]

    def renewed(self, signal: ResolvedSignal, begin: int, time: int) -> int | UnknownValue:
        """From when on the age of a signal counts at a time; see `renewals`."""
        series = self._series(signal)
        last_sample = series.at(time)
        if not series.times:
            return UnknownValue(_none_of(signal))
        return last_sample[0] if last_sample is not None else begin

    def changes(self, signal: ResolvedSignal, begin: int, end: int) -> list[int]:
        """The times after `begin`, up to `end`, at which a signal may change: a sample comes or expires."""
        series = self._series(signal)
        times = list(series.between(begin, end))
        if signal.fresh is not None:
            age = round(signal.fresh * 1e6) + 1
            before = series.at(begin)
            sampled = times if before is None else [before[0], *times]
            times = [*times, *[time + age for time in sampled if begin < time + age <= end]]
        return times

    def values(self, signal: ResolvedSignal, begin: int, end: int) -> list[float] | UnknownValue:
        """A signal's values from `begin`, if known then, to `end`; unknown if there are none, one is not a number, or
        one expired before the next.
        """
        series = self._series(signal)
        times = list(series.between(begin, end))
        if not isinstance(self.reading(signal, begin), UnknownValue):
            times.insert(0, begin)
        if not times:
            return UnknownValue(f"no sample of `{signal.name}` meanwhile" if series.times else _none_of(signal))
        checked = [*times, *self.changes(signal, times[0], end)] if signal.fresh is not None else times
        values: list[float] = []
        for time in checked:
            value = self.reading(signal, time)
            if isinstance(value, UnknownValue):
                return value
            values.append(float(value))
        return values[: len(times)]

    def sampled_values(self, signal: ResolvedSignal, begin: int, end: int) -> list[float] | UnknownValue:
        """A signal's values at its samples after `begin`, up to `end`; unknown if one is not a number."""
        series = self._series(signal)
        places = bisect_right(series.times, begin), bisect_right(series.times, end)
        converted: list[float] = []
        for sample in series.values[slice(*places)]:
            value = _as_declared(signal, sample, series.unit) if sample is not None else None
            if isinstance(value, UnknownValue):
                return value
            if value is not None:
                converted.append(float(value))
        return converted

    def number(self, signal: ResolvedSignal, begin: int, end: int) -> float | UnknownValue:
        """How many samples of a signal there are from `begin` to `end`."""
        series = self._series(signal)
        return float(len(series.between(begin - 1, end))) if series.times else UnknownValue(_none_of(signal))

    def remarks(self, signals: Mapping[str, ResolvedSignal], begin: int, end: int) -> Iterator[str]:
        """A remark on each signal whose samples end long before the log, compared with the times between them.

        Args:
            signals: by name.
            begin, end: of the session.
        """
        for name, signal in signals.items():
            times = self._series(signal).between(begin - 1, end)
            gaps = sorted(after - before for before, after in pairwise(times))
            if len(gaps) < _FEW:
                continue
            median = gaps[len(gaps) // 2]
            # A signal that is written when it changes has long gaps anyway.
            allowed = signal.fresh * 1e6 if signal.fresh is not None else max(_GAPS * median, gaps[-1])
            if end - times[-1] > allowed:
                lacking, usual = (duration(time / 1e6) for time in (end - times[-1], median))
                holds = "" if signal.fresh is not None else "; without `fresh within` the last one counts until the end"
                yield f"the samples of `{name}`, mostly one each {usual}, end {lacking} before the log does{holds}"

    def forget_before(self, time: int) -> None:
        """Drop the samples of the log's entries that are not needed for this time or later ones."""
        for series in self.logged.values():
            series.forget_before(time)

    def _series(self, signal: ResolvedSignal) -> SampleSeries:
        return self._given.get(signal.name) or self.logged.get(signal.entry) or _EMPTY


def _before_samples(signal: ResolvedSignal, is_sampled: bool, with_initial: bool) -> SampleValue | UnknownValue:
    """The value of a signal before its first sample.  Its value `initially` was not measured: it may decide which
    activations a requirement is about, but never that one satisfies the requirement. In a log without any sample it
    decides nothing.
    """
    if not is_sampled:
        return UnknownValue(_none_of(signal))
    first = signal.initially if with_initial else None
    if first is None:
        return UnknownValue(f"no sample of `{signal.name}` before that time")
    return first.si if isinstance(first, Quantity) else first.value


def _none_of(signal: ResolvedSignal) -> str:
    return f"{NO_SAMPLES} `{signal.name}`"


def _as_declared(signal: ResolvedSignal, value: SampleValue, unit: Unit | None) -> SampleValue | UnknownValue:
    """Convert a sample to its signal's declared type and SI; unit: of the sample, None for the signal's own."""
    if signal.sort == "text":
        return value if isinstance(value, str) else f"{value:g}"
    if signal.sort == "bool":
        if isinstance(value, str):
            return _BOOLS.get(
                value.strip().lower(), UnknownValue(f"a sample of `{signal.name}` is `{value}`, which is not a bool")
            )
        return bool(value)
    if isinstance(value, str):
        return UnknownValue(f"a sample of `{signal.name}` is `{value}`, which is not a number")
    unit = unit or signal.unit
    return to_si(value, unit) if unit is not None else float(value)


def by_signal(signals: Iterable[ResolvedSignal], *sources: Mapping[str, SampleSeries]) -> dict[str, SampleSeries]:
    """The samples of signals, each from the first source that has it by its name or its entry."""
    names = {signal.name: (signal.name, signal.entry) for signal in signals}
    series_by_signal: dict[str, SampleSeries] = {}
    for signal, keys in names.items():
        for source in sources:
            if (key := next((key for key in keys if key in source), None)) is not None:
                series_by_signal[signal] = source[key]
                break
    return series_by_signal


NO_SAMPLES: Final = "no samples of"
_FEW: Final = 10  # fewer times between samples say nothing about them
_GAPS: Final = 10
_EMPTY: Final = SampleSeries()
_BOOLS: Final[dict[str, SampleValue | UnknownValue]] = {"true": True, "1": True, "false": False, "0": False}
