"""What is wrong with the files of a store: those that are missing, damaged or of another table."""

from __future__ import annotations

import os
from typing import Any, Final

from btq_lang.evidence.store.tables import COMMON, OF_CLAUSE, ROWS, files_of, quoted


def incomplete(connection: Any, store: str) -> str | None:
    """A file that a store lacks, or whose columns are not those of its table.

    Args:
        connection: to DuckDB.
    """
    import duckdb

    if os.path.isfile(store):
        return f"{store}: expected a folder, found a file"
    found = _files(connection, store)
    if not found:
        return f"{store}: no verdicts are kept there; keep some with btq verify LOG --store {store}"
    for folder in sorted({file.rpartition("/")[0] for file in found}):
        for table in ROWS:
            if (file := f"{folder}/{table}.parquet") not in found:
                return f"{file}: missing; {_AGAIN}"
    for table in ROWS:
        wanted = {f"{name} {_STORED[kind]}": (name, kind) for name, kind in _columns(table).items()}
        question = (
            f"SELECT file_name, list({_COLUMN}) FROM parquet_schema({quoted(files_of(store, table))}) GROUP BY ALL"
        )
        try:
            for file, columns in connection.execute(question).fetchall():
                if lacking := wanted.keys() - columns:
                    return _lacking(file, *min(wanted[each] for each in lacking))
        except duckdb.Error:
            return damage(connection, store)
    return None


def damage(connection: Any, store: str) -> str | None:
    """The first file of a store that cannot be read, or whose columns are not those of its table."""
    import duckdb

    for file in _files(connection, store):
        table, source = file.rpartition("/")[2].removesuffix(".parquet"), f"read_parquet({quoted(file)})"
        try:
            types = {name: kind for name, kind, *_ in connection.execute(f"DESCRIBE FROM {source}").fetchall()}
            connection.execute(f"SELECT max(COLUMNS(*)) FROM {source}").fetchall()
        except duckdb.Error as error:
            return f"{file}: {' '.join(str(error).split())}; {_AGAIN}"
        if wrong := _columns(table).items() - types.items():
            return _lacking(file, *min(wrong))
    return None


def _lacking(file: str, name: str, kind: str) -> str:
    return f"{file}: no column {name} of the type {kind}; {_AGAIN}"


def _files(connection: Any, store: str) -> list[str]:
    """The files of all tables."""
    patterns = [quoted(files_of(store, table)) for table in ROWS]
    question = " UNION ALL ".join(f"SELECT file FROM glob({each})" for each in patterns)
    return sorted(file.replace("\\", "/") for (file,) in connection.execute(question).fetchall())


def _columns(table: str) -> dict[str, str]:
    """The columns of a table and their types."""
    texts = dict.fromkeys((*COMMON[table], *(OF_CLAUSE if table == "verdicts" else ())), "VARCHAR")
    return {
        **texts,
        **{name: kind for name, kind in ROWS[table].items() if (table, name) != ("verdicts", "clause_index")},
    }


# A column as Parquet has it: its name, that it repeats, its type, and what that is converted to.  Integers of the
# width of their type may say so or not.
_COLUMN: Final = """concat_ws(
    ' ', name, if(repetition_type = 'REPEATED', 'REPEATED', NULL), type, nullif(converted_type, 'INT_' || type[4:])
)"""
_STORED: Final = {
    "VARCHAR": "BYTE_ARRAY UTF8",
    "INTEGER": "INT32",
    "BIGINT": "INT64",
    "DOUBLE": "DOUBLE",
    "BOOLEAN": "BOOLEAN",
}
_AGAIN: Final = "remove its folder and read its log again"
