"""What logs and stores show of skills: against the truth beside the logs, and half of a log against the other half."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median, variance

import pytest
from evidence_logs import as_logged, rows, write_db3
from in_process import run_btq

from btq_lang.prediction.measured import MeasuredActivation, MeasuredSkill, MeasuredSkills
from btq_lang.prediction.measuring import Measurement, actions_of, measured_in_logs, measured_in_store
from btq_lang.prediction.streams import Stream
from btq_lang.projects.files import Files
from btq_lang.scenarios.mission import ScenarioMission, as_program
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS
from btq_lang.simulator.skills import Write
from btq_lang.util.record import replace
from btq_lang.workspace.workspace import Workspace

TREES = {"lab": ("lab.xml", "mainTree"), "nav": ("nav.xml", "NavigateToPoseWReplanningAndRecovery")}
LOGS = {"lab": "lab", "nav": "nav", "nav_noidle": "nav"}
Mission = Callable[[str], ScenarioMission]


@pytest.fixture(scope="module")
def mission_of(shared: Path) -> Mission:
    missions: dict[str, ScenarioMission] = {}

    def mission(log: str) -> ScenarioMission:
        file, tree = TREES[LOGS[log]]
        if tree not in missions:
            path = str(shared / "logs" / file)
            groups, problems = Files().groups([path], with_xml=True)
            assert problems == ()
            missions[tree] = ScenarioMission(as_program(groups[0].workspace, path, tree), path, tree)
        return missions[tree]

    return mission


def read(shared: Path, log: str, mission: ScenarioMission, *suffixes: str) -> Measurement:
    return measured_in_logs([str(shared / "logs" / f"{log}{suffix}") for suffix in suffixes or (".btlog",)], mission)


def in_log(measurement: Measurement) -> Iterator[MeasuredActivation]:
    """All activations of a measurement."""
    for (scope, _), pairs in measurement.skills._by.items():
        yield from (each for each, _ in pairs if scope == "kind")


@pytest.mark.parametrize("log", LOGS)
def test_activations_are_those_of_the_truth(shared: Path, mission_of: Mission, log: str) -> None:
    """As often, with the same results, and as long, up to the ticks and pauses of the machine."""
    mission = mission_of(log)
    kinds = {kind for _, kind in actions_of(mission).values()}
    measurement = read(shared, log, mission)
    lines = (shared / "logs" / f"{log}.truth.jsonl").read_text(encoding="utf-8").splitlines()
    truth = [each for line in lines if (each := json.loads(line)).get("id") in kinds]
    words = {SUCCESS: "SUCCESS", FAILURE: "FAILURE"}
    ended = [each for each in in_log(measurement) if each.kind in kinds and each.result != RUNNING]
    counted = Counter((each.kind, words[each.result]) for each in ended)
    assert counted == Counter((each["id"], each["status"]) for each in truth if each["status"] in words.values())
    assert (measurement.foreign, measurement.left_out, measurement.problems) == (0, 0, ())
    for kind in {each.kind for each in ended}:
        logged = sorted(each.seconds * 1000 for each in ended if each.kind == kind)
        true = sorted(each["ms"] for each in truth if each["id"] == kind and each["status"] in words.values())
        late = [after - before for after, before in zip(logged, true, strict=True)]
        assert min(late) > -1
        assert median(late) < 10
        assert max(late) < 60


def test_each_format_shows_the_same(shared: Path, mission_of: Mission, tmp_path: Path) -> None:
    mission = mission_of("lab")
    actions = actions_of(mission)
    of_btlog = read(shared, "lab", mission).skills
    assert of_btlog.runs == 200
    shown = {uid: summary(skill) for uid, skill in of_btlog.of_nodes(actions).items()}
    assert shown.keys() == actions.keys()
    of_db3 = read(shared, "lab", mission, ".db3").skills
    assert {uid: summary(skill)[:4] for uid, skill in of_db3.of_nodes(actions).items()} == {
        uid: each[:4] for uid, each in shown.items()
    }
    twice = read(shared, "lab", mission, ".btlog", ".db3")
    assert twice.skills.runs == 200
    assert len(twice.remarks) == 1
    pytest.importorskip("duckdb")
    (tmp_path / "lab.xml").write_text((shared / "logs" / "lab.xml").read_text(encoding="utf-8"), encoding="utf-8")
    log = str(shared / "logs" / "lab.btlog")
    code, _, err = run_btq("verify", log, "--mission", "lab.xml", "--store", "store", "--label", "v1", cwd=tmp_path)
    assert (code, err) == (0, "")
    for label in (None, "v1"):
        in_store = measured_in_store(str(tmp_path / "store"), "lab", label).skills
        assert {uid: summary(skill) for uid, skill in in_store.of_nodes(actions).items()} == shown
    assert measured_in_store(str(tmp_path / "store"), "lab", "v2").skills.of_nodes(actions) == {}


def summary(skill: MeasuredSkill) -> tuple[object, ...]:
    return skill.by, skill.number, skill.ended, round(skill.probability(SUCCESS), 9), skill.longest


def test_by_path_from_30_on_else_by_kind(shared: Path, mission_of: Mission) -> None:
    mission = mission_of("lab")
    actions = actions_of(mission)
    skills = read(shared, "lab", mission).skills.of_nodes(actions)
    assert {actions[uid][0]: (skill.by, skill.number) for uid, skill in skills.items()} == {
        "MoveToCharger": ("kind", 201),  # it ran 26 times
        "Charge": ("kind", 25),
        "MoveToStation": ("path", 175),
        "PickPlate/Pick": ("path", 169),
        "PickPlate/Place": ("path", 162),
        "PickTube/Pick": ("path", 447),
        "PickTube/Place": ("path", 421),
    }


def test_halted_activations_are_kept(shared: Path, mission_of: Mission) -> None:
    mission = mission_of("nav")
    plan = next(uid for uid, (_, kind) in actions_of(mission).items() if kind == "ComputePathToPose")
    for log, number, halted in (("nav", 168, 9), ("nav_noidle", 166, 5)):
        measurement = read(shared, log, mission)
        skill = measurement.skills.of_nodes(actions_of(mission))[plan]
        assert (skill.by, skill.number, skill.number - skill.ended) == ("path", number, halted)
    assert measurement.latest > 0


def test_entries_are_drawn_with_the_activation(tmp_path: Path) -> None:
    """As far as the logger's callback notes them with the row of the result."""
    text = (
        "Action Count\n    output tubes : int\n    output full : bool\n    output pose : string\n\n"
        "BehaviorTree Main\n    ->\n        Count (tubes = {@left} full = {is_full} pose = {pose})\n"
    )
    (tmp_path / "main.btq").write_text(text, encoding="utf-8")
    assert run_btq("build", "main.btq", cwd=tmp_path)[0] == 0
    xml = as_logged((tmp_path / "main.xml").read_text(encoding="utf-8"))
    transitions = rows("1R 2R 10 2S 1S 1I 100 1R 2R 120 2F 1F 1I")
    extra = {
        1: '{"left": 9}',  # when it begins
        2: '{"left": 3, "is_full": true, "other": 1}',
        7: '{"left": 2}',
    }
    write_db3(tmp_path / "run.db3", xml, [transitions], extra)
    workspace = Workspace.of({"main.btq": text})
    mission = ScenarioMission(as_program(workspace, "main.btq", "Main"), "main.btq", "Main")
    (skill,) = measured_in_logs([str(tmp_path / "run.db3")], mission).skills.of_nodes(actions_of(mission)).values()
    draws = {skill.draw(Stream(1, "x", run).activation(0)) for run in range(100)}
    assert {(each.result, each.writes) for each in draws} == {
        (SUCCESS, (Write("tubes", 3, "long"), Write("full", 1, "bool"))),
        (FAILURE, (Write("tubes", 2, "long"),)),
    }


# ---- one half predicts the other (foresight §7) ----


def halves(skills: MeasuredSkills, change: Callable[[MeasuredActivation], MeasuredActivation]) -> list[MeasuredSkills]:
    """The first half of the runs, and the other one, changed."""
    runs: list[list[MeasuredActivation]] = [[] for _ in range(skills.runs)]
    for (scope, _), pairs in skills._by.items():
        for each, run in pairs if scope == "kind" else ():
            runs[run].append(each)
    half = len(runs) // 2
    return [MeasuredSkills(runs[:half]), MeasuredSkills([[*map(change, run)] for run in runs[half:]])]


def deviations(
    skills: MeasuredSkills,
    mission: ScenarioMission,
    change: Callable[[MeasuredActivation], MeasuredActivation] = lambda each: each,
) -> dict[tuple[str, str], float]:
    """By how many standard deviations the shares of results, at all and within the median, differ between the halves.

    The variance of each half is that of runs drawn again, and at least that of one activation among all.
    """
    actions = actions_of(mission)
    first, second = halves(skills, change)
    skills_of = first.of_nodes(actions), second.of_nodes(actions)
    again = [
        [half.resampled(actions, Stream(1, "half", number).activation(0)) for number in range(200)]
        for half in (first, second)
    ]
    differences: dict[tuple[str, str], float] = {}
    for uid in skills_of[0].keys() & skills_of[1].keys():
        one, two = (of_half[uid] for of_half in skills_of)
        if min(one.ended, two.ended) < 10:
            continue
        middle = sorted(each.takes for each in one._drawn)[len(one._drawn) // 2] / 1000
        for what, result, within in (
            ("succeeds", SUCCESS, math.inf),
            ("fails", FAILURE, math.inf),
            ("within the median", SUCCESS, middle),
        ):
            spread = sum(
                max(variance(each[uid].probability(result, within) for each in half), 1 / skill.number**2)
                for half, skill in zip(again, (one, two), strict=True)
            )
            difference = one.probability(result, within) - two.probability(result, within)
            differences[actions[uid][0], what] = difference / math.sqrt(spread)
    return differences


@pytest.mark.parametrize(("log", "number"), [("lab", 21), ("nav", 39), ("nav_noidle", 39)])
def test_the_first_half_predicts_the_other(shared: Path, mission_of: Mission, log: str, number: int) -> None:
    """Of so many shares none is off by more than 3 standard deviations."""
    mission = mission_of(log)
    differences = deviations(read(shared, log, mission).skills, mission)
    assert len(differences) == number
    assert max(map(abs, differences.values())) < 3, differences


def test_another_second_half_is_noticed(shared: Path, mission_of: Mission) -> None:
    """Else the test above would show nothing: a fifth slower, or one in seven that fails instead."""
    mission = mission_of("lab")
    skills = read(shared, "lab", mission).skills
    slower = deviations(skills, mission, lambda each: replace(each, seconds=each.seconds * 1.2))
    assert min(slower[name, "within the median"] for name in ("PickPlate/Pick", "PickTube/Pick")) > 5
    assert slower["MoveToStation", "within the median"] > 2  # its durations vary by a third
    unreliable = deviations(
        skills, mission, lambda each: replace(each, result=FAILURE) if round(each.seconds * 1e6) % 7 == 0 else each
    )
    names = ("MoveToStation", "PickPlate/Pick", "PickTube/Pick", "PickTube/Place")
    assert max(unreliable[name, "fails"] for name in names) < -3


@pytest.mark.parametrize(("log", "spec"), [("lab", "spec"), ("nav", "nav_spec"), ("nav_noidle", "nav_spec")])
def test_shares_are_those_that_the_robot_was_made_with(shared: Path, mission_of: Mission, log: str, spec: str) -> None:
    """The shares of activations that nobody halts."""
    mission = mission_of(log)
    actions = actions_of(mission)
    skills = read(shared, log, mission).skills
    nodes = json.loads((shared / "logs" / f"{spec}.json").read_text(encoding="utf-8"))["nodes"]
    again = [skills.resampled(actions, Stream(1, "spec", number).activation(0)) for number in range(200)]
    compared = 0
    for uid, skill in skills.of_nodes(actions).items():
        name, kind = actions[uid]
        share = nodes.get(name.rpartition("/")[2], nodes.get(kind, {})).get("success", 1.0)
        if skill.number < 30 or (skill.by == "kind" and log == "lab") or kind not in (*nodes, "MoveBase"):
            continue
        compared += 1
        spread = max(variance(each[uid].probability(SUCCESS) for each in again), 1 / skill.number**2)
        assert abs(skill.probability(SUCCESS) - share) < 4 * math.sqrt(spread), (name, share)
    assert compared == (5 if log == "lab" else 3)
