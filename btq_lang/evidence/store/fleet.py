"""Other engines, asked through Ibis: the questions are translated from DuckDB's SQL, and the engine reads the files."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from btq_lang.evidence.store.damage import LATER, judged_earlier
from btq_lang.evidence.store.engine import NoEngine
from btq_lang.evidence.store.queries import REPEATED
from btq_lang.evidence.store.tables import OPTIONAL, ROWS, files_of


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
            lacking = {name: ibis.null("float64") for name in names if name not in tables[table].columns}
            tables[table] = tables[table].mutate(**lacking) if lacking else tables[table]
        left_out = ibis.memtable(ask(REPEATED), schema={"log": "string", "run": "int32"})
        kept = {name: each.anti_join(left_out, ["log", "run"]) for name, each in tables.items() if name != "clauses"}
        kept["clauses"] = tables["clauses"].semi_join(kept["runs"], ["log", "mission", "robot"])
        repeated = tables["runs"].semi_join(left_out, ["log", "run"])
        for table, found in {"repeated": repeated, **kept}.items():  # what names a table, before that is replaced
            connection.create_view(table, found, overwrite=True)
    except NoEngine:
        raise
    except Exception as error:  # likewise
        raise _failed(url, error) from error
    return ask


def _failed(url: str, error: Exception) -> NoEngine:
    return NoEngine(f"{url}: {' '.join(str(error).split()) or type(error).__name__}")
