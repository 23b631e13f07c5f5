"""The engines: DuckDB, which writes the files of a set and answers questions about a store, and others through Ibis.

One invariant: nothing else imports DuckDB for the store; any failure is an OSError, or a NoEngine with one sentence.

For another engine, Ibis translates the questions from DuckDB's SQL, and the engine reads the files itself.
"""

from __future__ import annotations

import os
import re
import tempfile
import uuid
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, Final

from btq_lang.evidence.store.damage import LATER, damage, incomplete, judged_earlier
from btq_lang.evidence.store.queries import REPEATED
from btq_lang.evidence.store.rows import file_of
from btq_lang.evidence.store.tables import COMMON, OF_CLAUSE, OPTIONAL, ROWS, files_of, quoted
from btq_lang.evidence.wording import message_of


class NoEngine(Exception):
    """The engine is missing, or cannot do what it should; the message says why."""


def write_parquet(folder: str, common: Mapping[str, str]) -> None:
    """Write the Parquet files of a set from its rows.

    Args:
        common: what all rows of a table have in common.

    Raises:
        NoEngine: DuckDB is missing, or fails.
        OSError: the files cannot be written; the disk may be full.
    """
    duckdb = imported()
    cursor = _writer(os.getpid()).cursor()
    try:
        for table in ROWS:
            try:
                cursor.execute(_copy(folder, table, common))
            except duckdb.OutOfMemoryException:  # kilobytes of text in each row
                cursor.execute("RESET memory_limit")
                cursor.execute(_copy(folder, table, common))
    except duckdb.Error as error:
        if match := re.search(r'"errno":"(\d+)"', str(error)):
            raise OSError(int(match[1]), os.strerror(int(match[1]))) from error
        raise NoEngine(message_of(error)) from error
    finally:
        cursor.close()


def asked(store: str, label: str | None = None) -> Callable[[str], list[dict[str, Any]]]:
    """A function that gives DuckDB a question about a store, and returns the rows by the names of their columns.

    Args:
        label: None: all runs count; else only those of this label.

    Raises:
        NoEngine: DuckDB is missing, or the store has no sets or a damaged one; so does the function.
    """
    duckdb = imported()
    # DuckDB makes this folder when it needs it, and removes it.
    spilled = os.path.join(tempfile.gettempdir(), f"btq-{uuid.uuid4().hex}")
    connection = duckdb.connect(config={"memory_limit": _MOST, "temp_directory": spilled})

    def executed(question: str) -> Any:
        try:
            return connection.execute(question)
        except duckdb.OutOfMemoryException:  # not all that a question needs can be on the disk
            connection.execute("RESET memory_limit")
            return connection.execute(question)

    def ask(question: str) -> list[dict[str, Any]]:
        try:
            result = executed(question)
            names = [str(column[0]) for column in result.description]
            return [dict(zip(names, row, strict=True)) for row in result.fetchall()]
        except duckdb.Error as error:
            raise NoEngine(damage(connection, store) or f"{store}: {message_of(error)}") from error

    if problem := incomplete(connection, store):
        raise NoEngine(problem)
    wanted = f"label = {quoted(label)}" if label is not None else "true"
    for table in ROWS:
        files = quoted(files_of(store, table))
        rows = f"SELECT * FROM read_parquet({files}, union_by_name = true)"
        if optional := ", ".join(f"NULL::{ROWS[table][name]} AS {name}" for name in OPTIONAL.get(table, ())):
            rows += f" UNION ALL BY NAME SELECT {optional} WHERE false"
        ask(f"CREATE VIEW all_{table} AS SELECT * FROM ({rows}) WHERE {wanted}")
        ask(f"CREATE VIEW {table} AS FROM all_{table}")
    ask(f"CREATE TABLE left_out AS {REPEATED}")
    ask("CREATE VIEW repeated AS SELECT all_runs.* FROM all_runs JOIN left_out USING (log, run)")
    if ask("FROM left_out LIMIT 1"):
        for table in ROWS:
            keys, kept = ("log, mission, robot", "SEMI JOIN runs") if table == "clauses" else ("log, run", _KEPT)
            ask(f"CREATE OR REPLACE VIEW {table} AS SELECT * FROM all_{table} {kept} USING ({keys})")
    return ask


def imported() -> Any:
    """The module `duckdb`.

    Raises:
        NoEngine: it is not installed.
    """
    try:
        import duckdb
    except ImportError as error:
        raise NoEngine(
            "a store is written and read with duckdb; install it with pip install 'btq-lang[evidence]'"
        ) from error
    return duckdb


@lru_cache(1)
def _writer(process: int) -> Any:
    """A connection of this process: a connection made before a fork must not serve both processes.

    Its memory limit frees text that has been read; otherwise all of it stays.
    """
    return imported().connect(config={"threads": 1, "memory_limit": _MEMORY, "temp_directory": ""})


def _copy(folder: str, table: str, common: Mapping[str, str]) -> str:
    """The statement that writes a table, in the order of its rows."""
    columns = [f"{quoted(common[name])} AS {name}" for name in COMMON[table]]
    sources = _rows(folder, table)
    if table == "verdicts":  # a join would change the order
        lists = ", ".join(f"list({name} ORDER BY clause_index) AS {name}s" for name in OF_CLAUSE)
        sources += f", (SELECT {lists} FROM {_rows(folder, 'clauses')}) AS names"
        columns += [f"coalesce(names.{name}s[verdicts.clause_index + 1], '') AS {name}" for name in OF_CLAUSE]
    for name in ROWS[table]:
        if (table, name) != ("verdicts", "clause_index"):
            columns.append(f"coalesce({name}, '') AS {name}" if name in OF_CLAUSE else name)
    target = quoted(os.path.join(folder, f"{table}.parquet"))
    return f"COPY (SELECT {', '.join(columns)} FROM {sources}) TO {target} ({_OPTIONS})"


def _rows(folder: str, table: str) -> str:
    """The rows of a table, as they are in its text."""
    types = ", ".join(f"{quoted(name)}: {quoted(kind)}" for name, kind in ROWS[table].items())
    form = "header = false, auto_detect = false, delim = ',', quote = '\"', escape = '\"', nullstr = ''"
    form += f", buffer_size = {_BUFFER}"
    return f"read_csv({quoted(file_of(folder, table))}, columns = {{{types}}}, {form}, parallel = false) AS {table}"


def asked_by(url: str, store: str) -> Callable[[str], list[dict[str, Any]]]:
    """A function that gives an engine a question about a store, and returns the rows by the names of their columns.

    Args:
        url: of the engine, as Ibis takes it: `polars://`.

    Raises:
        NoEngine: Ibis or the engine is missing, or the engine fails; so does the function.
    """
    try:
        import ibis
    except ImportError as error:
        raise NoEngine("other engines are asked with ibis; install it with pip install 'btq-lang[fleet]'") from error

    def ask(question: str) -> list[dict[str, Any]]:
        try:
            rows: list[dict[str, Any]] = connection.sql(question, dialect="duckdb").to_pyarrow().to_pylist()
        except Exception as error:  # each engine has errors of its own
            raise _failed(url, error) from error
        return rows

    try:
        connection = ibis.connect(url)
        tables = {table: connection.read_parquet(files_of(store, table), table_name=table) for table in ROWS}
        for table, columns in LATER.items():
            if not {name for name, _ in columns} <= {*tables[table].columns}:
                raise NoEngine(f"{store}: {judged_earlier('logs in it', store)}")
        for table, names in OPTIONAL.items():
            types = {name: "string" if ROWS[table][name] == "VARCHAR" else "float64" for name in names}
            lacking = {name: ibis.null(types[name]) for name in names if name not in tables[table].columns}
            tables[table] = tables[table].mutate(**lacking) if lacking else tables[table]
        left_out = ibis.memtable(ask(REPEATED), schema={"log": "string", "run": "int32"})
        kept = {name: rows.anti_join(left_out, ["log", "run"]) for name, rows in tables.items() if name != "clauses"}
        kept["clauses"] = tables["clauses"].semi_join(kept["runs"], ["log", "mission", "robot"])
        repeated = tables["runs"].semi_join(left_out, ["log", "run"])
        for table, view in {"repeated": repeated, **kept}.items():  # what names a table, before that is replaced
            connection.create_view(table, view, overwrite=True)
    except NoEngine:
        raise
    except Exception as error:  # likewise
        raise _failed(url, error) from error
    return ask


def _failed(url: str, error: Exception) -> NoEngine:
    return NoEngine(f"{url}: {message_of(error)}")


# The rows of a group are in memory together: fewer than DuckDB's 122 880 take less memory, and few more bytes on the
# disk.
_OPTIONS: Final = "FORMAT parquet, COMPRESSION zstd, PARQUET_VERSION v2, ROW_GROUP_SIZE 20480"
_KEPT: Final = "ANTI JOIN left_out"
_BUFFER: Final = 4_000_000  # bytes of text that are read at once
_MEMORY: Final = "64MB"
_MOST: Final = "400MB"  # of a question; what exceeds it goes to the disk
