"""The unit table, every row of it compared with pint; reading, converting, and suggestions for misspelt units."""

from __future__ import annotations

import math
import re
from typing import Any

import pint
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from btq_lang.catalog.units import (
    BASES,
    SYMBOLS,
    Unit,
    convert,
    dimension_name,
    from_si,
    nearest_units,
    parse_unit,
    to_si,
)

COUNTED = """person persons people item items object objects piece pieces pcs times cycle cycles step steps tick ticks
    frame frames px pixel pixels"""
# Our spellings that pint does not have, or reads as something else: its fps is feet per second, its pcs a picoparsec.
PINT_NAMES = {
    "kmh": "km/h",
    "Nm": "N*m",
    "mNm": "mN*m",
    "kNm": "kN*m",
    "Celsius": "degC",
    "RPM": "rpm",
    "rev": "revolution",
    "revs": "revolution",
    "amps": "ampere",
    **dict.fromkeys(COUNTED.split(), "count"),
    "fps": "count/s",
    "Mpx": "1e6 count",
}
# pint's names of our bases; angle, data, count and percent are plain numbers to it: there only factors compare.
PINT_BASES = {
    "length": "[length]",
    "mass": "[mass]",
    "time": "[time]",
    "current": "[current]",
    "temperature": "[temperature]",
}
# The words of the grammar that may follow a number: a unit with such a name would swallow them.
KEYWORDS = """
    include qualities quality iso25010 TreeNodesModel Action Condition Control Decorator SubTree input output inout
    metadata Root BehaviorTree ID xml parameters satisfices satisfies tags Quality QualityReq description signal
    from level counter gauge fresh within initially context apply to except every under node tagged mission sum
    of takes succeeds needs keeps never leaves uses tries per runs starts ends after follows at most least less
    than more between and if else fails finishes halts when while in with probability activations confidence
    over last on violation fail halt warn log goal because verified by monitor analysis test review or not max
    mean p95 stddev change count true false bool text name satisfies ros_pkg"""
# What a roboticist writes without looking it up.
EXPECTED = """
    s ms us ns sec secs second seconds msec usec mins min minutes h hours d days m mm cm km meter metres kilometers
    g kg t N kN Nm Pa hPa bar J Wh kWh mWh W kW MW milliwatt V mV A mA Ah mAh ohm Ω K degC % percent Hz kHz deg
    degrees rad rpm rev bit byte B kB MB GiB Mbit Mbps person people items frames fps px l liters ml inch ft mph
    kmh µs μm"""


@pytest.fixture(scope="module")
def registry() -> pint.UnitRegistry[Any]:
    return pint.UnitRegistry()


def unit(text: str) -> Unit:
    found = parse_unit(text)
    assert found is not None, text
    return found


@pytest.mark.parametrize("spelling", sorted(SYMBOLS))
def test_every_spelling_means_what_pint_says(spelling: str, registry: pint.UnitRegistry[Any]) -> None:
    ours = unit(spelling)
    theirs = registry(PINT_NAMES.get(spelling, spelling))
    base = theirs.to_root_units()
    zero = registry.Quantity(0.0, theirs.units).to_root_units().magnitude if ours.offset else 0.0
    # pint's root unit of mass is the gram; ours, as SI's, the kilogram.
    grams = dict(base.unit_items()).get("gram", 0)
    assert ours.factor == pytest.approx((base.magnitude - zero) / 1000**grams, rel=1e-14)
    assert ours.offset == zero
    powers = dict(zip(BASES, ours.dimension, strict=True))
    assert {PINT_BASES[base]: powers[base] for base in PINT_BASES if powers[base]} == dict(theirs.dimensionality)


def test_pint_is_not_helped_where_it_knows_better(registry: pint.UnitRegistry[Any]) -> None:
    """Every exception is needed: pint does not know the word, or means another thing."""
    for spelling in PINT_NAMES:
        try:
            theirs = registry(spelling).to_root_units()
        except pint.UndefinedUnitError:
            continue
        assert theirs != registry(PINT_NAMES[spelling]).to_root_units(), spelling


@pytest.mark.parametrize("spelling", EXPECTED.split())
def test_the_words_roboticists_write_are_there(spelling: str) -> None:
    assert spelling in SYMBOLS


def test_no_word_of_the_grammar_is_a_unit() -> None:
    assert SYMBOLS.isdisjoint(KEYWORDS.split())
    assert "min" in SYMBOLS


def test_the_lexer_can_read_every_symbol() -> None:
    assert [symbol for symbol in SYMBOLS if not re.fullmatch(r"[^\W\d_]+|%", symbol)] == []


def test_canonical_symbols_are_symbols_and_stand_for_themselves() -> None:
    canonical = {unit(spelling).symbol for spelling in SYMBOLS}
    assert canonical <= SYMBOLS
    assert [symbol for symbol in canonical if unit(symbol).symbol != symbol] == []


@pytest.mark.parametrize(
    ("text", "symbol", "factor", "name"),
    [
        ("1", "1", 1.0, "a plain number"),
        ("seconds", "s", 1.0, "time"),
        ("m/s^2", "m/s^2", 1.0, "acceleration"),
        ("meters/sec", "m/s", 1.0, "speed"),
        ("m*s^-1", "m*s^-1", 1.0, "speed"),
        ("km/h", "km/h", 1000 / 3600, "speed"),
        ("kmh/s", "kmh/s", 1 / 3.6, "acceleration"),
        ("W*h", "W*h", 3600.0, "energy or torque"),
        ("N/cm^2", "N/cm^2", 1e4, "pressure"),
        ("1/s", "1/s", 1.0, "frequency"),
        ("1/min", "1/min", 1 / 60, "frequency"),
        ("%/h", "%/h", 0.01 / 3600, "percent/time"),
        ("deg/s", "deg/s", math.pi / 180, "angular speed"),
        ("person/m^2", "person/m^2", 1.0, "count/length^2"),
        ("kWh", "kWh", 3.6e6, "energy or torque"),
        ("m^1", "m", 1.0, "length"),
        ("µm", "um", 1e-6, "length"),
        ("m^4/s", "m^4/s", 1.0, "length^4/time"),
        ("1/m^2", "1/m^2", 1.0, "1/length^2"),
    ],
)
def test_parse(text: str, symbol: str, factor: float, name: str) -> None:
    found = unit(text)
    assert (found.symbol, found.offset, dimension_name(found)) == (symbol, 0.0, name)
    assert found.factor == pytest.approx(factor, rel=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        *("", "kw", "S", "Sec", "m/", "/m", "m//s", "m s", "m /s", "1*m", "1/1", "1^2", "11/s", "m^", "m^0", "m^x"),
        *("m^--2", "m^10", "m^²", "m^2^2", "degC/min", "degC^1", "1/degC", "m*degC", "%%", "bool", "text", "dB"),
        "*".join(["km^9"] * 20),
    ],
)
def test_what_is_no_unit(text: str) -> None:
    assert parse_unit(text) is None


def test_what_the_requirements_page_keeps_apart() -> None:
    dimensions = {text: unit(text).dimension for text in ("1", "deg", "%", "B", "person", "Hz", "rpm", "bps", "fps")}
    assert len(set(dimensions.values())) == len(dimensions)


@pytest.mark.parametrize(
    ("value", "source", "target", "expected"),
    [
        (30, "s", "ms", 30000.0),
        (1.005, "s", "ms", 1005.0),
        (0.29, "m", "cm", 29.0),
        (0.02, "kWh", "Wh", 20.0),
        (15, "Wh", "kWh", 0.015),
        (25, "degC", "K", 298.15),
        (0, "K", "degC", -273.15),
        (-5, "degC", "degC", -5.0),
        (180, "deg", "rad", 3.14159265358979),
        (36, "km/h", "m/s", 10.0),
        (60, "rpm", "rev/s", 1.0),
        (1, "MiB", "B", 1048576.0),
        (98, "%", "%", 98.0),
    ],
)
def test_convert(value: float, source: str, target: str, expected: float) -> None:
    assert convert(value, unit(source), unit(target)) == expected


def test_si_form() -> None:
    assert to_si(30, unit("min")) == 1800.0
    assert to_si(25, unit("degC")) == 298.15
    assert to_si(98, unit("%")) == 0.98
    assert to_si(1005, unit("ms")) == 1.005
    assert from_si(1800, unit("min")) == 30.0
    assert from_si(298.15, unit("degC")) == 25.0


def test_units_of_different_dimensions_do_not_convert() -> None:
    with pytest.raises(ValueError, match=r"^s is time, % is percentage$"):
        convert(1, unit("s"), unit("%"))


@given(st.sampled_from(sorted(SYMBOLS)), st.integers(-999_999, 999_999), st.integers(0, 4))
def test_si_form_and_back_is_the_value_as_typed(symbol: str, digits: int, places: int) -> None:
    value = float(f"{digits}e-{places}")
    back = from_si(to_si(value, unit(symbol)), unit(symbol))
    assert back == pytest.approx(value, rel=1e-14, abs=1e-12)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("kw", ("kW",)),
        ("30sek", ("s",)),
        ("sek", ("s",)),
        ("mps", ("m/s",)),
        ("millis", ("ms",)),
        ("SEC", ("s",)),
        ("Mw", ("MW", "mW")),
        ("hz", ("Hz",)),
        ("KM", ("km",)),
        ("KB", ("kB",)),
        ("minuts", ("min",)),
        ("kmph", ("kmh", "mph")),
        ("m/sek", ("m/s",)),
        ("1/sek", ("1/s",)),
        ("m/s2", ("m/s^2",)),
        ("m/s²", ("m/s^2",)),
        ("m**2", ("m^2",)),
        ("m / s", ("m/s",)),
        ("3.5 kwh", ("kWh",)),
        ("°", ("deg",)),
        ("°C", ("degC",)),
        ("C", ("degC",)),
        ("degC/min", ("K/min",)),
        ("in", ("inch",)),
        ("humans", ("person",)),
        ("dB", ()),
        ("foobarbaz", ()),
        ("s", ()),
        ("", ()),
        ("m^", ()),
    ],
)
def test_nearest_units(text: str, expected: tuple[str, ...]) -> None:
    assert nearest_units(text) == expected


@pytest.mark.parametrize(
    ("text", "wanted", "expected"),
    [
        ("msk", None, ("ms", "mK")),
        ("msk", "s", ("ms",)),
        ("msk", "K", ("mK",)),
        ("metr", "s", ()),
        ("metr", "m", ("m",)),
        ("m/sek", "s", ()),
        ("m/sek", "m/s", ("m/s",)),
        ("prc", "%", ()),
    ],
)
def test_nearest_units_that_measure_something(text: str, wanted: str | None, expected: tuple[str, ...]) -> None:
    assert nearest_units(text, wanted) == expected


@given(st.text(alphabet="kKmMsSecW/*^123 -°²%C.", max_size=12) | st.text(max_size=8))
@example("1")
@example("1/")
@example("*" * 9)
def test_every_answer_is_a_unit(text: str) -> None:
    parse_unit(text)
    for answer in nearest_units(text):
        assert parse_unit(answer) is not None
        assert answer != text
