"""What btq.toml declares of skills and the world, in a mission: who it is about, and what is drawn."""

from __future__ import annotations

import math
from collections.abc import Callable
from statistics import NormalDist, median

import pytest

from btq_lang.catalog.units import Unit
from btq_lang.prediction.declared import DeclaredCondition, DeclaredSkill, DeclaredWorld, Outages, declared_world
from btq_lang.prediction.measured import MeasuredActivation, MeasuredSkill
from btq_lang.prediction.skill import AssumedSkill, DrawnActivation, Skill
from btq_lang.prediction.streams import Stream
from btq_lang.requirements.model import All, Compare, NodeTarget, Quantity, signals_in
from btq_lang.scenarios.mission import ScenarioMission, as_program
from btq_lang.simulator.blackboard import DOUBLE, Board
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, SimulatedNode
from btq_lang.simulator.skills import Write
from btq_lang.workspace.config import parse_project
from btq_lang.workspace.project_simulation import Spread
from btq_lang.workspace.workspace import Workspace

MISSION = """\
signal battery : % from {battery_level} level
signal person_near : bool
signal heat : degC

Condition BatteryFull
Condition SensorsAlive
Action MoveBase
    input station : string
Action Charge
Action Pick
    output tubes : int

BehaviorTree Main
    R->
        SensorsAlive
        ->
            MoveBase ToStation (station = "s")
            SubTree BatteryCheck
            Pick (tubes = {tubes})

BehaviorTree BatteryCheck
    ->
        MoveBase (station = "c")
        R?
            BatteryFull
            Charge
"""


@pytest.fixture(scope="module")
def mission() -> ScenarioMission:
    workspace = Workspace.of({"main.btq": MISSION})
    return ScenarioMission(as_program(workspace, "main.btq", "Main"), "main.btq", "Main")


def declared(mission: ScenarioMission, toml: str, measured: dict[int, Skill] | None = None) -> DeclaredWorld:
    project, wrong = parse_project(toml)
    assert wrong == ()
    assert project.simulation is not None
    return declared_world(project.simulation, mission, measured)


def skills(mission: ScenarioMission, lines: str) -> dict[str, Skill]:
    """What is declared of skills, by the last name of the path of a node."""
    of_uid = declared(mission, f"[simulate.skills]\n{lines}").skills
    return {mission.tree.nodes[uid].path: skill for uid, skill in of_uid.items()}


def drawn(skill: Skill, number: int = 4_000) -> list[DrawnActivation]:
    return [skill.draw(Stream(1, "x", run).activation(0)) for run in range(number)]


def within_4_sigma(count: float, trials: int, p: float) -> bool:
    return abs(count - trials * p) <= 4 * math.sqrt(trials * p * (1 - p))


PERCENT = Unit("%", (0, 0, 0, 0, 0, 0, 0, 0, 1), 0.01)
TO_STATION, TO_CHARGER = "ToStation", "BatteryCheck::5/MoveBase::7"


def test_the_most_specific_setting_counts_for_each_aspect(mission: ScenarioMission) -> None:
    by_path = skills(
        mission,
        '"BatteryCheck/MoveBase" = { takes = "9 s" }\n'
        'MoveBase = { takes = "5 s", succeeds = "0 %" }\n'
        'ToStation = { succeeds = "100 %" }\n',
    )
    assert by_path.keys() == {TO_STATION, TO_CHARGER}
    assert drawn(by_path[TO_STATION], 3) == [DrawnActivation(SUCCESS, 5_000, ())] * 3
    assert drawn(by_path[TO_CHARGER], 3) == [DrawnActivation(FAILURE, 9_000, ())] * 3
    assert {skill.source for skill in by_path.values()} == {"declared"}


@pytest.mark.parametrize(
    ("takes", "distribution"),
    [
        ('["10 s", "20 s"]', lambda ms: (ms - 10_000) / 10_000),
        ('{ from = "10 s", to = "20 s" }', lambda ms: (ms - 10_000) / 10_000),
        (
            '{ median = "18 s", p95 = "27 s" }',
            lambda ms: NormalDist(math.log(18_000), math.log(1.5) / NormalDist().inv_cdf(0.95)).cdf(math.log(ms)),
        ),
    ],
)
def test_durations_have_the_declared_distribution(
    mission: ScenarioMission, takes: str, distribution: Callable[[float], float]
) -> None:
    """Within 4 sigma in each of ten parts that are equally likely."""
    (skill,) = skills(mission, f"Charge = {{ takes = {takes} }}").values()
    counts = [0] * 10
    for each in drawn(skill):
        counts[int(distribution(each.takes) * 10)] += 1
    assert all(within_4_sigma(count, 4_000, 0.1) for count in counts), counts


def test_a_lognormal_duration_has_its_median(mission: ScenarioMission) -> None:
    (skill,) = skills(mission, 'Charge = { takes = { median = "18 s", p95 = "27 s" } }').values()
    durations = [each.takes for each in drawn(skill)]
    assert within_4_sigma(sum(duration <= 18_000 for duration in durations), 4_000, 0.5)
    assert within_4_sigma(sum(duration <= 27_000 for duration in durations), 4_000, 0.95)
    assert median(durations) == pytest.approx(18_000, rel=0.02)


def test_the_share_that_succeeds(mission: ScenarioMission) -> None:
    (skill,) = skills(mission, 'Pick = { takes = "6 s", succeeds = "97 %" }').values()
    assert within_4_sigma(sum(each.result == SUCCESS for each in drawn(skill)), 4_000, 0.97)


def test_another_share_changes_no_duration(mission: ScenarioMission) -> None:
    lines = 'Pick = {{ takes = ["5 s", "7 s"], succeeds = "{} %" }}'
    (often,), (seldom,) = (skills(mission, lines.format(share)).values() for share in (90, 10))
    pairs = [*zip(drawn(often), drawn(seldom), strict=True)]
    assert all(left.takes == right.takes for left, right in pairs)
    assert not any(left.result == FAILURE and right.result == SUCCESS for left, right in pairs)


def node(board: Board) -> SimulatedNode:
    return SimulatedNode(1, "Pick", "Pick", "Pick", {}, board, None)  # type: ignore[arg-type]  # its rules are not used


def test_writes_are_computed_where_it_succeeds() -> None:
    skill = DeclaredSkill(Spread("fixed", 1, 1), 1.0, [("tubes", "tubes - 1"), ("held", "'tube'")])
    board = Board()
    board.define("tubes", 3.0, DOUBLE)
    success, failure = DrawnActivation(SUCCESS, 0, ()), DrawnActivation(FAILURE, 0, ())
    assert skill.keys == ("tubes", "held")
    assert skill.writes(node(board), success, True) == (
        Write("tubes", 2.0, "double"),
        Write("held", "tube", "std::string"),
    )
    assert skill.writes(node(board), failure, True) == ()


def measured(*activations: tuple[int, float]) -> MeasuredSkill:
    return MeasuredSkill([(MeasuredActivation("Pick", "Pick", result, seconds), 1) for result, seconds in activations])


def test_what_is_not_declared_is_measured() -> None:
    base = measured((FAILURE, 7))
    stream = Stream(1, "x", 0).activation(0)
    only_writes = DeclaredSkill(writes=[("tubes", "1")], base=base)
    assert (only_writes.source, only_writes.draw(stream)) == ("measured", DrawnActivation(FAILURE, 7_000))
    with_time = DeclaredSkill(Spread("fixed", 2, 2), base=base)
    assert (with_time.source, with_time.draw(stream)) == ("measured", DrawnActivation(FAILURE, 2_000))
    whole = DeclaredSkill(Spread("fixed", 2, 2), 1.0, base=base)
    assert (whole.source, whole.draw(stream)) == ("declared", DrawnActivation(SUCCESS, 2_000, ()))
    assert AssumedSkill().draw(stream) == DrawnActivation(SUCCESS, 0, ())


def test_a_measured_skill_that_runs_on_ends_only_if_its_duration_is_declared() -> None:
    base = measured((FAILURE, 7), (RUNNING, 8), (RUNNING, 9))
    guess = DrawnActivation(RUNNING, 9_000, None, True)
    assert {*drawn(DeclaredSkill(succeeds=1.0, base=base))} == {guess, DrawnActivation(SUCCESS, 7_000)}
    assert {*drawn(DeclaredSkill(Spread("fixed", 2, 2), base=base))} == {DrawnActivation(FAILURE, 2_000)}


def test_conditions_are_read_over_signals_and_entries(mission: ScenarioMission) -> None:
    world = declared(
        mission,
        '[simulate.skills]\nBatteryFull = { is = "battery >= 95 % and {mode} == 2" }\n'
        'SensorsAlive = { fails = "1 per 8 h", for = "2 s" }',
    )
    full, alive = (world.conditions[uid] for uid in sorted(world.conditions, reverse=True))
    assert (full.fails, full.outages(Stream(1, "x", 0))) == (0, None)
    assert isinstance(full.condition, All)
    battery, mode = full.condition.conditions
    assert isinstance(battery, Compare)
    assert isinstance(mode, Compare)
    assert (battery.operators, battery.operands[1]) == ((">=",), Quantity("95 %", 0.95, PERCENT))
    assert [signal.entry for signal in signals_in(full.condition)] == ["battery_level", "mode"]
    assert alive == DeclaredCondition(None, 1 / 28_800, 2.0)


@pytest.mark.parametrize(("fails", "lasts"), [(1 / 60, 2.0), (1 / 10, 4.0)])
def test_a_condition_fails_as_often_and_as_long_as_declared(fails: float, lasts: float) -> None:
    """At any time: also when the run begins."""
    runs = [Outages(fails, lasts, Stream(1, "x", run)) for run in range(4_000)]
    for now in (0, 700, 50_000):
        assert within_4_sigma(sum(run.is_out(now) for run in runs), 4_000, fails * lasts)
    begins = 0
    for run in runs:
        now, was_out = 0, run.is_out(0)
        while (now := run.next_change(now)) < 100_000:
            begins += run.is_out(now) and not was_out
            was_out = run.is_out(now)
    assert begins / len(runs) == pytest.approx(100 * fails, rel=0.03)


def test_an_outage_has_its_length_whoever_asks_first() -> None:
    outages = Outages(1 / 60, 2.0, Stream(1, "x", 3))
    begin = outages.next_change(0)
    end = outages.next_change(begin)
    assert not outages.is_out(begin - 1)
    assert outages.is_out(begin)
    assert outages.is_out(end - 1)
    assert not outages.is_out(end)
    assert end - begin in (2_000, 2_001)
    late = Outages(1 / 60, 2.0, Stream(1, "x", 3))
    late.is_out(10_000_000)
    assert (late.next_change(0), late.next_change(begin)) == (begin, end)


def test_signals_are_in_their_units(mission: ScenarioMission) -> None:
    world = declared(
        mission,
        '[simulate.world]\nbattery = { start = "600000 ppm", rate = "-3 %/min", while = { Charge = "+1 %/s" }, '
        'between = ["0 %", "100 %"] }\nperson_near = { start = true }\nheat = { start = "300 K", rate = "1 K/min" }\n'
        '"{light}" = { start = 5, rate = "0.5 1/s" }\n',
    )
    battery, person, heat, light = world.signals
    (target,), rate = battery.rates[0]
    assert isinstance(target, NodeTarget)
    assert (target.node.id.text if target.node.id else "", rate) == ("Charge", 1.0)
    assert (battery.start, battery.rate, battery.low, battery.high) == (60.0, -0.05, 0.0, 100.0)
    assert (person.start, person.rate) == (True, 0.0)
    assert heat.start == 26.85
    assert heat.rate == pytest.approx(1 / 60)
    assert (light.signal.entry, light.start, light.rate, light.high) == ("light", 5.0, 0.5, math.inf)
    assert world.problems == ()


@pytest.mark.parametrize(
    ("lines", "problem"),
    [
        (
            '[simulate.skills]\nPick = { fails = "1 per h", for = "1 s" }',
            ("`Pick` is an action; say what it `takes` and how often it `succeeds`", ("skills", "Pick")),
        ),
        (
            '[simulate.skills]\nBatteryFull = { succeeds = "1 %" }',
            (
                "`BatteryFull` is a condition; say what it `is`, or how often it `fails` and `for` how long",
                ("skills", "BatteryFull"),
            ),
        ),
        (
            '[simulate.skills]\nSequence = { succeeds = "1 %" }',
            ("`Sequence` is a Sequence, and no skill; name an action or a condition", ("skills", "Sequence")),
        ),
        (
            '[simulate.skills]\nBatteryFull = { is = "battery >= 95" }',
            ("missing unit after `95`; `battery` is in %", ("skills", "BatteryFull", "is")),
        ),
        (
            '[simulate.skills]\nBatteryFull = { is = "batery >= 95 %" }',
            ("unknown signal `batery`; did you mean `battery`?", ("skills", "BatteryFull", "is")),
        ),
        (
            '[simulate.skills]\nBatteryFull = { is = "battery >=" }',
            (
                "expected a condition: a signal, a context, a value, …, found the end of the line",
                ("skills", "BatteryFull", "is"),
            ),
        ),
        (
            '[simulate.world]\nbattery = { start = "3 m" }',
            ("expected a percentage, found `3 m` (a length)", ("world", "battery", "start")),
        ),
        (
            "[simulate.world]\nbattery = { start = 3 }",
            ("missing unit after `3`; expected a percentage", ("world", "battery", "start")),
        ),
        (
            "[simulate.world]\nbattery = { start = true }",
            ("expected a number for `battery`", ("world", "battery", "start")),
        ),
        (
            '[simulate.world]\nbattery = { start = "3 %", rate = "3 %" }',
            ("expected a value in %/s, found `3 %` (a percentage)", ("world", "battery", "rate")),
        ),
        (
            '[simulate.world]\nbattery = { start = "3 %", between = ["4 %", "5 %"] }',
            (
                "`battery` must start between the two values, of which the lower one comes first",
                ("world", "battery", "between"),
            ),
        ),
    ],
)
def test_problems_are_at_their_keys(mission: ScenarioMission, lines: str, problem: tuple[str, tuple[str, ...]]) -> None:
    assert declared(mission, lines).problems == (problem,)
