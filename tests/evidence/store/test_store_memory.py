"""Writing the set of a long log takes little memory, and works with any rows."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import duckdb
import pytest

from btq_lang.evidence.store import engine
from btq_lang.evidence.store.rows import file_of
from btq_lang.evidence.store.tables import ROWS

ROOT = Path(__file__).parents[3]
COMMON = {"log": "0" * 64, "label": "", "source": "log"}
MEASURE = """
import resource, sys
from btq_lang.evidence.store import engine
peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)
engine.imported()
before = peak()
engine.write_parquet(sys.argv[1], {"log": "0" * 64, "label": "", "source": "log"})
print(peak() - before)
"""


def written(folder: Path, activations: int, name: str = "Move") -> Path:
    """The rows of a log with nothing but activations."""
    for table in ROWS:
        Path(file_of(str(folder), table)).touch()
    with open(file_of(str(folder), "activations"), "w", encoding="utf-8") as file:
        for number in range(activations):
            at = 1_795_209_740_000_000 + number * 1000
            path = f"{number:08}" * (len(name) // 8) or name
            file.write(f"main,r7,{number // 9},2,{path},{path},{name[:8]},True,{at},{at + 500},succeeded,exact,{at}\n")
    return folder


@pytest.mark.scheduled
def test_a_set_is_never_in_memory_as_a_whole(tmp_path: Path) -> None:
    command = [sys.executable, "-c", MEASURE, str(written(tmp_path, 1_000_000))]
    run = subprocess.run(command, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True)
    assert (tmp_path / "activations.csv").stat().st_size > 80_000_000
    assert float(run.stdout) < 110, run.stderr  # 94 MB; 138 if DuckDB keeps what it has read


def test_rows_that_take_more_memory_than_that(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "_MEMORY", "10MB")
    engine._writer.cache_clear()
    engine.write_parquet(str(written(tmp_path, 20_000, "Move" * 250)), COMMON)
    engine._writer.cache_clear()
    question = f"SELECT count(DISTINCT path), max(length(path)) FROM '{tmp_path}/activations.parquet'"
    assert duckdb.connect().execute(question).fetchall() == [(20_000, 1000)]
