"""The loader: what it says of trees whose fate in the engine is known."""

from __future__ import annotations

import signal
from pathlib import Path

from engine_loader import Engine, Node, job, stubs_of


def mission(nodes: str, more: str = "") -> str:
    tree = f'<BehaviorTree ID="Main">{nodes}</BehaviorTree>'
    return f'<root BTCPP_format="4" main_tree_to_execute="Main">{tree}{more}</root>'


def test_a_tree_is_told_as_the_engine_made_it(engine: Engine) -> None:
    xml = mission(
        '<Sequence name="all"><Pick name="first" what="{tube}" _onSuccess="n := 1"/>'
        '<SubTree ID="Rest" name="rest"/></Sequence>',
        '<BehaviorTree ID="Rest"><Inverter><Ready/></Inverter></BehaviorTree>',
    )
    answer = engine.run_one(xml, stubs=[stub("Pick", "Action", input="what"), stub("Ready", "Condition")])
    assert (answer.stage, answer.error, answer.ticks) == ("done", "", 0)
    assert list(answer.trees) == ["Main"]
    assert answer.tree == (
        Node(1, "all", "Sequence", "all", 0, {}, {}, {}),
        Node(2, "first", "Pick", "first", 1, {"what": "{tube}"}, {}, {"_onSuccess": "n := 1"}),
        Node(3, "rest", "SubTree", "rest", 1, {}, {}, {}),
        Node(4, "rest/Inverter::4", "Inverter", "Inverter", 3, {}, {}, {}),
        Node(5, "rest/Ready::5", "Ready", "Ready", 4, {}, {}, {}),
    )


def test_a_refusal_has_the_words_of_the_engine(engine: Engine) -> None:
    answer = engine.run_one(mission("<Pikc/>"), stubs=[])
    assert (answer.stage, answer.error) == ("load", "Error at line 3: -> Node not recognized: Pikc")


def test_the_model_of_a_subtree_makes_no_node_of_its_tree(engine: Engine) -> None:
    other = '<BehaviorTree ID="Pick"><AlwaysSuccess/></BehaviorTree>'
    model = '<TreeNodesModel><SubTree ID="Pick"/></TreeNodesModel>'
    answer = engine.run_one(mission("<Pick/>", other + model), stubs=[])
    assert (answer.stage, answer.error) == ("load", "Error at line 3: -> Node not recognized: Pick")


def test_every_tree_is_instantiated_when_asked(engine: Engine) -> None:
    xml = mission("<AlwaysSuccess/>", '<BehaviorTree ID="Other"><SubTree ID="Nowhere"/></BehaviorTree>')
    assert engine.run_one(xml).stage == "done"
    answer = engine.run_one(xml, every_tree=True)
    assert (answer.stage, answer.error) == ("create", "Can't find a tree with name: Nowhere")
    assert list(answer.trees) == ["Main"]


def test_stubs_play_their_parts(engine: Engine) -> None:
    answer = engine.run_one(
        mission('<RetryUntilSuccessful num_attempts="3"><Pick/></RetryUntilSuccessful>'),
        parts={"Pick": [["RUNNING", "FAILURE"], ["RUNNING", "RUNNING", "SUCCESS"]]},
        ticks=10,
    )
    assert (answer.status, answer.ticks) == ("SUCCESS", 4)
    assert answer.statuses("Pick") == ["RUNNING", "FAILURE", "IDLE", "RUNNING", "SUCCESS", "IDLE"]
    assert answer.transitions[0] == (1, 1, "IDLE", "RUNNING")


def test_a_part_may_be_said_for_one_instance(engine: Engine) -> None:
    answer = engine.run_one(
        mission('<Fallback><Pick name="left"/><Pick name="right"/></Fallback>'), parts={"left": ["FAILURE"]}, ticks=10
    )
    assert answer.statuses("left") == ["FAILURE", "IDLE"]
    assert answer.statuses("right") == ["RUNNING", "SUCCESS", "IDLE"]


def test_stubs_write_on_the_blackboard(engine: Engine) -> None:
    answer = engine.run_one(
        mission('<Sequence><SubTree ID="Work" name="work"/><ScriptCondition code="battery &lt; 20.0"/></Sequence>',
                '<BehaviorTree ID="Work"><Pick tube="{found}"/></BehaviorTree>'),
        stubs=[stub("Pick", "Action", output="tube")],
        parts={"Pick": [{"status": "SUCCESS", "write": {"@battery": 12.5, "local": "x"}, "output": {"tube": "t7"}}]},
        blackboard={"battery": 80.0},
        ticks=10,
    )  # fmt: skip
    assert answer.status == "SUCCESS"
    assert answer.blackboards[""] == {"battery": 12.5}
    assert answer.blackboards["work"] == {"found": "t7", "local": "x"}


def test_a_limit_is_broken_in_real_time(engine: Engine) -> None:
    xml = mission('<Timeout name="rq1_limit" msec="200"><Move/></Timeout>')
    answer = engine.run_one(xml, parts={"Move": ["RUNNING"]}, ticks=10_000, tick_ms=1, seconds=60)
    assert answer.status == "FAILURE"
    assert answer.statuses("Move") == ["RUNNING", "IDLE"]
    assert engine.run_one(xml, parts={"Move": ["SUCCESS"]}, ticks=1).status == "SUCCESS"


def test_a_tree_is_halted(engine: Engine) -> None:
    xml = mission('<Move _onHalted="stopped := true"/>')
    answer = engine.run_one(xml, parts={"Move": ["RUNNING"]}, ticks=3, halt=True)
    assert (answer.status, answer.ticks) == ("RUNNING", 3)
    assert answer.statuses("Move") == ["RUNNING", "IDLE"]
    assert answer.blackboards[""] == {"stopped": 1.0}


def test_an_action_without_time_of_its_own(engine: Engine) -> None:
    sync = [{"ID": "Log", "category": "Action", "sync": True}]
    assert engine.run_one(mission("<Log/>"), stubs=sync, ticks=1).status == "SUCCESS"
    answer = engine.run_one(mission("<Log/>"), stubs=sync, parts={"Log": ["RUNNING"]}, ticks=1)
    assert answer.stage == "tick"
    assert "SyncActionNode MUST never return RUNNING" in answer.error


def test_custom_controls_and_decorators_tick_their_children(engine: Engine) -> None:
    answer = engine.run_one(
        mission("<Roulette><Log/><Watch><Move/></Watch></Roulette>"), parts={"Move": ["RUNNING", "FAILURE"]}, ticks=10
    )
    assert answer.status == "FAILURE"
    assert answer.statuses("Watch") == ["RUNNING", "FAILURE", "IDLE"]


def test_an_error_while_ticking_is_told(engine: Engine) -> None:
    answer = engine.run_one(mission('<ScriptCondition code="nosuch"/>'), ticks=1)
    assert answer.stage == "tick"
    assert "Variable not found: nosuch" in answer.error


def test_a_crash_is_told_and_the_next_file_is_loaded(engine: Engine) -> None:
    crash = mission('<Move _onHalted="nosuch += 1"/>')  # thrown in a destructor
    answers = engine.run([job(mission("<AlwaysSuccess/>")), job(crash), job(mission("<AlwaysSuccess/>"), ticks=1)])
    assert [(each.stage, each.crashed) for each in answers] == [("done", 0), ("load", signal.SIGABRT), ("done", 0)]
    assert answers[2].status == "SUCCESS"


def test_an_engine_that_does_not_return_is_told(engine: Engine) -> None:
    parts = {"Move": [{"status": "SUCCESS", "ms": 60_000}]}
    answers = engine.run([job(mission("<Move/>"), parts=parts, ticks=1, seconds=1), job(mission("<AlwaysSuccess/>"))])
    assert [(each.stage, each.crashed) for each in answers] == [("load", signal.SIGALRM), ("done", 0)]


def test_typed_ports_refuse_what_their_nodes_would(engine: Engine) -> None:
    model = '<Action ID="Move"><input_port name="speed" type="double"/></Action>'
    xml = mission('<Move speed="fast"/>', f"<TreeNodesModel>{model}</TreeNodesModel>")
    answer = engine.run_one(xml)
    assert answer.stage == "load"
    assert 'The port with name "speed" and value "fast" can not be converted to double' in answer.error


def test_stubs_are_found_in_models_and_in_use(tmp_path: Path) -> None:
    (tmp_path / "skills.xml").write_text(
        '<root><TreeNodesModel><Condition ID="Ready"/><Action ID="Pick"><output_port name="tube" type="int"/></Action>'
        "</TreeNodesModel></root>"
    )
    main = tmp_path / "main.xml"
    main.write_text(
        '<root><include path="skills.xml"/><BehaviorTree ID="M"><Roulette odds="1;2"><Pick tube="{t}" colour="red"/>'
        '<Watch _skipIf="x"><Action ID="Move to" name="n"/></Watch></Roulette></BehaviorTree></root>'
    )
    assert stubs_of(main) == [
        {"ID": "Roulette", "category": "Control", "ports": [{"name": "odds", "direction": "inout"}]},
        {"ID": "Pick", "category": "Action", "ports": [{"name": "tube", "direction": "output", "type": "int"}]},
        {"ID": "Watch", "category": "Decorator", "ports": []},
        {"ID": "Move to", "category": "Action", "ports": []},
        {"ID": "Ready", "category": "Condition", "ports": []},
    ]


def stub(ID: str, category: str, **ports: str) -> dict[str, object]:
    return {
        "ID": ID,
        "category": category,
        "ports": [{"name": name, "direction": direction} for direction, name in ports.items()],
    }
