"""What is predicted is what happens: half of a log by the other half, a simulated mission by its own log, and a known
probability by its intervals.
"""

from __future__ import annotations

import json
import struct
from math import hypot
from pathlib import Path
from typing import Any

from in_process import run_btq
from test_drawn_runs import mission_of, with_settings

from btq_lang.prediction.predicting import Predictor, Recipe
from btq_lang.prediction.shown_run import shown_run
from btq_lang.prediction.words import Uncertainty, interval_of
from btq_lang.projects.files import Files
from btq_lang.scenarios.btlog import as_btlog
from btq_lang.scenarios.mission import as_program
from btq_lang.util.record import replace
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

BOUNDS = (500, 550, 600, 650, 700)  # ms
LAB = """include "lab.xml"

signal battery : % from {{battery}} level

QualityReq works : reliability
    SolidStation succeeds in at least 80 % of activations
{}"""
TIME = """
QualityReq within_{0} : performance-efficiency
    SolidStation takes at most {0} ms in at least 50 % of activations
"""
WORLD = """[simulate.world]
battery = { start = "100 %" }
"{tubes}" = { start = 3 }
"""
MISSION = """Action Drive
Action Pick

BehaviorTree Carry
    ->
        Drive
        Retry (num_attempts = 2)
            Pick

QualityReq works : reliability
    mission succeeds in at least 50 % of runs

QualityReq soon : performance-efficiency
    mission takes at most 22 s in at least 50 % of runs
"""
RETRY = "Root D\nAction Pick\nBehaviorTree D\n    Retry (num_attempts = 2)\n        Pick\n"
SKILLS = """[simulate.skills]
Drive = { takes = { median = "12 s", p95 = "20 s" }, succeeds = "95 %" }
Pick = { takes = ["4 s", "8 s"], succeeds = "70 %" }
"""


def clauses(*arguments: str, cwd: Path) -> dict[str, dict[str, Any]]:
    """The only clause of each requirement."""
    _, out, err = run_btq(*arguments, "--format", "json", cwd=cwd)
    assert err == ""
    document = json.loads(out)
    return {each["id"]: each["clauses"][0] for each in document["requirements"]}


def write_halves(log: Path, folder: Path) -> None:
    """Write the first and the second half of the runs of a log."""
    data = log.read_bytes()
    (size,) = struct.unpack_from("<i", data, 19)
    begin = 31 + size
    ends = [at + 9 for at in range(begin, len(data), 9) if struct.unpack_from("<HB", data, at + 6) == (1, 0)]
    middle = ends[len(ends) // 2 - 1]
    (folder / "first.btlog").write_bytes(data[:middle])
    (folder / "second.btlog").write_bytes(data[:begin] + data[middle:])


def test_half_of_the_runs_predicts_the_other(shared: Path, tmp_path: Path) -> None:
    """Success and times of the second half of the laboratory's runs, those that need not charge: each share differs by
    no more than both intervals say.
    """
    write_halves(shared / "logs" / "lab.btlog", tmp_path)
    (tmp_path / "lab.xml").write_bytes((shared / "logs" / "lab.xml").read_bytes())
    (tmp_path / "lab.btq").write_text(LAB.format("".join(map(TIME.format, BOUNDS))), encoding="utf-8")
    (tmp_path / "btq.toml").write_text(WORLD, encoding="utf-8")
    predicted = clauses("simulate", "lab.btq", "--from", "first.btlog", "--runs", "1000", cwd=tmp_path)
    happened = clauses("verify", "second.btlog", "--mission", "lab.btq", cwd=tmp_path)
    assert len(predicted) == 1 + len(BOUNDS)
    for name, clause in predicted.items():
        counted = happened[name]["counted"]
        assert counted == 88
        share = 1 - happened[name]["violated"] / counted
        low, high = clause["interval"]
        own_low, own_high = interval_of(counted - happened[name]["violated"], counted, Uncertainty(0))
        assert abs(clause["share"] - share) <= hypot(high - low, own_high - own_low) / 2, name


def write_runs(predictor: Predictor, runs: int, log: Path) -> None:
    """Write the first runs as the sessions of one log."""
    rows: list[tuple[int, int, int]] = []
    begin = 0
    full = predictor.full
    for drawn in predictor.again(range(1, runs + 1)):
        shown = shown_run(full, drawn)
        rows += [(time + begin, uid, status) for time, uid, status in shown.rows]
        begin += drawn.now * 1000 + 1_000_000
    log.write_bytes(as_btlog(full.mission.tree, replace(shown, rows=rows)))


def test_a_log_of_simulated_runs_predicts_them(tmp_path: Path) -> None:
    (tmp_path / "carry.btq").write_text(MISSION, encoding="utf-8")
    (tmp_path / "btq.toml").write_text(SKILLS, encoding="utf-8")
    declared = clauses("simulate", "carry.btq", "--runs", "2000", cwd=tmp_path)
    (group,), _ = Files().groups([str(tmp_path / "carry.btq")], None)
    (path,) = group.given
    write_runs(
        Predictor(Recipe(as_program(group.workspace, path, "Carry"), path, "Carry", True, None, 1)),
        300,
        tmp_path / "runs.btlog",
    )
    (tmp_path / "btq.toml").unlink()
    happened = clauses("verify", "runs.btlog", "--mission", "carry.btq", cwd=tmp_path)
    measured = clauses("simulate", "carry.btq", "--from", "runs.btlog", "--runs", "2000", cwd=tmp_path)
    truth = 0.95 * (1 - 0.3**2)
    assert declared["works"]["interval"][0] < truth < declared["works"]["interval"][1]
    for name, clause in measured.items():
        low, high = clause["interval"]
        assert high - low < 0.15
        assert low < declared[name]["share"] < high
        assert low < 1 - happened[name]["violated"] / 300 < high


def test_intervals_hold_a_known_probability() -> None:
    """Of a thousand predictions, each with a seed of its own, 930 to 970 intervals with 95 % hold 1 − 0.42²."""
    mission = mission_of(Workspace.of({"m.btq": RETRY}, Project()), "m.btq")
    loaded = with_settings(mission, '[simulate.skills]\nPick = { takes = "2 s", succeeds = "58 %" }\n').loaded
    holding = 0
    for seed in range(1, 1001):
        held = sum(loaded.run(seed, number).end == "succeeds" for number in range(1, 201))
        low, high = interval_of(held, 200, Uncertainty(0))
        holding += low <= 1 - 0.42**2 <= high
    assert 930 <= holding <= 970
