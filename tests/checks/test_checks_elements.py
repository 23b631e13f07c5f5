"""Models, includes and other elements beside trees: what the engine refuses, and what it drops without a word."""

from __future__ import annotations

from pathlib import Path

import pytest

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

MAIN = '<BehaviorTree ID="Main"><AlwaysSuccess/></BehaviorTree>'
PORT = '<TreeNodesModel><Action ID="A"><input_port name="a" {}="1"/></Action></TreeNodesModel>'


def found(xml: str, *engines: str) -> list[str]:
    """What is found in a file, with the text that it points at."""
    project = Project(engines=engines) if engines else Project()
    diagnostics = check(Workspace({"a.xml": file_of("a.xml", xml)}, project), "a.xml")
    return [
        f"{each.effective_severity.value} {each.rule} «{xml[each.span.start : each.span.end]}» {each.message}"
        for each in diagnostics
    ]


def beside(rest: str, *engines: str) -> list[str]:
    """What is found in what stands beside a tree."""
    return found(f'<root BTCPP_format="4">{MAIN}{rest}</root>', *engines)


def below_models(models: str) -> list[str]:
    return beside(f"<TreeNodesModel>{models}</TreeNodesModel>")


@pytest.mark.parametrize(
    ("element", "severity", "message"),
    [
        ("<treenodesmodel/>", "warning", "the engine ignores <treenodesmodel>; did you mean <TreeNodesModel>?"),
        ("<TreeNodeModels/>", "warning", "the engine ignores <TreeNodeModels>; did you mean <TreeNodesModel>?"),
        ("<BehaviourTree/>", "error", "the engine ignores <BehaviourTree>; did you mean <BehaviorTree>?"),
        (
            '<Behaviortree ID="B"/>',
            "error",
            "the engine ignores <Behaviortree>, and with it the tree `B`; did you mean <BehaviorTree>?",
        ),
        (
            '<Include path="b.xml"/>',
            "error",
            "the engine ignores <Include>, and with it the trees of `b.xml`; did you mean <include>?",
        ),
        ("<Sequence/>", "warning", "the engine ignores <Sequence> directly below <root>"),
        ('<Action ID="A"/>', "warning", "the engine ignores <Action> directly below <root>"),
        ("<Setting/>", "hint", "the engine ignores <Setting> directly below <root>"),
        ("<MetadataFields/>", "", ""),
    ],
)
def test_what_is_ignored_below_the_root(element: str, severity: str, message: str) -> None:
    assert beside(element) == ([f"{severity} xml-ignored «{element}» {message}"] if message else [])


@pytest.mark.parametrize(
    ("model", "severity", "message"),
    [
        ("<Action/>", "warning", "a model without an ID declares nothing"),
        ('<Condition Id="A"/>', "warning", "a model without an ID declares nothing; did you mean `ID`?"),
        ('<Acton ID="A"/>', "warning", "the engine ignores <Acton> in <TreeNodesModel>; did you mean <Action>?"),
        ('<Subtree ID="A"/>', "warning", "the engine ignores <Subtree> in <TreeNodesModel>; did you mean <SubTree>?"),
        ('<input_port name="a"/>', "warning", "the engine ignores <input_port> in <TreeNodesModel>"),
        ('<include path="b.xml"/>', "error", "the engine ignores <include> in <TreeNodesModel>"),
        ('<Undefined ID="A"/>', "hint", "the engine ignores <Undefined> in <TreeNodesModel>"),
        ("<MetadataFields/>", "", ""),
    ],
)
def test_what_is_ignored_in_models(model: str, severity: str, message: str) -> None:
    assert below_models(model) == ([f"{severity} xml-ignored «{model}» {message}"] if message else [])


@pytest.mark.parametrize(
    ("part", "meant"),
    [
        ('<bidirectional_port name="a"/>', '`<inout_port name="a"/>`'),
        ('<Parameter label="a" default="x"/>', '`<input_port name="a"/>`'),
        ('<input_prot name="a"/>', '`<input_port name="a"/>`'),
        ('<InputPort name="a"/>', '`<input_port name="a"/>`'),
        ('<output name="a"/>', '`<output_port name="a"/>`'),
        ("<port/>", "`<input_port>`"),
        ("<Metadata/>", ""),
    ],
)
def test_what_is_ignored_in_a_model(part: str, meant: str) -> None:
    message = f"the engine and its tools ignore <{part[1:-2].split()[0]}> in a model; did you mean {meant}?"
    assert below_models(f'<Action ID="A">{part}</Action>') == (
        [f"warning xml-ignored «{part}» {message}"] if meant else []
    )


@pytest.mark.parametrize(
    ("xml", "key", "meant"),
    [
        (f'<root BTCPP_fromat="4">{MAIN}</root>', "BTCPP_fromat", "BTCPP_format"),
        (f'<root Main_tree_to_execute="Main">{MAIN}</root>', "Main_tree_to_execute", "main_tree_to_execute"),
        (
            f"<root>{MAIN}{PORT.format('Default')}</root>",
            "Default",
            "default",
        ),
        (f'<root BTCPP_format="4" project_name="a" _favorite="b">{MAIN}</root>', "", ""),
        (
            f"<root>{MAIN}{PORT.format('required')}</root>",
            "",
            "",
        ),
    ],
)
def test_misspelt_attributes(xml: str, key: str, meant: str) -> None:
    message = f"warning xml-ignored «{key}» the engine ignores `{key}`; did you mean `{meant}`?"
    assert found(xml) == ([message] if key else [])


def test_what_version_3_does_not_read_it_does_not_refuse() -> None:
    models = '<TreeNodesModel><SubTree/><SubTree ID="Main"><input_port/></SubTree></TreeNodesModel>'
    assert [each.split(" ")[1] for each in beside(models, "4.6")] == ["refused-element"] * 2
    assert beside(models, "3.8") == []
    assert [each.split(" ")[1] for each in beside("<TreeNodesModel/><TreeNodesModel/>", "3.8")] == ["refused-element"]


def test_the_order_of_attributes_means_nothing() -> None:
    """A default before the name is one, and a name that is no word of the language is one that the engine refuses."""
    model = '<SubTree ID="Main"><input_port {}/></SubTree>'
    use = '<BehaviorTree ID="Top"><SubTree ID="Main"/></BehaviorTree>'
    trees = f'<root BTCPP_format="4" main_tree_to_execute="Top">{MAIN}{use}'
    root = f"{trees}<TreeNodesModel>{model}</TreeNodesModel></root>"
    assert found(root.format('default="1" name="a"')) == []
    assert found(root.format('name="1a" default="1"')) == [
        "error forbidden-name «1a» the engine refuses the port name `1a`: it begins with a digit"
    ]
    assert [each.split(" ")[1] for each in found(root.format('default="" name="a"'))] == ["missing-port"]


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        (
            "13-treenodemodel/t.xml",
            ["warning xml-ignored the engine ignores <TreeNodeModel>; did you mean <TreeNodesModel>?"],
        ),
        (
            "23-model-tag/t.xml",
            [
                "warning xml-ignored the engine and its tools ignore <bidirectional_port> in a model; did you mean "
                '`<inout_port name="n"/>`?'
            ],
        ),
        ("34-models/m1.xml", ["warning xml-ignored a model without an ID declares nothing"]),
        ("34-models/m2.xml", ["warning xml-ignored a model without an ID declares nothing; did you mean `ID`?"]),
        ("34-models/m3.xml", ["error refused-element the engine refuses a port without a name in the model of `Main`"]),
        ("34-models/m4.xml", ["error refused-element the engine refuses a second TreeNodesModel in one file"]),
        (
            "34-models/m5.xml",
            ["warning xml-ignored the engine ignores <Acton> in <TreeNodesModel>; did you mean <Action>?"],
        ),
        ("34-models/m7.xml", ["error refused-element the engine refuses the model of a SubTree without an ID"]),
        (
            "34-models/m10.xml",
            [
                "error xml-ignored the engine ignores <behaviortree>, and with it the tree `M2`; did you mean "
                "<BehaviorTree>?"
            ],
        ),
    ],
)
def test_the_shared_files(shared: Path, path: str, expected: list[str]) -> None:
    text = (shared / "field" / "trees" / path).read_text(encoding="utf-8")
    assert [" ".join((*each.split("«")[0].split(), each.split("» ", 1)[1])) for each in found(text)] == expected
