"""Examples with logs made by hand."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Final

from evidence_logs import START, btlog, rows

ROOT = Path(__file__).resolve().parents[1]


def judged_example(folder: Path, name: str) -> Path:
    """A copy of an example with runs on 2026-11-20: one or two of its tree, and samples of the speed.  In `inspection`,
    the approval of `enough_power` is outdated.
    """
    copied = folder / name
    shutil.copytree(ROOT / "examples" / name, copied)
    xml, runs = _LOGS[name]
    (copied / "runs.btlog").write_bytes(btlog(xml, rows(runs)))
    samples = (f"{START / 1e6 + tenths / 10},0.3\n" for tenths in range(0, 26_000, 4))
    (copied / "speed.csv").write_text("t,speed\n" + "".join(samples), encoding="utf-8")
    with (copied / "btq.toml").open("a", encoding="utf-8") as project:
        project.write(_EVIDENCE)
    if name == "inspection":
        mission = copied / "mission.btq"
        text = mission.read_text(encoding="utf-8")
        mission.write_text(text.replace("    refines PLANT_2\n", f"    refines PLANT_2\n{_OUTDATED}"), encoding="utf-8")
    return copied


_EVIDENCE: Final = """
[evidence]
logs = ["runs.btlog"]

[evidence.signals]
speed = { file = "speed.csv", time = "t", column = "speed", unit = "m/s" }
"""
_OUTDATED: Final = '    approved by "A. Engineer" on "2026-11-01" of "1:0123456789ab"\n'
_LOGS: Final = {
    # One run of 5 minutes, one of 25.
    "inspection": (
        '<root BTCPP_format="4"><BehaviorTree ID="Inspection" _fullpath="">'
        '<ReactiveSequence name="ReactiveSequence" _uid="1"><SensorsAlive name="SensorsAlive" _uid="2"/>'
        '<Sequence name="Round" _uid="3"><DriveTo name="ToRoom" _uid="4"/><MeasureDose name="MeasureDose" _uid="5"/>'
        '<DriveTo name="ToExit" _uid="6"/></Sequence></ReactiveSequence></BehaviorTree></root>',
        "0 2S 4R 3R 1R 60000 2S 4S 5S 6R 300000 2S 6S 3S 1S 1I"
        " 1000000 2S 4R 3R 1R 1060000 2S 4S 5S 6R 2500000 2S 6S 3S 1S 1I",
    ),
    # A run of 13 minutes, 9 of them on the way to the ward.
    "hospital": (
        '<root BTCPP_format="4"><BehaviorTree ID="DeliverMedicine" _fullpath="">'
        '<ReactiveSequence name="ReactiveSequence" _uid="1"><RobotAlive name="RobotAlive" _uid="2"/>'
        '<Sequence name="Delivery" _uid="3"><SubTree ID="EnoughBattery" _fullpath="EnoughBattery::4" _uid="4"/>'
        '<MoveBase name="ToPharmacy" _uid="10"/><OpenDrawer name="AtPharmacy" _uid="11"/>'
        '<MoveBase name="ToWard" _uid="12"/><SayWhere name="SayWhere" _uid="13"/><Timeout name="Timeout" _uid="14">'
        '<OpenDrawer name="AtWard" _uid="15"/></Timeout></Sequence></ReactiveSequence></BehaviorTree>'
        '<BehaviorTree ID="EnoughBattery" _fullpath="EnoughBattery::4"><Fallback name="Fallback" _uid="5">'
        '<BatteryAbove name="BatteryAbove" _uid="6"/><Sequence name="Recharge" _uid="7">'
        '<MoveBase name="ToCharger" _uid="8"/><Charge name="Charge" _uid="9"/></Sequence></Fallback>'
        "</BehaviorTree></root>",
        "0 2S 6S 5S 4S 10R 3R 1R 60000 2S 10S 11R 120000 2S 11S 12R 660000 2S 12S 13S 15R 14R"
        " 780000 2S 15S 14S 3S 1S 1I",
    ),
}
