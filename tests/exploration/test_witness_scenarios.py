"""Runs that `btq explore` finds, as scenarios: in `btq test` the same happens again."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from drawn_trees import drawn
from evidence_logs import logged
from exploring import Exploring
from in_process import run_btq
from seeds import seeds

from btq_lang.exploration.answers import full_runs
from btq_lang.exploration.missions import ExploredMission, NotExplored
from btq_lang.exploration.search import Search, SearchBudget
from btq_lang.exploration.witness import Tick, replay
from btq_lang.projects.opening import open_workspace
from btq_lang.scenarios.running import ScenarioRun
from btq_lang.scenarios.witnessed import PossibleExpectation, Witness, as_scenario

MODELS = """
<TreeNodesModel>
  <Action ID="Act"><input_port name="in"/><output_port name="out" type="int"/></Action>
  <Condition ID="Cond"/>
  <Action ID="Do"><input_port name="a"/></Action>
</TreeNodesModel>
</root>"""
MISSION = """
Condition Ready
Action DetectCup
    output cup : int
Action Grasp
    input cup : int
Action Wait

QualityReq calm : safety
    Grasp succeeds

BehaviorTree Fetch
    R->
        Ready
        ->
            ?
                DetectCup (cup = {cup})
                Wait
            ScriptCondition (code = "cup > 3")
            Grasp (cup = {cup})
"""


def statuses(ticks: tuple[Tick, ...]) -> list[tuple[int, int]]:
    """What a witness says of its leaves, without what changes nothing."""
    return [change for tick in ticks for change in tick.changes]


def statuses_of_leaves(run: ScenarioRun, leaves: set[int]) -> list[tuple[int, int]]:
    """The same of a run."""
    before: dict[int, int] = {}
    changes: list[tuple[int, int]] = []
    for _, uid, status in run.rows:
        if uid in leaves and (status != 0 or before.get(uid) == 1):
            changes.append((uid, status))
        before[uid] = status
    return changes


@pytest.mark.parametrize("seed", seeds(300))
def test_runs_of_drawn_trees_happen_again(seed: int, tmp_path: Path) -> None:
    random = Random(seed)
    xml = drawn(random).replace('Cond out="{y}"', "Cond").replace("</root>", MODELS)  # a scenario gives them no writes
    (tmp_path / "tree.xml").write_text(xml, encoding="utf-8")
    path, case = str(tmp_path / "tree.xml"), tmp_path / "case.btq"
    mission = ExploredMission(open_workspace(path), path, "Main")
    try:
        opened = mission.open()
    except NotExplored:
        return
    custom = {node.uid for node in opened.custom}
    for leaves in (frozenset[int](), full_runs(opened)):
        opened.begin(None, leaves)
        search = Search(opened.snapshots, SearchBudget(200)).run()
        for ways in search.ends.values():
            ticks = replay(opened, None, leaves, ways)
            if ticks[-1].result not in ("succeeds", "fails"):
                continue  # a scenario that needs a value which nobody gives is unknown, and so is one of a skipped root
            scenario = as_scenario(
                mission, Witness("a run", ticks, False, (PossibleExpectation(""),)), str(case), "tree.xml"
            )
            if scenario is None:  # times of timers that contradict each other, or types of entries that do
                has_timers = any(deed.what == "goes off" for tick in ticks for deed in tick.deeds)
                assert has_timers or run_btq("check", "tree.xml", cwd=tmp_path)[0] == 1
                continue
            assert statuses_of_leaves(scenario.run, custom)[: len(statuses(ticks))] == statuses(ticks)
            assert scenario.run.end == ticks[-1].result
            case.write_text(f'include "tree.xml"\n\n{scenario.text}', encoding="utf-8")
            code, out, err = run_btq("test", "case.btq", cwd=tmp_path)
            assert (code, err) == (0, ""), out


def test_what_can_happen_is_a_scenario_that_passes(explore: Exploring) -> None:
    explore.mission(MISSION)
    questions = "Grasp halts", "Grasp starts after Wait succeeds", "mission fails"
    code, _, err = explore(*(word for question in questions for word in ("--can", question)), "-o", "case.btq")
    assert (code, err) == (0, "3 runs in case.btq: run with btq test case.btq\n")
    assert (explore.folder / "case.btq").read_text(encoding="utf-8") == (
        'include "mission.btq"\n'
        "\n"
        'scenario "can Grasp halts"\n'
        "    given Ready answers true, false\n"
        "    given DetectCup succeeds and writes cup = 4\n"
        "    given Grasp does not end\n"
        "    expect Grasp starts at least 1 per run\n"
        "\n"
        "QualityReq asked_2\n"
        "    mission never node Grasp\n"
        "    from Wait succeeds until mission finishes\n"
        "\n"
        'scenario "can Grasp starts after Wait succeeds"\n'
        "    given Ready answers true\n"
        "    given DetectCup fails and writes cup = 4\n"
        "    given Wait succeeds\n"
        "    given Grasp succeeds\n"
        "    expect asked_2 violated\n"
        "\n"
        'scenario "can mission fails"\n'
        "    given Ready answers true\n"
        "    given DetectCup fails\n"
        "    given Wait fails\n"
        "    expect mission fails at least 1 per run\n"
    )
    assert run_btq("test", "case.btq", cwd=explore.folder)[0] == 0


def test_what_must_never_happen_is_a_scenario_that_fails_until_it_cannot(explore: Exploring) -> None:
    explore.mission(MISSION)
    assert explore("--never", "Grasp starts after Wait succeeds", "-o", "case.btq")[0] == 1
    code, out, _ = run_btq("test", "case.btq", cwd=explore.folder)
    assert (code, out.splitlines()[0]) == (
        1,
        "failed  never Grasp starts after Wait succeeds (case.btq:7): succeeds after 0 ms",
    )
    explore.mission(MISSION.replace("                Wait\n", "                Inverter\n                    Wait\n"))
    assert run_btq("test", "case.btq", cwd=explore.folder)[0] == 0


def test_a_scenario_says_where_no_claim_says_what_was_asked(explore: Exploring) -> None:
    explore.mission(MISSION)
    assert explore("--never", "Wait fails before DetectCup succeeds", "-o", "case.btq")[0] == 1
    assert (explore.folder / "case.btq").read_text(encoding="utf-8") == (
        'include "mission.btq"\n'
        "\n"
        "# no claim says that this must not happen: the scenario passes while it can\n"
        'scenario "never Wait fails before DetectCup succeeds"\n'
        "    given Ready answers true\n"
        "    given DetectCup fails\n"
        "    given Wait fails\n"
        "    expect Wait starts at least 1 per run\n"
    )


def test_a_clause_that_can_be_violated_is_a_scenario_that_verifies_it(explore: Exploring) -> None:
    explore.mission(MISSION.replace('            ScriptCondition (code = "cup > 3")\n', ""))
    assert explore("-o", "case.btq")[0] == 1
    assert (explore.folder / "case.btq").read_text(encoding="utf-8") == (
        'include "mission.btq"\n'
        "\n"
        'scenario "calm is violated" verifies calm\n'
        "    given Ready answers true\n"
        "    given DetectCup succeeds\n"
        "    given Grasp fails\n"
        "    expect calm\n"
    )
    assert run_btq("test", "case.btq", cwd=explore.folder)[0] == 1


def test_a_run_without_an_end(explore: Exploring) -> None:
    explore.tree("<KeepRunningUntilFailure><A/></KeepRunningUntilFailure>")
    assert explore("--can", "mission does not end", "-o", "case.btq")[0] == 0
    assert run_btq("test", "case.btq", cwd=explore.folder)[0] == 0
    assert explore("--never", "mission does not end", "-o", "case.btq")[0] == 1
    assert run_btq("test", "case.btq", cwd=explore.folder)[0] == 1


def test_nothing_is_written_where_nothing_happens(explore: Exploring) -> None:
    explore.tree("<Sequence><A/></Sequence>")
    code, _, err = explore("--can", "mission fails before A fails", "-o", "case.btq")
    assert (code, err) == (1, "btq explore: there is no run to write to case.btq\n")
    assert not (explore.folder / "case.btq").exists()


def test_a_run_as_a_drawing_and_as_a_log(explore: Exploring) -> None:
    explore.mission(
        MISSION
        + "        SubTree Charge\n\nBehaviorTree Charge\n    Retry (num_attempts = 2)\n        Dock\n\nAction Dock\n"
    )
    code, out, err = explore("--can", "Dock fails after Grasp succeeds", "--show", "-o", "run.btlog")
    assert (code, err) == (0, "")
    drawn_run = out.partition("\n\n")[2].splitlines()
    assert drawn_run[0] == "can Dock fails after Grasp succeeds"
    assert drawn_run[2:] == [
        "  ReactiveSequence         |F                                       | failed",
        "    Ready                  |S                                       | succeeded 2",
        "    Sequence               |S                                       | succeeded 2",
        "      Fallback             |S                                       | succeeded 2",
        "        DetectCup          |S                                       | succeeded 2",
        "      ScriptCondition      |S                                       | succeeded 2",
        "      Grasp                |S                                       | succeeded 2",
        "    Charge                 |F                                       | failed",
        "      RetryUntilSuccessful |F                                       | failed",
        "        Dock               |F                                       | failed 2",
    ]
    code, out, err = run_btq("verify", "run.btlog", "--mission", "mission.btq", cwd=explore.folder)
    assert (code, err) == (0, "")
    assert "(as built now, 11 of 11 nodes)" in out
    assert "satisfied        calm  Grasp succeeds" in out
    assert logged(explore.folder / "run.btlog")[2][:3] == [(0, 1, 1), (0, 2, 2), (0, 3, 1)]


def test_a_log_has_one_run(explore: Exploring) -> None:
    explore.mission(MISSION)
    code, _, err = explore("--can", "mission fails", "--can", "mission succeeds", "-o", "run.btlog")
    assert (code, err) == (2, "btq explore: -o run.btlog takes one run, and there are 2; ask one question\n")
    code, _, err = explore("--show", "--format", "json")
    assert (code, err) == (2, "btq explore: --show draws runs as text, and --format json has none\n")


@pytest.mark.parametrize(
    ("driver", "fails_after"),
    [("tick_while_running", 205), ("tick_once", 300), ("tick_exactly_once", 300)],
)
def test_the_program_ticks_as_the_project_says(explore: Exploring, driver: str, fails_after: int) -> None:
    (explore.folder / "btq.toml").write_text(f'[simulate]\ndriver = {{ {driver} = "100 ms" }}\n', encoding="utf-8")
    late = '<Timeout msec="205"><ForceSuccess><Wait/></ForceSuccess></Timeout>'
    explore.tree(f'<Parallel success_count="1" failure_count="2">{late}<Other/></Parallel>')
    explore("--can", "Other succeeds after Timeout fails", "-o", "case.btq")
    assert f"    given Other succeeds after {fails_after} ms\n" in (explore.folder / "case.btq").read_text("utf-8")
    _, out, _ = run_btq("test", "case.btq", cwd=explore.folder)
    assert f": succeeds after {fails_after} ms\n" in out
