"""Faults that people have reported, each in the smallest file: what is found, and what to write instead."""

from __future__ import annotations

import re
from pathlib import Path
from shutil import copy, copytree

import pytest
from in_process import run_btq

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.engine_changes import ENGINE_CHANGES
from btq_lang.catalog.nav2.changes import CHANGES
from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.util.text import Edit, apply_edits
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace


def of_xml(xml: str, *engines: str) -> tuple[Diagnostic, ...]:
    project = Project(engines=engines) if engines else Project()
    return check(Workspace({"a.xml": file_of("a.xml", xml)}, project), "a.xml")


def of_node(node: str, *engines: str) -> list[str]:
    """What is found in a node."""
    xml = f'<root BTCPP_format="4"><BehaviorTree ID="Main">{node}</BehaviorTree></root>'
    return [f"{each.effective_severity.value} {each.rule} {each.message}" for each in of_xml(xml, *engines)]


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("04-json-in-braces/t.xml", ["4 warning json-in-braces", "5 warning json-in-braces"]),
        (
            "07-onlyif/t.xml",
            [
                "4 warning unknown-attribute",
                "5 hint one-shot-monitor",
                "5 warning one-shot-monitor",
                "6 warning unknown-attribute",
            ],
        ),
        ("14-root-node/t.xml", ["5 error forbidden-name"]),
        (
            "21-switch-variable/t.xml",
            [
                "5 warning switch-cases",
                "10 warning switch-cases",
                *(f"{line} hint duplicate-instance-name" for line in (11, 12, 13)),
                "15 error child-count",
                *(f"{line} hint duplicate-instance-name" for line in (16, 17)),
            ],
        ),
        ("24-old-model-and-remap/t.xml", ["3 error child-count", "7 warning unknown-port", "9 warning xml-ignored"]),
        ("25-reactive-two-async/t.xml", ["5 warning reactive-multiple-async"]),
        ("25-reactive-two-async/t2.xml", ["5 error reactive-multiple-async"]),
        ("25-reactive-two-async/t3.xml", ["5 warning reactive-multiple-async"]),
    ],
)
def test_the_shared_files(shared: Path, file: str, expected: list[str]) -> None:
    xml = (shared / "field" / "trees" / file).read_text(encoding="utf-8")
    assert [
        f"{xml.count(chr(10), 0, each.span.start) + 1} {each.effective_severity.value} {each.rule}"
        for each in of_xml(xml)
    ] == expected


@pytest.mark.parametrize(
    ("value", "is_json"),
    [
        ("{&quot;gain&quot;: 0.8}", True),
        ("{{&quot;gain&quot;: 0.8}}", True),
        ("{gain: 0.8}", True),
        ("{1, 2}", True),
        ("{[1]}", True),
        ("{ 'a' }", True),
        ("{gain}", False),
        ("{@gain}", False),
        ("{robot.gain}", False),
        ("{ns:gain}", False),
        ("{a}_{b}", False),
        ("json:{&quot;gain&quot;: 0.8}", False),
        ("{=}", False),
    ],
)
def test_json_in_braces(value: str, is_json: bool) -> None:
    text = value.replace("&quot;", '"')
    message = f"the engine reads `{text}` as an entry of that name, not as a value"
    assert of_node(f'<Tune settings="{value}"/>') == ([f"warning json-in-braces {message}"] if is_json else [])


@pytest.mark.parametrize(
    ("attribute", "instead"),
    [
        ("_onlyIf='a'", '_skipIf="!(a)"'),
        ("_onlyIf='ready'", '_skipIf="!(ready)"'),
        ("_runIf='a > 1'", '_skipIf="!(a > 1)"'),
        ("_executeIf='a &lt; 1 &amp;&amp; b'", '_skipIf="!(a < 1 && b)"'),
        ("_unless='a > 1'", '_skipIf="a > 1"'),
        ("_When='a > 1'", '_skipIf="!(a > 1)"'),
    ],
)
def test_attributes_that_never_existed(attribute: str, instead: str) -> None:
    xml = f'<root BTCPP_format="4"><BehaviorTree ID="Main"><Charge {attribute}/></BehaviorTree></root>\n'
    (found,) = of_xml(xml)
    assert (found.rule, found.severity, found.notes) == ("unknown-attribute", None, (f"write `{instead}`",))
    (fix,) = found.fixes
    fixed = apply_edits(xml, [Edit(each.place.span, each.text) for each in fix.changes])
    spelt = attribute.replace(attribute.split("=")[0], "_skipIf")
    assert fixed == xml.replace(attribute, spelt.replace("='", "='!(")[:-1] + ")'" if "!" in instead else spelt)


def test_root_is_no_node_of_any_version() -> None:
    xml = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Root><AlwaysSuccess/></Root></BehaviorTree></root>'
    (found,) = of_xml(xml)
    assert found.notes == ("<BehaviorTree> is the root: put its node directly into it, or several into a <Sequence>",)


def test_an_older_engine_is_named_only_for_nodes_that_it_can_have() -> None:
    tree = '<root BTCPP_format="4"><BehaviorTree ID="Main"><pkg.Dock/></BehaviorTree>{}</root>'
    (found,) = of_xml(tree.format(""))
    assert found.notes == ()
    (found,) = of_xml(tree.format('<TreeNodesModel><Action ID="pkg.Dock"/></TreeNodesModel>'))
    assert found.notes == ('4.6 accepts it: if you run that, set `engine = "4.6"` in btq.toml',)


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ('variable="{a}" case_1="x"', []),
        ('variable="a" case_1="x"', ["the text `a`, not the entry of that name"]),
        ('variable="5" case_1="5"', ["the text `5`, not the entry of that name"]),
        ('variable="{a}" case_1="\'x\'"', ["the quotes of `'x'` too: only scripts have quoted texts"]),
        ('variable="{a}" case_1="{b}"', []),
        ('variable="{a}" case_1="don\'t"', []),
    ],
)
def test_a_switch_compares_texts(attributes: str, expected: list[str]) -> None:
    switch = f'<Switch2 {attributes} case_2="y"><A/><B/><C/></Switch2>'
    assert of_node(switch) == [f"warning switch-cases `Switch2` compares {each}" for each in expected]


@pytest.mark.parametrize(("engine", "entry"), [("4.10", "{spot}"), ("3.8", "spot")])
def test_what_replaced_the_elements_of_a_subtree(engine: str, entry: str) -> None:
    xml = (
        '<root main_tree_to_execute="Main"><BehaviorTree ID="Main"><SubTree ID="Go"><remap internal="target" '
        'external="spot"/></SubTree></BehaviorTree><BehaviorTree ID="Go"><A/></BehaviorTree></root>'
    )
    (found,) = of_xml(xml, engine)
    assert found.rule == "child-count"
    assert found.notes == (f'<remap> is of version 2 of the engine: write `target="{entry}"` at the SubTree',)


PAUSING = "<AsyncFallback><{0}/><B/></AsyncFallback>"


@pytest.mark.parametrize(
    ("parent", "children", "expected"),
    [
        ("ReactiveSequence", (PAUSING.format("A"), PAUSING.format("A")), True),
        ("ReactiveSequence", (PAUSING.format("A"), "<Sleep msec='5'/>"), True),
        ("ReactiveFallback", ("<AsyncSequence><A/><B/></AsyncSequence>", PAUSING.format("A")), True),
        ("ReactiveSequence", (PAUSING.format("A"), "<C/>"), False),
        ("ReactiveSequence", (PAUSING.format("A"), "<AsyncFallback><A/></AsyncFallback>"), False),
        ("ReactiveSequence", ("<Fallback><A/><B/></Fallback>", PAUSING.format("A")), False),
        ("Sequence", (PAUSING.format("A"), PAUSING.format("A")), False),
    ],
)
def test_what_pauses_in_a_reactive_node(parent: str, children: tuple[str, str], expected: bool) -> None:
    found = [each.split(" ")[1] for each in of_node(f"<{parent}>{''.join(children)}</{parent}>")]
    warned = [each for each in of_node(f"<{parent}>{''.join(children)}</{parent}>") if "between its children" in each]
    assert (bool(warned), found.count("reactive-multiple-async") <= 1) == (expected, True)


def test_a_branch_that_begins_with_a_condition_may_interrupt() -> None:
    branch = "<AsyncFallback><Condition ID='Ok'/><B/></AsyncFallback>"
    assert not any(
        "between its children" in each for each in of_node(f"<ReactiveSequence>{branch}{branch}</ReactiveSequence>")
    )


@pytest.mark.parametrize(("nodes", "severity"), [('nodes = ["models.xml"]\n', "error"), ("", "warning")])
def test_an_unknown_node_of_a_program_whose_nodes_are_all_named(tmp_path: Path, nodes: str, severity: str) -> None:
    models = "<TreeNodesModel><Action ID='Dock'/></TreeNodesModel>"
    (tmp_path / "models.xml").write_text(f"<root BTCPP_format='4'>{models}</root>\n")
    own = "" if nodes else models
    tree = "<BehaviorTree ID='Main'><Sequence><Dock/><Fly/></Sequence></BehaviorTree>"
    (tmp_path / "t.xml").write_text(f"<root BTCPP_format='4'>{tree}{own}</root>\n")
    (tmp_path / "btq.toml").write_text(f'[[factory]]\nname = "robot"\nload = ["t.xml"]\nmain = "Main"\n{nodes}')
    out = run_btq("check", "t.xml", "--output-format", "concise", cwd=tmp_path)[1]
    assert f"{severity}[unknown-node] unknown node `Fly`\n" in out


@pytest.mark.parametrize("change", [*ENGINE_CHANGES, *CHANGES], ids=lambda change: f"{change.since}-{change.nodes[0]}")
def test_every_change_has_an_advice(change: object) -> None:
    assert change.instead or change.keeps is not None  # type: ignore[attr-defined]


@pytest.mark.parametrize("spelling", ["btq", "xml"])
def test_the_value_that_keeps_the_meaning_is_named(tmp_path: Path, spelling: str) -> None:
    (tmp_path / "btq.toml").write_text('nodes = ["nav2-kilted"]\n')
    (tmp_path / "t.btq").write_text("BehaviorTree Main\n    RoundRobin\n        Wait\n        Spin\n")
    tree = "<BehaviorTree ID='Main'><RoundRobin><Wait/><Spin/></RoundRobin></BehaviorTree>"
    (tmp_path / "t.xml").write_text(f"<root BTCPP_format='4'>{tree}</root>\n")
    out = run_btq("check", f"t.{spelling}", "--target", "nav2-lyrical", cwd=tmp_path)[1]
    said = 'wrap_around="true"' if spelling == "xml" else "wrap_around = true"
    assert f"= note: write `{said}` to keep its meaning\n" in out


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("trees/01-post-script-spaces/t.xml", ["4:31 warning unknown-attribute", "5:43 warning uncreated-entry"]),
        ("trees/03-assign-unknown-with-equals/t1.xml", []),
        ("trees/03-assign-unknown-with-equals/t2.xml", ["4:21 warning uncreated-entry"]),
        ("trees/18-shared-blackboard-literal/t.xml", ["2:2 warning version-3-file", "17:102 warning unread-argument"]),
        ("trees/18-shared-blackboard-literal/t4.xml", ["17:46 warning unread-argument"]),
        (
            "trees/27-subtree-does-not-share",
            ["4:20 error isolated-node", "5:26 warning unset-entry", "10:33 warning unset-entry"],
        ),
        ("trees/28-read-before-write/t.xml", ["4:22 hint unset-entry"]),
        (
            "trees/35-misspelt-subtree-argument/t.xml",
            [
                "4:26 warning unread-argument",
                "4:45 hint unset-entry",
                "5:22 warning unset-entry",
                "10:24 warning unset-entry",
            ],
        ),
        ("nav2/unset", ["6:26 warning unset-entry"]),
        ("nav2/c7_4016", ["6:30 warning unset-entry"]),
    ],
)
def test_entries_that_nothing_sets_and_arguments_that_nothing_reads(
    file: str, expected: list[str], shared: Path, tmp_path: Path
) -> None:
    source = shared / "field" / file
    folder = copytree(source, tmp_path / "x") if source.is_dir() else Path(copy(source, tmp_path)).parent
    _, out, _ = run_btq("check", "--output-format", "concise", cwd=folder)
    assert [" ".join(each) for each in re.findall(r"\.xml:(\d+:\d+): (\w+)\[([\w-]+)\]", out)] == expected
