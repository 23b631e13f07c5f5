"""Entries with two types: as the engines say it, see `engine/test_engine_entry_types.py` for the same cases there."""

from __future__ import annotations

import pytest
from check_asserts import findings, problems, workspace_of

from btq_lang.checks import check

RULE = "entry-with-two-types"

MODELS = """
Action Count
    output n : int
Action Count32
    input n : int32_t
Action Drive
    input speed : double
Action Say
    input text : string
Action Any
    inout value
Action Both
    input n : int
    input text : string
"""

# The lines of trees, and whether two types meet in them.
CASES = {
    "another type": ("Count (n = {k})\n Drive (speed = {k})", True),
    "a text later": ("Count (n = {k})\n Say (text = {k})", True),
    "a text first": ("Say (text = {k})\n Drive (speed = {k})\n Count (n = {k})", False),
    "the same type by another name": ("Count (n = {k})\n Count32 (n = {k})", False),
    "the engine's own nodes": ("Repeat (num_cycles = {k})\n  Sleep (msec = {k})", True),
    "a port that takes anything first": ("Any (value = {k})\n Count (n = {k})\n Drive (speed = {k})", False),
    "the node of nobody's model first": ("Act (value = {k})\n Count (n = {k})\n Drive (speed = {k})", False),
    "two ports of one node, one of text": ("Both (n = {k} text = {k})\n Drive (speed = {k})", False),
    "an entry of the same name": ("Count (n = {n})\n Drive (speed = {k})", False),
    "the port's own name": ("Count (n = {=})\n Drive (speed = {n})", True),
    "a tree below": ("Count (n = {k})\n SubTree S (v = {k})\nBehaviorTree S\n Drive (speed = {v})", True),
    "two trees below": (
        "SubTree S (v = {k})\n SubTree T (v = {k})\n"
        "BehaviorTree S\n Drive (speed = {v})\nBehaviorTree T\n Count (n = {v})",
        True,
    ),
    "not handed on": ("Count (n = {k})\n SubTree S\nBehaviorTree S\n Drive (speed = {k})", False),
    "handed on by the same name": (
        "Count (n = {k})\n SubTree S (_autoremap = true)\nBehaviorTree S\n Drive (speed = {k})",
        True,
    ),
    "a private entry is not handed on": (
        "Count (n = {_k})\n SubTree S (_autoremap = true)\nBehaviorTree S\n Drive (speed = {_k})",
        False,
    ),
    "in a tree whose entry was a text before": (
        "Say (text = {k})\n SubTree S (v = {k})\nBehaviorTree S\n ->\n  Count (n = {v})\n  Drive (speed = {v})",
        False,
    ),
    "in a tree whose entry is new": (
        "Say (text = {t})\n SubTree S (v = {k})\nBehaviorTree S\n ->\n  Count (n = {v})\n  Drive (speed = {v})",
        True,
    ),
    "in a tree that gets a text": (
        'Say (text = {t})\n SubTree S (v = "x")\nBehaviorTree S\n ->\n  Count (n = {v})\n  Drive (speed = {v})',
        False,
    ),
    "the root's entry": ("Count (n = {k})\n SubTree S\nBehaviorTree S\n Drive (speed = {@k})", True),
    "the root's entry in two trees": (
        "SubTree S\n SubTree T\nBehaviorTree S\n Drive (speed = {@k})\nBehaviorTree T\n Count (n = {@k})",
        True,
    ),
}


def mission(lines: str) -> str:
    return f"{MODELS}Root Main\nBehaviorTree Main\n ->\n  {lines.replace(chr(10) + ' ', chr(10) + '  ')}\n"


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
