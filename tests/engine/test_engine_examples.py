"""The examples as `btq build` writes them, at work: robots that keep what is demanded finish, and others are stopped by
the guard that is concerned.

What users of the language asked for, each shown by an example: requirements that are enforced, conditions that hold
while an action runs, units, requirements over several actions, and one requirement with a value for each situation.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from engine_loader import Answer, Engine, job
from test_engine_export import parts_of

from btq_lang.cli import main

ROOT = Path(__file__).resolve().parents[2]

Parts = Mapping[str, Sequence[Any]]


def readings(*samples: Mapping[str, object], **always: object) -> list[list[dict[str, object]]]:
    """What a sensor node puts out, tick by tick; the last sample stays."""
    return [[{"status": "SUCCESS", "output": {**always, **sample}}] for sample in samples or ({},)]


LAB: dict[str, object] = {"battery": 80.0, "sent": 0.0}
HOSPITAL: dict[str, object] = {
    "battery": 80.0,
    "speed": 0.2,
    "distance": 1.0,
    "drawer": True,
    "lamp": False,
    "hour": 12.0,
}
CELL: dict[str, object] = {"force": 5.0, "energy": 0.0, "door": True, "speed": 10.0}
OFFICE: dict[str, object] = {
    **{"speed": 0.09, "distance": 1.0, "track_error": 0.0, "load": 10.0, "rear_clear": True, "zone": "lobby"},
}
VIALS = [[{"status": "SUCCESS", "output": {"kind": "vial"}}]]
LONG, SOME = ["RUNNING"] * 5_000 + ["SUCCESS"], ["RUNNING"] * 400 + ["SUCCESS"]

# The example and its mission; texts of it that become others, for bounds that a test can wait for; what keeps and what
# breaks a requirement; and the node that fails because of it.
CASES: dict[str, tuple[str, Mapping[str, str], Parts, Parts, str]] = {
    "a limit in time": (
        "laboratory/mission",
        {"takes at most 30 s": "takes at most 500 ms"},
        {"SensorsAlive": readings(**LAB | {"battery": 10.0})},
        {"SensorsAlive": readings(**LAB | {"battery": 10.0}), "ToCharger": LONG},
        "rq1_limit",
    ),
    "a state that is left behind": (
        "laboratory/mission",
        {},
        {"SensorsAlive": readings({}, {"battery": 3.0}, {}, **LAB)},
        {"SensorsAlive": readings({}, {"battery": 2.9}, {}, **LAB)},
        "rq2_check",
    ),
    "a resource that is used": (
        "laboratory/mission",
        {},
        {"SensorsAlive": readings(**LAB | {"sent": 7.0}), "ReadLabel": ["RUNNING"] * 4 + ["SUCCESS"]},
        {
            "SensorsAlive": readings(*[{}] * 4, {"sent": 0.1}, **LAB),
            "ReadLabel": ["RUNNING"] * 4 + ["SUCCESS"],
        },
        "rq3_guard",
    ),
    "a condition while an action runs": (
        "pick-and-place/cell",
        {},
        {"CellAlive": readings(**CELL), "FindPart": VIALS},
        {"CellAlive": readings(*[{}] * 4, {"force": 8.1}, **CELL), "FindPart": VIALS},
        "grip_2_guard",
    ),
    "a condition while all of them run": (
        "pick-and-place/cell",
        {},
        {"CellAlive": readings(**CELL), "FindPart": VIALS},
        {"CellAlive": readings(*[{}] * 9, {"door": False}, **CELL), "FindPart": VIALS},
        "door_guard",
    ),
    "a limit over several actions": (
        "pick-and-place/cell",
        {"takes at most 15 s": "takes at most 500 ms"},
        {"CellAlive": readings(**CELL), "FindPart": VIALS},
        {"CellAlive": readings(**CELL), "FindPart": VIALS, **dict.fromkeys(("NextSlot", "ToBox", "Settle"), SOME)},
        "put_down_limit",
    ),
    "the value of a narrow place": (
        "hospital/missions/deliver",
        {},
        {"RobotAlive": readings(**HOSPITAL | {"speed": 0.3})},
        {"RobotAlive": readings(**HOSPITAL | {"speed": 0.31})},
        "slow_2_guard",
    ),
    "a situation": (
        "hospital/missions/disinfect",
        {},
        {"RobotAlive": readings(**HOSPITAL | {"lamp": True, "distance": 3.0})},
        {"RobotAlive": readings(**HOSPITAL | {"lamp": True, "distance": 2.9})},
        "dark_guard",
    ),
    "a value in another unit": (
        "navigation/navigation",
        {},
        {"RobotAlive": readings(**OFFICE | {"speed": 0.1})},
        {"RobotAlive": readings(**OFFICE | {"speed": 0.11})},
        "slow_2_guard",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_an_example_stops_what_breaks_its_requirements(engine: Engine, case: str, tmp_path: Path) -> None:
    mission, texts, kept, broken, guard = CASES[case]
    example, _, file = mission.partition("/")
    xml = built(example, texts, tmp_path) / f"{file}.xml"
    ways = ((kept, 0), (broken, 1 if texts else 0))  # only what breaks a limit in time takes any, whatever the machine
    jobs = [job(xml, parts={**parts_of(xml), **parts}, ticks=9_000, tick_ms=ms, seconds=60) for parts, ms in ways]
    good, bad = engine.run(jobs)
    assert [(each.stage, each.crashed, each.error) for each in (good, bad)] == [("done", 0, "")] * 2
    assert (good.status, fails(good, guard)) == ("SUCCESS", False)
    assert (bad.status, fails(bad, guard)) == ("FAILURE", True)


def fails(answer: Answer, name: str) -> bool:
    """Whether a node of an instance name failed, in one of the trees that it is a part of."""
    uids = {node.uid for node in answer.tree if node.name == name}
    assert uids
    return any(uid in uids and after == "FAILURE" for _, uid, _, after in answer.transitions)


def built(example: str, texts: Mapping[str, str], folder: Path) -> Path:
    """Where an example is built, with some of its texts changed."""
    source = folder / "source"
    shutil.copytree(ROOT / "examples" / example, source)
    for old, new in texts.items():
        (file,) = (path for path in source.rglob("*.btq") if old in path.read_text("utf-8"))
        file.write_text(file.read_text("utf-8").replace(old, new), encoding="utf-8")
    assert main(["build", str(source), "-o", str(folder / "built")]) == 0
    return folder / "built"
