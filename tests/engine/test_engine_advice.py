"""What findings say that the engine does, and what they say to write instead, as the engine has it."""

from __future__ import annotations

import pytest
from engine_loader import Engine

FILE = '<root BTCPP_format="4" main_tree_to_execute="Main"><BehaviorTree ID="Main">{}</BehaviorTree></root>'
SWITCH = '<Switch2 variable="{}" case_1="{}" case_2="BLUE"><Hit/><Other/><Missed/></Switch2>'


def test_an_entry_that_a_script_sets_holds_json(engine: Engine) -> None:
    json = '{"gain": 0.8, "bias": [1, 2]}'
    script = json.replace('"', "&quot;")
    answer = engine.run_one(FILE.format(f"<Script code=\"settings := '{script}'\"/>"), ticks=1)
    assert (answer.status, answer.blackboards[""]["settings"]) == ("SUCCESS", json)


@pytest.mark.parametrize(
    ("variable", "case", "child"),
    [("{color}", "RED", "Hit"), ("color", "RED", "Missed"), ("{color}", "'RED'", "Missed")],
)
def test_a_switch_compares_texts(engine: Engine, variable: str, case: str, child: str) -> None:
    xml = FILE.format(f"<Sequence><Script code=\"color := 'RED'\"/>{SWITCH.format(variable, case)}</Sequence>")
    answer = engine.run_one(xml, ticks=1)
    assert {name for name in ("Hit", "Other", "Missed") if answer.statuses(name)} == {child}


@pytest.mark.parametrize(("node", "status"), [("AsyncFallback", "RUNNING"), ("Fallback", "SUCCESS")])
def test_what_pauses_in_a_reactive_node_never_gets_further(engine: Engine, node: str, status: str) -> None:
    branch = f"<{node}><AlwaysFailure/><AlwaysSuccess/></{node}>"
    answer = engine.run_one(FILE.format(f"<ReactiveSequence>{branch}{branch}</ReactiveSequence>"), ticks=60)
    assert answer.status == status


@pytest.mark.parametrize(("battery", "runs"), [(10, True), (50, False)])
def test_the_opposite_of_a_skip(engine: Engine, battery: int, runs: bool) -> None:
    charge = '<Charge _skipIf="!(battery &lt; 20)"/>'
    xml = FILE.format(f'<Sequence><Script code="battery := {battery}"/>{charge}</Sequence>')
    answer = engine.run_one(xml, ticks=1)
    assert ("RUNNING" in answer.statuses("Charge")) is runs


@pytest.mark.parametrize(
    ("tag", "port", "error"),
    [
        ('SetBlackboard value="0.5"', "output_key", "missing port [output_key]"),
        ("UnsetBlackboard", "key", "missing input port [key]"),
    ],
)
def test_a_key_in_braces_is_read_from_the_entry(engine: Engine, tag: str, port: str, error: str) -> None:
    node = f'<{tag} {port}="{{target}}"/>'
    answer = engine.run_one(FILE.format(node), ticks=1)
    assert answer.stage == "tick"
    assert error in answer.error
    answer = engine.run_one(FILE.format(f"<Sequence><Script code=\"target := 'speed'\"/>{node}</Sequence>"), ticks=1)
    assert answer.status == "SUCCESS"
    assert answer.blackboards[""].get("target") == "speed"
    assert ("speed" in answer.blackboards[""]) is (port == "output_key")
