"""What it takes to read logs and to judge them, beside what nobody can do without.

Logs of the engine against a loop that decodes their rows and keeps how long each node ran: of a tiny mission, whose
runs have nine rows, so that what is done once a run counts most, and of one as large as robots' missions are.  A ROS 2
bag against `rosbags` alone, which reads and deserializes it.  All in this process, in turn, the best of some rounds;
the memory in a process of its own.  With pandas installed also what it takes for what the loop does.

    python bench/evidence.py [--transitions N] [--rounds N] [--json]
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import bare_loops
from report import Goal, as_data, machine, options, shown
from robot_log import Robot, battery, fetching, tiny

from btq_lang.evidence.judging import Means
from btq_lang.evidence.model import NamedLog, SampleSeries
from btq_lang.evidence.readers import read
from btq_lang.evidence.verifying import verify

# robot_log has put the tests on the path
from evidence_bags import names_of, tree_log, write_bag  # isort: skip
from evidence_logs import START, Row, btlog, write_db3  # isort: skip

Task = Callable[[], object]

# how many times a bare loop reading and judging may take, by the log; what is done once a run counts most in a tiny one
AT_MOST = {"tiny": 60, "fetching": 25}
COLUMNS = ("bare", "pandas", "btq")


def judged(robot: Robot, path: Path, samples: Mapping[str, SampleSeries]) -> None:
    report = verify([str(path)], Means([robot.mission], samples))
    assert report.problems == ()
    assert report.missions[0].runs > 0


def bare_bag(path: Path) -> None:
    """What `rosbags` does, its usual way."""
    from rosbags.highlevel import AnyReader

    with AnyReader([path]) as bag:
        for connection, _, data in bag.messages():
            bag.deserialize(data, connection.msgtype)


def read_bag(path: Path) -> None:
    for log in read(str(path)):
        assert isinstance(log, NamedLog)
        assert len(log.times) > 0


def tasks(robot: Robot, rows: list[Row], folder: Path) -> dict[str, dict[str, Task]]:
    """What is measured of logs of a robot, by the format of the log: `bare`, `btq`, and `pandas` if it is installed."""
    log, database = folder / "a.btlog", folder / "a.db3"
    log.write_bytes(btlog(robot.xml, rows))
    write_db3(database, robot.xml, [rows])
    samples = battery(rows[-1][0])
    found: dict[str, dict[str, Task]] = {}
    for path, bare, by_pandas in (
        (log, bare_loops.btlog, bare_loops.pandas_btlog),
        (database, bare_loops.db3, bare_loops.pandas_db3),
    ):
        measured = found[path.suffix] = {"bare": partial(bare, path), "btq": partial(judged, robot, path, samples)}
        if find_spec("pandas") is not None:
            assert by_pandas(path) == bare(path), "pandas counts as the loop does"
            measured["pandas"] = partial(by_pandas, path)
    return found


def best(rounds: int, measured: Mapping[str, Task]) -> dict[str, float]:
    """The shortest time of each task in seconds of one core, the tasks in turn."""
    times = {name: float("inf") for name in measured}
    for _ in range(rounds):
        for name, task in measured.items():
            start = time.process_time()
            task()
            times[name] = min(times[name], time.process_time() - start)
    return times


def memory(log: Path, until: int) -> float:
    """How much a process grows at most while it judges a log of the fetching robot, in MB.

    Args:
        until: when the log ends, in µs since its start.
    """
    command = [sys.executable, __file__, "--judge", str(log), "--until", str(until)]
    return float(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def grown(log: Path, until: int) -> float:
    robot, samples = fetching(), battery(until)
    before = peak()
    judged(robot, log, samples)
    return peak() - before


def peak() -> float:
    """The most memory that this process has had, in MB; `getrusage` would count what its parent had too."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return int(status.partition("VmHWM:")[2].split()[0]) / 1024


def main() -> None:
    parser = options(__doc__)
    parser.add_argument("--transitions", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--judge", type=Path, help="print by how many MB judging this log makes the process grow")
    parser.add_argument("--until", type=int, help="when that log ends, in µs since its start")
    given = parser.parse_args()
    if given.judge is not None:
        print(grown(given.judge, given.until))
        return
    seconds: dict[str, dict[str, float]] = {}
    for name, robot in {"tiny": tiny(), "fetching": fetching()}.items():
        rows = robot.rows(given.transitions)
        with tempfile.TemporaryDirectory() as folder:
            for suffix, measured in tasks(robot, rows, Path(folder)).items():
                seconds[f"{name}{suffix}"] = best(given.rounds, measured)
            if name == "fetching":
                most = memory(Path(folder) / "a.btlog", rows[-1][0])
                bag = Path(folder) / "bag"
                write_bag(bag, tree_log(rows, names_of(robot.xml), START))
                seconds["bag"] = best(given.rounds, {"bare": partial(bare_bag, bag), "btq": partial(read_bag, bag)})
    ratios = {name: taken["btq"] / taken["bare"] for name, taken in seconds.items()}
    goals = [
        Goal(
            f"{name} read and judged, in times of a bare loop <= {limit}",
            ratios[name],
            ratios[name] <= limit,
        )
        for robot_name, limit in AT_MOST.items()
        for name in (f"{robot_name}.btlog", f"{robot_name}.db3")
    ]
    goals += [
        Goal("bag read, in times of rosbags alone <= 1.5", ratios["bag"], ratios["bag"] <= 1.5),
        Goal("fetching.btlog judged: MB above start <= 150", most, most <= 150),
    ]
    if given.json:
        print(
            json.dumps(as_data({"transitions": given.transitions, "seconds": seconds, "peak": most}, goals), indent=1)
        )
        return
    print(f"{machine()}; {given.transitions:,} transitions, thousands of them a second\n")
    print("| log | bare | pandas | btq | btq, in times of bare |", "|---|---|---|---|---|", sep="\n")
    for name, taken in seconds.items():
        rates = [f"{given.transitions / taken[what] / 1000:,.0f}" if what in taken else "" for what in COLUMNS]
        print(f"| {' | '.join((name, *rates))} | {ratios[name]:.1f} |")
    print("", *shown(goals), sep="\n")


if __name__ == "__main__":
    main()
