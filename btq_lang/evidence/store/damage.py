"""Problems with the files of a store: missing, damaged, of another table or of earlier verdicts."""

from __future__ import annotations

import os
from typing import Any, Final

from btq_lang.evidence.store.tables import COMMON, OF_CLAUSE, OPTIONAL, ROWS, files_of, quoted
from btq_lang.evidence.wording import message_of


def incomplete(connection: Any, store: str) -> str | None:
    """A file that a store lacks, or whose columns are not those of its table.

    Args:
        connection: to DuckDB.
    """
    import duckdb

    if os.path.isfile(store):
        return f"{store}: expected a folder, found a file"
    files = _files(connection, store)
    if not files:
        return f"{store}: no verdicts are kept there; keep some with btq verify LOG --store {store}"
    folders = sorted({file.rpartition("/")[0] for file in files})
    for folder in folders:
        for table in ROWS:
            if (file := f"{folder}/{table}.parquet") not in files:
                return f"{file}: missing; {_AGAIN}"
    lacking: dict[str, set[tuple[str, str]]] = {}
    for table in ROWS:
        wanted = {f"{name} {_STORED[kind]}": (name, kind) for name, kind in _columns(table).items()}
        question = (
            f"SELECT file_name, list({_COLUMN}) FROM parquet_schema({quoted(files_of(store, table))}) GROUP BY ALL"
        )
        try:
            for file, columns in connection.execute(question).fetchall():
                if names := wanted.keys() - columns:
                    lacking[file.replace("\\", "/")] = {wanted[name] for name in names}
        except duckdb.Error:
            return damage(connection, store)
    for folder in folders:
        if all(lacking.get(f"{folder}/{table}.parquet") == columns for table, columns in LATER.items()):
            (log,) = connection.execute(f"SELECT max(source) FROM {quoted(f'{folder}/runs.parquet')}").fetchone()
            return f"{folder}: {judged_earlier(log, store)}"
    for file, columns in lacking.items():
        return _lacking(file, *min(columns))
    return None


def judged_earlier(logs: str, store: str) -> str:
    """A sentence: some logs have verdicts of an earlier version of btq; and what to do."""
    again = f"read such logs again with btq verify LOG --store {store}, or remove their folders"
    return f"an earlier version of btq, with other rules, has judged {logs}; {again}"


def damage(connection: Any, store: str) -> str | None:
    """The first file of a store that cannot be read, or whose columns are not those of its table."""
    import duckdb

    for file in _files(connection, store):
        table, source = file.rpartition("/")[2].removesuffix(".parquet"), f"read_parquet({quoted(file)})"
        try:
            types = {name: kind for name, kind, *_ in connection.execute(f"DESCRIBE FROM {source}").fetchall()}
            connection.execute(f"SELECT max(COLUMNS(*)) FROM {source}").fetchall()
        except duckdb.Error as error:
            return f"{file}: {message_of(error)}; {_AGAIN}"
        if wrong := _columns(table).items() - types.items():
            return _lacking(file, *min(wrong))
    return None


def _lacking(file: str, name: str, kind: str) -> str:
    return f"{file}: no column {name} of the type {kind}; {_AGAIN}"


def _files(connection: Any, store: str) -> list[str]:
    """The files of all tables."""
    patterns = [quoted(files_of(store, table)) for table in ROWS]
    question = " UNION ALL ".join(f"SELECT file FROM glob({pattern})" for pattern in patterns)
    return sorted(file.replace("\\", "/") for (file,) in connection.execute(question).fetchall())


def _columns(table: str) -> dict[str, str]:
    """The columns that a table must have, and their types."""
    others = (*(("clause_index",) if table == "verdicts" else ()), *OPTIONAL.get(table, ()))
    texts = dict.fromkeys((*COMMON[table], *(OF_CLAUSE if table == "verdicts" else ())), "VARCHAR")
    return {
        **texts,
        **{name: kind for name, kind in ROWS[table].items() if name not in others},
    }


# What the sets of earlier versions lack, which took durations for known and read `initially` as a measure.
LATER: Final = {"activations": {("earliest_us", "BIGINT")}, "verdicts": {("most_si", "DOUBLE")}}
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
