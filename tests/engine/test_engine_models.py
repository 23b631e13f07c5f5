"""What the engine refuses in models and includes, and only there: an error for the versions that do, and no other."""

from __future__ import annotations

import pytest
from engine_loader import Engine, job

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

TREE = '<BehaviorTree ID="Main"><Sequence><SubTree ID="Step" a="1"/></Sequence></BehaviorTree>'
STEP = '<BehaviorTree ID="Step"><AlwaysSuccess/></BehaviorTree>'
WITH = "<TreeNodesModel>{}</TreeNodesModel>"
SUBTREE = WITH.format('<SubTree ID="Step">{}</SubTree>')
CASES = {
    "nothing": "",
    "two-models": "<TreeNodesModel/><TreeNodesModel/>",
    "two-models-with-attributes": '<TreeNodesModel/><TreeNodesModel x="1"/>',
    "port": SUBTREE.format('<input_port name="a"/>'),
    "port-without-name": SUBTREE.format("<input_port/>"),
    "port-with-other-name": SUBTREE.format('<output_port Name="a"/>'),
    "port-with-empty-name": SUBTREE.format('<inout_port name=""/>'),
    "port-with-digit": SUBTREE.format('<inout_port name="1a" default="1"/><input_port name="a"/>'),
    "port-with-space": SUBTREE.format('<inout_port name="a b" default="1"/><input_port name="a"/>'),
    "port-with-dot": SUBTREE.format('<inout_port name="a.b" default="1"/><input_port name="a"/>'),
    "port-with-reserved-name": SUBTREE.format('<input_port name="_autoremap" default="1"/>'),
    "port-called-ID": SUBTREE.format('<input_port name="ID" default="1"/>'),
    "port-called-name": SUBTREE.format('<input_port name="name" default="1"/>'),
    "required-port": SUBTREE.format('<input_port name="b"/>'),
    "empty-default": SUBTREE.format('<input_port name="b" default=""/>'),
    "misspelt-default": SUBTREE.format('<input_port name="b" defalt="1"/>'),
    "unknown-port-tag": SUBTREE.format('<bidirectional_port name="b"/>'),
    "port-of-unknown-tree": WITH.format('<SubTree ID="Other"><input_port name="b"/></SubTree>'),
    "bad-port-of-unknown-tree": WITH.format('<SubTree ID="Other"><input_port/></SubTree>'),
    "subtree-without-id": WITH.format("<SubTree/>"),
    "subtree-with-other-id": WITH.format('<SubTree id="Step"/>'),
    "subtree-with-empty-id": WITH.format('<SubTree ID=""/>'),
    "subtree-with-name-of-node": WITH.format('<SubTree ID="Sequence"/>'),
    "action-without-id": WITH.format("<Action/>"),
    "unknown-model": WITH.format('<Acton ID="x"/>'),
    "tree-in-model": WITH.format("<BehaviorTree/>"),
    "tag-in-another-case": "<treenodesmodel><SubTree/></treenodesmodel>",
    "other-element": "<Other/>",
    "model-below-root": '<Action ID="Go"/>',
    "model-below-root-without-id": "<Action/>",
    "subtree-below-root-without-id": "<SubTree/>",
    "model-below-root-without-id-beside-models": "<TreeNodesModel/><Action/>",
    "control-below-root-without-id-beside-models": "<Control/><TreeNodesModel/>",
    "other-below-root-without-id-beside-models": "<Sequence/><TreeNodesModel/>",
    "include-without-path": "<include/>",
    "include-with-other-path": '<include file="x.xml"/>',
    "two-models-of-one-tree": WITH.format('<SubTree ID="Step"/><SubTree ID="Step"><input_port name="c"/></SubTree>'),
    "text-in-models": WITH.format("text"),
    "tree-without-id-beside-another-element": "<BehaviorTree><AlwaysSuccess/></BehaviorTree><Other/>",
}


@pytest.mark.parametrize("case", CASES)
def test_an_error_is_what_the_engine_refuses(engine: Engine, case: str) -> None:
    xml = f'<root BTCPP_format="4" main_tree_to_execute="Main">{TREE}{STEP}{CASES[case]}</root>'
    (answer,) = engine.run([job(xml, ticks=0)])
    version = ".".join(engine.version.split(".")[:2])
    found = check(Workspace({"a.xml": file_of("a.xml", xml)}, Project(engines=(version,))), "a.xml")
    # That a tree is lost is an error to btq alone.
    errors = {each.rule for each in found if each.effective_severity is Severity.ERROR} - {"xml-ignored"}
    assert bool(errors) is (answer.stage in ("load", "create")), (answer.stage, answer.error, answer.crashed, found)
