"""Trees of Nav2 as scenarios: its control nodes run, and the engine is that of the distribution."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq
from nav2_scenarios import ran

TREE = """\
<root {version}main_tree_to_execute="Navigate">
  <BehaviorTree ID="Navigate">
    <RecoveryNode number_of_retries="2" name="Recover">
      <PipelineSequence>
        <RateController hz="1.0">
          <ComputePathToPose goal="{{goal}}" path="{{path}}"/>
        </RateController>
        <FollowPath path="{{path}}"/>
      </PipelineSequence>
      <{sequence}>
        <Spin/>
        <Wait/>
      </{sequence}>
    </RecoveryNode>
  </BehaviorTree>
</root>
"""
CASES = """\
include "navigate.xml"

scenario "The controller fails once"
    given FollowPath fails after 2.5 s once, then succeeds after 4 s
    given Spin takes 3 s
    given Wait takes 1 s
    expect mission succeeds
    expect mission takes between 10.5 s and 10.6 s
    expect Spin tries at most 1

scenario "The path is computed each second"
    given FollowPath takes 3.5 s
    expect ComputePathToPose tries between 4 and 4

scenario "The controller fails again and again"
    given FollowPath fails after 1 s
    expect mission fails
"""


@pytest.mark.parametrize(
    ("nodes", "version", "sequence"),
    [
        ("humble", "", "SequenceStar"),
        ("jazzy", 'BTCPP_format="4" ', "SequenceWithMemory"),
        ("", 'BTCPP_format="4" ', "SequenceWithMemory"),
    ],
)
def test_recoveries(nodes: str, version: str, sequence: str, tmp_path: Path) -> None:
    if nodes:
        (tmp_path / "btq.toml").write_text(f'nodes = ["nav2-{nodes}"]\n', encoding="utf-8")
    (tmp_path / "navigate.xml").write_text(TREE.format(version=version, sequence=sequence), encoding="utf-8")
    (tmp_path / "cases.btq").write_text(CASES, encoding="utf-8")
    code, out, err = run_btq("test", "cases.btq", cwd=tmp_path)
    assert (code, err) == (0, ""), out


PASSED = ("passed", "succeeds", "")
THROTTLED = (
    '<PipelineSequence><{0}><ComputePathToPose path="{{path}}"/></{0}><FollowPath path="{{path}}"/></PipelineSequence>'
)


@pytest.mark.parametrize("nodes", ["humble", "iron", "jazzy", "lyrical"])
@pytest.mark.parametrize("node", ["DistanceController", "SpeedController"])
def test_what_a_controller_finds_must_be_given(tmp_path: Path, node: str, nodes: str) -> None:
    tree = THROTTLED.format(node)
    once, twice = (
        ("given FollowPath takes 1 s", f"expect ComputePathToPose tries between {count} and {count}")
        for count in (1, 2)
    )
    why = f"{node}::2 was asked at 0.01 s; say what it answers"
    assert ran(tmp_path, tree, *once, nodes=nodes) == ("error", "", why)
    assert ran(tmp_path, tree, f"given {node} answers false", *once, nodes=nodes) == PASSED
    assert ran(tmp_path, tree, f"given {node} answers false, true, false", *twice, nodes=nodes) == PASSED
    later = f"given {node} answers false", f"when 500 ms have passed: {node} answers true, false"
    assert ran(tmp_path, tree, *later, *twice, nodes=nodes) == PASSED


NOTICING = "<WhileDoElse><{}/><Wait/><Spin/></WhileDoElse>"


@pytest.mark.parametrize(
    ("node", "ends"),
    [  # what it is told counts from its second tick on
        ("GoalUpdated answers true", "10 ms"),
        ("DistanceTraveled answers true", "10 ms"),
        ("TimeExpired answers true", "10 ms"),
        ("PathExpiringTimer answers true", "10 ms"),
        ("GlobalUpdatedGoal answers false", "0 s"),
    ],
)
def test_a_condition_that_notices(tmp_path: Path, node: str, ends: str) -> None:
    given, node = f"given {node}", node.split()[0]
    steps = "given Spin takes 1 s", given, f"expect mission takes between {ends} and {ends}"
    assert ran(tmp_path, NOTICING.format(node), *steps) == PASSED


def test_goals_of_the_navigator_stay(tmp_path: Path) -> None:
    steps = "given Spin takes 1 s", "expect never node Wait"
    assert ran(tmp_path, NOTICING.format("GoalUpdated"), *steps) == PASSED


def test_goals_that_a_node_writes_are_unknown(tmp_path: Path) -> None:
    asked = "<WhileDoElse><GoalUpdated/><Wait/><Spin/></WhileDoElse>"
    removed = '<RemovePassedGoals input_goals="{goals}" output_goals="{goals}"/>'
    updater = f'<RateController hz="5">{removed}</RateController>'
    tree = f"<PipelineSequence>{updater}{asked}</PipelineSequence>"
    steps = "given Spin takes 1 s", "expect never node Wait"
    why = (
        "GoalUpdated::5 reads {goals}, and nothing says what RemovePassedGoals::3 writes into {goals}; "
        "write `given RemovePassedGoals succeeds and writes output_goals = …`"
    )
    assert ran(tmp_path, tree, *steps) == ("unknown", "", why)
    assert ran(tmp_path, tree, "given GoalUpdated answers false", *steps) == PASSED


def test_a_path_that_became_longer(tmp_path: Path) -> None:
    longer = '<PathLongerOnApproach path="{path}"><Wait/></PathLongerOnApproach>'
    tree = f'<PipelineSequence><ComputePathToPose path="{{path}}"/>{longer}<Spin/></PipelineSequence>'
    why = (
        "PathLongerOnApproach::3 reads {path}, and nothing says what ComputePathToPose::2 writes into {path}; "
        "write `given ComputePathToPose succeeds and writes path = …`"
    )
    assert ran(tmp_path, tree, "expect mission succeeds") == ("unknown", "", why)
    for answer, expected in (("true", "Wait finishes at least 1 per run"), ("false", "never node Wait")):
        steps = f"given PathLongerOnApproach answers {answer}", "given Spin takes 1 s", f"expect {expected}"
        assert ran(tmp_path, tree, *steps) == PASSED


@pytest.mark.parametrize("nodes", ["humble", "iron", "jazzy", "kilted", "lyrical"])
def test_an_updated_goal(tmp_path: Path, nodes: str) -> None:
    node = (
        '<GoalUpdater input_goal="{goal}" output_goal="{updated}"><ComputePathToPose goal="{updated}"/></GoalUpdater>'
    )
    given, runs = "given {goal} = 1", "expect ComputePathToPose (goal) runs"
    why = (
        "ComputePathToPose::2 reads its port `goal`, and nothing says what GoalUpdater::1 writes into {updated}; "
        "write `given GoalUpdater answers true and writes output_goal = …`"
    )
    assert ran(tmp_path, node, given, f"{runs} 1", nodes=nodes) == ("unknown", "succeeds", why)
    assert ran(tmp_path, node, given, "given GoalUpdater answers false", f"{runs} 1", nodes=nodes) == PASSED
    newer = "given GoalUpdater answers true and writes output_goal = 2"
    assert ran(tmp_path, node, given, newer, f"{runs} 2", nodes=nodes) == PASSED


def test_a_node_that_is_asked_nothing(tmp_path: Path) -> None:
    why = "line 4: `RateController` is not a condition: it succeeds or fails, and answers nothing"
    steps = "given RateController answers true", "expect mission succeeds"
    assert ran(tmp_path, THROTTLED.format("RateController"), *steps) == ("error", "", why)


@pytest.mark.parametrize("nodes", ["humble", "iron", "jazzy", "lyrical"])
def test_values_that_stand_for_messages(tmp_path: Path, nodes: str) -> None:
    computed = '<RateController hz="10"><ComputePathToPose goal="{goal}" path="{path}"/></RateController>'
    longer = '<PathLongerOnApproach path="{path}" prox_len="5" length_factor="2"><Wait/></PathLongerOnApproach>'
    tree = f"<PipelineSequence>{computed}{longer}<Spin/></PipelineSequence>"
    paths = (f'succeeds {times}and writes path = "{path}"' for times, path in (("once ", "5;2;2;0"), ("", "9;5;2;0")))
    steps = f"given ComputePathToPose {', then '.join(paths)}", "given Spin takes 1 s"
    assert ran(tmp_path, tree, *steps, "expect Wait finishes at least 1 per run", nodes=nodes) == PASSED
    later = "given Spin takes 1 s", "when 500 ms have passed: {goal} = 2", "expect finally {goal} == 2"
    assert ran(tmp_path, tree, "given PathLongerOnApproach answers false", *later, nodes=nodes) == PASSED
