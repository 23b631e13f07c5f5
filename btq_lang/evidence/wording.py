"""Formats measures, times and errors for people."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta, timezone
from typing import TYPE_CHECKING

from btq_lang.catalog.units import Unit, from_si, parse_unit

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation


def quantity(si: float, unit: Unit | None, bound: float | None = None) -> str:
    """A value in a unit, with three digits, or more if rounding would put it on the other side of its bound."""
    value = from_si(si, unit) if unit is not None else si
    limit = None if bound is None else from_si(bound, unit) if unit is not None else bound
    shown = value
    for digits in range(3, 16):
        shown = float(f"{value:.{digits}g}")
        if limit is None or ((shown > limit) == (value > limit) and (shown < limit) == (value < limit)):
            break
    number = f"{shown:.15g}"
    return number if unit is None or unit.symbol == "1" else f"{number} {unit.symbol}"


def measured(si: float, unit: Unit | None, bound: float | None = None) -> str:
    """A value in the unit of its bound; a time below one such unit, in the unit that `duration` chooses."""
    if unit is not None and unit.dimension == _SECOND.dimension and from_si(si, unit) < 1:
        unit = _readable(si)
    return quantity(si, unit, bound)


def duration(seconds: float) -> str:
    """A duration in ms, s, min or h, whichever is easiest to read."""
    return quantity(seconds, _readable(seconds))


def took(activation: Activation) -> str:
    """How long an activation lasted, as far as the log says; empty if it shows no time."""
    least = duration(activation.seconds) if activation.end > activation.begin else ""
    if activation.is_duration_known:
        return least
    if not activation.earliest:
        return f"at least {least}" if least else "an unknown time"
    most = duration((activation.end - activation.earliest) / 1e6)
    return f"{least} to {most}" if least else f"at most {most}"


def first_of(texts: Sequence[str]) -> str:
    """The first five texts, and how many more there are."""
    more = len(texts) - _NAMED
    return "; ".join([*texts[:_NAMED], *([f"{more} more"] if more > 0 else [])])


def message_of(error: Exception) -> str:
    """The message of an error in one line; its class if it has none."""
    return " ".join(str(error).split()) or type(error).__name__


def _readable(seconds: float) -> Unit:
    if seconds < 1:
        return _MILLISECOND
    return _HOUR if seconds >= 7200 else _MINUTE if seconds >= 120 else _SECOND


def share(probability: float) -> str:
    """A fraction of one as a percentage, with three digits, or more if rounding would give 0 or 100 %."""
    percent = probability * 100
    shown = (float(f"{percent:.{digits}g}") for digits in range(3, 16))
    return f"{next((rounded for rounded in shown if rounded < 100 or percent >= 100), percent):.15g} %"


def moment(time: int) -> datetime | None:
    """A time in µs since the epoch, in UTC; None outside the calendar."""
    try:
        return _EPOCH + timedelta(microseconds=time)
    except OverflowError:
        return None


def clock_time(time: int) -> str:
    """A time in µs since the epoch, to the millisecond; empty outside the calendar."""
    date = moment(time)
    return f"{date:%Y-%m-%d %H:%M:%S}.{date.microsecond // 1000:03} UTC" if date is not None else ""


def period(begin: int, end: int) -> str:
    """Two times in µs since the epoch, to the minute."""
    first, last = moment(begin), moment(end)
    if first is None or last is None:
        return "times that no calendar has"
    since = first.strftime("%Y-%m-%d %H:%M")
    until = last.strftime("%H:%M" if first.date() == last.date() else "%Y-%m-%d %H:%M")
    return f"{since} UTC" if since.endswith(until) else f"{since}–{until} UTC"


def timestamp(time: int) -> str:
    """A time in ISO 8601; the bare number outside the calendar."""
    date = moment(time)
    return date.isoformat(timespec="microseconds").replace("+00:00", "Z") if date is not None else f"{time} us"


def time_of(text: str) -> int:
    """The time that `timestamp` wrote."""
    if text.endswith(" us"):
        return int(text.removesuffix(" us"))
    return (datetime.fromisoformat(text.replace("Z", "+00:00")) - _EPOCH) // timedelta(microseconds=1)


_MILLISECOND, _SECOND, _MINUTE, _HOUR = filter(None, map(parse_unit, ("ms", "s", "min", "h")))
_NAMED = 5
_EPOCH = datetime(1970, 1, 1, tzinfo=timezone.utc)
