"""Charts: a pure function of their values."""

from __future__ import annotations

import re

from btq_lang.render.chart import Chart, ChartMark, ChartSeries, Level, drawn


def chart(*series: ChartSeries, levels: tuple[Level, ...] = (), marks: tuple[ChartMark, ...] = ()) -> str:
    ticks = ((0.0, "0"), (10.0, "10"))
    return drawn(Chart("measure", "what it <is>", (107, 54), series, ticks, ("first", "last"), levels, marks))


def test_values_are_placed_between_the_ends_of_the_axis() -> None:
    """Texts of 13 pixels are left of it, 20 below, 7 right of it and above."""
    text = chart(ChartSeries("dots", (0.0, None, 5.0, 10.0), ("none", "", "a & b", "ten")))
    assert re.findall(r'cx="(.*?)" cy="(.*?)" r="2.5"><title>(.*?)<', text) == [
        ("30.0", "34", "none"),
        ("70.0", "20.5", "a &amp; b"),
        ("90.0", "7", "ten"),
    ]
    assert 'aria-label="what it &lt;is&gt;"' in text
    assert re.findall(r'class="grid" d="(.*?)"', text) == ["M20 34H100", "M20 7H100"]


def test_bars_begin_at_nothing() -> None:
    text = chart(ChartSeries("bars", (5.0, 0.0), ("", "")))
    assert re.findall(r'y="([\d.]*)" width="32.0" height="(.*?)"', text) == [("20.5", "13.5"), ("33.0", "1.0")]


def test_levels_beyond_all_values_are_drawn_and_their_texts_apart() -> None:
    levels = Level("bound", "bound 20", 20.0), Level("goal", "goal 10", 10.0)
    text = chart(ChartSeries("line", (1.0, 2.0), ("", "")), levels=levels)
    assert re.findall(r'class="(bound|goal)" d="M20 (.*?)H100"', text) == [("bound", "7"), ("goal", "20.5")]
    places = [float(y) for y in re.findall(r'y="([\d.]*)">(?:bound|goal) ', text)]
    assert places == [17.0, 27.0]


def test_a_mark_without_room_has_its_name_in_its_title_only() -> None:
    marks = ChartMark(0, "a"), ChartMark(0.1, "b"), ChartMark(1.9, "longer")
    text = chart(ChartSeries("line", (1.0, 2.0), ("", "")), marks=marks)
    assert re.findall("<title>(.*?) begins</title></path>(?:<text[^>]*>(.*?)<)?", text) == [
        ("a", "a"),
        ("b", ""),
        ("longer", ""),
    ]
