"""The guard and the verdict say the same: what a guard stops or refuses is a violation of its clause in the log of the
engine, with the guard as the reason; what it lets pass is none.

A guard that lets pass proves nothing: the logs have no samples, so a clause that reads a signal is unknown then.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import pytest
from engine_loader import Engine
from in_process import run_btq
from test_engine_enforcement import BATTERY, ENERGY, QUICK, SLOW, SPEED, Parts, step

from btq_lang.btcpp.document import write
from btq_lang.btcpp.enforcement import enforced
from btq_lang.btcpp.export import export
from btq_lang.workspace.workspace import Workspace

ONCE = "Move"
THRICE = "Repeat (num_cycles = 3)\n                ForceSuccess\n                    Move"

# By name: what is declared, a clause of Move, how often Move is to run, parts with which its guard fires, those with
# which it does not; then the verdict on these, and of the fired one how many cases are counted and violated, and how
# many starts `Move succeeds` counts, and of them as violated.
Row = tuple[str, str, str, Parts, Parts, str, tuple[int, int], tuple[int, int]]
FAST: Parts = {"First": [step("SUCCESS", speed=2.0)]}
SPEEDING: Parts = {"Move": ["RUNNING", step("RUNNING", speed=2.0), "RUNNING", "SUCCESS"]}
HELD, UNKNOWN = "satisfied", "unknown"
ROWS: Final[Mapping[str, Row]] = {
    # stopped while it runs: for `succeeds` of another requirement, a halt is no case
    "takes": ("", "takes at most 200 ms", ONCE, SLOW, QUICK, HELD, (1, 1), (0, 0)),
    "succeeds": ("", "succeeds within 200 ms", ONCE, SLOW, QUICK, HELD, (1, 1), (0, 0)),
    "keeps": (SPEED, "keeps speed <= 1 m/s", ONCE, SPEEDING, QUICK, UNKNOWN, (1, 1), (0, 0)),
    "never": (SPEED, "never speed > 1 m/s", ONCE, SPEEDING, QUICK, UNKNOWN, (1, 1), (0, 0)),
    "uses": (
        ENERGY,
        "uses at most 20 Wh of energy",
        ONCE,
        {"Move": ["RUNNING", step("RUNNING", energy=21.0), "RUNNING", "SUCCESS"]},
        QUICK,
        UNKNOWN,
        (1, 1),
        (0, 0),
    ),
    # turned into a failure when it has succeeded
    "leaves": (
        BATTERY,
        "leaves battery >= 3 %",
        ONCE,
        {"Move": ["RUNNING", step("SUCCESS", battery=2.0)]},
        QUICK,
        UNKNOWN,
        (1, 1),
        (1, 0),
    ),
    "ends_with": (
        BATTERY,
        "ends with battery >= 3 %",
        ONCE,
        {"Move": ["RUNNING", step("SUCCESS", battery=2.0)]},
        QUICK,
        UNKNOWN,
        (1, 1),
        (1, 0),
    ),
    "uses_at_the_end": (
        ENERGY,
        "uses at most 20 Wh of energy",
        ONCE,
        {"Move": ["RUNNING", step("SUCCESS", energy=21.0)]},
        QUICK,
        UNKNOWN,
        (1, 1),
        (1, 0),
    ),
    # refused at its start: one case of the clause, and of `succeeds`
    "needs": (SPEED, "needs speed <= 1 m/s", ONCE, FAST, QUICK, UNKNOWN, (1, 1), (1, 1)),
    "keeps_refused": (SPEED, "keeps speed <= 1 m/s", ONCE, FAST, QUICK, UNKNOWN, (1, 1), (1, 1)),
    "never_refused": (SPEED, "never speed > 1 m/s", ONCE, FAST, QUICK, UNKNOWN, (1, 1), (1, 1)),
    "follows": ("", "follows First succeeds", ONCE, {"First": ["FAILURE"]}, QUICK, HELD, (1, 1), (1, 1)),
    "follows_again": ("", "follows First succeeds", THRICE, QUICK, {}, HELD, (3, 2), (3, 2)),
    # judged per run: the refusals add no case
    "tries": ("", "tries at most 1", THRICE, QUICK, {}, HELD, (1, 1), (3, 2)),
    "starts": ("", "starts at most 1 per run", THRICE, QUICK, {}, HELD, (1, 1), (3, 2)),
}


@pytest.mark.parametrize("action", ["fail", "halt"])
@pytest.mark.parametrize("row", ROWS)
def test_a_guard_that_fires_is_a_violation(engine: Engine, row: str, action: str, tmp_path: Path) -> None:
    _, clause, how_often, fires, _, _, counts, succeeds = ROWS[row]
    if action == "halt" and how_often is THRICE:
        counts, succeeds = (min(counts[0], 2), 1), (2, 1)  # the first refusal halts the mission
    found = verdicts(engine, row, action, fires, how_often, tmp_path)
    own = found["own"]
    assert (own["verdict"], own["counted"], own["violated"]) == ("violated", *counts), clause
    assert [each["why"] for each in own["violations"] if "guard" not in each["why"]] == []
    assert (found["others"]["counted"], found["others"]["violated"]) == succeeds


@pytest.mark.parametrize("action", ["fail", "halt"])
@pytest.mark.parametrize("row", ROWS)
def test_a_guard_that_lets_pass_is_none(engine: Engine, row: str, action: str, tmp_path: Path) -> None:
    _, _, _, _, passes, verdict, _, _ = ROWS[row]
    found = verdicts(engine, row, action, passes, ONCE, tmp_path)
    assert (found["own"]["verdict"], found["own"]["violated"]) == (verdict, 0)
    assert (found["others"]["counted"], found["others"]["violated"]) == (1, 0)


def test_refusals_count_as_starts_of_the_worst_run(engine: Engine, tmp_path: Path) -> None:
    assert verdicts(engine, "tries", "fail", QUICK, THRICE, tmp_path)["own"]["worst"]["si"] == 3


def verdicts(
    engine: Engine, row: str, action: str, parts: Parts, how_often: str, folder: Path
) -> dict[str, dict[str, Any]]:
    """The clause of Move that is enforced, and `Move succeeds` of another requirement, as a log of the engine is
    judged."""
    signals, clause = ROWS[row][:2]
    text = (
        f"{signals}QualityReq own\n    Move {clause}\n    on violation {action}\nQualityReq others\n    Move succeeds\n"
        "Root Main\nBehaviorTree Main\n    ->\n        ForceSuccess\n            First\n        ForceSuccess\n"
        f"            {how_often}\n        Rest\n"
    )
    (folder / "mission.btq").write_text(text, encoding="utf-8")
    log = folder / "run.btlog"
    workspace = Workspace.of({"mission.btq": text})
    xml = write(enforced(workspace, "mission.btq", export(workspace, "mission.btq")).export.document)
    answer = engine.run_one(xml, parts=parts, ticks=10_000, tick_ms=1, seconds=60, log=log)
    assert (answer.stage, answer.error) == ("done", "")
    _, output, errors = run_btq("verify", log.name, "--mission", "mission.btq", "--format", "json", cwd=folder)
    assert errors == ""
    return {each["id"]: each["clauses"][0] for each in json.loads(output)["requirements"]}
