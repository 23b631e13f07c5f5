"""What checks know of Nav2's nodes, by distribution: `nodes = ["nav2-…"]`."""

from __future__ import annotations

from check_asserts import assert_fixes_mend, assert_sound, show

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.loader import read
from btq_lang.workspace.workspace import Workspace


def found(text: str, distribution: str) -> list[str]:
    """All that is found in a file for a distribution."""
    path = PACKAGED[f"nav2-{distribution}"]
    name = "main.xml" if text.startswith("<") else "main.btq"
    files = {name: file_of(name, text), path: file_of(path, read(path)[0] or "")}
    workspace = Workspace(files, Project(node_files=(path,)))
    diagnostics = check(workspace, name)
    assert_sound(workspace, name, diagnostics)
    assert_fixes_mend(workspace, name, diagnostics)
    return show(text, diagnostics)


def tree(*lines: str) -> str:
    return "BehaviorTree Main\n" + "".join(f"    {line}\n" for line in lines)


# ---- children and results ----


def test_a_number_of_children_that_throws_only_when_ticked() -> None:
    text = tree("RecoveryNode", "    IsStuck", "    IsStuck", "    IsStuck")
    assert found(text, "jazzy") == [
        "2:5 error child-count «RecoveryNode» `RecoveryNode` requires exactly 2 children, found 3"
    ]
    controller = 'PauseResumeController (pause_service_name = "p" resume_service_name = "r")'
    text = tree(controller, *(["    IsStuck"] * 5))
    assert found(text, "lyrical") == [
        "2:5 error child-count «PauseResumeController» `PauseResumeController` requires 1 to 4 children, found 5"
    ]
    assert found(tree(controller, *(["    IsStuck"] * 4)), "lyrical") == []


def test_a_model_of_the_project_with_another_category_is_another_node() -> None:
    text = "Decorator RecoveryNode\n" + tree("RecoveryNode", "    IsStuck")
    assert found(text, "jazzy") == [
        "1:11 warning duplicate-definition «RecoveryNode» duplicate definition of the node model `RecoveryNode`"
    ]


def test_a_node_of_another_distribution_is_unknown_here() -> None:
    text = "Control PauseResumeController\n" + tree("PauseResumeController", *(["    IsStuck"] * 5))
    assert found(text, "kilted") == []


def test_children_that_can_never_run() -> None:
    pipeline = tree("PipelineSequence", "    AlwaysFailure", "    IsStuck")
    assert found(pipeline, "jazzy") == [
        "4:9 warning unreachable-child «IsStuck» `IsStuck` can never run: `AlwaysFailure` before it never succeeds"
    ]
    recovery = tree("RecoveryNode", "    AlwaysSuccess", "    Wait")
    assert found(recovery, "jazzy") == [
        "4:9 warning unreachable-child «Wait» `Wait` can never run: `AlwaysSuccess` before it never fails"
    ]


def test_a_failure_that_a_recovery_swallows() -> None:
    demand = "satisfies QualityReq q takes at most 5 s on violation fail"
    first = tree("RecoveryNode (number_of_retries = 2)", f"    Spin {demand}", "    Wait")
    assert found(first, "jazzy") == [
        "3:37 warning swallowed-failure «takes at most 5 s» when `Spin` fails "
        "because of this, `RecoveryNode` runs its second child"
    ]
    assert found(first.replace("= 2", "= 0"), "jazzy") == []
    assert found(tree("RecoveryNode", "    Spin", f"    Wait {demand}"), "jazzy") == []


# ---- what ends within a tick ----


def test_only_what_may_run_on_restarts_what_runs_beside_it() -> None:
    text = tree("R->", "    TruncatePathLocal (input_path = {p} output_path = {q})", "    FollowPath (path = {q})")
    assert found(text, "jazzy") == []
    text = text.replace("TruncatePathLocal (input_path = {p} output_path = {q})", "Spin")
    assert found(text, "jazzy") == [
        "4:9 hint reactive-multiple-async «FollowPath» if `Spin` takes longer than one tick, it restarts whenever "
        "`FollowPath` is RUNNING, and halts it"
    ]


# ---- version 3 of the engine ----

OF_VERSION_3 = """\
<root main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <ReactiveSequence>
      <Condition ID="IsStuck"/>
      <SequenceStar name="rest">
        <SubTreePlus ID="Other" __autoremap="true"/>
        <SubTree ID="Other" __shared_blackboard="true"/>
        <BlackboardCheckInt value_A="{a}" value_B="1" return_on_mismatch="FAILURE"><IsStuck/></BlackboardCheckInt>
        <Parallel success_threshold="1" failure_threshold="1"><GoalReached goal="${goal}"/></Parallel>
      </SequenceStar>
    </ReactiveSequence>
  </BehaviorTree>
  <BehaviorTree ID="Other"><Wait/></BehaviorTree>
</root>
"""


def test_words_of_version_3_are_right_where_the_nodes_come_with_it() -> None:
    assert found(OF_VERSION_3, "humble") == []
    assert found(OF_VERSION_3, "iron") == []
    assert found(OF_VERSION_3, "jazzy") == [
        "1:2 error version-3-file «root» this file is for version 3 of the engine: it has "
        "`SequenceStar`, `SubTreePlus`, `__autoremap`, `__shared_blackboard` …, but Jazzy has 4.9.1"
    ]


def test_nodes_of_version_4_are_not_in_version_3() -> None:
    text = tree("->", '    Script (code = "a := 1")', "    IsStuck")
    assert found(text, "iron") == [
        "3:9 error newer-engine-node «Script» `Script` requires BehaviorTree.CPP 4; 3.8 does not have it"
    ]
    assert found(text, "jazzy") == []
