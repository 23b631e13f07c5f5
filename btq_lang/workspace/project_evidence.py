"""The table `[evidence]` of a project file: where logs are, and where the samples of signals come from.

    [evidence]
    logs = ["logs/**/*.btlog", "bags/*"]
    store = "evidence"

    [evidence.signals]
    battery = { topic = "/battery_state", field = "percentage", scale = 100, unit = "%" }
    energy  = { file = "power.csv", time = "t", column = "wh", unit = "Wh" }

One invariant: what is wrong is left out and reported, and the rest is kept.  Not known here: missions, files and
topics.
"""

from __future__ import annotations

from collections.abc import Iterator
from sys import float_info
from typing import Any, Final, TypeAlias

from btq_lang.catalog.units import Unit, nearest_units, parse_unit
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near

Complaint: TypeAlias = tuple[str, tuple[str, ...]]  # the message, and the keys below `evidence` to its place


class SignalSource(Record):
    """The source of the samples of a signal: a field of a topic, or a column of a file.

    Attributes:
        signal: its name.
        file: relative to the project file.
        time: the column with the time in seconds since the epoch; empty: the first one.
        scale, offset: the value is what is read, times the scale, plus the offset.
        unit: of the value; None: the signal's own.
    """

    signal: str
    topic: str = ""
    field: str = ""
    file: str = ""
    time: str = ""
    column: str = ""
    scale: float = 1.0
    offset: float = 0.0
    unit: Unit | None = None


class EvidenceSettings(Record):
    """The settings of a project for logs.

    Attributes:
        logs: patterns of paths, relative to the project file.
        store: the folder where verdicts are kept, if any.
        signals: where samples come from, at most one source for each signal.
    """

    logs: tuple[str, ...] = ()
    store: str | None = None
    signals: tuple[SignalSource, ...] = ()


def read_evidence(table: object) -> tuple[EvidenceSettings, list[Complaint]]:
    """The contents of a table, and what is wrong with it."""
    if not isinstance(table, dict):
        return EvidenceSettings(), [("`evidence` must be a table", ())]
    complaints: list[Complaint] = [
        (f"unknown key `evidence.{key}`{did_you_mean(near(key, KEYS, 1))}", (key,)) for key in table if key not in KEYS
    ]
    logs, store, signals = (table.get(key) for key in KEYS)
    if logs is not None and not (isinstance(logs, list) and all(isinstance(each, str) and each for each in logs)):
        complaints.append(("`evidence.logs` must be a list of paths", ("logs",)))
        logs = None
    if store is not None and not (isinstance(store, str) and store):
        complaints.append(("`evidence.store` must be the path of a folder", ("store",)))
        store = None
    if signals is not None and not isinstance(signals, dict):
        complaints.append(("`evidence.signals` must be a table of signals", ("signals",)))
        signals = None
    sources = []
    for name, source in (signals or {}).items():
        wrong = [*_mistakes(name, source)]
        complaints += [(message, ("signals", name, *below)) for message, below in wrong]
        if not wrong:
            unit = source.get("unit")
            sources.append(SignalSource(name, **{**source, "unit": None if unit is None else parse_unit(unit)}))
    return EvidenceSettings(tuple(logs or ()), store, tuple(sources)), complaints


def _mistakes(name: str, source: Any) -> Iterator[Complaint]:
    """The mistakes in the source of a signal, each with the key that has it."""
    key = f"evidence.signals.{name}"
    if not isinstance(source, dict):
        yield f'`{key}` must be a table such as {{ topic = "/battery_state", field = "percentage" }}', ()
        return
    for field in source:
        if field not in SOURCE_KEYS:
            yield f"unknown key `{key}.{field}`{did_you_mean(near(field, SOURCE_KEYS, 1))}", (field,)
    for field in (*TEXTS, "unit"):
        if field in source and not (isinstance(source[field], str) and source[field]):
            yield f"`{key}.{field}` must be a string", (field,)
    for field in NUMBERS:
        number = source.get(field, 0.0)
        if isinstance(number, bool) or not isinstance(number, int | float) or not abs(number) <= float_info.max:
            yield f"`{key}.{field}` must be a number", (field,)
    unit = source.get("unit")
    if isinstance(unit, str) and unit and parse_unit(unit) is None:
        yield f"unknown unit `{unit}`{did_you_mean(nearest_units(unit))}", ("unit",)
    if ("topic" in source) == ("file" in source):
        yield f"`{key}` must have either a `topic` and its `field`, or a `file` and its `column`", ()
        return
    kind, wanted, others = OF_A_TOPIC if "topic" in source else OF_A_FILE
    if wanted not in source:
        yield f"`{key}` must have a `{wanted}` beside its `{kind}`", ()
    for field in others:
        if field in source:
            yield f"`{key}.{field}` does not go with a `{kind}`", (field,)


# Each key with a line for editors.
KEYS: Final = {
    "logs": "patterns of the paths of logs, relative to this file",
    "store": "the folder where btq verify keeps the verdicts",
    "signals": "where the samples of signals come from, by the names of the signals",
}
TEXTS: Final = {
    "topic": "the topic of a bag that has the samples",
    "field": "the field of the topic's messages",
    "file": "the CSV or Parquet file that has the samples, relative to this file",
    "time": "the column with the time in seconds since the epoch; default: the first one",
    "column": "the column with the samples",
}
NUMBERS: Final = {
    "scale": "the value is what is read, times the scale, plus the offset; default: 1",
    "offset": "the value is what is read, times the scale, plus the offset; default: 0",
}
SOURCE_KEYS: Final = {**TEXTS, **NUMBERS, "unit": "the unit of the value; default: that of the signal"}
# What comes with a topic, and what with a file: its key, the key that it requires, and those that do not go with it.
OF_A_TOPIC: Final = ("topic", "field", ("file", "time", "column"))
OF_A_FILE: Final = ("file", "column", ("topic", "field"))
