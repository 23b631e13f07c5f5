"""The unit table: which words are units, what they measure, and how values convert.

One invariant: two values compare if and only if their units have the same dimension, and then `to_si` makes them
comparable.  Angle, data, count and percent are dimensions of their own, so `30 deg` is not a plain number and Hz is not
rpm. Left out on purpose: candela and mole (nothing on a robot is required in them), logarithmic units (dB has no
factor), coulomb, farad, henry, siemens and tesla (`25 C` is meant as a temperature), and every word that the grammar
needs after a number (`in`, `per`, `to`, `count` …), save `min`.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from math import inf, pi
from typing import Final

from btq_lang.util.record import Record
from btq_lang.util.spelling import near

BASES: Final = ("length", "mass", "time", "current", "temperature", "angle", "data", "count", "percent")
Dimension = tuple[int, ...]  # an exponent for each


class Unit(Record):
    """A unit.

    Attributes:
        symbol: the canonical spelling: `s` for `seconds`, `m/s` for `meters/sec`.
        dimension: its exponents over `BASES`.
        factor: one of it in SI base units, rad, bit, and the fraction of one for percent.
        offset: added after that; only for `degC`, which is always an absolute temperature.
    """

    symbol: str
    dimension: Dimension
    factor: float
    offset: float = 0.0


@lru_cache(1024)
def parse_unit(text: str) -> Unit | None:
    """Read a unit: a symbol of the table or a compound of them (`m/s^2`, `W*h`, `1/s`, `%/h`), or `1`, or None.

    `*` and `/` bind alike, from left to right; an exponent has one digit and perhaps a sign.  `degC` is allowed alone
    only: in a compound a temperature is a difference, written `K`.
    """
    if text == "1":
        return ONE
    factor = 1.0
    dimension = list(_NO_DIMENSION)
    written: list[str] = []
    for operator, word, exponent in _factors(text):
        if word == "1" and not written and exponent == "":
            written.append("1")
            continue
        entry = _TABLE.get(word)
        power = _power(exponent)
        if entry is None or power is None:
            return None
        symbol, unit_dimension, unit_factor, offset = entry
        if offset != 0.0:
            return Unit(symbol, unit_dimension, unit_factor, offset) if word == text else None
        written.append(f"{operator}{symbol}{'' if power == 1 else f'^{power}'}")
        power = -power if operator == "/" else power
        factor *= unit_factor**power
        for base, unit_exponent in enumerate(unit_dimension):
            dimension[base] += power * unit_exponent
    if written == ["1"] or (written[:1] == ["1"] and written[1][0] != "/") or not 0.0 < factor < inf:
        return None
    return Unit("".join(written), (*dimension,), factor)


def nearest_units(text: str, wanted: str | None = None) -> tuple[str, ...]:
    """The units that an unknown unit may mean, best first: `kw` is `kW`, `30sek` and `sek` are `s`.

    `parse_unit` reads each of them; a leading number is ignored.  `wanted`: a unit of their dimension; None: any.
    """
    written = text
    number = len(text) - len(text.lstrip("0123456789.+- "))
    text = text[number:] if not text.startswith("1/") else text
    for wrong, right in (("²", "^2"), ("³", "^3"), ("·", "*"), ("**", "^"), (" ", "")):
        text = text.replace(wrong, right)
    factors = list(_factors(text))
    target = parse_unit(wanted) if wanted is not None else None
    alone = target if len(factors) == 1 and not factors[0][2] else None
    answers: dict[str, None] = {}
    for choice in range(3):  # the best for every factor, then the second best where there is one …
        words = [(operator, _nearest_words(word, len(factors) == 1, alone), power) for operator, word, power in factors]
        counts = [len(candidates) for _, candidates, _ in words]
        if choice >= max(counts) or not all(counts):
            break
        guess = "".join(
            f"{operator}{candidates[min(choice, len(candidates) - 1)]}{'^' if power else ''}{power}"
            for operator, candidates, power in words
        )
        unit = parse_unit(guess)
        if guess != written and unit is not None and (target is None or unit.dimension == target.dimension):
            answers[guess] = None
    return tuple(answers)


def symbols() -> tuple[Unit, ...]:
    """Every unit of the table in its canonical spelling."""
    return tuple(Unit(*entry) for word, entry in _TABLE.items() if entry[0] == word)


def to_si(value: float, unit: Unit) -> float:
    """A value in the unit's SI form: `30 min` is 1800, `25 degC` is 298.15, `98 %` is 0.98."""
    return _tidy(value * unit.factor + unit.offset)


def from_si(value: float, unit: Unit) -> float:
    """A value from its SI form back into the unit."""
    return _tidy((value - unit.offset) / unit.factor)


def convert(value: float, source: Unit, target: Unit) -> float:
    """A value of one unit in another.

    Raises:
        ValueError: they measure different things.
    """
    if source.dimension != target.dimension:
        raise ValueError(f"{source.symbol} is {dimension_name(source)}, {target.symbol} is {dimension_name(target)}")
    if source.offset == target.offset:
        return _tidy(value * source.factor / target.factor)
    return from_si(value * source.factor + source.offset, target)


def dimension_name(unit: Unit) -> str:
    """The dimension of a unit, in words: `time`, `speed`, `energy or torque`, `length^4/time`."""
    name = _DIMENSION_NAMES.get(unit.dimension)
    if name is not None:
        return name
    powers = list(zip(BASES, unit.dimension, strict=True))
    above = "*".join(_powered(base, power) for base, power in powers if power > 0)
    below = "".join(f"/{_powered(base, -power)}" for base, power in powers if power < 0)
    return f"{above or '1'}{below}"


def a_dimension(unit: Unit) -> str:
    """The dimension of a unit, with an article: `a time`, `an angle`, `a plain number`; a formula has none."""
    name = dimension_name(unit)
    if name.startswith("a ") or not name.replace(" ", "").isalpha():
        return name
    return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"


def _factors(text: str) -> Iterator[tuple[str, str, str]]:
    """The factors of a compound: the operator before it ("" for the first), the word, and the text after its `^`."""
    operator = ""
    start = 0
    for end in range(len(text) + 1):
        if end == len(text) or text[end] in "*/":
            word, caret, exponent = text[start:end].partition("^")
            yield operator, word, exponent or ("?" if caret else "")
            operator = text[end : end + 1]
            start = end + 1


def _power(exponent: str) -> int | None:
    """The number after a `^`: one digit, for more would exceed a float; 0 is meaningless."""
    digit = exponent.removeprefix("-")
    if exponent == "":
        return 1
    return int(exponent) if len(digit) == 1 and digit in "123456789" else None


def _powered(name: str, power: int) -> str:
    return name if power == 1 else f"{name}^{power}"


def _tidy(value: float) -> float:
    """A value without the noise of the last digit, so that 0.29 m is 29 cm and not 28.999999999999996."""
    return float(f"{value:.15g}")


def _nearest_words(word: str, alone: bool, target: Unit | None) -> tuple[str, ...]:
    """Symbols for one factor: itself if it is right, else what was probably meant, in the dimension of the target."""
    if word == "1":
        return ("1",)
    if word in _TABLE:
        symbol = _TABLE[word][0]
        return (symbol if alone or symbol != "degC" else "K",)
    if word in _MEANT:
        return (_MEANT[word],)
    if word[-1:] in "23" and word[:-1] in _TABLE:  # m/s2
        return (f"{_TABLE[word[:-1]][0]}^{word[-1]}",)
    candidates = SYMBOLS if target is None else [name for name in SYMBOLS if _TABLE[name][1] == target.dimension]
    return tuple(dict.fromkeys(_TABLE[name][0] for name in near(word, candidates)))


# ---- the table ----

_PREFIXES: Final = {
    "n": (1e-9, ("nano",)),
    "u": (1e-6, ("micro",)),
    "µ": (1e-6, ()),  # U+00B5, as keyboards have it
    "μ": (1e-6, ()),  # U+03BC, as Unicode prefers it
    "m": (1e-3, ("milli",)),
    "c": (1e-2, ("centi",)),
    "d": (1e-1, ("deci",)),
    "h": (1e2, ("hecto",)),
    "k": (1e3, ("kilo",)),
    "M": (1e6, ("mega",)),
    "G": (1e9, ("giga",)),
    "T": (1e12, ("tera",)),
    "Ki": (2.0**10, ("kibi",)),
    "Mi": (2.0**20, ("mebi",)),
    "Gi": (2.0**30, ("gibi",)),
    "Ti": (2.0**40, ("tebi",)),
}
_MICRO: Final = "u µ μ"  # one prefix, three spellings

_Entry = tuple[str, Dimension, float, float]  # symbol, dimension, factor, offset


def _dimension(**exponents: int) -> Dimension:
    """The exponents of some bases, by their names; those of the others are 0."""
    return tuple([exponents.get(base, 0) for base in BASES])


_NO_DIMENSION: Final = _dimension()
ONE: Final = Unit("1", _NO_DIMENSION, 1.0)  # the unit of a plain number
_LENGTH: Final = _dimension(length=1)
_MASS: Final = _dimension(mass=1)
_TIME: Final = _dimension(time=1)
_SPEED: Final = _dimension(length=1, time=-1)
_FORCE: Final = _dimension(length=1, mass=1, time=-2)
_PRESSURE: Final = _dimension(length=-1, mass=1, time=-2)
_ENERGY: Final = _dimension(length=2, mass=1, time=-2)
_POWER: Final = _dimension(length=2, mass=1, time=-3)
_CHARGE: Final = _dimension(time=1, current=1)
_VOLTAGE: Final = _dimension(length=2, mass=1, time=-3, current=-1)
_RESISTANCE: Final = _dimension(length=2, mass=1, time=-3, current=-2)
_FREQUENCY: Final = _dimension(time=-1)
_ANGLE: Final = _dimension(angle=1)
_TURNING: Final = _dimension(time=-1, angle=1)
_DATA: Final = _dimension(data=1)
_DATA_RATE: Final = _dimension(time=-1, data=1)
_COUNT: Final = _dimension(count=1)
_PERCENT: Final = _dimension(percent=1)

# Symbol, dimension, factor, prefixes of the symbol, long names that take them too (and an `s` in the plural), and
# other spellings, as they are.  One row a unit.
_ROWS: Final = (
    ("m", _LENGTH, 1.0, f"n {_MICRO} m c d k", "meter metre", ""),
    ("inch", _LENGTH, 0.0254, "", "", "inches"),
    ("ft", _LENGTH, 0.3048, "", "", "foot feet"),
    ("g", _MASS, 1e-3, f"{_MICRO} m k", "gram", ""),
    ("t", _MASS, 1e3, "", "", "tonne tonnes"),
    ("lb", _MASS, 0.45359237, "", "", "lbs pound pounds"),
    ("s", _TIME, 1.0, f"n {_MICRO} m", "second", "sec secs"),
    ("ms", _TIME, 1e-3, "", "", "msec msecs"),
    ("us", _TIME, 1e-6, "", "", "usec usecs"),
    ("ns", _TIME, 1e-9, "", "", "nsec nsecs"),
    ("min", _TIME, 60.0, "", "", "mins minute minutes"),
    ("h", _TIME, 3600.0, "", "", "hr hrs hour hours"),
    ("d", _TIME, 86400.0, "", "", "day days"),
    ("week", _TIME, 604800.0, "", "", "weeks"),
    ("mile", _LENGTH, 1609.344, "", "", "miles mi"),
    ("kmh", _SPEED, 1 / 3.6, "", "", "kph"),
    ("mph", _SPEED, 0.44704, "", "", ""),
    ("l", _dimension(length=3), 1e-3, "m", "liter litre", "L"),
    ("ml", _dimension(length=3), 1e-6, "", "", "mL"),
    ("N", _FORCE, 1.0, "m k", "", "newton newtons"),
    ("Nm", _ENERGY, 1.0, "m k", "", ""),
    ("Pa", _PRESSURE, 1.0, "m h k M G", "", "pascal pascals"),
    ("bar", _PRESSURE, 1e5, "m", "", ""),
    ("J", _ENERGY, 1.0, f"{_MICRO} m k M G", "joule", ""),
    ("Wh", _ENERGY, 3600.0, "m k M", "", ""),
    ("W", _POWER, 1.0, f"{_MICRO} m k M G", "watt", ""),
    ("A", _dimension(current=1), 1.0, f"n {_MICRO} m k", "amp", "ampere amperes"),
    ("Ah", _CHARGE, 3600.0, "m", "", ""),
    ("V", _VOLTAGE, 1.0, f"{_MICRO} m k", "volt", ""),
    ("ohm", _RESISTANCE, 1.0, "m k M", "", "ohms Ω Ω"),
    ("K", _dimension(temperature=1), 1.0, "m", "", "kelvin kelvins"),
    ("Hz", _FREQUENCY, 1.0, "m k M G", "", "hertz"),
    ("rad", _ANGLE, 1.0, f"{_MICRO} m", "", "radian radians"),
    ("deg", _ANGLE, pi / 180, "", "", "degs degree degrees"),
    ("rev", _ANGLE, 2 * pi, "", "", "revs revolution revolutions turn turns"),
    ("rpm", _TURNING, 2 * pi / 60, "", "", "RPM"),
    ("bit", _DATA, 1.0, "k M G T", "", "bits"),
    ("B", _DATA, 8.0, "k M G T Ki Mi Gi Ti", "byte", ""),
    ("bps", _DATA_RATE, 1.0, "k M G", "", ""),
    ("%", _PERCENT, 1e-2, "", "", "percent"),
    ("ppm", _PERCENT, 1e-6, "", "", ""),
    ("person", _COUNT, 1.0, "", "", "persons people"),
    ("item", _COUNT, 1.0, "", "", "items object objects piece pieces pcs"),
    ("times", _COUNT, 1.0, "", "", "cycle cycles step steps tick ticks"),
    ("frame", _COUNT, 1.0, "", "", "frames"),
    ("fps", _dimension(time=-1, count=1), 1.0, "", "", ""),
    ("px", _COUNT, 1.0, "M", "", "pixel pixels"),
)


def _entries() -> Iterator[tuple[str, _Entry]]:
    for symbol, dimension, factor, prefixes, names, others in _ROWS:
        entry: _Entry = (symbol, dimension, factor, 0.0)
        yield symbol, entry
        for spelling in others.split():
            yield spelling, entry
        for name in names.split():
            yield name, entry
            yield f"{name}s", entry
        for prefix in prefixes.split():
            by, words = _PREFIXES[prefix]
            larger: _Entry = (f"{'u' if by == 1e-6 else prefix}{symbol}", dimension, factor * by, 0.0)
            yield f"{prefix}{symbol}", larger
            for word in words:
                for name in names.split():
                    yield f"{word}{name}", larger
                    yield f"{word}{name}s", larger
    celsius: _Entry = ("degC", _dimension(temperature=1), 1.0, 273.15)
    for spelling in ("degC", "celsius", "Celsius"):
        yield spelling, celsius


_TABLE: Final = dict(_entries())

# Every word that is a unit.  The lexer looks up each word after a number here.
SYMBOLS: Final = frozenset(_TABLE)

# Spellings whose meaning is not the most similar symbol.
_MEANT: Final = {
    "°": "deg",
    "°C": "degC",
    "C": "degC",
    "centigrade": "degC",
    "in": "inch",
    '"': "inch",
    "'": "ft",
    "pct": "%",
    "KB": "kB",
    "Kb": "kbit",
    "kb": "kbit",
    "Mb": "Mbit",
    "Gb": "Gbit",
    "b": "bit",
    "micron": "um",
    "kilos": "kg",
    "mps": "m/s",
    "millis": "ms",
    "micros": "us",
    **dict.fromkeys(("Sekunde", "Sekunden", "segundos", "secondes"), "s"),
    **dict.fromkeys(("Minute", "Minuten", "minutos"), "min"),
    **dict.fromkeys(("Stunde", "Stunden", "horas", "heures"), "h"),
    **dict.fromkeys(("Prozent", "pourcent", "porciento"), "%"),
    "kilo": "kg",
    "human": "person",
    "humans": "person",
}

_DIMENSION_NAMES: Final = {
    _NO_DIMENSION: "a plain number",
    _LENGTH: "length",
    _dimension(length=2): "area",
    _dimension(length=3): "volume",
    _MASS: "mass",
    _TIME: "time",
    _SPEED: "speed",
    _dimension(length=1, time=-2): "acceleration",
    _dimension(length=1, time=-3): "jerk",
    _FORCE: "force",
    _PRESSURE: "pressure",
    _ENERGY: "energy or torque",
    _POWER: "power",
    _dimension(current=1): "current",
    _CHARGE: "charge",
    _VOLTAGE: "voltage",
    _RESISTANCE: "resistance",
    _dimension(temperature=1): "temperature",
    _FREQUENCY: "frequency",
    _ANGLE: "angle",
    _TURNING: "angular speed",
    _dimension(time=-2, angle=1): "angular acceleration",
    _DATA: "amount of data",
    _DATA_RATE: "data rate",
    _COUNT: "count",
    _dimension(time=-1, count=1): "rate of events",
    _PERCENT: "percentage",
}
