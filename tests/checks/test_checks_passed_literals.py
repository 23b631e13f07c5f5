"""Texts that SubTrees pass to ports without a type, and that a node below cannot read."""

from __future__ import annotations

from pathlib import Path

import pytest
from check_asserts import assert_clean, assert_problems, findings, problems
from in_process import run_btq

MODELS = "Action Read\n    input v : {}\nAction Write\n    output v : {}\nAction Take\n    input v : string\n"
TREE = "Root Main\nBehaviorTree Main\n    SubTree Low (v = {})\nBehaviorTree Low\n    input v\n"


def mission(value: str, *below: str, type_: str = "int", low: str = TREE) -> str:
    lines = "".join(f"        {line}\n" for line in below or ("Read (v = {v})",))
    return f"{low.replace('{}', value)}    ->\n{lines}{MODELS.format(type_, type_)}"


@pytest.mark.parametrize(
    ("type_", "value", "expected"),
    [
        ("int", '"80%"', "an integer"),
        ("int", "much", "an integer"),
        ("double", '"2.5 l/min"', "a number"),
        ("bool", "yes", "true, false, 1 or 0"),
    ],
)
def test_a_text_that_the_node_below_cannot_read(type_: str, value: str, expected: str) -> None:
    text = mission(value, type_=type_)
    (found,) = problems(text, "invalid-literal")
    plain = value.strip('"')
    assert_problems(
        text, f"3:22 warning invalid-literal «{value}» expected {expected} for `v` of `Read`, found `{plain}`"
    )
    assert [related.message for related in found.related] == [f"read here as {type_}"]


def test_through_another_tree() -> None:
    text = mission("much", "SubTree Lower (w = {v})") + "BehaviorTree Lower\n    input w\n    Read (v = {w})\n"
    assert_problems(text, "3:22 warning invalid-literal «much» expected an integer for `v` of `Read`, found `much`")


@pytest.mark.parametrize(
    ("value", "below"),
    [
        ("80", ("Read (v = {v})",)),
        ('"80 "', ("Read (v = {v})",)),  # a text which the node reads as the number
        ("{@level}", ("Read (v = {v})",)),
        ("much", ("Take (v = {v})",)),
        ("much", ("Take (v = {v})", "Read (v = {v})")),  # of two types
        ("much", ("Write (v = {v})", "Read (v = {v})")),  # written before it is read
        ("much", ("Own (v = {v})",)),  # whose type is unknown
    ],
)
def test_what_the_nodes_below_may_read(value: str, below: tuple[str, ...]) -> None:
    assert findings(mission(value, *below), "invalid-literal") == []


def test_other_types_accept_any_text() -> None:
    assert_clean(mission('"1;2;0"', type_="Pose2D"))


def test_a_port_with_a_type_is_reported_for_its_own_type() -> None:
    text = mission("much").replace("input v\n    ->", "input v : int\n    ->")
    assert findings(text, "invalid-literal") == ["3 warning «much» expected an integer for `v`, found `much`"]


def test_in_xml(tmp_path: Path) -> None:
    xml = (
        '<root BTCPP_format="4" main_tree_to_execute="M">\n<BehaviorTree ID="M"><SubTree ID="S" level="80%"/>'
        '</BehaviorTree>\n<BehaviorTree ID="S"><Charge level="{level}"/></BehaviorTree>\n<TreeNodesModel>'
        '<Action ID="Charge"><input_port name="level" type="int"/></Action></TreeNodesModel></root>\n'
    )
    (tmp_path / "a.xml").write_text(xml)
    code, out, _ = run_btq("check", "--output-format", "concise", "a.xml", cwd=tmp_path)
    assert (code, out.splitlines()[0]) == (
        1,
        "a.xml:2:45: warning[invalid-literal] expected an integer for `level` of `Charge`, found `80%`",
    )
