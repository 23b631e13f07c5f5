"""Slips in XML, which messages mend in the words of XML."""

from __future__ import annotations

import pytest
from check_asserts import apply, workspace_of

from btq_lang.checks import check

PATH = "main.xml"


def xml(node: str, *others: str) -> str:
    trees = "".join(f'<BehaviorTree ID="{name}"><Go/></BehaviorTree>' for name in others)
    return f'<root BTCPP_format="4"><BehaviorTree ID="Main">{node}</BehaviorTree>{trees}</root>'


@pytest.mark.parametrize(
    ("node", "rule", "message"),
    [
        ('<SubTree name="Drive"/>', "unknown-tree", 'missing tree of this SubTree: write `ID="Drive"`'),
        ('<SubTree id="Drive" x="1"/>', "unknown-tree", 'missing tree of this SubTree: write `ID="Drive"`'),
        ('<SubTree tree="Drive"/>', "unknown-tree", 'missing tree of this SubTree: write `ID="Drive"`'),
        ("<SubTree/>", "unknown-tree", 'missing tree of this SubTree: write `ID="…"`'),
        ('<Action name="Go"/>', "unknown-node", 'missing ID of this Action: write `ID="Go"`'),
        ("<Condition/>", "unknown-node", 'missing ID of this Condition: write `ID="…"`'),
    ],
)
def test_an_id_is_missing(node: str, rule: str, message: str) -> None:
    found = check(workspace_of({PATH: xml(node, "Drive")}), PATH)
    assert [(each.rule, each.message) for each in found if each.rule != "unknown-main-tree"] == [(rule, message)]
    reports_main = any(each.rule == "unknown-main-tree" for each in found)
    assert reports_main is ("SubTree" not in node)  # else the tree that it runs is unknown


def test_a_tree_without_an_id() -> None:
    text = xml("<Go/>").replace("</root>", '<BehaviorTree name="Drive"><Go/></BehaviorTree></root>')
    (found,) = check(workspace_of({PATH: text}), PATH)
    assert (found.rule, found.message) == ("forbidden-name", 'missing ID of this tree: write `ID="Drive"`')


@pytest.mark.parametrize(
    ("tag", "attributes", "meant"),
    [
        ("Retry", ' num_attempts="3"', "RetryUntilSuccessful"),
        ("Loop", ' num_cycles="3"', "Repeat"),
        ("Loop", ' queue="{q}" value="{v}"', "LoopDouble"),
        ("Switch", ' variable="{v}" case_1="1" case_2="2"', "Switch2"),
    ],
)
def test_a_word_of_this_language(tag: str, attributes: str, meant: str) -> None:
    text = xml(f"<{tag}{attributes}>{'<Go/>' * (3 if tag == 'Switch' else 1)}</{tag}>")
    (found,) = check(workspace_of({PATH: text}), PATH)
    says = f"`{tag}` is not built into BehaviorTree.CPP 4.6–4.10; did you mean `{meant}`?"
    assert (found.rule, found.message, found.notes) == ("not-an-engine-node", says, ())
    fixed = apply({PATH: text}, PATH, found.fixes[0])
    assert fixed == {PATH: text.replace(f"<{tag}", f"<{meant}").replace(f"</{tag}", f"</{meant}")}
    assert check(workspace_of(fixed), PATH) == ()


@pytest.mark.parametrize(
    ("text", "rule", "message", "notes"),
    [
        (
            xml("<Go/>").replace("<root", '<root main_tree="Main"'),
            "xml-ignored",
            "the engine ignores `main_tree`; did you mean `main_tree_to_execute`?",
            (),
        ),
        (
            xml("<Go/>").replace("BTCPP_format", "format"),
            "xml-ignored",
            "the engine ignores `format`; did you mean `BTCPP_format`?",
            (),
        ),
        (
            xml('<include path="a.xml"/>'),
            "unknown-node",
            "an include goes directly below <root>: <include path=…/>",
            (),
        ),
        (
            xml("<Sequence><Go/><-- to it --></Sequence>"),
            "xml-syntax",
            "unexpected `<`: no tag begins here",
            ("a comment is written <!-- … -->",),
        ),
        (
            xml('<If condition="x"><Go/><Turn/></If>'),
            "not-an-engine-node",
            "`If` is not built into BehaviorTree.CPP 4.6–4.10; did you mean `IfThenElse`?",
            ("its first child is the condition, a node of its own",),
        ),
        (
            xml('<Sequence memory="true"><Go/></Sequence>'),
            "unknown-port",
            "`Sequence` has no port `memory`",
            (
                "it has no ports",
                "a Sequence or Fallback goes on with the child that is running; "
                "a ReactiveSequence or ReactiveFallback begins with the first one at every tick",
            ),
        ),
    ],
)
def test_a_word_of_another_tool(text: str, rule: str, message: str, notes: tuple[str, ...]) -> None:
    (found,) = check(workspace_of({PATH: text}), PATH)
    assert (found.rule, found.message, found.notes) == (rule, message, notes)


def test_a_time_with_a_unit_is_converted() -> None:
    text = xml('<Timeout msec="30s"><Go/></Timeout>')
    (found,) = check(workspace_of({PATH: text}), PATH)
    assert found.message == "the engine reads `30s` as 30 and silently drops the rest"
    assert [fix.title for fix in found.fixes] == ["Write `30000`, which is 30 s", "Write what the engine reads: `30`"]
    assert apply({PATH: text}, PATH, found.fixes[0]) == {PATH: text.replace("30s", "30000")}
