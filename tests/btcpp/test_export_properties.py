"""What holds for every mission that is written as XML."""

from __future__ import annotations

import pytest
from engine_rules import violations
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree
from mission_strategies import odd_missions
from missions import Spelling, mission
from seeds import seeds

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Tree
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

VERSIONS = ("4.6", "4.8", "4.10")


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("spelling", ["classic", "short"])
@pytest.mark.parametrize("seed", seeds(4))
def test_missions_made_up_keep_the_engines_rules(version: str, spelling: Spelling, seed: int) -> None:
    workspace = Workspace.of({"m.btq": mission(150, seed, spelling)}, Project(engines=(version,)))
    done = export(workspace, "m.btq")
    assert done.problems == ()
    assert violations(write(done.document), version) == []


def test_the_rules_find_what_is_wrong() -> None:
    xml = """<root main_tree_to_execute="B"><BehaviorTree ID="a b"><Sequence ID="x"/></BehaviorTree>
        <BehaviorTree ID="A"><ReactiveSequence><Action ID="P"/><SubTree ID="C" name="n"/><SubTree ID="A" name="n"/>
        <Timeout msec="-1" x="1"/><TryCatch><AlwaysSuccess/><AlwaysSuccess/></TryCatch>
        </ReactiveSequence></BehaviorTree>
        <TreeNodesModel><Action ID="P"/></TreeNodesModel><TreeNodesModel/></root>"""
    both = ["no BTCPP_format", "two TreeNodesModel", "no main tree 'B'"]
    ports = [
        "Timeout has 0 children",
        "Timeout.msec: '-1', expected an integer from 0 to 4294967295",
        "Timeout has no port x",
    ]
    assert violations(xml, "4.10") == [
        *both,
        *("tree name 'a b'", "<Sequence> has an ID", "Sequence has no children", "names of SubTrees: ['n', 'n']"),
        *("no tree 'C'", "explicit <Action> in a ReactiveSequence", *ports),
    ]
    assert violations(xml, "4.6") == [
        *both,
        *("<Sequence> has an ID", "Sequence has no children", "no tree 'C'", *ports, "TryCatch is newer"),
    ]


@settings(max_examples=300)
@given(text=odd_missions(), version=st.sampled_from(VERSIONS), verbatim=st.booleans())
def test_every_mission_gives_well_formed_xml_or_says_why_not(text: str, version: str, verbatim: bool) -> None:
    workspace = Workspace.of({"m.btq": text}, Project(engines=(version,)))
    done = export(workspace, "m.btq", verbatim=verbatim)
    xml = write(done.document)
    assert xml == write(export(workspace, "m.btq", verbatim=verbatim).document)  # the same bytes
    if done.problems:
        return
    root = etree.fromstring(xml.encode())
    written = [node for item in workspace.files["m.btq"].parsed.trees for node in item.walk()]
    elements = [each for tree in root.iterchildren("BehaviorTree") for each in tree.iterdescendants(etree.Element)]
    assert len(written) == len(elements)  # one element a node
    assert verbatim <= (done.repairs == () or all("`--`" in repair.message for repair in done.repairs))
    errors = [each for each in check(workspace, "m.btq") if each.effective_severity is Severity.ERROR]
    if not errors and not verbatim:
        assert violations(xml, version) == []


@settings(max_examples=300)
@given(text=odd_missions(), at=st.integers(0, 400), torn=st.integers(0, 40))
def test_a_torn_mission_is_written_all_the_same(text: str, at: int, torn: int) -> None:
    text = text[:at] + text[at + torn :]
    workspace = Workspace.of({"m.btq": text})
    done = export(workspace, "m.btq")
    write(done.document)
    assert {id(node) for tree in workspace.files["m.btq"].parsed.trees for node in tree.walk()} == set(done.elements)
    assert isinstance(done.document.root.children, list)
    assert all(isinstance(tree, Tree) for tree in workspace.files["m.btq"].parsed.trees)
