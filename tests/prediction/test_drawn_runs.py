"""Drawn runs are those of the simulator's own driver, row by row, whatever is remembered between them."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from drawn_trees import drawn
from plain_runs import plain_run
from seeds import seeds

from btq_lang.btcpp.opening import file_of
from btq_lang.prediction import remembering
from btq_lang.prediction.declared import declared_world
from btq_lang.prediction.judging import Judge
from btq_lang.prediction.prepared import PreparedMission, prepared
from btq_lang.prediction.runs import DrawnRun
from btq_lang.scenarios.mission import NotRunnable, ScenarioMission, as_program, main_tree
from btq_lang.scenarios.running import with_begins
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import RUNNING
from btq_lang.util.record import replace
from btq_lang.workspace.config import Project, parse_project
from btq_lang.workspace.workspace import Workspace

LABORATORY = Path(__file__).parents[2] / "examples/laboratory/mission.btq"
OF_LABORATORY = """
[simulate.skills]
MoveBase = { takes = { median = "12 s", p95 = "20 s" }, succeeds = "97 %" }
Pick = { takes = ["4 s", "7 s"], succeeds = "97 %", writes = { "@tubes" = "@tubes - 1" } }
ReadLabel = { takes = ["1.5 s", "3 s"] }
Place = { takes = "5 s" }
Charge = { takes = "1000 s" }
BatteryFull = { is = "battery >= 95 %" }
MicroplateNotEmpty = { is = "{tubes} > 0" }
SensorsAlive = { fails = "1 per 1 h", for = "2 s" }
[simulate.world]
label_traffic = { start = "0 kB" }
"{tubes}" = { start = 6 }
[simulate.world.battery]
start = "60 %"
rate = "-0.1 %/s"
while = { Charge = "+1 %/s", MoveBase = "-0.5 %/s" }
between = ["0 %", "100 %"]
"""
IN_BETWEEN = 'rate = "0.001 kB/s", while = { ReadLabel = "0 kB/s" } }'  # of which guards copy the value
MODELS = """<TreeNodesModel><Action ID="Act"><input_port name="in"/><output_port name="out" type="double"/></Action>
<Action ID="Do"><input_port name="a"/></Action><Condition ID="Cond"><output_port name="out"/></Condition>
</TreeNodesModel></root>"""
OF_TREES = """
[simulate.skills]
Act = { takes = ["0 s", "0.04 s"], succeeds = "70 %", writes = { out = "x + 1" } }
Do = { takes = { median = "0.05 s", p95 = "0.4 s" }, succeeds = "60 %" }
Cond = { fails = "4 per 1 s", for = "0.05 s" }
[simulate.world]
"{x}" = { start = 0, rate = "10 1/s", while = { Do = "-5 1/s" }, between = [0, 5] }
"""


def mission_of(workspace: Workspace, path: str) -> ScenarioMission:
    tree = main_tree(workspace, path)
    return ScenarioMission(as_program(workspace, path, tree), path, tree)


def with_settings(mission: ScenarioMission, text: str, with_all_rows: bool = True) -> PreparedMission:
    project, problems = parse_project(text)
    assert problems == ()
    assert project.simulation is not None
    world = declared_world(project.simulation, mission)
    assert world.problems == ()
    return prepared(mission, world, world.skills, with_all_rows)


def laboratory(with_all_rows: bool = True, settings: str = OF_LABORATORY) -> PreparedMission:
    workspace = Workspace.of({"mission.btq": LABORATORY.read_text(encoding="utf-8")}, Project())
    return with_settings(mission_of(workspace, "mission.btq"), settings, with_all_rows)


def ends(run: DrawnRun) -> str:
    words = {"succeeds": "SUCCESS", "fails": "FAILURE", "is skipped": "SKIPPED", "does not end": "RUNNING"}
    return words.get(run.end, run.why)


def changes(run: DrawnRun) -> list[tuple[int, int, int]]:
    """The rows without those that begin a node, and without the end of a root that did not succeed."""
    rows = [row for row in run.rows if row[2] != RUNNING]
    return rows if run.end in ("succeeds", "fails") else [row for row in rows if row[1] != 1]


def assert_same(mission: PreparedMission, seed: int, numbers: range) -> set[str]:
    outcomes: set[str] = set()
    limit = mission.loaded.limit
    for number in numbers:
        run = mission.loaded.run(seed, number)
        end, now, rows = plain_run(mission, seed, number)
        outcomes.add(run.end)
        plain = [row for row in rows if row[2] != RUNNING]
        if now > limit:  # it looks at that only after a tick
            assert run.end == "does not end"
            assert [row for row in changes(run) if row[0] < limit] == [row for row in plain if row[0] < limit]
            continue
        assert (ends(run), run.now) == (end, now), number
        assert changes(run) == (plain if end in ("SUCCESS", "FAILURE") else [row for row in plain if row[1] != 1])
    return outcomes


def test_runs_of_the_laboratory() -> None:
    assert assert_same(laboratory(), 1, range(1, 21)) == {"succeeds", "fails"}


def test_a_value_of_the_world_that_is_copied_and_calculated_with() -> None:
    settings = OF_LABORATORY.replace(
        'label_traffic = { start = "0 kB" }', f'label_traffic = {{ start = "0 kB", {IN_BETWEEN}'
    )
    assert assert_same(laboratory(settings=settings), 1, range(1, 3)) == {"succeeds", "fails"}


@pytest.mark.parametrize("seed", seeds(300))
def test_runs_of_drawn_trees(seed: int) -> None:
    xml = drawn(Random(seed)).replace("</root>", MODELS)
    workspace = Workspace({"tree.xml": file_of("tree.xml", xml)}, Project())
    try:
        mission = with_settings(mission_of(workspace, "tree.xml"), OF_TREES)
    except (NotRunnable, EngineError, NotModelled):
        return
    mission.loaded.limit = 2_000  # ms
    assert_same(mission, seed, range(1, 6))


def test_a_run_does_not_depend_on_those_before_it() -> None:
    first, second = laboratory(), laboratory()
    in_order = {number: first.loaded.run(3, number) for number in range(1, 31)}
    assert {number: second.loaded.run(3, number) for number in reversed(range(1, 31))} == in_order


def test_the_rows_that_are_kept_are_enough() -> None:
    with_all, with_few = laboratory(), laboratory(with_all_rows=False)
    judge = Judge(with_all.mission)
    leaves = with_all.mission.tree.leaves
    judged = []
    for mission in (with_all, with_few):
        runs = [mission.loaded.run(5, number) for number in range(1, 121)]
        assert {run.end for run in runs} == {"succeeds", "fails"}
        evaluation = judge.evaluation()
        if mission is with_all:
            runs = [replace(run, rows=[*with_begins(run.rows, leaves)]) for run in runs]
        judge.read(evaluation, iter(runs))
        judged.append(
            [
                (
                    each.text,
                    each.verdict,
                    each.counted,
                    each.violated,
                    each.unknown,
                    each.failed,
                    each.halted,
                    each.worst,
                )
                for verdict in evaluation.verdicts()
                for each in verdict.clauses
            ]
        )
    assert judged[0] == judged[1]
    assert {each[1] for each in judged[0]} == {"violated", "satisfied"}


def test_runs_are_the_same_where_nothing_more_is_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    remembered = [laboratory().loaded.run(5, number) for number in range(1, 11)]
    monkeypatch.setattr(remembering, "_MOST", 30)
    few = laboratory()
    assert [few.loaded.run(5, number) for number in range(1, 11)] == remembered


def test_an_entry_that_a_node_writes_is_sampled_as_often_as_it_must_be_fresh() -> None:
    text = """signal tubes : count from {tubes} fresh within 3 s
Action Pick
Root Fill
QualityReq left : reliability
    leaves tubes >= 1
BehaviorTree Fill
    ->
        Script (code = "tubes := 2")
        Repeat (num_cycles = 2)
            Pick satisfies left
"""
    skills = '[simulate.skills]\nPick = { takes = "4 s", writes = { "@tubes" = "@tubes - 1" } }\n'
    mission = with_settings(mission_of(Workspace.of({"m.btq": text}, Project()), "m.btq"), skills)
    samples = mission.loaded.run(1, 1).samples["tubes"]
    assert samples == [(0, 2), (3_000_000, 2), (4_000_000, 1.0), (6_000_000, 1.0), (8_000_000, 0.0)]
