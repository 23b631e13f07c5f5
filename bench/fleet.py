"""A fleet: logs of many robots with several versions of their software, made in the model of the engine that scenarios
have, and what it takes to judge them, to keep the verdicts, to compare the last two versions and to write the overview.

    python bench/fleet.py [--robots N] [--twins N] [--days N] [--runs N] [--jobs N] [--keep FOLDER] [--json]

To judge the logs of all robots takes long, and each as long as the other.  So only those of some are made and judged,
and what is kept of each is also kept of its twins, under other names.

With `--keep` the logs, the store and the page stay in that folder.
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import tempfile
from hashlib import sha256
from pathlib import Path

import duckdb
from report import ENVIRONMENT, as_data, machine, options
from robot_log import FETCH, SECONDS, logged_xml, skill_of

# robot_log has put the tests on the path
from evidence_logs import Row, btlog  # isort: skip
from random_runs import START, LoggedRun  # isort: skip
from simulated_runs import bare  # isort: skip

from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.model import FAILURE, SUCCESS
from btq_lang.evidence.store.tables import ROWS
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[1]
DEMANDS = """\
QualityReq quick : performance-efficiency "Follow a path in time"
    every Follow takes at most 8 s
QualityReq planned : reliability "Plans are nearly always found"
    every Plan succeeds within 2 s
    in at least 90 % of activations
QualityReq looks : performance-efficiency "Find the thing soon"
    every Look tries at most 6
QualityReq seen : safety "Pick only what was seen"
    every Pick follows Look succeeds
QualityReq fetched : reliability "The thing is nearly always fetched"
    mission succeeds
    in at least 90 % of runs
    confidence 95 %
"""
MISSION = DEMANDS + FETCH[FETCH.index("Root Main") :]
FAILS = {"Charge": 0.02, "Look": 0.2, "Pick": 0.15, "Plan": 0.03, "Follow": 0.03, "Place": 0.1, "BackUp": 0.02}
# What is different in a version: how long actions take, and how often they fail.
VERSIONS: dict[str, tuple[dict[str, float], dict[str, float]]] = {
    "v1.2": ({}, {}),
    "v1.3": ({"Plan": 0.15}, {"Look": 0.15}),
    "v1.4": ({"Follow": 6.6}, {"Place": 0.4}),
}
BASE = 200  # runs of each version that differ; the logs of robots are made of these
DAY = 86_400_000_000  # µs


class VersionRun(LoggedRun):
    """A run with a version of the software."""

    def __init__(self, mission: ScenarioMission, version: str, seed: int, rows: list[Row]) -> None:
        super().__init__(mission, random.Random(seed), rows, resets=True)
        seconds, fails = VERSIONS[version]
        self.seconds, self.fails = {**SECONDS, **seconds}, {**FAILS, **fails}

    def drawn(self, leaf: ResolvedNode) -> float:
        return self.seconds[skill_of(leaf)] * self.chance.uniform(0.7, 1.3)

    def ended(self, leaf: ResolvedNode) -> int:
        return FAILURE if self.chance.random() < self.fails[skill_of(leaf)] else SUCCESS


def write_logs(folder: Path, robots: int, versions: list[str], days: int, runs: int) -> None:
    """The mission, and a log of each day of each robot, in `logs/VERSION/ROBOT/`.

    Args:
        runs: of each log.
    """
    (folder / "fetch.btq").write_text(MISSION, encoding="utf-8")
    mission = Candidate(Workspace.of({"fetch.btq": MISSION}), "fetch.btq", "fetch", None)
    xml, written = logged_xml(mission), bare(mission)
    for number, version in enumerate(versions):
        base = [_rows(written, version, number * BASE + seed) for seed in range(min(BASE, robots * days * runs))]
        for robot in range(robots):
            chance = random.Random(robot * len(versions) + number)
            pace = 0.98 + 0.04 * random.Random(robot).random()  # no two robots are alike
            target = folder / "logs" / version / f"r{robot + 1:03}"
            target.mkdir(parents=True)
            for day in range(days):
                start = START + (number * days + day) * DAY + robot * 1_000_000
                rows = _one_after_the_other([chance.choice(base) for _ in range(runs)], pace)
                (target / f"{day + 1:02}.btlog").write_bytes(btlog(xml, rows, start))


def _rows(mission: ScenarioMission, version: str, seed: int) -> list[Row]:
    """The rows of a run; those of one tick are 20 µs apart."""
    rows: list[Row] = []
    VersionRun(mission, version, seed, rows).run()
    return [(time - START + 20 * index, uid, status) for index, (time, uid, status) in enumerate(rows)]


def _one_after_the_other(runs: list[list[Row]], pace: float) -> list[Row]:
    found: list[Row] = []
    begin = 0
    for run in runs:
        found += [(begin + round(time * pace), uid, status) for time, uid, status in run]
        begin = found[-1][0] + 10_000_000
    return found


def taken(folder: Path, *arguments: str) -> tuple[float, float]:
    """What a command of btq takes: seconds of processor time of all its processes, and the most memory of one in MB."""
    environment = {**ENVIRONMENT, "PYTHONPATH": str(ROOT)}
    with open(folder / "errors.txt", "w+", encoding="utf-8") as errors:
        process = subprocess.Popen(
            [sys.executable, "-m", "btq_lang", *arguments],
            cwd=folder,
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=errors,
        )
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        assert process.returncode in (0, 1), errors.read()
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def measured(folder: Path, versions: list[str], jobs: int, twins: int) -> dict[str, float]:
    """The figures of a folder of logs."""
    judging = [
        taken(
            folder,
            *("verify", f"logs/{version}", "--mission", "fetch.btq", "--jobs", str(jobs), "-o", "verdicts.json"),
            *("--store", "evidence", "--label", version, "--robot-by", "folder"),
        )
        for version in versions
    ]
    found = {"verify s": sum(each[0] for each in judging), "verify MB": max(each[1] for each in judging)}
    for name in ("logs", "evidence"):
        files = [file for file in (folder / name).rglob("*") if file.is_file()]
        found[f"{name} files"], found[f"{name} bytes"] = len(files), sum(file.stat().st_size for file in files)
    found["judged"] = activations(folder / "evidence")
    add_twins(folder / "evidence", twins)
    commands = {
        "summary": ("verify", "--store", "evidence", "--by", "label", "-o", "summary.json"),
        "compare": ("compare", "evidence", *versions[-2:], "-o", "changes.json"),
        "report": ("report", "evidence", "-o", "report.html"),
    }
    for name, arguments in commands.items():
        found[f"{name} s"], found[f"{name} MB"] = taken(folder, *arguments)
    found["page bytes"] = (folder / "report.html").stat().st_size
    found["activations"] = activations(folder / "evidence")
    return found


def activations(store: Path) -> int:
    (row,) = duckdb.execute(f"SELECT COUNT(*) FROM read_parquet('{store}/*/activations.parquet')").fetchall()
    return int(row[0])


def add_twins(store: Path, twins: int) -> None:
    """Keep each set of a store also under the names of its robot's twins: `r001-2` of `r001`."""
    made = duckdb.connect(config={"threads": 1})
    for folder in [*store.iterdir()]:
        for twin in range(2, twins + 1):
            name = sha256(f"{folder.name} {twin}".encode()).hexdigest()
            (store / name).mkdir()
            for table in ROWS:
                columns = f"* REPLACE ('{name}' AS log, robot || '-{twin}' AS robot)"
                made.execute(
                    f"COPY (SELECT {columns} FROM '{folder}/{table}.parquet') TO '{store / name / table}.parquet'"
                    " (FORMAT parquet, COMPRESSION zstd, PARQUET_VERSION v2)"
                )


def main() -> None:
    parser = options(__doc__)
    parser.add_argument("--robots", type=int, default=10, help="whose logs are judged")
    parser.add_argument("--twins", type=int, default=20, help="robots of each kind, itself among them")
    parser.add_argument("--days", type=int, default=1, help="with each version, a log a day")
    parser.add_argument("--runs", type=int, default=240, help="of each log")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", metavar="FOLDER", help="where logs, store and page stay; must be empty")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(given.keep or temporary)
        write_logs(folder, given.robots, [*VERSIONS], given.days, given.runs)
        found = measured(folder, [*VERSIONS], given.jobs, given.twins)
    if given.json:
        print(json.dumps(as_data(found, []), indent=1))
        return
    print(f"{given.robots * given.twins} robots, {len(VERSIONS)} versions of {given.days} days, {machine()}")
    print(*(f"{name:>16}  {value:,.1f}".removesuffix(".0") for name, value in found.items()), sep="\n")


if __name__ == "__main__":
    main()
