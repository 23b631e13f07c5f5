"""Runs of logs as scenarios: what the nodes do there they do in `btq test`."""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Set
from pathlib import Path

import pytest
from evidence_logs import as_logged, btlog
from in_process import run_btq

from btq_lang.commands.recorded import run_of
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.judging import Means
from btq_lang.evidence.model import Activation
from btq_lang.evidence.readers.samples import read as read_samples
from btq_lang.evidence.runs import activations
from btq_lang.projects.opening import open_workspace
from btq_lang.scenarios.mission import ScenarioMission, as_program, main_tree
from btq_lang.scenarios.reading import plan_of
from btq_lang.scenarios.recording import as_scenario
from btq_lang.scenarios.running import START, ScenarioRun, run
from btq_lang.syntax.tree import Scenario

LABORATORY = Path(__file__).resolve().parents[2] / "examples" / "laboratory"
SAMPLES = read_samples(str(LABORATORY / "signals.csv"))
MISSION = """\
QualityReq quick : performance-efficiency "Dock in time"
    Dock takes at most 5 s

Condition Low
Action Move
    input to : string
Action Dock

BehaviorTree Main
    R?
        -> Charging
            Low
            Retry (num_attempts = 3)
                Dock
        Inverter
            ->
                Move (to = "A")
                Move (to = "B")
                Move (to = "C")
"""
ODD = """\
include "main.btq"

scenario "A low battery on the way"
    given Low answers false
    given Move takes 10 s
    given Dock fails after 2 s twice, then succeeds after 7.5 s
    when 25 s have passed: Low answers true
    expect mission succeeds
"""


def ran(path: Path, is_enforced: bool = True) -> tuple[ScenarioMission, ScenarioRun]:
    """The run of the only scenario of a file."""
    workspace = open_workspace(str(path))
    name = next(each for each in workspace.files if each.endswith(f"/{path.name}"))
    tree = main_tree(workspace, name)
    program = as_program(workspace, name, tree)
    mission = ScenarioMission(program, name, tree, is_enforced)
    (scenario,) = program.files[name].of_type(Scenario)
    return mission, run(mission, plan_of(mission, scenario, ()))


def recorded_case(folder: Path, mission: str, scenario: str, *options: str) -> tuple[int, str, str]:
    """Run a scenario, and write case.btq from a log of that run; what the command gives."""
    (folder / "main.btq").write_text(mission, encoding="utf-8")
    (folder / "odd.btq").write_text(scenario, encoding="utf-8")
    assert run_btq("build", "main.btq", cwd=folder)[0] == 0
    _, first = ran(folder / "odd.btq")
    tree = as_logged((folder / "main.xml").read_text(encoding="utf-8"))
    rows = [(time - START, uid, status) for time, uid, status in first.rows]
    (folder / "run.btlog").write_bytes(btlog(tree, rows))
    options = "verify", "run.btlog", "--mission", "main.btq", "-o", "case.btq", *options
    return run_btq(*options, cwd=folder)


def test_a_run_is_the_same_again(tmp_path: Path) -> None:
    written = recorded_case(tmp_path, MISSION, ODD, "--show", "quick")
    assert written == (0, "", "run 1 of run.btlog is in case.btq: run it with btq test case.btq\n")
    assert (tmp_path / "case.btq").read_text(encoding="utf-8") == (
        'include "main.btq"\n\nscenario "Run 1 of run.btlog" verifies quick\n'
        "    given Low answers false\n"
        "    when 25 s have passed: Low answers true\n"
        '    given Move (to = "A") succeeds after 10 s\n'
        '    given Move (to = "B") succeeds after 10 s\n'
        '    given Move (to = "C") does not end\n'
        "    given Dock fails after 2 s 2 times, then succeeds after 7.5 s\n"
        "    expect mission succeeds\n    expect quick violated  # once this is mended: expect quick\n"
    )
    _, first = ran(tmp_path / "odd.btq")
    _, again = ran(tmp_path / "case.btq")
    assert [*again.rows] == [*first.rows]
    assert run_btq("test", "case.btq", cwd=tmp_path)[:2] == (
        0,
        "passed  Run 1 of run.btlog (case.btq:3): succeeds after 36.5 s\n1 scenario: 1 passed\n",
    )


TWICE = """\
QualityReq quick : performance-efficiency "At the ward in time"
    ToWard takes at most 5 s

Action Move
    input to : string
Action Look

BehaviorTree Main
    ->
        SubTree Way Out
        Move ToWard (to = "ward")
        SubTree Way Back

BehaviorTree Way
    ->
        Look
        Move ToPharmacy (to = "pharmacy")
"""
TIMES = """\
include "main.btq"

scenario "All ways take another time"
    given Look takes 1 s
    given Out/ToPharmacy takes 2 s
    given ToWard takes 7 s
    given Back/ToPharmacy takes 3 s
    expect mission succeeds
"""


def test_each_node_has_its_own_activations(tmp_path: Path) -> None:
    assert recorded_case(tmp_path, TWICE, TIMES, "--show", "quick")[0] == 0
    assert (tmp_path / "case.btq").read_text(encoding="utf-8").splitlines()[3:] == [
        "    given every Look succeeds after 1 s",
        "    given Out/ToPharmacy succeeds after 2 s",
        "    given ToWard succeeds after 7 s",
        "    given Back/ToPharmacy succeeds after 3 s",
        "    expect mission succeeds",
        "    expect quick violated  # once this is mended: expect quick",
    ]


def test_a_changed_mission_does_not_give_one_node_what_another_did(tmp_path: Path) -> None:
    assert recorded_case(tmp_path, TWICE, TIMES, "--show", "quick")[0] == 0
    (tmp_path / "main.btq").write_text(TWICE.replace("        SubTree Way Out\n", ""), encoding="utf-8")
    code, out, _ = run_btq("test", "case.btq", cwd=tmp_path)
    assert (code, out.splitlines()[1:-1]) == (2, ["        line 5: no node `ToPharmacy` below `Out`"])


def test_nodes_that_no_words_tell_apart_count_together(tmp_path: Path) -> None:
    mission = (
        'QualityReq quick : performance-efficiency "Soon"\n    mission takes at most 3 s\nAction Look\n'
        "BehaviorTree Main\n    ->\n        Look Once\n        Look\n        Look\n"
    )
    steps = "    given every Look succeeds after 1 s, then succeeds after 2 s, then succeeds after 3 s\n"
    scenario = f'include "main.btq"\n\nscenario "S"\n{steps}    expect mission succeeds\n'
    assert recorded_case(tmp_path, mission, scenario, "--show", "quick")[0] == 0
    written = (tmp_path / "case.btq").read_text(encoding="utf-8").splitlines(keepends=True)
    assert written[3:5] == [steps, "    given Once succeeds after 1 s\n"]
    assert run_btq("test", "case.btq", cwd=tmp_path)[0] == 0


STOPPED = """\
include "main.btq"

scenario "Somebody stops it"
    given ToWard takes 9 s
    when 7 s have passed: mission halts
    expect mission halts
"""


def test_a_run_that_was_halted_is_halted_again(tmp_path: Path) -> None:
    assert recorded_case(tmp_path, TWICE, STOPPED, "--show", "quick", "--run", "1")[0] == 0
    assert (tmp_path / "case.btq").read_text(encoding="utf-8").splitlines()[3:] == [
        "    given Out/Look succeeds",
        "    given Out/ToPharmacy succeeds",
        "    given ToWard does not end",
        "    when 7 s have passed: mission halts",
        "    expect mission halts",
        "    expect quick violated  # once this is mended: expect quick",
    ]
    assert run_btq("test", "case.btq", cwd=tmp_path)[0] == 0


def test_an_unknown_requirement_has_no_run(tmp_path: Path) -> None:
    code, _, err = run_btq("verify", str(LABORATORY), "--show", "rq9", cwd=tmp_path)
    assert (code, err) == (2, "btq verify: --show rq9: no requirement of a mission in these logs has this ID\n")


@pytest.mark.parametrize("number", [1, 8, 21, 24])
def test_runs_of_the_laboratory(number: int, tmp_path: Path) -> None:
    """All that its nodes did happens again, but how often the conditions of reactive nodes are asked: the model that
    made the log does not reset them."""
    for name in ("mission.btq", "btq.toml"):
        shutil.copy(LABORATORY / name, tmp_path / name)
    workspace = open_workspace(str(tmp_path / "mission.btq"))
    (path,) = workspace.files
    candidate = Candidate(workspace, path, "mission", None)
    recorded = run_of([str(LABORATORY / "runs.btlog")], candidate, Means([candidate], SAMPLES), number)
    assert recorded is not None
    text = as_scenario(recorded[1], "again", "mission.btq", [])
    (tmp_path / "case.btq").write_text(text, encoding="utf-8")
    mission, again = ran(tmp_path / "case.btq", is_enforced=False)
    polled = {uid for uid, node in mission.tree.nodes.items() if node.kind in ("SensorsAlive", "BatteryFull")}
    assert told(activations(again.session(mission)), polled) == told(recorded[1].activations, polled)


def told(all_activations: Iterable[Activation], polled: Set[int]) -> list[tuple[int, str]]:
    """The nodes in the order of their starts, each with its outcome, without some of them."""
    started = sorted(all_activations, key=lambda activation: (activation.started, activation.uid))
    return [(activation.uid, activation.outcome) for activation in started if activation.uid not in polled]


@pytest.fixture
def laboratory(tmp_path: Path) -> Path:
    """The mission of the laboratory with its logs."""
    for name in ("mission.btq", "btq.toml", "runs.btlog", "signals.csv"):
        shutil.copy(LABORATORY / name, tmp_path / name)
    return tmp_path


@pytest.mark.parametrize(
    ("options", "which", "last"),
    [
        (["rq1"], "run 21 of runs.btlog", "expect rq1 violated  # once this is mended: expect rq1"),
        (["rq2"], "run 9 of runs.btlog, which comes closest to a violation,", "expect rq2 satisfied"),
        (["rq4"], "run 7 of runs.btlog", "expect rq4 undecided"),
        (["rq1", "--run", "3"], "run 3 of runs.btlog", "expect rq1 never exercised"),
    ],
)
def test_which_run_is_written_and_with_which_verdict(
    options: list[str], which: str, last: str, laboratory: Path
) -> None:
    written = run_btq("verify", "runs.btlog", "--show", *options, "-o", "case.btq", cwd=laboratory)
    assert written == (0, "", f"{which} is in case.btq: run it with btq test case.btq --no-enforce\n")
    lines = (laboratory / "case.btq").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "# The log is of a build without guards, which btq test --no-enforce runs."
    assert lines[-1].strip() == last
    assert run_btq("test", "case.btq", "--no-enforce", cwd=laboratory)[0] == 0


def test_a_requirement_that_nothing_measured_has_no_worst_run(tmp_path: Path) -> None:
    unread = 'QualityReq calm : safety "Nobody is near"\n    every Look never node ToWard\n'
    code, _, err = recorded_case(tmp_path, f"{unread}\n{TWICE}", TIMES, "--show", "calm")
    assert (code, (tmp_path / "case.btq").exists()) == (1, False)
    assert err == "btq verify: --show calm: no run violates it (satisfied); name one with --run N\n"


def test_another_file_is_not_overwritten_unless_that_is_forced(laboratory: Path) -> None:
    (laboratory / "case.btq").write_text("# mine\n", encoding="utf-8")
    command = "verify", "runs.btlog", "--show", "rq1", "-o", "case.btq"
    assert run_btq(*command, cwd=laboratory) == (
        2,
        "",
        "btq verify: case.btq is there and differs; write to another file, or overwrite it with --force\n",
    )
    assert run_btq(*command, "--force", cwd=laboratory)[0] == 0
    assert run_btq(*command, cwd=laboratory)[0] == 0  # nothing would change
