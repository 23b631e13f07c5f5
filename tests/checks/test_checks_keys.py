"""key-in-braces: what its page does not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, workspace_of

from btq_lang.checks import check


def mission(*nodes: str) -> str:
    return "\n        ".join(("BehaviorTree Main\n    ->", *nodes)) + "\n"


@pytest.mark.parametrize(
    ("node", "port", "entry"),
    [
        ("SetBlackboard (output_key = {speed} value = 0.5)", "output_key", "speed"),
        ("SetBlackboard (output_key = {@speed} value = 0.5)", "output_key", "@speed"),
        ("SetBlackboard (value = {other} output_key = {speed})", "output_key", "speed"),
        ("UnsetBlackboard (key = {speed})", "key", "speed"),
        ("UnsetBlackboard (key = {=})", "key", "key"),
    ],
)
def test_a_name_in_braces(node: str, port: str, entry: str) -> None:
    pointer = node.split(f"{port} = ")[1].split("}")[0] + "}"
    column = len("        ") + node.index(f"{port} = ") + len(f"{port} = ") + 1
    message = f"`{pointer}` is the entry whose name `{entry}` holds; write `{port}` without braces"
    text = mission("Action Go (speed = {speed})", node)
    assert_problems(text, f"4:{column} warning key-in-braces «{pointer}» {message}")
    if entry[0] != "@":
        after = text.replace(f"{port} = {pointer}", f"{port} = {entry}")
        assert_fix(text, f"Replace `{pointer}` with `{entry}`", after)


@pytest.mark.parametrize(
    "gives",
    [
        "Script (code = \"speed := 'limit'\")",
        "SetBlackboard (output_key = speed value = limit)",
        "Ask (name_of = {speed})",
    ],
)
def test_an_entry_that_is_given_a_name(gives: str) -> None:
    model = "Action Ask\n    output name_of : string\n"
    assert_clean(model + mission(gives, "SetBlackboard (output_key = {speed} value = 0.5)"))


def test_a_port_may_be_given_a_name() -> None:
    set_it = "SetBlackboard (output_key = {which} value = 0.5)"
    called = f"BehaviorTree Set\n    input which : string\n    {set_it}\n"
    assert_clean(f"Root Main\n{mission('SubTree Set (which = speed)')}{called}")
    assert_clean(f"Root Main\n{mission('SubTree Set (which = speed)')}BehaviorTree Set\n    {set_it}\n")


def test_other_nodes_take_a_name_with_or_without_braces() -> None:
    assert_clean(mission("WaitValueUpdate (entry = {speed})", "    Action Go"))


def test_xml_says_the_same() -> None:
    node = '<SetBlackboard output_key="{speed}" value="0.5"/>'
    xml = f'<root BTCPP_format="4"><BehaviorTree ID="Main">{node}</BehaviorTree></root>'
    (found,) = check(workspace_of({"main.xml": xml}), "main.xml")
    assert found.message == "`{speed}` is the entry whose name `speed` holds; write `output_key` without braces"
    (change,) = found.fixes[0].changes
    assert (xml[change.place.span.start : change.place.span.end], change.text) == ("{speed}", "speed")
