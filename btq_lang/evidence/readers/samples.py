"""Samples of signals in a CSV or Parquet file: a column with times, the first one by default, and columns of values.

One invariant: a cell that is empty, or not a finite number, is not a sample, and a time that cannot be read is an
error with its line.  DuckDB reads Parquet; any of its failures is one NoSamples.
"""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

from btq_lang.evidence.model import SampleSeries, SampleValue, is_sample
from btq_lang.evidence.wording import message_of
from btq_lang.util.spelling import did_you_mean, near

if TYPE_CHECKING:
    from btq_lang.workspace.project_evidence import SignalSource


class NoSamples(Exception):
    """A file that is not a table of samples; the message says what was expected."""


def read(path: str, time: str = "") -> dict[str, SampleSeries]:
    """The samples of a file, by the names of their columns.

    Args:
        time: the column with the time in seconds since the epoch; empty: the first one.

    Raises:
        NoSamples: it is not such a table.
        OSError: it cannot be read.
    """
    with open(path, "rb") as file:
        is_parquet = file.read(len(_PARQUET)) == _PARQUET
    if is_parquet:
        names, rows = _parquet_columns(path)
        return _table(names, time, ((f"row {number}", row) for number, row in enumerate(rows, start=1)))
    with open(path, encoding="utf-8-sig", errors="replace", newline="") as text:
        lines = csv.reader(text)
        try:
            names = [name.strip() for name in next(lines, [])]
            if any("\0" in name for name in names):
                raise NoSamples("expected text in UTF-8, found UTF-16 or no text")
            if names and isinstance(_value(names[0]), float):
                raise NoSamples(f"line 1: {_NAMES}, found the number `{names[0]}`; write one above it: `t,battery`")
            rows_of_text = ([_value(cell.strip()) for cell in row] for row in lines if row)
            return _table(names, time, ((f"line {lines.line_num}", row) for row in rows_of_text))
        except csv.Error as error:
            raise NoSamples(f"line {lines.line_num}: {error}") from error


def _table(names: list[str], time: str, rows: Iterable[tuple[str, Sequence[object]]]) -> dict[str, SampleSeries]:
    """The columns of a table; rows: each with its place in the file."""
    if len(names) < 2:
        raise NoSamples(_NAMES)
    time_column = names.index(_checked_column(time, names)) if time else 0
    others = [name for column, name in enumerate(names) if column != time_column]
    if twice := next((name for name in others if others.count(name) > 1), None):
        raise NoSamples(f"two columns are named `{twice}`")
    series = {name: SampleSeries() for name in others}
    for place, row in rows:
        moment = _time(row[time_column] if time_column < len(row) else None, place)
        for column, value in enumerate(row[: len(names)]):
            if column != time_column and isinstance(value, bool | int | float | str) and is_sample(value):
                series[names[column]].add(moment, value)
    return series


def read_sources(sources: Iterable[SignalSource], folder: str) -> dict[str, SampleSeries]:
    """The samples of signals that come from files, which are below a folder unless their paths are absolute.

    Raises:
        NoSamples: a file does not match its source.
        OSError: it cannot be read.
    """
    files: dict[tuple[str, str], dict[str, SampleSeries]] = {}
    series_by_signal: dict[str, SampleSeries] = {}
    for source in sources:
        if not source.file:
            continue
        key = source.file, source.time
        try:
            if key not in files:
                files[key] = read(os.path.join(folder, source.file), source.time)
            column = files[key][_checked_column(source.column, files[key])]
        except NoSamples as error:
            raise NoSamples(f"{source.file}: {error}") from error
        series = series_by_signal[source.signal] = SampleSeries(source.unit)
        for time, value in zip(column.times, column.values, strict=True):
            series.add(time, scaled(value, source))
    return series_by_signal


def scaled(value: SampleValue | None, source: SignalSource) -> SampleValue | None:
    """A value in the unit of its source."""
    if value is None or isinstance(value, str) or (source.scale == 1 and source.offset == 0):
        return value
    return value * source.scale + source.offset


def _checked_column(column: str, names: Iterable[str]) -> str:
    if column not in (there := [*names]):
        meant = did_you_mean(near(column, there, 1)) or f"; it has {', '.join(there)}"
        raise NoSamples(f"no column `{column}`{meant}")
    return column


def _time(value: object, place: str) -> int:
    """µs since the epoch, of a value in seconds."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= _LATEST:
        raise NoSamples(f"{place}: `{'' if value is None else value}` is not a time in seconds since the epoch")
    return round(value * 1e6)


def _value(cell: str) -> SampleValue | None:
    try:
        return float(cell)
    except ValueError:
        return cell or None


def _parquet_columns(path: str) -> tuple[list[str], Iterator[tuple[Any, ...]]]:
    """The names of the columns, and the rows; timestamps are in seconds since the epoch.

    Raises:
        NoSamples: DuckDB is missing, or cannot read the file, also while the rows are read.
    """
    try:
        import duckdb

        database = _engine().cursor()
    except ImportError as error:
        raise NoSamples("Parquet is read with duckdb; install it with pip install 'btq-lang[evidence]'") from error
    try:
        columns = database.execute("DESCRIBE SELECT * FROM read_parquet(?)", [path]).fetchall()
    except duckdb.Error as error:
        raise NoSamples(message_of(error)) from error
    names = [str(name) for name, *_ in columns]
    expressions = ", ".join(_expression(str(name), str(kind)) for name, kind, *_ in columns)

    def rows() -> Iterator[tuple[Any, ...]]:
        try:
            result = database.execute(f"SELECT {expressions} FROM read_parquet(?)", [path])
            while block := result.fetchmany(_ROWS_AT_ONCE):
                for row in block:
                    yield tuple(float(value) if isinstance(value, Decimal) else value for value in row)
        except duckdb.Error as error:
            raise NoSamples(message_of(error)) from error
        finally:
            database.close()

    return names, rows()


@lru_cache(1)
def _engine() -> Any:
    """A connection to DuckDB; with a single thread, because starting others takes longer than reading most files."""
    import duckdb

    return duckdb.connect(config={"threads": 1})


def _expression(name: str, kind: str) -> str:
    quoted = '"' + name.replace('"', '""') + '"'
    return f"epoch_us({quoted}) / 1e6" if kind.startswith(("TIMESTAMP", "DATE")) else quoted


_NAMES: Final = "expected a line of column names, separated by commas: the time first, then signals or their entries"
_LATEST: Final = 9e12  # s since the epoch, in µs still 64 bits
_PARQUET: Final = b"PAR1"
_ROWS_AT_ONCE: Final = 4096
