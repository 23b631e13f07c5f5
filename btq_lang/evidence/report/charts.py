"""The drawings of the page: what happened in each step of the time, and what clauses measured.

One invariant: every fact in a drawing is also in a text, and colour is never the only sign.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.units import from_si, to_si
from btq_lang.evidence.wording import measured as written
from btq_lang.evidence.wording import moment
from btq_lang.render.chart import Chart, ChartMark, ChartSeries, Level, drawn, round_values
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.report.trends import MeasureTrend, Steps, Values
    from btq_lang.render.pages import PageData


def bars(
    values: Values, steps: Steps, labels: Sequence[tuple[str, int]], shown: Callable[[float], str]
) -> tuple[str, str]:
    """A measure over time, a bar for each step, with a dotted line where the first run of a label began; and a remark.

    Args:
        shown: gives a value as people read it.
    """
    places = [(place, value) for place, value in enumerate(values) if value is not None]
    if not places:
        return "", ""
    (first, begin), (last, end) = places[0], places[-1]
    highest = max(value for _, value in places)
    if not highest:
        return "", f"always {shown(0.0)}"
    dates = [date(steps.begin(place), steps.name) for place in range(len(values))]
    change = f"{shown(begin)} from {dates[first]}, {shown(end)} from {dates[last]}"
    titles = tuple("" if value is None else f"{day}: {shown(value)}" for day, value in zip(dates, values, strict=True))
    began = _began([(name, date(start, steps.name)) for name, start in labels])
    chart = Chart(
        kind="trend",
        label=f"by {steps.name}: {change}, at most {shown(highest)}{began}",
        size=_SMALL,
        series=(ChartSeries("bars", values, titles),),
        ticks=((0.0, shown(0.0)), (highest, shown(highest))),
        ends=(dates[0], dates[-1]),
        marks=tuple(ChartMark((start - steps.origin) / steps.length, name or NO_NAME) for name, start in labels),
    )
    return drawn(chart), f"at most {shown(highest)}"


def measure_figures(measured: Sequence[MeasureTrend], keys: Mapping[str, str]) -> PageData:
    """A figure for each clause that measures something, the later ones folded if there are many.

    Args:
        keys: the ids of the rows of requirements on the page, by name.
    """
    figures = [_figure(trend, keys) for trend in measured]
    more = figures[_SHOWN:]
    return {"first": figures[:_SHOWN], "more": more, "summary": counted(len(more), "more measure")}


def _figure(trend: MeasureTrend, keys: Mapping[str, str]) -> PageData:
    return {
        "measured": trend,
        "key": keys[trend.requirement],
        "node": "" if trend.node in trend.clause else trend.node,
        "drawing": _chart(trend),
        "change": _change(trend),
    }


def _chart(measured: MeasureTrend) -> str:
    unit = measured.unit
    dates = [date(start, measured.by) for start in measured.starts]

    def titles(values: Values, label: str) -> tuple[str, ...]:
        pairs = zip(dates, values, strict=True)
        return tuple("" if value is None else f"{day}: {label}{written(value, unit)}" for day, value in pairs)

    series = [ChartSeries("dots", measured.values, titles(measured.values, f"{measured.what} "))]
    middle = measured.medians if measured.medians is not None else measured.values
    series.insert(0, ChartSeries("line", middle, titles(middle, "median ")))
    values = [each for each in (*measured.values, *middle) if each is not None]
    levels = [Level(kind.rpartition(" ")[2], f"{kind} {written(si, unit)}", si) for kind, si in measured.levels]
    every = [from_si(each, unit) for each in (*values, *(level.value for level in levels))]
    ticks = round_values(min(every), max(every), _TICKS)
    return drawn(
        Chart(
            kind="measure",
            label=_change(measured) + _began([(name, dates[int(place)]) for name, place in measured.labels]),
            size=_LARGE,
            series=tuple(series),
            ticks=tuple((to_si(tick, unit), _number(tick, unit.symbol)) for tick in ticks),
            ends=(dates[0], dates[-1]),
            levels=tuple(levels),
            marks=tuple(ChartMark(place, name or NO_NAME) for name, place in measured.labels),
        )
    )


def _number(value: float, symbol: str) -> str:
    return f"{value:.12g}" if symbol == "1" else f"{value:.12g} {symbol}"


def _change(measured: MeasureTrend) -> str:
    """The first and the last values in words, the extreme ones, and what they are compared with."""

    def words(values: Values, label: str) -> str:
        numbers = [value for value in values if value is not None]
        first, last, least, most = (
            written(value, unit) for value in (numbers[0], numbers[-1], min(numbers), max(numbers))
        )
        between = f", between {least} and {most}" if {least, most} != {first, last} else ""
        return f"{label} from {first} to {last}{between}" if len(numbers) > 1 else f"{label} {first}"

    unit = measured.unit
    what = f"failures per {measured.period}" if measured.period else f"the {measured.what}"
    parts = [words(measured.values, f"{what} of each {measured.by}")]
    if measured.medians is not None:
        parts.insert(0, words(measured.medians, "the median"))
    parts.append(", ".join(f"{kind} {written(si, unit)}" for kind, si in measured.levels))
    return "; ".join(parts)


def _began(labels: Sequence[tuple[str, str]]) -> str:
    """When labels began, for readers who cannot see the dotted lines."""
    return "".join(f"; {name or NO_NAME} begins {when}" for name, when in labels)


def date(time: int, by: str) -> str:
    """A time to the minute or the day, depending on what begins then: a run, a minute or longer."""
    begin = moment(time)
    if begin is None:
        return f"{time} µs"
    return f"{begin:%Y-%m-%d %H:%M}" if by in ("run", "minute", "hour") else f"{begin:%Y-%m-%d}"


_SMALL: Final = (240, 72)  # pixels
_LARGE: Final = (420, 170)
_TICKS: Final = 5
_SHOWN: Final = 12
NO_NAME: Final = "(none)"
