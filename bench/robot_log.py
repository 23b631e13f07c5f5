"""Missions with ten requirements, and what the engine logs of them: a tiny one, whose runs have nine rows, and one as
large as robots' missions are, run in the model of the engine that scenarios have."""

from __future__ import annotations

import random
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path

sys.path.extend(str(Path(__file__).resolve().parents[1] / folder) for folder in ("tests", "tests/evidence"))
from evidence_logs import Row, as_logged
from random_runs import START, LoggedRun
from simulated_runs import bare

from btq_lang.btcpp.document import write as xml_of
from btq_lang.btcpp.export import export
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.model import SampleSeries
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

TINY = """\
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
    Move runs at most 100 per 20 ms
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

FETCH = """\
signal battery : % from {level} level
QualityReq a : performance-efficiency
    every Follow takes at most 8 s
QualityReq b : reliability
    every Plan succeeds within 2 s
    in at least 90 % of activations
QualityReq c : safety
    every Pick needs battery > 10 %
QualityReq d : safety
    every Follow keeps battery > 5 %
QualityReq e : safety
    every Charge leaves battery > 5 %
QualityReq f : resource-utilization
    every Follow uses at most 20 % of battery
QualityReq g : reliability
    every Look tries at most 6
QualityReq h : safety
    every Pick follows Look succeeds
QualityReq i : performance-efficiency
    every Plan runs at most 20 per 10 s
QualityReq j : reliability
    mission succeeds
    in at least 10 % of runs
    confidence 95 %
Root Main
BehaviorTree Main
    ->
        Retry prepare (num_attempts = 9)
            ?
                Condition Charged
                Action Charge
        Repeat shelves (num_cycles = 2)
            Retry shelf (num_attempts = 3)
                ->
                    SubTree Drive
                    Retry grasp (num_attempts = 9)
                        ->
                            Action Look
                            Action Pick
        SubTree Drive
        ?
            Action Place
            ->
                Action BackUp
                Action Place
BehaviorTree Drive
    Retry drive (num_attempts = 9)
        R->
            Condition Clear
            ->
                Action Plan
                Action Follow
Condition Charged
Condition Clear
Action Charge
Action Look
Action Pick
Action Plan
Action Follow
Action Place
Action BackUp
"""
SECONDS = {"Charge": 9.0, "Look": 0.4, "Pick": 3.0, "Plan": 0.2, "Follow": 6.0, "Place": 2.0, "BackUp": 1.0}
RUNS = 100  # that differ; a longer log has them again


@dataclass(frozen=True)
class Robot:
    """A mission, and logs of it.

    Attributes:
        xml: its tree as the engine logs it.
        runs: the rows of some runs, by µs since the start of each.
    """

    mission: Candidate
    xml: str
    runs: Sequence[Sequence[Row]]

    def rows(self, number: int) -> list[Row]:
        """The rows of runs one after the other, by µs since the first of them; the last run may be cut off."""
        found: list[Row] = []
        begin = 0
        for run in cycle(self.runs):
            found += [(begin + time, uid, status) for time, uid, status in run]
            if len(found) >= number:
                break
            begin = found[-1][0] + 4000
        return found[:number]


def tiny() -> Robot:
    """Two leaves, one after the other, in 26 ms."""
    mission = Candidate(Workspace.of({"a.btq": TINY}), "a.btq", "a", None)
    return Robot(mission, logged_xml(mission), [[(1000 * ms, uid, status) for ms, uid, status in ROWS]])


def fetching() -> Robot:
    """A robot that fetches things: loops, retries, and driving that stops when the way is not clear."""
    mission = Candidate(Workspace.of({"a.btq": FETCH}), "a.btq", "a", None)
    written = bare(mission)
    return Robot(mission, logged_xml(mission), [_run(written, random.Random(seed)) for seed in range(RUNS)])


def battery(until: int) -> dict[str, SampleSeries]:
    """Samples of the battery, one a second.

    Args:
        until: µs since the start of the log.
    """
    series = SampleSeries()
    for second in range(until // 1_000_000 + 1):
        series.add(START + second * 1_000_000, 90.0 - second % 80)
    return {"battery": series}


def logged_xml(mission: Candidate) -> str:
    """The tree of a mission as the engine logs it."""
    return as_logged(xml_of(export(mission.workspace, mission.path).document))


def _run(mission: ScenarioMission, chance: random.Random) -> list[Row]:
    """The rows of a run; those of one tick are 20 µs apart."""
    rows: list[Row] = []
    _Timed(mission, chance, rows, resets=True).run()
    return [(time - START + 20 * index, uid, status) for index, (time, uid, status) in enumerate(rows)]


class _Timed(LoggedRun):
    """A run whose leaves take about as long as a robot's."""

    def drawn(self, leaf: ResolvedNode) -> float:
        return SECONDS[skill_of(leaf)] * self.chance.uniform(0.7, 1.3)


def skill_of(leaf: ResolvedNode) -> str:
    """The ID of a leaf of the mission, all of whose leaves have one."""
    assert leaf.node.id is not None
    return leaf.node.id.text
