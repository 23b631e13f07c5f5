"""The line below a violated clause says what to look at: which node, what happened, why, in which run and when.

The expected lines were written from the truth files and the rows of the logs, before there was code for them.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from evidence_logs import Verify

from btq_lang.cli import main

HERE = Path(__file__).parent
LINES = [
    (
        "lab",
        "MoveToCharger takes at most 280 ms",
        "MoveToCharger: took 331 ms, bound 280 ms; its median is 233 ms"
        " (run 31 of lab.btlog, 331 ms after its start at 2026-11-20 21:22:35.757 UTC)",
    ),
    (
        "lab",
        "SolidStation takes at most 550 ms",
        "SolidStation: took 708 ms, bound 550 ms; MoveToStation ran 286 ms of it"
        " (run 37 of lab.btlog, 708 ms after its start at 2026-11-20 21:22:38.884 UTC)",
    ),
    (
        "lab",
        "MoveToStation leaves battery >= 15 %",
        "MoveToStation: `battery` was 8 % at the end, bound 15 %; sampled just before, while MoveToStation ran;"
        " MoveToCharger had failed before in this run"
        " (run 157 of lab.btlog, 411 ms after its start at 2026-11-20 21:23:38.092 UTC)",
    ),
    (
        "lab",
        "Charge needs battery < 17 %",
        "Charge::5: `battery` was 17.5 % at the start, bound 17 %; sampled just before, while MoveToCharger ran"
        " (run 99 of lab.btlog, 206 ms after its start at 2026-11-20 21:23:11.036 UTC)",
    ),
    (
        "lab",
        "mission succeeds in at least 98 % of runs confidence 95 %",
        "Mission: 14 of 200 runs broke it, 7 of them at PickPlate/Pick::10"
        " (run 43 of lab.btlog, 279 ms after its start at 2026-11-20 21:22:41.843 UTC;"
        " also runs 47, 60, 74, 104 and 9 more)",
    ),
    (
        "lab",
        "PickPlace/Place succeeds",
        "PickTube/Place::19: failed; it ran 41 ms"
        " (run 3 of lab.btlog, 392 ms after its start at 2026-11-20 21:22:21.135 UTC)",
    ),
    (
        "lab",
        "from PickTube/Pick starts to PickTube/Place succeeds takes at most 127 ms",
        "from PickTube/Pick starts to PickTube/Place succeeds: took 128 ms, bound 127 ms;"
        " PickTube/Pick::18 ran 87 ms of it"
        " (run 136 of lab.btlog, 533 ms after its start at 2026-11-20 21:23:27.778 UTC)",
    ),
    (
        "lab",
        "MoveToStation uses at most 3 % of battery",
        "MoveToStation: used 4 %, bound 3 %; `battery` went from 100 % to 96 % in 186 ms"
        " (run 1 of lab.btlog, 186 ms after its start at 2026-11-20 21:22:20.034 UTC)",
    ),
    (
        "nav",
        "mission takes at most 1.05 s",
        "NavigateRecovery: took 1.16 s, bound 1.05 s;"
        " FollowPath::22 ran 1.13 s of it in 2 starts, 1 of them failed"
        " (run 11 of nav.btlog, 1.16 s after its start at 2026-11-24 03:17:57.931 UTC)",
    ),
    (
        "nav",
        "NavigateWithReplanning succeeds",
        "NavigateWithReplanning: failed; it began at ComputePathToPose::17, 2 of its 3 starts failed"
        " (run 9 of nav.btlog, 209 ms after its start at 2026-11-24 03:17:56.787 UTC)",
    ),
    (
        "nav",
        "FallbackComputePathToPose takes at most 70 ms",
        "FallbackComputePathToPose: took 77.6 ms, bound 70 ms; ComputePathToPose::17 ran 77.5 ms of it"
        " (run 11 of nav.btlog, 307 ms after its start at 2026-11-24 03:17:57.931 UTC)",
    ),
    (
        "nav_noidle",
        "mission succeeds",
        "NavigateRecovery: failed; it began at RecoveryActions, whose last child BackUp::38 succeeded,"
        " which is lost without `wrap_around`"
        " (run 40 of nav_noidle.btlog, 1.03 s after its start at 2026-11-24 04:28:35.075 UTC)",
    ),
]


def mission(log: str, demand: str, shared: Path, folder: Path) -> None:
    """The mission of a log with one demand."""
    if log == "lab":
        text = (HERE / "lab.btq").read_text(encoding="utf-8")
        signals, tree = text[: text.index("QualityReq")], text[text.index("BehaviorTree mainTree") :]
    else:
        shutil.copy(shared / "logs" / "nav.xml", folder)
        assert main(["import", "nav.xml"]) == 0
        signals, _, rest = (folder / "nav.btq").read_text(encoding="utf-8").partition("BehaviorTree")
        tree = f"BehaviorTree{rest}"
    requirement = f"QualityReq rq : reliability\n    {demand}\n\n"
    (folder / "mission.btq").write_text(f"{signals}{requirement}{tree}", encoding="utf-8")


@pytest.mark.parametrize(("log", "demand", "line"), LINES)
def test_the_first_line(log: str, demand: str, line: str, shared: Path, verify: Verify) -> None:
    mission(log, demand, shared, verify.folder)
    for name in (f"{log}.btlog", "lab.battery.csv"):
        shutil.copy(shared / "logs" / name, verify.folder)
    signals = ("--signals", "lab.battery.csv") if log.startswith("lab") else ()
    output = verify.text(f"{log}.btlog", "--mission", "mission.btq", *signals)
    assert (verify.code, verify.errors) == (1, "")
    _, below, *_ = output.partition("\n\n")[2].splitlines()
    assert below.strip() == line
