"""Samples of signals in a CSV file: the first column is the time, the others are named as signals or their entries.

One invariant: a cell that is empty, or not a finite number, is not a sample, and a time that cannot be read is an
error with its line.
"""

from __future__ import annotations

import csv
from math import isfinite

from btq_lang.evidence.model import Series, is_sample

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

    from btq_lang.evidence.model import SampleValue


class NoSamples(Exception):
    """A file is not the table of samples that it was taken for; the message says what was expected."""


def read(path: str) -> dict[str, Series]:
    """The samples of a file, by the names of their columns.

    Raises:
        NoSamples: it is not such a table.
        OSError: it cannot be read.
    """
    with open(path, encoding="utf-8-sig", errors="replace", newline="") as file:
        rows = csv.reader(file)
        try:
            names = [name.strip() for name in next(rows, [])]
            if len(names) < 2:
                raise NoSamples("expected a line of column names: the time first, then signals or their entries")
            if twice := next((name for name in names[1:] if names[1:].count(name) > 1), None):
                raise NoSamples(f"two columns are named `{twice}`")
            found = {name: Series() for name in names[1:]}
            for row in rows:
                if row:
                    time = _time(row[0], rows.line_num)
                    for name, cell in zip(names[1:], row[1:], strict=False):
                        if (value := _value(cell.strip())) is not None:
                            found[name].add(time, value)
        except csv.Error as error:
            raise NoSamples(f"line {rows.line_num}: {error}") from error
    return found


def _time(cell: str, line: int) -> int:
    """µs since the epoch, of a cell with seconds."""
    try:
        seconds = float(cell)
    except ValueError:
        seconds = float("nan")
    if not isfinite(seconds) or abs(seconds) > _LATEST:
        raise NoSamples(f"line {line}: `{cell}` is not a time in seconds since the epoch")
    return round(seconds * 1e6)


def _value(cell: str) -> SampleValue | None:
    try:
        number = float(cell)
    except ValueError:
        return cell or None
    return number if is_sample(number) else None


_LATEST: Final = 9e12  # s since the epoch, in µs still 64 bits
