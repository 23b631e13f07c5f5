"""`btq check --target`: what another distribution of Nav2 changes for trees of an earlier one."""

from __future__ import annotations

from pathlib import Path

import pytest
from check_asserts import assert_fixes_mend, assert_sound, show
from in_process import run_btq

from btq_lang.catalog.nav2 import DISTRIBUTIONS, PACKAGED
from btq_lang.catalog.nav2.changes import ANY, CHANGES, Change
from btq_lang.checks import check
from btq_lang.commands.target import with_target
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

# A value that matches the value of a change, and a node that has the port of a change that concerns every node.
SAMPLES = ("-1", "0.5", "{x}", "1;2", "{path}")
WITH_PORT = {
    "service_name": "ClearEntireCostmap",
    "goals": "ComputePathThroughPoses",
    "input_goals": "RemovePassedGoals",
    "error_code_id": "Spin",
    "path": "FollowPath",
}


def moved(text: str, origin: str, target: str) -> list[str]:
    """What is found of the two rules."""
    workspace = Workspace.of({"main.btq": text}, Project(node_files=(PACKAGED[f"nav2-{origin}"],)))
    workspace = with_target(workspace, f"nav2-{target}")
    found = [each for each in check(workspace, "main.btq") if each.rule.startswith("target-")]
    assert_sound(workspace, "main.btq", found)
    assert_fixes_mend(workspace, "main.btq", found)
    return show(text, found)


def tree(*nodes: str) -> str:
    return "BehaviorTree Main\n    ->\n" + "".join(f"        {node}\n" for node in nodes)


def sample(change: Change) -> str:
    node = WITH_PORT[change.port] if change.nodes == (ANY,) else change.nodes[0]
    if not change.port or change.value is None:
        return node
    value = next(each for each in SAMPLES if change.matches(each))
    return f'{node} ({change.port} = "{value}")'


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: f"{change.since}-{change.nodes[0]}-{change.port}")
def test_each_change_is_found_on_the_step_that_brings_it(change: Change) -> None:
    before = DISTRIBUTIONS[DISTRIBUTIONS.index(change.since) - 1]
    said = f"from {change.since.title()} on"
    assert [line for line in moved(tree(sample(change)), before, change.since) if said in line and change.what in line]
    assert moved(tree(sample(change)), before, before) == []


def test_what_a_tree_of_humble_meets_on_the_way_to_lyrical() -> None:
    text = tree(
        "IsPathValid (path = {way})",
        'TruncatePathLocal (input_path = {way} output_path = {part} robot_frame = "base_link")',
        "SubTree Rest (goal = goal)",
    )
    assert moved(f"{text}BehaviorTree Rest\n    Own\n", "humble", "lyrical") == [
        "3:9 error target-breaks «IsPathValid» Nav2 has no `IsPathValid` in Lyrical: it is called `ValidatePath`",
        "3:9 warning target-differs «IsPathValid» from Kilted on `IsPathValid` ends the goal with an exception if "
        "there is no answer in time; before, it failed",
        "3:9 warning target-differs «IsPathValid» from Lyrical on `IsPathValid` takes a cost up to 254 for free "
        "without `max_cost`, no longer up to 253",
        "4:68 error target-breaks «robot_frame» `TruncatePathLocal` has no port `robot_frame` in Lyrical: it is called "
        "`robot_base_frame`",
        "5:17 error target-breaks «Rest» from Jazzy on a SubTree has a blackboard of its own: Nav2's nodes in it "
        "lack the entry `node`",
        "5:30 warning target-differs «goal» from Jazzy on `goal` is a text that the SubTree gets, no longer the name "
        "of an entry",
    ]


def test_a_node_that_comes_back_is_missed_only_between() -> None:
    text = tree("ClearCostmapAroundPose (service_name = clear)")
    assert moved(text, "jazzy", "kilted") == [
        "3:9 error target-breaks «ClearCostmapAroundPose» Nav2 has no `ClearCostmapAroundPose` in Kilted"
    ]
    assert [line for line in moved(text, "jazzy", "lyrical") if "breaks" in line] == []


def test_on_the_way_back_only_what_is_not_there_counts() -> None:
    assert moved(tree("RoundRobin (wrap_around = true)", "    AlwaysSuccess"), "lyrical", "kilted") == [
        "3:21 error target-breaks «wrap_around» `RoundRobin` has no port `wrap_around` in Kilted"
    ]


def test_an_include_of_humble_is_looked_for_elsewhere() -> None:
    text = f'include "more.btq"\n{tree("Own")}'
    assert moved(text, "humble", "iron") == [
        '1:9 warning target-differs «"more.btq"» from Iron on the path counts from the file that includes it, not '
        "from bt_navigator's working folder"
    ]
    assert moved(text, "iron", "lyrical") == []


def test_the_command(tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('nodes = ["nav2-kilted"]\n')
    (tmp_path / "tree.xml").write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="Main"><RoundRobin><IsStuck/></RoundRobin></BehaviorTree></root>\n'
    )
    code, out, _ = run_btq("check", "--target", "nav2-lyrical", "--output-format", "concise", cwd=tmp_path)
    assert (code, out) == (
        1,
        "tree.xml:1:49: warning[target-differs] from Lyrical on `RoundRobin` does not begin again after its last "
        "child: it then fails, even if that child has succeeded\nFound 1 warning\n",
    )
    assert run_btq("check", cwd=tmp_path)[0] == 0
    (tmp_path / "btq.toml").write_text("")
    code, _, err = run_btq("check", "--target", "nav2-lyrical", cwd=tmp_path)
    assert (code, err) == (
        2,
        'btq check: --target needs to know what the trees are for: write `nodes = ["nav2-jazzy"]` into btq.toml\n',
    )
