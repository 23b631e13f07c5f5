"""Entries with two types: what the rule says is what the engine does."""

from __future__ import annotations

from engine_loader import Engine
from test_checks_mixed_types import CASES, mission

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.workspace import Workspace


def test_the_engine_refuses_what_the_rule_tells(engine: Engine) -> None:
    for name, (lines, meet) in CASES.items():
        done = export(Workspace.of({"main.btq": mission(lines)}), "main.btq")
        answer = engine.run_one(write(done.document))
        assert ("was initially created with type" in answer.error) == meet, (name, answer.error)
        assert (answer.stage == "done") != meet, (name, answer.error)
