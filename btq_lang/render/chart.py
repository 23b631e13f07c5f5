"""Values in their order as a drawing: bars, or dots on a line, with an axis, levels to compare them with, and marks.

One invariant: a pure function of its values, whatever these measure; the page's style sheet paints it (`chart.css`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from html import escape
from itertools import count
from math import ceil, floor, log10
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from btq_lang.graph.widths import width
from btq_lang.util.record import Record

if TYPE_CHECKING:
    Kind: TypeAlias = Literal["bars", "line", "dots"]


class ChartSeries(Record):
    """Values in the places of a chart.

    Attributes:
        values: from the left; None: there is none.
        titles: of each place, what its value is.
    """

    kind: Kind
    values: tuple[float | None, ...]
    titles: tuple[str, ...]


class Level(Record):
    """A horizontal line: `bound` or `goal`, its text and its value."""

    kind: str
    text: str
    value: float


class ChartMark(Record):
    """A dotted line at the left edge of a place, or within one, where something begins."""

    place: float
    text: str


class Chart(Record):
    """A drawing.

    Attributes:
        kind: its class: what it is for.
        label: what it shows, for who cannot see it.
        size: its width and height in pixels.
        ticks: the values of the axis, each with its text.
        ends: the texts below the first and the last place.
    """

    kind: str
    label: str
    size: tuple[int, int]
    series: tuple[ChartSeries, ...]
    ticks: tuple[tuple[float, str], ...]
    ends: tuple[str, str]
    levels: tuple[Level, ...] = ()
    marks: tuple[ChartMark, ...] = ()


def drawn(chart: Chart) -> str:
    """The chart as SVG, in a line."""
    wide, high = chart.size
    return (
        f'<svg class="chart {chart.kind}" viewBox="0 0 {wide} {high}" role="img" aria-label="{escape(chart.label)}">'
        f"{''.join(_Frame(chart).parts())}</svg>"
    )


class _Frame:
    """Where values are in the drawing."""

    def __init__(self, chart: Chart) -> None:
        values = [value for series in chart.series for value in series.values if value is not None]
        values += [value for value, _ in chart.ticks] + [level.value for level in chart.levels]
        self._low: Final = min(values)
        self._high: Final = max(values)
        self._chart: Final = chart
        self._left: Final = max(width(text, _SIZE) for _, text in chart.ticks) + _GAP
        self._right: Final = chart.size[0] - _GAP
        self._top: Final = _LINE if chart.marks else _GAP
        self._ground: Final = chart.size[1] - _LINE - _GAP
        self._step: Final = (self._right - self._left) / max(len(each.values) for each in chart.series)

    def parts(self) -> Iterator[str]:
        chart = self._chart
        for value, text in chart.ticks:
            y = self._y(value)
            yield f'<path class="grid" d="M{self._left:g} {y:g}H{self._right:g}"/>'
            yield f'<text class="tick" x="{self._left - 4:g}" y="{y + 3.5:g}">{escape(text)}</text>'
        yield from self._marks()
        for series in chart.series:
            yield from _DRAWN[series.kind](self, series)
        yield from self._levels()
        first, last = chart.ends
        yield f'<text x="{self._left:g}" y="{chart.size[1] - 3}">{escape(first)}</text>'
        if last != first:
            yield f'<text class="last" x="{self._right:g}" y="{chart.size[1] - 3}">{escape(last)}</text>'

    def bars(self, series: ChartSeries) -> Iterator[str]:
        base = self._y(max(self._low, 0.0))
        for x, value, title in self._points(series):
            high = max(base - self._y(value), 1.0)
            rectangle = f'x="{x - self._step * 0.4:.1f}" y="{base - high:.1f}" width="{self._step * 0.8:.1f}"'
            yield f'<rect {rectangle} height="{high:.1f}"><title>{escape(title)}</title></rect>'

    def line(self, series: ChartSeries) -> Iterator[str]:
        points = "L".join(f"{x:.1f} {self._y(value):g}" for x, value, _ in self._points(series))
        yield f'<path class="line" d="M{points}"/>'

    def dots(self, series: ChartSeries) -> Iterator[str]:
        for x, value, title in self._points(series):
            yield f'<circle cx="{x:.1f}" cy="{self._y(value):g}" r="2.5"><title>{escape(title)}</title></circle>'

    def _levels(self) -> Iterator[str]:
        """The levels with their texts, from above, none over another."""
        last = float("-inf")
        for level in sorted(self._chart.levels, key=lambda each: -each.value):
            y = self._y(level.value)
            above = y - 3 if y - 3 - _SIZE >= self._top else y + _SIZE
            last = max(above, last + _SIZE)
            yield f'<path class="{level.kind}" d="M{self._left:g} {y:g}H{self._right:g}"/>'
            yield f'<text class="last" x="{self._right:g}" y="{last:g}">{escape(level.text)}</text>'

    def _marks(self) -> Iterator[str]:
        """The marks, named as far as there is room."""
        free: float = self._left
        for mark in self._chart.marks:
            x = round(self._left + mark.place * self._step, 1)
            title = f"{mark.text} begins"
            yield f'<path class="mark" d="M{x:g} 0V{self._ground:g}"><title>{escape(title)}</title></path>'
            if x >= free and x + _NEAR + width(mark.text, _SIZE) <= self._right:
                yield f'<text x="{x + _NEAR:g}" y="{_SIZE - 1}">{escape(mark.text)}</text>'
                free = x + 2 * _NEAR + width(mark.text, _SIZE)

    def _points(self, series: ChartSeries) -> Iterator[tuple[float, float, str]]:
        """The middle of each place that has a value, that value and its title."""
        for place, (value, title) in enumerate(zip(series.values, series.titles, strict=True)):
            if value is not None:
                yield self._left + (place + 0.5) * self._step, value, title

    def _y(self, value: float) -> float:
        share = (value - self._low) / (self._high - self._low or 1.0)
        return round(self._ground - share * (self._ground - self._top), 1)


_DRAWN: Final[dict[Kind, Callable[[_Frame, ChartSeries], Iterator[str]]]] = {
    "bars": _Frame.bars,
    "line": _Frame.line,
    "dots": _Frame.dots,
}
_SIZE: Final = 10  # of texts, in pixels
_LINE: Final = 13
_GAP: Final = 7
_NEAR: Final = 3


# ---- round numbers for an axis ----


def round_values(low: float, high: float, most: int, *, is_time: bool = False) -> tuple[float, ...]:
    """The multiples of a round step from one value to another, with the smallest step of which there are few enough.

        >>> round_values(0, 35.5, 8)
        (0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0)
        >>> round_values(0, 200, 6, is_time=True)
        (0.0, 60.0, 120.0, 180.0)

    Args:
        most: how many there may be, at least 2.
        is_time: the values are seconds; then steps of more than a second are round in minutes and hours.
    """
    if not high > low:
        return (float(low),)
    for step in _steps((high - low) / most, is_time):
        first, last = ceil(low / step - _ROUNDING), floor(high / step + _ROUNDING)
        if last - first < most:
            return tuple(float(f"{place * step:.12g}") for place in range(first, last + 1))
    raise AssertionError("steps grow without end")


def _steps(least: float, is_time: bool) -> Iterator[float]:
    """The round steps, from the largest that is not above a value."""
    unit = 1.0
    if is_time and least > 1:
        yield from (each for each in _TIMES if each >= least)
        unit = _DAY
    for exponent in count(floor(log10(max(least / unit, 1.0 if unit == _DAY else 0.0)))):
        yield from (each * 10.0**exponent * unit for each in (1, 2, 5))


_DAY: Final = 86_400.0  # s
_TIMES: Final = (2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10_800, 21_600, 43_200)  # s
_ROUNDING: Final = 1e-9  # of a step: what a division may round off
