"""Nodes that do not do what they seem to do: what the rules say of them is what the engine does."""

from __future__ import annotations

from typing import NamedTuple

import pytest
from engine_loader import Engine

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.versions import at_least
from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

XML = (
    '<root BTCPP_format="4" main_tree_to_execute="Main"><BehaviorTree ID="Main">{}</BehaviorTree>'
    '<BehaviorTree ID="Below">{}</BehaviorTree><TreeNodesModel><Action ID="Act"/></TreeNodesModel></root>'
)
ACT, LONG = '<Act name="act"/>', '<Sleep msec="60000"/>'
WRITE, HAS_ENTRY = '<Script code="e := 1"/>', '<ScriptCondition code="e == 1"/>'
REMOVE = '<UnsetBlackboard key="e"/>'
MODEL = '<Action ID="Act"><output_port name="y"/></Action>'


class Trap(NamedTuple):
    """A tree, the rule that finds something in it, and what is seen of the engine.

    Attributes:
        ends: the result of the tree after four ticks.
        is_reset: whether the action is reset, so that it starts again; None: there is no action.
        result: of the action, in the tick that starts it.
    """

    main: str
    rules: list[str]
    ends: str
    is_reset: bool | None = None
    below: str = "<AlwaysSuccess/>"
    result: str = "FAILURE"


def for_ever(node: str) -> str:
    """A node that is ticked again after its end, whatever its result."""
    return f"<KeepRunningUntilFailure><ForceSuccess>{node}</ForceSuccess></KeepRunningUntilFailure>"


CONDITION, KEPT = ["stateful-condition"], ["unset-without-effect"]
TRAPS = {
    "a condition that has failed is not asked again": Trap(
        for_ever(f"<IfThenElse>{ACT}<AlwaysSuccess/></IfThenElse>"), CONDITION, "RUNNING", is_reset=False
    ),
    "it is with three children": Trap(
        for_ever(f"<IfThenElse>{ACT}<AlwaysSuccess/><AlwaysFailure/></IfThenElse>"), [], "RUNNING", is_reset=True
    ),
    "it is below a decorator": Trap(
        for_ever(f"<IfThenElse><Inverter>{ACT}</Inverter><AlwaysSuccess/></IfThenElse>"),
        *([], "RUNNING"),
        is_reset=True,
        result="SUCCESS",
    ),
    "a condition is not asked while a child runs": Trap(
        f'<WhileDoElse><Sleep msec="1" name="act"/>{LONG}</WhileDoElse>', CONDITION, "RUNNING", is_reset=False
    ),
    "it is where no child runs on": Trap(
        for_ever('<WhileDoElse><Sleep msec="1" name="act"/><AlwaysSuccess/></WhileDoElse>'),
        *([], "RUNNING"),
        is_reset=True,
    ),
    "an entry of another tree stays": Trap(
        f'<Sequence>{WRITE}<SubTree ID="Below" e="{{e}}"/>{HAS_ENTRY}</Sequence>', KEPT, "SUCCESS", below=REMOVE
    ),
    "one that is passed with all others stays": Trap(
        f'<Sequence>{WRITE}<SubTree ID="Below" _autoremap="true"/>{HAS_ENTRY}</Sequence>', KEPT, "SUCCESS", below=REMOVE
    ),
    "one of the root blackboard stays": Trap(
        f'<Sequence>{WRITE}<UnsetBlackboard key="@e"/>{HAS_ENTRY}</Sequence>', KEPT, "SUCCESS"
    ),
    "an entry of the tree itself may have another type afterwards": Trap(
        f"<Sequence>{WRITE}{REMOVE}<Script code=\"e := 'text'\"/></Sequence>", [], "SUCCESS"
    ),
}


@pytest.mark.parametrize("name", TRAPS)
def test_the_engine_does_what_the_rule_says(name: str, engine: Engine) -> None:
    trap = TRAPS[name]
    xml = XML.format(trap.main, trap.below)
    rules = {each.rule for each in check(Workspace({"a.xml": file_of("a.xml", xml)}, Project()), "a.xml")}
    assert sorted(rules & {*CONDITION, *KEPT}) == trap.rules
    answer = engine.run_one(xml, parts={"act": [[trap.result]] * 9}, ticks=4, tick_ms=5)
    assert (answer.error, answer.status) == ("", trap.ends)
    assert trap.is_reset is None or trap.is_reset == ("IDLE" in answer.statuses("act"))


def test_a_copy_of_an_entry_without_a_value_fails_from_4_7_on(engine: Engine) -> None:
    main = '<Fallback><SetBlackboard value="{y}" output_key="x"/><Act name="act" y="{y}"/></Fallback>'
    xml = XML.format(main, "<AlwaysSuccess/>").replace('<Action ID="Act"/>', MODEL)
    rules = {each.rule for each in check(Workspace({"a.xml": file_of("a.xml", xml)}, Project()), "a.xml")}
    assert "unreachable-child" not in rules
    answer = engine.run_one(xml, parts={"act": [["SUCCESS"]]}, ticks=1)
    assert (answer.error, answer.status) == ("", "SUCCESS")
    assert answer.statuses("act") == (["SUCCESS", "IDLE"] if at_least(engine.version, "4.7") else [])
