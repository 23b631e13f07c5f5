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
            (
                "its first child is the condition, a node of its own",
                'write `<ScriptCondition code="x"/>` as its first child',
            ),
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
    assert [fix.title for fix in found.fixes] == ["Write `30000`, which is 30 s"]
    assert apply({PATH: text}, PATH, found.fixes[0]) == {PATH: text.replace("30s", "30000")}


CHECK_OF_3 = 'BlackboardCheck{} value_A="{{a}}" value_B="{}" return_on_mismatch="{}"'


@pytest.mark.parametrize(
    ("kind", "value", "mismatch", "script"),
    [
        ("Int", "1", "FAILURE", "a == 1"),
        ("Double", "0.5", "SUCCESS", "a == 0.5"),
        ("Bool", "true", "FAILURE", "a == true"),
        ("String", "home", "SKIPPED", "a == 'home'"),
        ("String", "{b}", "FAILURE", "a == b"),
    ],
)
def test_a_check_of_version_3(kind: str, value: str, mismatch: str, script: str) -> None:
    tag = CHECK_OF_3.format(kind, value, mismatch)
    (found,) = check(workspace_of({PATH: xml(f"<{tag}><Go/></BlackboardCheck{kind}>")}), PATH)
    assert found.notes[1] == f'write `<Precondition if="{script}" else="{mismatch}">`'


@pytest.mark.parametrize(
    ("node", "rule", "note"),
    [
        (
            '<If condition="a == 1"><Go/></If>',
            "not-an-engine-node",
            'write `<ScriptCondition code="a == 1"/>` as its first child',
        ),
        (
            '<While cond="{a}"><Go/></While>',
            "not-an-engine-node",
            'write `<ScriptCondition code="a"/>` as its first child',
        ),
        (
            '<IfThenElse condition="a"><Go/><Go/></IfThenElse>',
            "unknown-port",
            "its first child is the condition, such as a ScriptCondition",
        ),
        (
            '<Switch2 variable="{a}" case_1="1" case_2="2"><Go/><Go/></Switch2>',
            "child-count",
            "its last child is the default: add one, such as an AlwaysFailure",
        ),
        ("<Script>a := 1</Script>", "xml-ignored", 'a script goes in a port: <Script code="a := 1"/>'),
    ],
)
def test_conditions_and_scripts_in_other_places(node: str, rule: str, note: str) -> None:
    found = [each for each in check(workspace_of({PATH: xml(node)}), PATH) if each.rule == rule]
    assert [each.notes[-1] for each in found] == [note]


@pytest.mark.parametrize(
    ("node", "message"),
    [
        ('<Script code="a := "b""/>', "the value before `b` ends at its second quote"),
        ('<Script code="a := "5""/>', "the value before `5` ends at its second quote"),
        ('<Go _skipIf="a == "home""/>', "the value before `home` ends at its second quote"),
    ],
)
def test_quotes_in_quotes(node: str, message: str) -> None:
    (found,) = check(workspace_of({PATH: xml(node)}), PATH)
    assert (found.message, found.notes) == (message, ("write a quote in a value as &quot;, in a script as '",))


@pytest.mark.parametrize(("tag", "meant"), [("out_port", "output_port"), ("in_port", "input_port")])
def test_ports_by_short_names(tag: str, meant: str) -> None:
    model = f'<TreeNodesModel><Action ID="Go"><{tag} name="a"/></Action></TreeNodesModel>'
    text = xml("<Go/>").replace("</root>", f"{model}</root>")
    (found,) = check(workspace_of({PATH: text}), PATH)
    assert found.message.endswith(f'did you mean `<{meant} name="a"/>`?')


@pytest.mark.parametrize("node", ['<Go _skipIf="a == 1"/>', '<Sequence><Script code="a := 1"/><Go/></Sequence>'])
def test_a_wrong_declaration_of_the_version(node: str) -> None:
    text = xml(node).replace('"4"', '"3"', 1)
    (found,) = check(workspace_of({PATH: text}), PATH)
    assert (found.rule, found.message, found.notes) == (
        "version-4-file",
        "this file is for version 4 of the engine, but declares version 3",
        ('write `BTCPP_format="4"`',),
    )
