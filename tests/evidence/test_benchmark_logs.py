"""What `bench/evidence.py` compares is comparable: the bare loop finds the activations that `verify` counts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import bare_loops
import pytest
import robot_log
from evidence_logs import Row, btlog, write_db3

from btq_lang.evidence.judging import Means
from btq_lang.evidence.verdicts import MissionVerdicts
from btq_lang.evidence.verifying import verify


def judged(robot: robot_log.Robot, rows: list[Row], log: Path) -> MissionVerdicts:
    report = verify([str(log)], Means([robot.mission], robot_log.battery(rows[-1][0])))
    assert report.problems == ()
    (mission,) = report.missions
    return mission


@pytest.mark.parametrize(("make", "nodes", "runs"), [(robot_log.tiny, 3, 200), (robot_log.fetching, 31, 5)])
def test_loop_finds_what_is_judged(make: Callable[[], robot_log.Robot], nodes: int, runs: int, tmp_path: Path) -> None:
    robot = make()
    rows = robot.rows(1800)
    log, database = tmp_path / "a.btlog", tmp_path / "a.db3"
    log.write_bytes(btlog(robot.xml, rows))
    write_db3(database, robot.xml, [rows])
    mission = judged(robot, rows, log)
    assert (sum(number for _, number in mission.outcomes), len(mission.nodes)) == (runs, nodes)
    assert all(each.verdict not in ("unknown", "never exercised") for each in mission.requirements)
    found = bare_loops.btlog(log)
    ended = {uid: each.succeeded + each.failed + each.halted for uid, each in enumerate(mission.nodes, 1)}
    assert {uid: len(found.get(uid, ())) for uid in ended} == ended
    assert [each.verdict for each in judged(robot, rows, database).requirements] == [
        each.verdict for each in mission.requirements
    ]
    assert {uid: len(each) for uid, each in bare_loops.db3(database).items()} == {
        uid: len(each) for uid, each in found.items()
    }
