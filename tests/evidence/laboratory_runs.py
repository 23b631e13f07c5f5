"""The logs of examples/laboratory and examples/paper, and their samples: fifty runs of each by a robot that is a model.

The model of the engine runs a mission as it is written, without guards.  How long a skill takes, whether it fails,
and what the battery loses meanwhile is drawn.  The same bytes come out every time.
"""

from __future__ import annotations

import random
from bisect import bisect_right
from math import ceil
from sys import maxsize

from evidence_logs import btlog
from random_runs import START, LoggedRun
from robot_log import logged_xml
from simulated_runs import bare

from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.model import FAILURE, SUCCESS, Transition
from btq_lang.simulator.blackboard import DOUBLE
from btq_lang.workspace.resolved import ResolvedNode

SEED = 7
RUNS = 50
MONDAY = 1_795_420_800  # s since the epoch: 2026-11-23 08:00 UTC
SECONDS = {
    "ToSolidStation": (9.0, 16.0),
    "ToCharger": (14.0, 24.0),
    "Pick": (4.0, 7.0),
    "ReadLabel": (1.5, 3.0),
    "Place": (4.0, 6.0),
}
DETOUR, DETOURS = (28.0, 38.0), 0.12  # s; the share of drives to the charger
FAILURES = {"ToSolidStation": 0.003, "Pick": 0.003}  # shares of activations
DRIVING, OTHERWISE, CHARGING = -0.5, -0.1, 1.0  # % of battery per s
LONGER, ARM = 1.1, -0.3  # of the paper's robot: s for each drive to the charger, % of battery per s
LOW, FULL = 20.0, 95.0  # %
PERIOD = 4  # s between samples; the mission's `fresh within` is longer
REPORT = 1.5  # kB that the label reader sends after each run
PAUSE = 15.0  # s after each run


def campaign(mission: Candidate, kind: type[Robot]) -> tuple[bytes, str]:
    """The .btlog of a robot of a kind, and the CSV file of the signals."""
    rows: list[Transition] = []
    robot = kind(bare(mission), random.Random(SEED), rows, resets=True)
    reports = []
    for _ in range(RUNS):
        first = len(rows)
        robot.tubes = robot.chance.choice([6, 6, 6, 5])
        robot.run()
        # Those of one tick have the same time in the model.
        rows[first:] = [
            (time - START + 20 * index, uid, status) for index, (time, uid, status) in enumerate(rows[first:])
        ]
        reports.append(robot.now + PAUSE / 2)
        robot.spend(PAUSE, OTHERWISE)
        robot.wait(round(PAUSE * 1000))
    lines = [
        f"{MONDAY + second},{robot.battery(second):.1f},{REPORT * bisect_right(reports, second):g}"
        for second in range(0, int(robot.now), PERIOD)
    ]
    csv = "\n".join(["t,battery,label_traffic", *lines, ""])
    return btlog(logged_xml(mission), rows, MONDAY * 1_000_000), csv


class Robot(LoggedRun):
    """Runs of the laboratory's mission, in which one skill works at a time.

    Attributes:
        tubes: left in the microplate.
        changes: of the battery: from when on (s), from which level (%), and by how much per s.
    """

    last = maxsize
    tubes = 0
    changes: tuple[tuple[float, float, float], ...] = ((0.0, FULL, OTHERWISE),)

    @property
    def now(self) -> float:
        """The time, in s."""
        return self.machine.now / 1000

    def drawn(self, leaf: ResolvedNode) -> float:
        name = self.name_of(leaf)
        if name == "Charge":  # until it is halted
            seconds, rate = ceil((FULL - self.battery(self.now)) / CHARGING * 1000) / 1000, CHARGING
        else:
            bounds = DETOUR if name == "ToCharger" and self.chance.random() < DETOURS else SECONDS[name]
            seconds, rate = round(self.chance.uniform(*bounds), 2), DRIVING if name.startswith("To") else OTHERWISE
        self.spend(seconds, rate)
        return seconds

    def ended(self, leaf: ResolvedNode) -> int:
        name = self.name_of(leaf)
        if self.chance.random() < FAILURES.get(name, 0.0):
            return FAILURE
        self.tubes -= name == "Pick"
        return SUCCESS

    def answer(self, condition: ResolvedNode) -> int:
        level = self.battery(self.now)
        self.machine.root.board.write("battery_level", level, DOUBLE)  # SensorsAlive does, which is asked at every tick
        holds = {
            "SensorsAlive": True,
            "BatteryLow": level < LOW,
            "BatteryFull": level >= FULL,
            "MicroplateNotEmpty": self.tubes > 0,
        }[self.name_of(condition)]
        return SUCCESS if holds else FAILURE

    def spend(self, seconds: float, rate: float) -> None:
        """The battery changes for a while, and then as it does otherwise."""
        until = self.now + seconds
        level = self.battery(self.now)
        self.changes += ((self.now, level, rate), (until, level + seconds * rate, OTHERWISE))

    def battery(self, time: float) -> float:
        """Its level at a time, in %."""
        begin, level, rate = self.changes[bisect_right(self.changes, time, key=lambda change: change[0]) - 1]
        return level + (time - begin) * rate

    def name_of(self, leaf: ResolvedNode) -> str:
        """What a leaf does."""
        name = leaf.name or leaf.id
        assert name is not None
        return name.text


class Inspector(Robot):
    """Runs of the paper's mission, in which both drives have one name, and a plate is brought before the tubes.

    The arm takes more of the battery, and the way to the charger gets longer.

    Attributes:
        drives: to the charger.
    """

    drives = 0

    def drawn(self, leaf: ResolvedNode) -> float:
        if self.name_of(leaf) != "ToCharger":
            return super().drawn(leaf)
        seconds = round(self.chance.uniform(17.0, 21.0) + LONGER * self.drives, 2)
        self.drives += 1
        self.spend(seconds, DRIVING)
        return seconds

    def spend(self, seconds: float, rate: float) -> None:
        super().spend(seconds, ARM if rate == OTHERWISE else rate)

    def run(self) -> None:
        self.tubes += 1 - self.tubes // 6  # the plate; after the sixth tube Retry gives up
        super().run()

    def name_of(self, leaf: ResolvedNode) -> str:
        name = super().name_of(leaf)
        if name != "MoveBase":
            return name
        assert leaf.parent is not None
        return "ToCharger" if super().name_of(leaf.parent) == "BatteryCheck" else "ToSolidStation"
