"""What the engine makes of literals that are right for the type of a port and wrong for its node."""

from __future__ import annotations

import pytest
from engine_loader import Engine

FILE = """<root BTCPP_format="4" main_tree_to_execute="Main">
  <BehaviorTree ID="Main">{}</BehaviorTree>
  <BehaviorTree ID="Part"><AlwaysSuccess/></BehaviorTree>
</root>"""
RETURNING = (
    '<LoopDouble queue="" value="{{value}}" if_empty="{}"><AlwaysSuccess/></LoopDouble>',
    '<Precondition if="false" else="{}"><AlwaysSuccess/></Precondition>',
)


@pytest.mark.parametrize("node", RETURNING)
def test_a_node_returns_what_a_port_says_but_idle(engine: Engine, node: str) -> None:
    for status in ("SUCCESS", "FAILURE", "SKIPPED", "RUNNING"):
        answer = engine.run_one(FILE.format(node.format(status)), ticks=2)
        assert (answer.stage, answer.status) == ("done", status)
    answer = engine.run_one(FILE.format(node.format("IDLE")), ticks=2)
    assert answer.stage == "tick"
    assert "you are not allowed to set manually the status to IDLE" in answer.error


@pytest.mark.parametrize(("cycles", "ticks"), [("2", 2), ("2.0", 2), ("2.9", 2), ("2x", 2)])
def test_an_integer_ends_at_the_first_other_character(engine: Engine, cycles: str, ticks: int) -> None:
    loop = f'<Repeat num_cycles="{cycles}"><Script code="n += 1"/></Repeat>'
    text = FILE.format(f'<Sequence><Script code="n := 0"/>{loop}<ScriptCondition code="n == {ticks}"/></Sequence>')
    assert engine.run_one(text, ticks=5).status == "SUCCESS"


def test_a_tree_keeps_the_type_of_an_integer_that_is_written_as_a_real(engine: Engine) -> None:
    """So it stays a warning there."""
    part = '<BehaviorTree ID="Part"><Repeat num_cycles="{n}"><AlwaysSuccess/></Repeat></BehaviorTree>'
    text = FILE.format('<SubTree ID="Part" n="2.0"/>').replace(
        '<BehaviorTree ID="Part"><AlwaysSuccess/></BehaviorTree>', part
    )
    answer = engine.run_one(text, ticks=5)
    if engine.version.startswith("4.6"):
        assert answer.status == "SUCCESS"
    else:
        assert (answer.stage, "initially created with type [double]" in answer.error) == ("load", True)


@pytest.mark.parametrize("value", ["{=}", "{remap}"])
def test_autoremap_is_no_entry(engine: Engine, value: str) -> None:
    text = FILE.format(f'<SubTree ID="Part" _autoremap="{value}"/>')
    answer = engine.run_one(text, blackboard={"remap": "true"})
    assert (answer.stage, answer.error) == ("load", "convertFromString(): invalid bool conversion")
