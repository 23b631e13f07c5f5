"""The columns of a Parquet file, read by DuckDB.

One invariant: any failure of DuckDB is one NoSamples whose message names what was expected.
"""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal
from functools import lru_cache
from typing import Any, Final

MAGIC: Final = b"PAR1"


class NoSamples(Exception):
    """A file that is not a table of samples; the message says what was expected."""


def read(path: str) -> tuple[list[str], Iterator[tuple[Any, ...]]]:
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
        raise NoSamples(_message(error)) from error
    names = [str(name) for name, *_ in columns]
    expressions = ", ".join(_expression(str(name), str(kind)) for name, kind, *_ in columns)

    def rows() -> Iterator[tuple[Any, ...]]:
        try:
            found = database.execute(f"SELECT {expressions} FROM read_parquet(?)", [path])
            while block := found.fetchmany(_ROWS_AT_ONCE):
                for row in block:
                    yield tuple(float(value) if isinstance(value, Decimal) else value for value in row)
        except duckdb.Error as error:
            raise NoSamples(_message(error)) from error
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


def _message(error: Exception) -> str:
    return " ".join(str(error).split())


_ROWS_AT_ONCE: Final = 4096
