"""Entries that nothing sets, and arguments that nothing reads: what the rules say is what the engine does."""

from __future__ import annotations

import pytest
from engine_loader import Engine

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

MAIN = (
    '<root BTCPP_format="4" main_tree_to_execute="Main">'
    '<BehaviorTree ID="Main"><Sequence>{}</Sequence></BehaviorTree>{}</root>'
)
BELOW = '<BehaviorTree ID="Below">{}</BehaviorTree>'
ASSIGN, CREATE = '<Script code="x = 4"/>', '<Script code="x := 4"/>'
READ, SLEEP = '<ScriptCondition code="x == 4"/>', '<Sleep msec="{x}"/>'
UNCREATED, UNSET, UNREAD = ["uncreated-entry"], ["unset-entry"], ["unread-argument"]

CASES = {
    "assigned": (ASSIGN, "", UNCREATED, "doesn't exist, yet"),
    "added": ('<Script code="x += 4"/>', "", UNCREATED, "doesn't exist, yet"),
    "afterwards": ('<AlwaysSuccess _onSuccess="x = 4"/>', "", UNCREATED, "doesn't exist, yet"),
    "created": (CREATE + ASSIGN, "", [], ""),
    "created by a port": (ASSIGN + SLEEP, "", [], ""),
    "created by a value": ('<SubTree ID="Below" x="3"/>', ASSIGN.replace("4", "'4'"), [], ""),
    "not created by an argument": ('<SubTree ID="Below" x="{y}"/>', ASSIGN, UNCREATED, "doesn't exist, yet"),
    "created above": ('<Script code="y := 1"/><SubTree ID="Below" x="{y}"/>', ASSIGN, [], ""),
    "shared": ('<Script code="x := 1"/><SubTree ID="Below" _autoremap="true"/>', ASSIGN, [], ""),
    "never read": (CREATE + '<SubTree ID="Below" y="{x}"/>', "<AlwaysSuccess/>", UNREAD, ""),
    "not given to a script": (CREATE + '<SubTree ID="Below"/>', READ, UNSET, "not found: x"),
    "not given to a port": (CREATE + '<SubTree ID="Below"/>', SLEEP, UNSET, "[msec]"),
    "given": (CREATE + '<SubTree ID="Below" x="{x}"/>', READ, [], ""),
    "given as a value": ('<SubTree ID="Below" x="4"/>', READ, [], ""),
    "lost": ('<SubTree ID="Below"/>' + READ, CREATE, UNSET, "not found: x"),
    "passed on": ('<SubTree ID="Below" x="{x}"/>' + READ, CREATE, [], ""),
    "passed on by all": ('<SubTree ID="Below" _autoremap="1"/>' + READ, CREATE, [], ""),
    "on the root blackboard": ('<SubTree ID="Below"/>' + READ, CREATE.replace("x", "@x"), [], ""),
    "never written": (SLEEP, "", UNSET, "[msec]"),
    "read in a script before it is written": (READ + CREATE, "", UNSET, "not found: x"),
    "written afterwards": (SLEEP + CREATE, "", UNSET, "[msec]"),
    "written afterwards below": ('<SubTree ID="Below"/>', f"<Sequence>{SLEEP + CREATE}</Sequence>", UNSET, "[msec]"),
    "read at every tick below": (
        *('<SubTree ID="Below"/>', f"<ReactiveSequence>{SLEEP + CREATE}</ReactiveSequence>"),
        *(UNSET, "[msec]"),
    ),
    "created afterwards": (ASSIGN + CREATE, "", UNCREATED, "doesn't exist, yet"),
}


@pytest.mark.parametrize("name", CASES)
def test_the_engine_fails_where_a_rule_finds_something(name: str, engine: Engine) -> None:
    above, below, rules, failure = CASES[name]
    xml = MAIN.format(above, BELOW.format(below) if below else "")
    workspace = Workspace({"a.xml": file_of("a.xml", xml)}, Project())
    assert [each.rule for each in check(workspace, "a.xml")] == rules
    answer = engine.run_one(xml, ticks=5, tick_ms=10)
    assert failure in answer.error
    assert (answer.error == "") == (failure == ""), answer.error
