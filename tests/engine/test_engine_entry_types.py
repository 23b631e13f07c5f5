"""Entries with two types: what the rule says is what the engine does."""

from __future__ import annotations

from engine_loader import Engine
from mixed_types import CASES, mission

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.catalog.versions import TYPED_CONSTANTS
from btq_lang.workspace.workspace import Workspace


def test_the_engine_refuses_what_the_rule_tells(engine: Engine) -> None:
    for name, (lines, meet) in CASES.items():
        done = export(Workspace.of({"main.btq": mission(lines)}), "main.btq")
        answer = engine.run_one(write(done.document))
        assert ("was initially created with type" in answer.error) == meet, (name, answer.error)
        assert (answer.stage == "done") != meet, (name, answer.error)


def test_the_default_of_a_tree_has_a_type_where_a_subtree_gives_no_value(engine: Engine) -> None:
    default = '<SubTree ID="S"><input_port name="v" default="{}"/></SubTree>'
    trees = (
        '<BehaviorTree ID="M"><SubTree ID="S"{}/></BehaviorTree>'
        '<BehaviorTree ID="S"><Sleep msec="{{v}}"/></BehaviorTree>'
    )
    for attributes, value, meet in (("", "10", True), ("", "10 ", False), (' _autoremap="true"', "10", False)):
        models = f"<TreeNodesModel>{default.format(value)}</TreeNodesModel>"
        xml = f'<root BTCPP_format="4" main_tree_to_execute="M">{trees.format(attributes)}{models}</root>'
        answer = engine.run_one(xml)
        is_typed = TYPED_CONSTANTS.holds(engine.version)
        assert ("was initially created with type" in answer.error) == (meet and is_typed), (value, answer.error)


def test_a_switch_chooses_by_a_number_that_a_script_copied(engine: Engine) -> None:
    text = """Root Main
BehaviorTree Main
    ->
        Script (code = "k := 1; choice := k")
        Switch (variable = {choice} case_1 = "1" case_2 = "2")
            AlwaysSuccess
            AlwaysFailure
            AlwaysFailure
"""
    done = export(Workspace.of({"main.btq": text}), "main.btq")
    assert engine.run_one(write(done.document), ticks=1).status == "SUCCESS"
