"""Entries with two types: as the engines say it, see `engine/test_engine_entry_types.py` for the same cases there."""

from __future__ import annotations

import pytest
from check_asserts import findings, problems, workspace_of
from mixed_types import CASES, MODELS, mission

from btq_lang.checks import check

RULE = "entry-with-two-types"


@pytest.mark.parametrize("case", CASES)
def test_two_types_meet(case: str) -> None:
    lines, meet = CASES[case]
    found = problems(mission(lines), RULE)
    assert len(found) == meet, found


def test_a_mission_says_where_and_why() -> None:
    text = mission("Count (n = {k})\n SubTree S (v = {k})\nBehaviorTree S\n Drive (speed = {v})")
    assert findings(text, RULE) == [
        "19 error «{k}» `n` of `Count` creates `{k}` as int, but `speed` of `Drive` has the type double"
    ]


@pytest.mark.parametrize(
    ("one", "other", "severity"),
    [
        ("Pose", "Path", "warning"),
        ("Pose", "int", "warning"),
        ("Pose", "geometry_msgs::msg::Pose", None),
        ("std::vector<Pose>", "Path", None),
        ("std::vector<double>", "std::vector<double, std::allocator<double> >", None),
        ("std::vector<double>", "std::vector<int>", "error"),
        ("int", "string", "error"),
        ("", "int", None),
    ],
)
def test_types_of_ones_own_may_be_other_words_for_one(one: str, other: str, severity: str | None) -> None:
    text = f"""
<root BTCPP_format="4">
  <BehaviorTree ID="Main"><Sequence><A p="{{k}}"/><B p="{{k}}"/></Sequence></BehaviorTree>
  <TreeNodesModel>
    <Action ID="A"><output_port name="p" type="{one.replace("<", "&lt;")}"/></Action>
    <Action ID="B"><input_port name="p" type="{other.replace("<", "&lt;")}"/></Action>
  </TreeNodesModel>
</root>"""
    workspace = workspace_of({"main.xml": text.strip()})
    found = [each for each in check(workspace, "main.xml") if each.rule == RULE]
    assert [each.effective_severity.value for each in found] == ([severity] if severity else [])


def test_trees_that_run_each_other_or_many_others_are_no_trouble() -> None:
    circle = "BehaviorTree A\n SubTree B (k = {k})\nBehaviorTree B\n SubTree A (k = {k})\n"
    assert problems(circle, RULE) == []
    chain = "".join(
        f"BehaviorTree T{i}\n ->\n  SubTree T{i + 1} (k = {{k}})\n  SubTree T{i + 1} (k = {{k}})\n" for i in range(2000)
    )
    end = "BehaviorTree T2000\n Count (n = {k})\n"
    assert problems(f"{MODELS}Root T0\n{chain}{end}", RULE) == []
