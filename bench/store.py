"""What the evidence store takes: to summarise millions of verdicts, to judge a folder of logs in two processes, and on
the disk.

The summary of btq beside the same counts by hand in SQL and, where pandas is installed, in pandas, on the same files.
The folder of logs by one process and by two, each as a person starts it, with the verdicts kept.

    python bench/store.py [--verdicts N] [--logs N] [--transitions N] [--rounds N] [--json]
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import duckdb
from report import ENVIRONMENT, Goal, as_data, machine, options, shown
from robot_log import FETCH, fetching

from btq_lang.evidence.store.engine import asked
from btq_lang.evidence.store.summary import summary

# robot_log has put the tests on the path
from evidence_logs import btlog  # isort: skip

ROOT = Path(__file__).resolve().parents[1]
CLAUSES, RUNS = 10, 1000  # of each log
IN_A_LOG = 50_000  # verdicts
PROCESSES = {"one": "one process", "two": "two processes"}
COMMON = """
    printf('%064x', getvariable('log')) AS log, 'v' || getvariable('log') % 4 AS label, 'main' AS mission,
    'r' || getvariable('log') % 50 AS robot
"""
CLAUSE = "'rq' || clause_index AS requirement, 'Do takes at most 1 s' AS clause, 'Do::' || clause_index AS node"
QUESTIONS = {  # of the tables of a made-up log
    "runs": f"""
        SELECT {COMMON}, 'x.btlog' AS source, run::INTEGER AS run, 1795209740000000 + run * 60000000 AS start_us,
            start_us + 50000000 AS end_us, 'succeeded' AS outcome, 50 AS activations, 0 AS retries, 0 AS recoveries,
            NULL::VARCHAR AS failure, '' AS tree, 40 AS nodes, 40 AS joined
        FROM range(1, {RUNS + 1}) AS t(run)
    """,
    "clauses": f"""
        SELECT {COMMON}, clause_index::INTEGER AS clause_index, {CLAUSE}, '' AS title, NULL::VARCHAR AS measures,
            'activations' AS counts, 's' AS unit, NULL::DOUBLE AS odds, NULL::VARCHAR AS relation,
            NULL::VARCHAR AS experiments, NULL::DOUBLE AS confidence, NULL::INTEGER AS last_number,
            NULL::VARCHAR AS last_of, NULL::DOUBLE AS last_seconds, true AS exercised, 0 AS cut_off,
            NULL::VARCHAR AS missing
        FROM range({CLAUSES}) AS t(clause_index)
    """,
    "activations": f"""
        SELECT {COMMON}, 1 AS run, 1 AS uid, '' AS path, '' AS node, '' AS kind, true AS leaf, 0::BIGINT AS start_us,
            0::BIGINT AS end_us, '' AS outcome, '' AS timing, 0::BIGINT AS earliest_us
        LIMIT 0
    """,
    "verdicts": f"""
        SELECT {COMMON}, {CLAUSE}, run::INTEGER AS run, 'Do::' || clause_index AS path,
            1795209740000000 + run * 60000000 + n * 1000000 AS start_us, start_us + (took * 1e6)::BIGINT AS end_us,
            if(took > 1, 'violated', 'satisfied') AS verdict, true AS counted, if(took > 1, end_us, NULL) AS at_us,
            took AS measured_si, 1.0::DOUBLE AS bound_si, if(took > 1, 'took {{}}', NULL) AS why,
            NULL::DOUBLE AS most_si
        FROM (
            SELECT 1 + i // {IN_A_LOG // RUNS} AS run, i % {IN_A_LOG // RUNS} AS n, i % {CLAUSES} AS clause_index,
                (hash(i + getvariable('log') * {IN_A_LOG}) % 1010000)::DOUBLE / 1e6 AS took
            FROM range({IN_A_LOG}) AS t(i)
        )
    """,
}


def made_up(folder: Path, verdicts: int) -> None:
    """A store of logs of 1 000 runs, each with 50 verdicts on ten clauses, one in a hundred violated."""
    made = duckdb.connect()
    for log in range(verdicts // IN_A_LOG):
        target = folder / f"{log:064x}"
        target.mkdir()
        made.execute("SET VARIABLE log = ?", [log])
        for table, question in QUESTIONS.items():
            file = target / f"{table}.parquet"
            made.execute(f"COPY ({question}) TO '{file}' (FORMAT parquet, COMPRESSION zstd, PARQUET_VERSION v2)")


def by_btq(store: Path) -> int:
    report = summary(asked(str(store)), "store", ("label",))
    return sum(
        clause.violated for mission in report.missions for each in mission.requirements for clause in each.clauses
    )


def by_hand(store: Path) -> int:
    """What one writes who knows SQL: the counts and the worst of each requirement and label."""
    question = (
        "SELECT label, requirement, count(*), count(*) FILTER (verdict = 'violated'), max(measured_si)"
        f" FROM read_parquet('{store}/*/verdicts.parquet') GROUP BY ALL"
    )
    return sum(row[3] for row in duckdb.connect().execute(question).fetchall())


def by_pandas(store: Path) -> int:
    import pandas

    columns = ["label", "requirement", "verdict", "measured_si"]
    files = sorted(store.glob("*/verdicts.parquet"))
    table = pandas.concat([pandas.read_parquet(file, columns=columns) for file in files])
    table["violated"] = table["verdict"] == "violated"
    found = table.groupby(["label", "requirement"]).agg({"violated": "sum", "measured_si": "max", "verdict": "count"})
    return int(found["violated"].sum())


def summarised(verdicts: int, rounds: int) -> dict[str, float]:
    """The shortest time of each summary in seconds, in turn; they count the same."""
    tasks: dict[str, Callable[[Path], int]] = {"btq": by_btq, "sql": by_hand}
    if find_spec("pandas") is not None and find_spec("pyarrow") is not None:
        tasks["pandas"] = by_pandas
    with tempfile.TemporaryDirectory() as folder:
        made_up(Path(folder), verdicts)
        times = {name: float("inf") for name in tasks}
        counts = set()
        for _ in range(rounds):
            for name, task in tasks.items():
                start = time.perf_counter()
                counts.add(task(Path(folder)))
                times[name] = min(times[name], time.perf_counter() - start)
    assert len(counts) == 1, counts
    return times


def judged(logs: int, transitions: int, rounds: int) -> dict[str, float]:
    """Seconds by one process and by two, and the bytes of the logs and of the store."""
    robot = fetching()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "logs").mkdir()
        (folder / "mission.btq").write_text(FETCH, encoding="utf-8")
        rows = robot.rows(transitions)
        for number in range(logs):  # a day each
            (folder / "logs" / f"{number:04}.btlog").write_bytes(btlog(robot.xml, rows, number * 86_400_000_000))
        found = {"one": float("inf"), "two": float("inf")}
        for turn in range(rounds):
            for jobs, key in ((1, "one"), (2, "two")):
                start = time.perf_counter()
                command = [
                    sys.executable,
                    "-m",
                    "btq_lang",
                    "verify",
                    "logs",
                    "--mission",
                    "mission.btq",
                    "-o",
                    "x.json",
                ]
                keeping = ["--jobs", str(jobs), "--store", f"store{turn}{jobs}"]
                run = subprocess.run(
                    [*command, *keeping], cwd=folder, env={**ENVIRONMENT, "PYTHONPATH": str(ROOT)}, capture_output=True
                )
                assert run.returncode == 1, run.stderr
                found[key] = min(found[key], time.perf_counter() - start)
        found["logs"] = sum(file.stat().st_size for file in (folder / "logs").iterdir())
        found["store"] = sum(file.stat().st_size for file in (folder / "store01").rglob("*") if file.is_file())
        assert len(os.listdir(folder / "store01")) == logs
    return found


def main() -> None:
    parser = options(__doc__)
    parser.add_argument("--verdicts", type=int, default=10_000_000)
    parser.add_argument("--logs", type=int, default=1000)
    parser.add_argument("--transitions", type=int, default=15_000, help="of each log")
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    times = summarised(given.verdicts, given.rounds)
    taken = judged(given.logs, given.transitions, 1)
    faster, size = taken["one"] / taken["two"], taken["store"] / taken["logs"]
    goals = [
        Goal(f"{given.verdicts:,} verdicts summarised: s <= 3", times["btq"], times["btq"] <= 3),
        Goal("two processes, times as fast as one >= 1.7", faster, faster >= 1.7),
        Goal("bytes of the store, in times of those of its logs <= 1", size, size <= 1),
    ]
    if given.json:
        sizes = {"verdicts": given.verdicts, "logs": given.logs, "transitions": given.transitions}
        print(json.dumps(as_data({**sizes, "summaries": times, "judged": taken}, goals), indent=1))
        return
    summarise, judge = f"{given.verdicts:,} verdicts summarised", f"{given.logs:,} logs judged and kept"
    print(f"{machine()}; logs of {given.transitions:,} transitions, {taken['logs'] / 1e6:,.1f} MB\n")
    print("| what | s |", "|---|---|", *(f"| {summarise}, {name} | {s:.2f} |" for name, s in times.items()), sep="\n")
    print(*(f"| {judge}, {jobs} | {taken[key]:.1f} |" for key, jobs in PROCESSES.items()), sep="\n")
    print("", *shown(goals), sep="\n")


if __name__ == "__main__":
    main()
