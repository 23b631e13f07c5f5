"""Stored files that are damaged by chance: an answer, or one error that names a file; and nothing is lost."""

from __future__ import annotations

import random
from pathlib import Path

import duckdb
import pytest
from evidence_logs import MAIN, MAIN_XML, START, btlog, rows
from in_process import run_btq
from seeds import seeds, share_of

from btq_lang.evidence.store.engine import NoEngine, asked
from btq_lang.evidence.store.summary import summary

MISSION = "QualityReq quick : safety\n    Move takes at most 15 ms\n" + MAIN
CASES, SHARE = 20_000, 400


@pytest.fixture
def store(tmp_path: Path) -> Path:
    """A store of two logs."""
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    for number in range(2):
        log = f"1R 2R {12 + 5 * number} 2S 3R 25 3S 1S 26 2I 3I 1I"
        (tmp_path / f"{number}.btlog").write_bytes(btlog(MAIN_XML, rows(log), START + number * 60_000_000))
    run_btq("verify", "0.btlog", "1.btlog", "--mission", "main.btq", "--store", "kept", cwd=tmp_path)
    return tmp_path / "kept"


def damaged(chance: random.Random, data: bytes, others: list[bytes]) -> bytes | None:
    """A file with bytes changed, cut, empty, another one, or gone."""
    how = chance.randrange(7)
    if how < 3:
        changed = bytearray(data)
        for _ in range(chance.choice((1, 1, 2, 8))):
            changed[chance.randrange(len(data))] = chance.randrange(256)
        return bytes(changed)
    return (data[: chance.randrange(len(data))], b"", chance.choice(others), None)[how - 3]


def problem(store: Path) -> str | None:
    """Why a store has no summary."""
    try:
        summary(asked(str(store)), "kept")
    except NoEngine as error:
        return str(error)
    return None


def test_damaged_files_are_named(store: Path) -> None:
    paths = sorted(store.glob("*/*.parquet"))
    whole = {path: path.read_bytes() for path in paths}
    expected = summary(asked(str(store)), "kept")
    for case in share_of(seeds(CASES), SHARE):
        chance = random.Random(case)
        path = chance.choice(paths)
        data = damaged(chance, whole[path], [*whole.values()])
        path.unlink()
        if data is not None:
            path.write_bytes(data)
        error = problem(store)
        if error is None:
            assert data, f"case {case}: {path} is missing or empty"
        else:
            assert any(str(each) in error for each in paths), f"case {case}: {error}"
            assert error.endswith("; remove its folder and read its log again"), f"case {case}: {error}"
            assert "\n" not in error
        path.write_bytes(whole[path])
    assert summary(asked(str(store)), "kept") == expected


@pytest.mark.parametrize("table", ["runs", "activations", "clauses", "verdicts"])
def test_a_file_that_is_missing_or_of_another_table(table: str, store: Path) -> None:
    path = sorted(store.glob(f"*/{table}.parquet"))[-1]
    path.unlink()
    again = "remove its folder and read its log again"
    code, output, errors = run_btq("verify", "--store", "kept", cwd=store.parent)
    named = path.relative_to(store.parent)
    assert (code, output, errors) == (2, "", f"btq verify: {named}: missing; {again}\n")
    other = "clauses" if table != "clauses" else "runs"
    path.write_bytes(path.with_name(f"{other}.parquet").read_bytes())
    code, output, errors = run_btq("verify", "--store", "kept", cwd=store.parent)
    assert (code, output) == (2, "")
    assert errors.startswith(f"btq verify: {named}: no column ")


@pytest.mark.parametrize(
    ("column", "other", "type_"),
    [
        ("mission", "mission::BLOB", "VARCHAR"),
        ("run", "[run]", "INTEGER"),
        ("start_us", "make_timestamp(run)", "BIGINT"),
    ],
)
def test_a_column_of_another_type(column: str, other: str, type_: str, store: Path) -> None:
    path = sorted(store.glob("*/runs.parquet"))[0]
    changed = f"SELECT * REPLACE ({other} AS {column}) FROM '{path}'"
    duckdb.sql(f"COPY ({changed}) TO '{path.with_suffix('.new')}' (FORMAT parquet)")
    path.with_suffix(".new").replace(path)
    message = f"btq verify: {path.relative_to(store.parent)}: no column {column} of the type {type_}; "
    message += "remove its folder and read its log again\n"
    assert run_btq("verify", "--store", "kept", cwd=store.parent) == (2, "", message)


def judged_earlier(folder: Path) -> None:
    """Make a set that btq has written before durations were intervals."""
    for table, column in (("activations", "earliest_us"), ("verdicts", "most_si")):
        path = folder / f"{table}.parquet"
        duckdb.sql(f"COPY (SELECT * EXCLUDE ({column}) FROM '{path}') TO '{path}.new' (FORMAT parquet)")
        Path(f"{path}.new").replace(path)
    about = folder / "about.json"
    about.write_text(about.read_text(encoding="utf-8").replace('"version": 4', '"version": 1'), encoding="utf-8")


@pytest.mark.parametrize(
    "command", [("verify", "--store", "kept"), ("compare", "kept", "a", "b"), ("report", "kept", "-o", "x.html")]
)
def test_sets_of_an_earlier_version_are_to_be_judged_again(command: tuple[str, ...], store: Path) -> None:
    """Its verdicts may say `satisfied` where nothing was measured."""
    folder = store.parent
    log = duckdb.execute(f"SELECT DISTINCT log FROM '{store}/*/runs.parquet' WHERE source = '1.btlog'").fetchall()
    old = store / log[0][0]
    judged_earlier(old)
    said = "an earlier version of btq, with other rules, has judged 1.btlog"
    again = "read such logs again with btq verify LOG --store kept, or remove their folders"
    message = f"btq {command[0]}: {old.relative_to(folder)}: {said}; {again}\n"
    assert run_btq(*command, cwd=folder) == (2, "", message)
    assert run_btq("verify", "1.btlog", "--mission", "main.btq", "--store", "kept", cwd=folder)[::2] == (1, "")
    assert "earlier version" not in run_btq(*command, cwd=folder)[2]


def test_sets_without_the_columns_of_this_version_are_read(store: Path) -> None:
    """Goals and pairs of bounds are missing in sets of version 2, rates in those before them; nothing else depends on
    them.
    """
    before = run_btq("report", "kept", cwd=store.parent)
    for path in store.glob("*/clauses.parquet"):
        columns = "lower_si, upper_si, goal_si, rate_low, rate_high, rate_strict, rate_seconds"
        columns += ", mean_low, mean_high, mean_strict"
        duckdb.sql(f"COPY (SELECT * EXCLUDE ({columns}) FROM '{path}') TO '{path}.new' (FORMAT parquet)")
        Path(f"{path}.new").replace(path)
    for path in store.glob("*/verdicts.parquet"):
        columns = "number, number_most, exposure_s, exposure_most_s"
        duckdb.sql(f"COPY (SELECT * EXCLUDE ({columns}) FROM '{path}') TO '{path}.new' (FORMAT parquet)")
        Path(f"{path}.new").replace(path)
    assert run_btq("report", "kept", cwd=store.parent) == before
