"""Entries with two types: as the engines say it, see `engine/test_engine_entry_types.py` for the same cases there."""

from __future__ import annotations

import pytest
from check_asserts import apply, findings, problems, workspace_of
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


PLANNER = (
    '<TreeNodesModel><Action ID="Plan"><input_port name="goal" type="geometry_msgs::msg::PoseStamped"/>'
    '<output_port name="path" type="nav_msgs::msg::Path"/></Action>'
    '<Action ID="Follow"><input_port name="path" type="{}"/></Action></TreeNodesModel>'
)


@pytest.mark.parametrize(
    ("type_", "more", "severity", "meant"),
    [
        ("nav_msgs::msg::Path", "", "error", "{path}"),
        ("nav_msgs::msg::Path", '<Follow path="{path}"/>', "error", None),  # it is read elsewhere
        ("nav_msgs::msg::Path", '<Plan goal="{goal}" path="{other}"/>', "error", None),  # two may be meant
        ("my::Path", "", "warning", None),
        ("int", "", "warning", None),
    ],
)
def test_an_entry_of_the_type_that_is_read_nowhere(type_: str, more: str, severity: str, meant: str | None) -> None:
    nodes = f'<Sequence><Plan goal="{{goal}}" path="{{path}}"/><Follow path="{{goal}}"/>{more}</Sequence>'
    tree = f'<BehaviorTree ID="Main">{nodes}</BehaviorTree>'
    text = f'<root BTCPP_format="4" main_tree_to_execute="Main">{tree}{PLANNER.format(type_)}</root>'
    found = [each for each in check(workspace_of({"a.xml": text}), "a.xml") if each.rule == "entry-with-two-types"]
    assert found[0].effective_severity.value == severity
    assert found[0].message.endswith(f"; did you mean `{meant}`?" if meant else f"has the type {type_}")
    unless = ", unless one of the types is an alias for the other" if severity == "warning" else ""
    advice = "" if meant else "; use an entry for each type, and copy the value in a script: `other := entry`"
    assert found[0].notes == (f"BehaviorTree.CPP refuses to load this tree{unless}{advice}",)
    fixed = [apply({"a.xml": text}, "a.xml", fix)["a.xml"] for fix in found[0].fixes]
    assert fixed == ([text.replace('Follow path="{goal}"', f'Follow path="{meant}"')] if meant else [])
