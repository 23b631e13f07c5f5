"""The drawing of a run: what its nodes did, where it broke clauses, and signals below it, on one axis of time.

One invariant: all that is drawn is placed in percent of the run, so it fits into any window; every fact in it is also
in a text, and colour is never the only sign.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.units import Unit, parse_unit
from btq_lang.evidence.verdicts import OUTCOMES
from btq_lang.evidence.wording import duration, quantity, timestamp
from btq_lang.render.chart import round_values
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.model import SampleValue
    from btq_lang.evidence.verdicts import Bar, SignalLine, Timeline, Violation
    from btq_lang.render.pages import PageData


class Breach(Record):
    """A violation in the run; key: of the requirement's row on the page, empty if it has none."""

    requirement: str
    key: str
    violation: Violation


def run_figure(timeline: Timeline, breaches: Sequence[Breach]) -> PageData:
    """What the template shows of the run.

    Args:
        breaches: in this run.
    """
    length = timeline.length or _LEAST
    times = round_values(0, length, _TIMES, is_time=True)
    marks = grouped((each.violation.path, _breach(each, length)) for each in breaches[:_BREACHES])
    bars = grouped(((bar.path, min(bar.depth, _DEEPEST)), _bar(bar, length)) for bar in timeline.bars)
    rows = [(path, f"{depth * 0.8 + 0.4:g}rem", bars[path, depth], marks.pop(path, ())) for path, depth in bars]
    remarks = (
        (timeline.left_out, "activation", "are not drawn"),
        (len(breaches) - _BREACHES, "violation", "in this run are not marked"),
    )
    return {
        "run": timeline.run,
        "name": f"Run {timeline.run} of {timeline.source}",
        "when": f"from {timestamp(timeline.start)}, {duration(length)}",
        "remarks": [f"{counted(number, what)} more {words}." for number, what, words in remarks if number > 0],
        "grid": _share(times[1], length) if len(times) > 1 else "",
        "rows": rows,
        "elsewhere": [breach for others in marks.values() for breach in others],
        "signals": [(_numbers if line.sort == "number" else _bands)(line, length) for line in timeline.signals],
        "axis": _axis(times, length),
    }


def _bar(bar: Bar, length: float) -> tuple[str, str, str]:
    """Its outcome, its place, and both in words."""
    after = f" after {bar.took}," if bar.took else ""
    title = f"{OUTCOMES[bar.outcome]}{after} {duration(bar.end)} after the start of the run"
    return bar.outcome, _stretch(bar.begin, bar.end, length), title


def _stretch(begin: float, end: float, length: float) -> str:
    return f"left: {_share(begin, length)}; width: {_share(end - begin, length)}"


def _share(seconds: float, length: float) -> str:
    return f"{seconds / length:.3%}"


# ---- the axis ----


def _axis(times: Sequence[float], length: float) -> list[tuple[str, str, str]]:
    """The numbers of the axis: the class of each, its place, and its text; small windows show every second one."""
    unit = _unit(times[1] if len(times) > 1 else length)
    labels = []
    for place, time in enumerate(times):
        kinds = [*(["minor"] if place % 2 else []), *(["end"] if time > length * _END else [])]
        labels.append((" ".join(kinds), _share(time, length), quantity(time, unit) if time else "0"))
    return labels


def _unit(step: float) -> Unit:
    symbol = next(symbol for least, symbol in _UNITS if step >= least)
    unit = parse_unit(symbol)
    assert unit is not None, "a unit of the table"
    return unit


# ---- violations ----


def _breach(breach: Breach, length: float) -> PageData:
    """Where the clause was broken, and what happened there."""
    violation = breach.violation
    moment = violation.at if violation.passed is None else violation.passed  # else when that was decided
    text = f"bound {violation.bound} passed"
    if violation.passed is None:
        text = f"{violation.why}, bound {violation.bound}" if violation.bound else violation.why
    share = moment / length
    side = f"margin-left: {share:.3%}" if share <= _MIDDLE else f"margin-right: {1 - share:.3%}; text-align: right"
    return {
        "breach": breach,
        "at": _share(moment, length),
        "side": side,
        "text": f"{text} ({duration(moment)} after the start)",
    }


# ---- signals ----


def _bands(line: SignalLine, length: float) -> PageData:
    """A signal as bands with its values: the text of each, its place, and both in words."""
    bands = []
    for (time, value), end in zip(line.points, _ends(line, length), strict=True):
        if value is not None:
            title = f"{_text(value)} from {duration(time)} to {duration(end)} after the start of the run"
            bands.append((_text(value), _stretch(time, end, length), title))
    remark = f"{counted(line.left_out, 'later change')} not drawn" if line.left_out else ""
    return {"name": line.name, "remark": remark, "path": "", "bands": bands}


def _text(value: SampleValue) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _numbers(line: SignalLine, length: float) -> PageData:
    """A signal as a stepped line."""
    numbers = [float(value) for _, value in line.points if value is not None]
    drawn = [*numbers, *(value.si for _, value in line.bounds)]
    low, high = min(drawn), max(drawn)
    first, last, least, most = (
        quantity(number, line.unit) for number in (numbers[0], numbers[-1], min(numbers), max(numbers))
    )

    def up(value: float) -> float:
        return round(_TALL - _PAD - (value - low) / (high - low or 1.0) * (_TALL - 2 * _PAD), 1)

    extent = " to ".join(dict.fromkeys((least, most)))
    ends = (("top", high), ("bottom", low)) if high > low else (("top", high),)
    bounds = enumerate(dict.fromkeys(bound for _, bound in line.bounds))
    return {
        "name": line.name,
        "remark": extent + "".join(f"; bound {bound.text} of {name}" for name, bound in line.bounds),
        "label": f"{line.name} from {first} to {last}, between {least} and {most}",
        "size": f"{_BROAD} {_TALL}",
        "bound_paths": [f"M0 {up(bound.si):g}H{_BROAD}" for _, bound in line.bounds],
        "path": _steps(line, length, up),
        "ends": [(kind, quantity(value, line.unit)) for kind, value in ends],
        "bounds": [
            (f"top: {up(bound.si) / _TALL:.1%}; right: {place * _APART}rem", bound.text) for place, bound in bounds
        ],
    }


def _steps(line: SignalLine, length: float, up: Callable[[float], float]) -> str:
    """The path of a line whose values hold until the next, broken where none is known."""
    parts: list[str] = []
    is_drawn = False
    for (time, value), end in zip(line.points, _ends(line, length), strict=True):
        if value is not None:
            x, y = round(time / length * _BROAD, 1), up(float(value))
            parts.append(f"{f'V{y:g}' if is_drawn else f'M{x:g} {y:g}'}H{round(end / length * _BROAD, 1):g}")
        is_drawn = value is not None
    return "".join(parts)


def _ends(line: SignalLine, length: float) -> list[float]:
    """Until when each value of a signal holds."""
    return [*(time for time, _ in line.points[1:]), length]


_LEAST: Final = 1e-6  # s, of a run that took no time
_TIMES: Final = 9  # numbers of the axis
_END: Final = 0.94  # of the run: numbers after that are left of their place
_MIDDLE: Final = 0.5
_UNITS: Final = ((3600.0, "h"), (60.0, "min"), (1.0, "s"), (1e-3, "ms"), (0.0, "us"))
_DEEPEST: Final = 12  # levels that are indented
_BREACHES: Final = 20  # that are marked
_BROAD: Final = 1000  # of the drawing of a signal, in units of its own
_TALL: Final = 100
_PAD: Final = 6
_APART: Final = 4  # rem from the name of a bound to the next
