"""What it takes to read logs and to judge them, beside what nobody can do without.

A log of the engine against a loop that decodes its rows and keeps each node's state; a ROS 2 bag against `rosbags`
alone, which reads and deserializes it.  Both in this process, in turn, the best of some rounds; the memory in a process
of its own.

    python bench/evidence.py [--transitions N] [--rounds N] [--json]
"""

from __future__ import annotations

import json
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from report import Goal, as_data, machine, options, shown

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from evidence_bags import names_of, tree_log, write_bag
from evidence_logs import START, as_logged, btlog, write_db3

from btq_lang.btcpp.document import write as xml_of
from btq_lang.btcpp.export import export
from btq_lang.evidence import verify
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.model import NamedLog
from btq_lang.evidence.readers import read
from btq_lang.evidence.readers.btlog import _HEAD, _RECORD, _START
from btq_lang.workspace import Workspace

MISSION = """\
signal battery : % from {level}
QualityReq a : safety
    Move takes at most 30 ms
QualityReq b : safety
    Move takes at least 1 ms
QualityReq c : reliability
    Pick succeeds
    in at least 90 % of activations
QualityReq d : reliability
    Pick succeeds within 1 s
QualityReq e : safety
    Move needs battery > 10 %
QualityReq f : safety
    Move keeps battery > 5 %
QualityReq g : safety
    Move leaves battery > 5 %
QualityReq h : safety
    Pick follows Move succeeds
QualityReq i : performance-efficiency
    Move runs at most 100 per 1 s
QualityReq j : reliability
    mission succeeds
    in at least 90 % of runs
    confidence 95 %
Root Main
BehaviorTree Main
    ->
        Action Move
        Action Pick
Action Move
Action Pick
"""
# A run of nine rows, 30 ms long.
ROWS = ((0, 1, 1), (0, 2, 1), (20, 2, 2), (20, 3, 1), (25, 3, 2), (25, 1, 2), (26, 2, 0), (26, 3, 0), (26, 1, 0))


def candidate() -> tuple[Candidate, str]:
    """The mission, and its tree as the engine logs it."""
    workspace = Workspace.of({"a.btq": MISSION})
    xml = as_logged(xml_of(export(workspace, "a.btq").document))
    return Candidate(workspace, "a.btq", "a", None), xml


def transitions(number: int) -> list[tuple[int, int, int]]:
    return [(30_000 * run + 1000 * ms, uid, to) for run in range(number // len(ROWS)) for ms, uid, to in ROWS]


def judged(path: Path) -> None:
    mission, _ = candidate()
    report = verify([str(path)], [mission], {}, str)
    assert report.problems == ()
    assert report.missions[0].runs > 0


def bare_btlog(path: Path) -> None:
    """Decode the rows and keep each node's state."""
    data = path.read_bytes()
    _, _, length = _HEAD.unpack_from(data)
    body = _HEAD.size + length
    (start,) = _START.unpack_from(data, body)
    state: dict[int, tuple[int, int]] = {}
    for low, high, uid, status in _RECORD.iter_unpack(memoryview(data)[body + _START.size :]):
        state[uid] = start + low + (high << 32), status


def bare_db3(path: Path) -> None:
    state: dict[int, tuple[int, int]] = {}
    asked = "SELECT timestamp, node_uid, state FROM Transitions ORDER BY timestamp"
    for moment, uid, status in sqlite3.connect(path).execute(asked):
        state[uid] = moment, status


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


def best(rounds: int, *tasks: Callable[[], None]) -> list[float]:
    """The shortest time of each task in seconds, the tasks in turn."""
    times = [[float("inf")] for _ in tasks]
    for _ in range(rounds):
        for task, taken in zip(tasks, times, strict=True):
            start = time.process_time()
            task()
            taken.append(time.process_time() - start)
    return [min(each) for each in times]


def memory(path: Path) -> float:
    """How much a process grows at most while it judges a log, in MB."""
    run = subprocess.run([sys.executable, __file__, "--judge", path], capture_output=True, text=True, check=True)
    return float(run.stdout)


def grown(path: Path) -> float:
    before = peak()
    judged(path)
    return peak() - before


def peak() -> float:
    """The most memory that this process has had, in MB; `getrusage` would count what its parent had too."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return int(status.partition("VmHWM:")[2].split()[0]) / 1024


def main() -> None:
    parser = options(__doc__)
    parser.add_argument("--transitions", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--judge", type=Path, help="print by how many MB judging a log makes this process grow")
    given = parser.parse_args()
    if given.judge is not None:
        print(grown(given.judge))
        return
    _, xml = candidate()
    rows = transitions(given.transitions)
    with tempfile.TemporaryDirectory() as folder:
        log, database, bag = Path(folder) / "a.btlog", Path(folder) / "a.db3", Path(folder) / "bag"
        log.write_bytes(btlog(xml, rows))
        write_db3(database, xml, [rows])
        write_bag(bag, tree_log(rows, names_of(xml), START))
        measured = {
            "btlog": best(given.rounds, lambda: bare_btlog(log), lambda: judged(log)),
            "db3": best(given.rounds, lambda: bare_db3(database), lambda: judged(database)),
            "bag": best(given.rounds, lambda: bare_bag(bag), lambda: read_bag(bag)),
        }
        most = memory(log)
    ratios = {name: ours / bare for name, (bare, ours) in measured.items()}
    goals = [
        Goal(".btlog read and judged, times a bare loop (at most 6)", ratios["btlog"], ratios["btlog"] <= 6),
        Goal(".db3 read and judged, times a bare loop (at most 6)", ratios["db3"], ratios["db3"] <= 6),
        Goal("bag read, times rosbags alone (at most 1.5)", ratios["bag"], ratios["bag"] <= 1.5),
        Goal("MB above start, .btlog judged (at most 150)", most, most <= 150),
    ]
    if given.json:
        print(json.dumps(as_data({"transitions": len(rows), "seconds": measured, "peak": most}, goals), indent=1))
        return
    print(f"{len(rows):,} transitions, {machine()}")
    for name, (bare, ours) in measured.items():
        print(f"{name:6}  bare {bare:.2f} s, btq {ours:.2f} s")
    print(*shown(goals), sep="\n")


if __name__ == "__main__":
    main()
