"""What is predicted is what happens: half of a log by the other half, a simulated mission by its own log, and a known
probability by its intervals.
"""

from __future__ import annotations

import json
import struct
from math import hypot
from pathlib import Path
from typing import Any

import pytest
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

# Each log with what it is a log of, the subject of demands and their bounds, and how many runs its second half has.
LOGS = {
    "lab": ("lab", "SolidStation", "activations", (500, 550, 600, 650, 700), 88),
    "nav": ("nav", "mission", "runs", (400, 500, 600, 700, 1000), 20),
    "nav_noidle": ("nav", "mission", "runs", (400, 500, 600, 700, 1000), 20),
}
HEAD = {
    "lab": "signal battery : % from {battery} level\n",
    "nav": "Root NavigateToPoseWReplanningAndRecovery\n",
}
SUCCESS = """
QualityReq works : reliability
    {0} succeeds in at least 80 % of {1}
"""
TIME = """
QualityReq within_{2} : performance-efficiency
    {0} takes at most {2} ms in at least 50 % of {1}
"""
# What conditions answer no log shows: in the laboratory it follows from the battery, and those of Nav2 hold as often as
# they did when the log was written (nav_spec.json), each time anew.
SETTINGS = {
    "lab": """[simulate.world]
battery = { start = "100 %" }
"{tubes}" = { start = 3 }
""",
    "nav": """[simulate.skills]
GlobalUpdatedGoal = { fails = "1 per 200 ms", for = "190 ms" }
IsGoalNearby = { fails = "1 per 100 ms", for = "70 ms" }
GoalUpdated = { fails = "1 per 5 s", for = "4.99 s" }
WouldAPlannerRecoveryHelp = { fails = "1 per 100 ms", for = "10 ms" }
WouldAControllerRecoveryHelp = { fails = "1 per 100 ms", for = "10 ms" }
""",
}
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
    starts = [at for at in range(begin, len(data), 9) if struct.unpack_from("<HB", data, at + 6) == (1, 1)]
    middle = starts[len(starts) // 2]
    (folder / "first.btlog").write_bytes(data[:middle])
    (folder / "second.btlog").write_bytes(data[:begin] + data[middle:])


# A thousand runs of `nav` take half a minute: its conditions are asked every 10 ms.
@pytest.mark.parametrize("log", ["lab", pytest.param("nav", marks=pytest.mark.scheduled), "nav_noidle"])
def test_half_of_the_runs_predicts_the_other(shared: Path, tmp_path: Path, log: str) -> None:
    """Success and times of the second half, of the laboratory's runs those that need not charge: of so many
    shares none is off by more than 3 standard deviations, as the intervals of both halves have them.
    """
    name, subject, unit, bounds, runs = LOGS[log]
    write_halves(shared / "logs" / f"{log}.btlog", tmp_path)
    (tmp_path / f"{name}.xml").write_bytes((shared / "logs" / f"{name}.xml").read_bytes())
    demands = [SUCCESS.format(subject, unit), *(TIME.format(subject, unit, bound) for bound in bounds)]
    mission = f'include "{name}.xml"\n{HEAD[name]}{"".join(demands)}'
    (tmp_path / "mission.btq").write_text(mission, encoding="utf-8")
    (tmp_path / "btq.toml").write_text(SETTINGS[name], encoding="utf-8")
    predicted = clauses("simulate", "mission.btq", "--from", "first.btlog", "--runs", "1000", cwd=tmp_path)
    happened = clauses("verify", "second.btlog", "--mission", "mission.btq", cwd=tmp_path)
    assert len(predicted) == len(demands)
    for requirement, clause in predicted.items():
        assert happened[requirement]["counted"] == runs
        held = runs - happened[requirement]["violated"]
        low, high = clause["interval"]
        own_low, own_high = interval_of(held, runs, Uncertainty(0))
        deviation = hypot(high - low, own_high - own_low) / 2 / 1.96
        assert abs(clause["share"] - held / runs) <= 3 * deviation, requirement


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
