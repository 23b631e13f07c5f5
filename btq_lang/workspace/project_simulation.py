"""The table `[simulate]` of a project file: what skills and the world do in simulated runs, and how the program ticks.

    [simulate]
    driver = { tick_once = "100 ms" }

    [simulate.skills]
    MoveBase      = { takes = { median = "18 s", p95 = "27 s" }, succeeds = "99 %" }
    "BatteryCheck/MoveBase" = { takes = ["12 s", "20 s"] }
    Pick          = { takes = "6 s", succeeds = "97 %", writes = { tubes = "tubes - 1" } }
    BatteryFull   = { is = "battery >= 95 %" }
    SensorsAlive  = { fails = "1 per 8 h", for = "2 s" }

    [simulate.world]
    battery = { start = "60 %", rate = "-0.05 %/s", while = { Charge = "+1 %/s" }, between = ["0 %", "100 %"] }

One invariant: what is wrong is left out and reported, and the rest is kept.  Not known here: which nodes and signals a
mission has, so the values of signals are as written.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from math import isfinite
from typing import Any, Final, Literal, TypeAlias

from btq_lang.catalog.units import Unit, dimension_name, nearest_units, to_si
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.script.parser import parse_script
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.workspace.project_driver import Driver, read_driver

Complaint: TypeAlias = tuple[str, tuple[str, ...]]  # the message, and the keys below `simulate` to its place


class Spread(Record):
    """How a duration is distributed, in seconds.

    Attributes:
        kind: always `low`; any between `low` and `high`; or lognormal with the median `low` and the 95 % quantile
            `high`.
    """

    kind: Literal["fixed", "uniform", "lognormal"]
    low: float
    high: float


class SkillSetting(Record):
    """What some nodes do.

    Attributes:
        name: of nodes, or a path to some, as in requirements.
        takes: None: nothing is said.
        succeeds: the share of activations; None: nothing is said.
        writes: when it succeeds: an entry or port, and a script for its value.
        condition: what a condition answers; empty: nothing is said.
        fails: how often a condition begins to fail, per second.
        lasts: for how many seconds it then fails.
    """

    name: str
    takes: Spread | None = None
    succeeds: float | None = None
    writes: tuple[tuple[str, str], ...] = ()
    condition: str = ""
    fails: float = 0.0
    lasts: float = 0.0


class SaidValue(Record):
    """A value as written: a number and its unit, None without one; or a text, or true or false."""

    value: float | bool | str
    unit: Unit | None = None


class WorldSetting(Record):
    """How a signal changes.

    Attributes:
        signal: its name, or an entry in braces.
        rate: by how much it changes in a second or another time; None: not at all.
        rates: in place of that while nodes run, by their names or paths.
        between: the values that it does not leave; empty: none.
    """

    signal: str
    start: SaidValue
    rate: SaidValue | None = None
    rates: tuple[tuple[str, SaidValue], ...] = ()
    between: tuple[SaidValue, ...] = ()


class SimulationSettings(Record):
    """The settings of a project for simulated runs; driver: None: nothing is said."""

    skills: tuple[SkillSetting, ...] = ()
    world: tuple[WorldSetting, ...] = ()
    driver: Driver | None = None


def read_simulation(table: object) -> tuple[SimulationSettings, list[Complaint]]:
    """The contents of a table, and what is wrong with it."""
    if not isinstance(table, dict):
        return SimulationSettings(), [("`simulate` must be a table", ())]
    complaints = _unknown_keys("simulate", table, KEYS)
    settings: dict[str, tuple[Any, ...]] = {}
    for key, read, what in (("skills", _skill, "skills"), ("world", _signal, "signals")):
        of_key = table.get(key, {})
        if not isinstance(of_key, dict):
            complaints.append((f"`simulate.{key}` must be a table of {what}", (key,)))
            continue
        read_ones = []
        for name, value in of_key.items():
            mistakes: list[Complaint] = []
            setting = read(name, value, mistakes)
            complaints += [(message, (key, name, *below)) for message, below in mistakes]
            read_ones += [setting] if setting is not None and not mistakes else []
        settings[key] = tuple(read_ones)
    driver, wrong = read_driver(table["driver"]) if "driver" in table else (None, [])
    complaints += [(f"`simulate.driver` {message}", ("driver", *below)) for message, below in wrong]
    return SimulationSettings(**settings, driver=driver), complaints


def _unknown_keys(above: str, table: dict[str, object], keys: dict[str, str]) -> list[Complaint]:
    return [
        (f"unknown key `{above}.{key}`{did_you_mean(near(key, keys, 1))}", (key,)) for key in table if key not in keys
    ]


# ---- skills ----


def _skill(name: str, table: object, mistakes: list[Complaint]) -> SkillSetting | None:
    above = f"simulate.skills.{name}"
    if not isinstance(table, dict) or not table:
        mistakes.append((f'`{above}` must be a table such as {{ takes = "6 s", succeeds = "97 %" }}', ()))
        return None
    mistakes += _unknown_keys(above, table, SKILL_KEYS)
    of_condition = [key for key in OF_CONDITIONS if key in table]
    mistakes += [
        (f"`{above}.{key}` does not go with `{of_condition[0]}`, which is for conditions", (key,))
        for key in (OF_ACTIONS if of_condition else ())
        if key in table
    ]
    for key, other in (("fails", "for"), ("for", "fails")):
        if key in table and other not in table:
            mistakes.append((f"`{above}` must have a `{other}` beside its `{key}`", ()))
    fields: dict[str, Any] = {}
    for key, (field, read) in _SKILL_FIELDS.items():
        if key in table:
            fields[field], wrong = read(table[key])
            mistakes += [(f"`{above}.{key}` {message}", (key, *below)) for message, below in wrong]
    setting = SkillSetting(name, **fields)
    if setting.fails * setting.lasts >= 1:
        mistakes.append((f"`{above}.for` must be shorter than the time from one failure to the next", ("for",)))
    return setting


_Read: TypeAlias = "tuple[Any, list[Complaint]]"  # the message without its subject, and the keys below


def _takes(value: object) -> _Read:
    kind: Literal["fixed", "uniform", "lognormal"] = "fixed" if isinstance(value, str) else "uniform"
    ends: list[tuple[object, tuple[str, ...]]]
    if isinstance(value, list) and len(value) == 2:
        ends = [(end, ()) for end in value]
    elif isinstance(value, dict) and value.keys() in ({"from", "to"}, {"median", "p95"}):
        kind = "lognormal" if "median" in value else "uniform"
        ends = [(value[key], (key,)) for key in (("median", "p95") if "median" in value else ("from", "to"))]
    elif isinstance(value, str):
        ends = [(value, ()), (value, ())]
    else:
        return None, [(_TAKES, ())]
    seconds = [_seconds(end) for end, _ in ends]
    for (_, message), (_, below) in zip(seconds, ends, strict=True):
        if message:
            return None, [(message, below)]
    low, high = [number for number, _ in seconds]
    if kind == "lognormal" and not 0 < low < high:
        return None, [("must have a `p95` above its `median`, and both above 0", ("p95",))]
    if kind == "uniform" and not low < high:
        return None, [("must begin with the shorter duration", ())]
    return Spread(kind, low, high), []


def _share(value: object) -> _Read:
    parsed = parse_quantity(value.strip()) if isinstance(value, str) else None
    share = to_si(parsed[0], parsed[1]) if parsed is not None else -1.0
    if parsed is None or parsed[2] != "%" or not 0 <= share <= 1:
        return None, [('must be a percentage from 0 to 100 such as "97 %"', ())]
    return share, []


def _writes(value: object) -> _Read:
    if not isinstance(value, dict) or not value:
        return (), [('must be a table of entries and scripts such as { tubes = "tubes - 1" }', ())]
    writes: list[tuple[str, str]] = []
    for key, written in value.items():
        text = str(written).lower() if isinstance(written, bool) else str(written)
        if not isinstance(written, str | int | float) or (isinstance(written, float) and not isfinite(written)):
            return (), [("must give each entry a number, `true`, `false` or a script", (key,))]
        script = parse_script(text)
        if script.problems or not script.complete or len(script.statements) != 1:
            message = script.problems[0].message if script.problems else "expected one expression"
            return (), [(f"has a mistake in the script of `{key}`: {message}", (key,))]
        writes.append((key, text))
    return tuple(writes), []


def _condition(value: object) -> _Read:
    if isinstance(value, str) and value.strip():
        return " ".join(value.split()), []
    return "", [('must be a condition such as "battery >= 95 %"', ())]


def _frequency(value: object) -> _Read:
    match = _FREQUENCY.fullmatch(value.strip()) if isinstance(value, str) else None
    seconds, message = _seconds(f"{match[2] or 1} {match[3]}" if match is not None else "")
    if match is None or (not message and not (float(match[1]) > 0 and seconds > 0)):
        return 0.0, [('must be how often it happens such as "1 per 8 h"', ())]
    return (0.0, [(message, ())]) if message else (float(match[1]) / seconds, [])


def _lasting(value: object) -> _Read:
    seconds, message = _seconds(value)
    if not message and seconds <= 0:
        message = "must be above 0 s"
    return seconds, [(message, ())] if message else []


def _seconds(value: object) -> tuple[float, str]:
    """A duration in seconds, and what is wrong with it."""
    said, message = _said(value) if isinstance(value, str) else (None, "")
    if message:
        return 0.0, message
    if said is None or said.unit is None or dimension_name(said.unit) != "time":
        return 0.0, 'must be a duration such as "6 s"'
    assert isinstance(said.value, float), "it has a unit"
    seconds = to_si(said.value, said.unit)
    return seconds, "" if 0 <= seconds <= _LONGEST else "must be from 0 s to a year"


# ---- the world ----


def _signal(name: str, table: object, mistakes: list[Complaint]) -> WorldSetting | None:
    above = f"simulate.world.{name}"
    if not isinstance(table, dict) or "start" not in table:
        mistakes.append((f'`{above}` must be a table with a `start` such as {{ start = "60 %" }}', ()))
        return None
    mistakes += _unknown_keys(above, table, WORLD_KEYS)

    def value(key: str, written: object, *below: str) -> SaidValue:
        said, message = _said(written)
        if message:
            mistakes.append((f"`{above}.{key}` {message}", (key, *below)))
        return said or SaidValue(0.0)

    def number(key: str, written: object, *below: str) -> SaidValue:
        said = value(key, written, *below)
        if isinstance(said.value, bool | str):
            mistakes.append((f'`{above}.{key}` must be a number with its unit such as "-0.05 %/s"', (key, *below)))
        return said

    start = value("start", table["start"])
    rates = table.get("while", {})
    between = table.get("between", [])
    if not isinstance(rates, dict):
        mistakes.append(
            (f'`{above}.while` must be a table of nodes and rates such as {{ Charge = "+1 %/s" }}', ("while",))
        )
        rates = {}
    if not isinstance(between, list) or len(between) not in (0, 2):
        mistakes.append((f'`{above}.between` must be two values such as ["0 %", "100 %"]', ("between",)))
        between = []
    limits = tuple(number("between", each) for each in between)
    if isinstance(start.value, bool | str) and (rates or limits or "rate" in table):
        mistakes.append((f"`{above}.start` must be a number if the signal changes with time", ("start",)))
    return WorldSetting(
        name,
        start,
        number("rate", table["rate"]) if "rate" in table else None,
        tuple((node, number("while", rate, node)) for node, rate in rates.items()),
        limits,
    )


def _said(value: object) -> tuple[SaidValue | None, str]:
    """A value as written, and what is wrong with it."""
    if isinstance(value, bool):
        return SaidValue(value), ""
    if isinstance(value, int | float):
        return (SaidValue(float(value)), "") if abs(value) <= _LARGEST else (None, "must be a finite number")
    if not isinstance(value, str) or not value.strip():
        return None, 'must be a value such as "60 %"'
    text = value.strip().removeprefix("+")
    match = _NUMBER.match(text)
    if match is None:
        return SaidValue(value), ""
    number, unit = float(match[0]), text[match.end() :].strip()
    parsed = parse_quantity(text)
    if unit and parsed is None:
        return None, f"has an unknown unit `{unit}`{did_you_mean(nearest_units(unit))}"
    if abs(number) > _LARGEST:
        return None, "must be a finite number"
    return SaidValue(number, parsed[1] if parsed is not None else None), ""


# Each key with a line for editors.
KEYS: Final = {
    "skills": "what skills do, by the names of nodes or paths to them; the most specific name counts",
    "world": "how signals change while a mission runs, by their names",
    "driver": "how the program ticks its tree: a function of the engine, and how long it sleeps between two ticks",
}
OF_ACTIONS: Final = {
    "takes": "a duration, two that it lies between, or its median and 95 % quantile",
    "succeeds": "in how many percent of its activations it succeeds",
    "writes": "what it writes when it succeeds: entries or ports, and scripts for their values",
}
OF_CONDITIONS: Final = {
    "is": "what the condition answers: a condition over signals, and entries in braces",
    "fails": "how often the condition begins to fail, whatever else it would answer",
    "for": "for how long it then fails",
}
SKILL_KEYS: Final = {**OF_ACTIONS, **OF_CONDITIONS}
WORLD_KEYS: Final = {
    "start": "the value at the start of each run",
    "rate": "by how much it changes in a unit of time",
    "while": "the rates while nodes run, in place of `rate`; those of several nodes add up",
    "between": "the two values that it does not leave",
}
# The field of a setting that a key sets, and how its value is read.
_SKILL_FIELDS: Final[dict[str, tuple[str, Callable[[object], _Read]]]] = {
    "takes": ("takes", _takes),
    "succeeds": ("succeeds", _share),
    "writes": ("writes", _writes),
    "is": ("condition", _condition),
    "fails": ("fails", _frequency),
    "for": ("lasts", _lasting),
}
_NUMBER: Final = re.compile(r"-?[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?")
_FREQUENCY: Final = re.compile(r"([0-9]+(?:\.[0-9]+)?) per (?:([0-9]+(?:\.[0-9]+)?) ?)?([A-Za-z]+)")
_LARGEST: Final = 1e300
_LONGEST: Final = 366 * 86400.0  # seconds
_TAKES: Final = (
    'must be a duration such as "6 s", two that it lies between such as ["12 s", "20 s"], or a table such as '
    '{ median = "18 s", p95 = "27 s" }'
)
