"""Entries with two types: what the rule says is what the engine does."""

from __future__ import annotations

from engine_loader import Engine
from mixed_types import CASES, mission

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.workspace.workspace import Workspace


def test_the_engine_refuses_what_the_rule_tells(engine: Engine) -> None:
    for name, (lines, meet) in CASES.items():
        done = export(Workspace.of({"main.btq": mission(lines)}), "main.btq")
        answer = engine.run_one(write(done.document))
        assert ("was initially created with type" in answer.error) == meet, (name, answer.error)
        assert (answer.stage == "done") != meet, (name, answer.error)


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
