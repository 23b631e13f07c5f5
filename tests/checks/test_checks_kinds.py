"""unknown-node, not-an-engine-node, newer-engine-node, category-mismatch, clause-as-node, duplicate-definition: what
their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, workspace_of

from btq_lang.checks import check
from btq_lang.workspace.config import Project


def tree(node: str) -> str:
    return f"BehaviorTree Main\n    ->\n        {node}\n"


# ---- unknown-node ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "node",
    [
        "MoveBase",  # without a palette every name is a node of the robot's own
        "Pack",
        "LoopPoint (queue = {points})",  # programs register loops over types of their own
        "Switch7",  # and switches with more cases
        "Sleep2",
        "Action Rety",  # a category says that there is such a node
        '"Test"',
    ],
)
def test_a_name_that_may_be_meant(node: str) -> None:
    assert_clean(tree(node))


@pytest.mark.parametrize(
    ("slip", "meant"),
    [
        ("sequence", "Sequence"),
        ("Sequences", "Sequence"),
        ("Rety", "Retry"),
        ("inverter", "Inverter"),
        ("RetryUntilSucessfull", "RetryUntilSuccessful"),
        ("Subtree", "SubTree"),
    ],
)
def test_a_slip_of_a_built_in(slip: str, meant: str) -> None:
    assert_problems(tree(slip), f"3:9 warning unknown-node «{slip}» unknown node `{slip}`; did you mean `{meant}`?")
    assert_fix(tree(slip), f"Replace `{slip}` with `{meant}`", tree(meant))


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("Selector", "Fallback"),
        ("selector", "Fallback"),
        ("MemSelector", "Fallback"),
        ("BTSelector", "Fallback"),
        ("SelectorComposite", "Fallback"),
        ("ActiveSelector", "ReactiveFallback"),
        ("MemSequence", "Sequence"),
        ("SequenceNode", "Sequence"),
        ("Not", "Inverter"),
        ("Invert", "Inverter"),
        ("InverterDecorator", "Inverter"),
        ("Succeeder", "ForceSuccess"),
        ("ReturnSuccess", "ForceSuccess"),
        ("FailureIsSuccess", "ForceSuccess"),
        ("Failer", "ForceFailure"),
        ("OneShot", "RunOnce"),
        ("UntilFail", "KeepRunningUntilFailure"),
        ("Wait", "Delay"),
        ("TimeLimit", "Timeout"),
    ],
)
def test_a_name_of_another_engine(written: str, meant: str) -> None:
    message = f"`{written}` is not built into BehaviorTree.CPP 4.6–4.10; did you mean `{meant}`?"
    mission = tree(f"{written}\n            Action Dock")
    assert_problems(mission, f"3:9 warning not-an-engine-node «{written}» {message}")
    node = f'<{written}><Action ID="Dock"/></{written}>'
    xml = f'<root BTCPP_format="4"><BehaviorTree ID="Main">{node}</BehaviorTree></root>'
    assert [found.message for found in check(workspace_of({"main.xml": xml}), "main.xml")] == [message]
    for declared in (f"Control {written}\n", f"BehaviorTree {written}\n    Action Go\n"):
        assert message not in {found.message for found in check(workspace_of({"m.btq": declared + mission}), "m.btq")}
    assert_clean(tree(f"{written} (x = 1)"))  # a node of the program
    assert_clean(tree(f"Decorator {written}\n            Action Dock"))


@pytest.mark.parametrize(
    ("written", "title", "after"),
    [
        ("Selector", "Replace `Selector` with `Fallback`", "Fallback"),
        ("Wait (s = 3)", "Replace `Wait` with `Delay`", "Delay (s = 3)"),
        ("Repeater", "Replace it with `Repeat (num_cycles = -1)`", "Repeat (num_cycles = -1)"),
        ("Loop3", None, None),
        ("Repeater (times = 3)", "Replace `Repeater` with `Repeat`", "Repeat (times = 3)"),
        (
            'UntilSuccess "try again"',
            "Replace it with `RetryUntilSuccessful (num_attempts = -1)`",
            'RetryUntilSuccessful "try again" (num_attempts = -1)',
        ),
    ],
)
def test_a_name_of_another_engine_is_replaced(written: str, title: str | None, after: str | None) -> None:
    child = "\n            Action Dock"
    if title is None:
        assert_problems(tree(written + child), f"3:9 hint unknown-node «{written}» unknown node `{written}`")
    else:
        assert_fix(tree(written + child), title, tree(f"{after}{child}"))


def test_a_parent_without_a_model_is_a_hint() -> None:
    text = tree("Race\n            Action Dock\n            Action Go")
    assert_problems(text, "3:9 hint unknown-node «Race» unknown node `Race`")
    assert_fix(text, "Declare it: `Control Race`", f"Control Race\n{text}")


@pytest.mark.parametrize(("model", "node"), [("Pick", "Pik"), ("MoveBase", "movebase"), ("OpenDoor", "OpenDoors")])
def test_a_slip_of_a_model(model: str, node: str) -> None:
    text = f"Action {model}\n{tree(node)}"
    assert_problems(text, f"4:9 warning unknown-node «{node}» unknown node `{node}`; did you mean `{model}`?")


@pytest.mark.parametrize(
    ("model", "node"),
    [("Pick", "Pack"), ("MoveTo1", "MoveTo2"), ("MoveBaseToDock", "MoveBaseToDesk"), ("Grasp", "Release")],
)
def test_models_of_the_file_alone_are_no_palette(model: str, node: str) -> None:
    assert_clean(f"Action {model}\n{tree(node)}")


def test_where_most_nodes_have_models_one_without_is_a_hint() -> None:
    models = "Action Grasp\nCondition Full\n"
    told = "5:9 hint unknown-node «Release» unknown node `Release`"
    assert_problems(models + tree("Release"), told)
    assert_problems(models + tree("Release\n        Release"), told)
    assert_fix(
        models + tree("Release (force = 3)"),
        "Declare it with its ports: `Action Release`",
        models + "Action Release\n    input force : int\n" + tree("Release (force = 3)"),
    )
    assert_clean(models + tree("Action Release"))  # which says that there is one
    assert_clean(models + tree("Release\n        Wait"))  # nearly as many have none


def test_with_a_palette_a_missing_model_is_told_once() -> None:
    text = """
        TreeNodesModel
            Action Grasp
        BehaviorTree Main
            ->
                Grasp
                Release
                Release
                Action Wait
        """
    assert_problems(
        text,
        "6:9 warning unknown-node «Release» unknown node `Release`",
        "8:16 warning unknown-node «Wait» unknown node `Wait`",
    )
    assert_fix(text, "Declare it: `Action Release`", text.replace("Behavior", "Action Release\n        Behavior"))


def test_what_is_declared_has_the_ports_that_its_uses_show() -> None:
    text = """
        //- main.btq
        include "lib.btq"
        TreeNodesModel
            Action Grasp
        BehaviorTree Main
          ->
            Grasp
            Release (force = 3 slowly = true to = "a b" out = {pose} width = 2)
            SubTree Lib
        //- lib.btq
        BehaviorTree Lib
            Release (width = 0.5 to = 1 out = x far = 30 s _skipIf = "x" name = y) satisfies r
        QualityReq r "Calm"
        """
    model = """Action Release
          input width : double
          input to : string
          inout out
          input far
          input force : int
          input slowly : bool
        """
    title = "Declare it with its ports: `Action Release`"
    assert_fix(text, title, text.replace("Behavior", f"{model}Behavior", 1))


def test_what_is_declared_is_what_its_uses_say() -> None:
    text = """
        TreeNodesModel
            Action Grasp
        BehaviorTree Main
        \t->
        \t\tGrasp
        \t\tGuard (limit = {=})
        \t\tDecorator Guard
        \t\t\tGrasp
        """
    declared = "Decorator Guard\n        \tinout limit\n        "
    title = "Declare it with its ports: `Decorator Guard`"
    assert_fix(text, title, text.replace("Behavior", f"{declared}Behavior"))


def test_a_palette_of_subtrees_says_nothing_of_nodes() -> None:
    assert_clean("TreeNodesModel\n    SubTree Main\n" + tree("Release"))


def test_models_that_nobody_can_see_are_not_missed() -> None:
    """What an XML file declares is not read, nor what a ROS package holds."""
    assert_clean('include "skills.btq" (ros_pkg = "robot")\nTreeNodesModel\n    Action Grasp\n' + tree("Release"))


def test_a_tree_called_as_a_node() -> None:
    pick = "BehaviorTree Pick\n    X\n"
    for node in ("Pick", "Action Pick", "Pick First (object = cup)"):
        column = 16 if node.startswith("Action") else 9
        assert_problems(tree(node) + pick, f"3:{column} error unknown-node «Pick» `Pick` is a tree, not a node")
    assert_fix(tree("Pick First") + pick, "Write `SubTree Pick`", tree("SubTree Pick First") + pick)
    assert_fix(tree("Action Pick") + pick, "Write `SubTree Pick`", tree("SubTree Pick") + pick)


def test_a_tree_called_as_a_node_beside_its_model() -> None:
    text = tree("Pick (object = cup)") + "BehaviorTree Pick\n    X\nSubTree Pick\n    input object\n"
    assert_problems(text, "3:9 error unknown-node «Pick» `Pick` is a tree, not a node")
    assert_fix(text, "Write `SubTree Pick`", text.replace("Pick (", "SubTree Pick (", 1))


@pytest.mark.parametrize("of_tree", ["", '<BehaviorTree ID="Pick"><AlwaysSuccess/></BehaviorTree>'])
@pytest.mark.parametrize("bare", ["<Pick/>", '<Pick name="first"/>', '<Pick object="cup"/>'])
def test_xml_that_calls_a_tree_as_a_node_beside_its_model(of_tree: str, bare: str) -> None:
    """Version 4 does not recognize the node; version 3 runs the tree."""
    model = '<TreeNodesModel><SubTree ID="Pick"><input_port name="object"/></SubTree></TreeNodesModel>'
    text = f'<root{{}}><BehaviorTree ID="Main">{bare}</BehaviorTree>{of_tree}{model}</root>'
    found = check(workspace_of({"a.xml": text.format(' BTCPP_format="4" main_tree_to_execute="Main"')}), "a.xml")
    assert [each.message for each in found if each.rule == "unknown-node"] == ["`Pick` is a tree, not a node"]
    found = check(workspace_of({"a.xml": text.format(' main_tree_to_execute="Main"')}), "a.xml")
    assert [each.message for each in found if each.rule == "unknown-node"] == []


def test_an_explicit_form_without_an_id() -> None:
    assert_problems(tree("Action"), "3:9 error unknown-node «Action» missing ID of this Action: write `Action <ID>`")
    assert_problems(
        tree('Condition ""'), "3:9 error unknown-node «Condition» missing ID of this Condition: write `Condition <ID>`"
    )
    assert_problems(
        tree("Action (ID = )"),
        "3:22 error syntax-error «)» expected a value: a string, a name, a number, a quantity or {key}, found `)`",
    )


def test_one_mistake_in_a_name_is_told_once() -> None:
    palette = "TreeNodesModel\n    Action Grasp\n"
    assert_problems(
        palette + tree("Root"),
        "5:9 error forbidden-name «Root» the engine refuses the node ID `Root`: `Root` is a reserved name",
    )
    assert_problems(
        palette + tree("keeps"),
        "5:9 warning clause-as-node «keeps» btq reads `keeps` as a node here, although it starts a requirement clause",
    )
    assert_problems(
        palette + tree("CoroAction"),
        "5:9 warning not-an-engine-node «CoroAction» `CoroAction` is not built into BehaviorTree.CPP 4.6–4.10",
    )


# ---- not-an-engine-node, newer-engine-node ---------------------------------------------------------------------------


def test_a_quoted_kind_is_the_xml_tag() -> None:
    text = tree('"Retry" (num_attempts = 3)\n            X')
    assert_problems(
        text, '3:9 warning not-an-engine-node «"Retry"» `Retry` is not built into BehaviorTree.CPP 4.6–4.10'
    )
    assert_fix(text, "Remove the quotes", text.replace('"', ""))
    assert_clean(tree('"RetryUntilSuccessful" (num_attempts = 3)\n            X'))
    assert_clean("Decorator Retry\n" + tree('"Retry"\n            X'))  # the program's own


def test_a_word_of_version_3_is_read_as_that_of_today() -> None:
    text = tree("SequenceStar")
    assert_problems(
        text,
        "3:9 error child-count «SequenceStar» `SequenceStar` requires 1 or more children, found none",
        "3:9 warning not-an-engine-node «SequenceStar» `SequenceStar` is not built into BehaviorTree.CPP 4.6–4.10",
    )
    assert_fix(text, "Replace it with `SequenceWithMemory`", tree("SequenceWithMemory"), safe=True)
    plus = "BehaviorTree Main\n    SubTreePlus (ID = Pick)\nBehaviorTree Pick\n    X\n"
    assert_problems(
        plus, "2:5 warning not-an-engine-node «SubTreePlus» `SubTreePlus` is not built into BehaviorTree.CPP 4.6–4.10"
    )
    assert_fix(plus, "Replace it with `SubTree`", plus.replace("Plus", ""))


def test_a_word_of_version_3_is_replaced_by_itself_only_where_no_version_3_reads_it() -> None:
    text = tree("SequenceStar\n            Dock")
    for engines, safe in ((("4.6", "4.10"), True), (("3.8", "4.10"), False)):
        workspace = workspace_of({"main.btq": text}, Project(engines=engines))
        (found,) = check(workspace, "main.btq")
        assert (found.rule, [fix.safe for fix in found.fixes]) == ("not-an-engine-node", [safe])
    assert_clean(text, Project(engines=("3.8",)))


@pytest.mark.parametrize(
    ("node", "engines", "is_own"),
    [
        ("Sleep", ("3.8",), True),
        ("Sleep", ("3.8", "4.10"), False),
        ("Sleep", ("4.6",), False),
        ("Retry", ("3.8",), False),
        ("TryCatch", ("4.6", "4.8"), True),
        ("TryCatch", ("4.8", "4.10"), False),
    ],
)
def test_a_model_counts_before_a_built_in_that_no_version_has(
    node: str, engines: tuple[str, ...], is_own: bool
) -> None:
    text = f"Action {node}\n    input seconds : double\nBehaviorTree Main\n    {node} (seconds = 1)\n"
    workspace = workspace_of({"main.btq": text}, Project(engines=engines))
    assert ([each.rule for each in check(workspace, "main.btq")] == []) == is_own
    without_model = workspace_of({"main.btq": text[text.index("Behavior") :]}, Project(engines=engines))
    assert "unknown-port" in [each.rule for each in check(without_model, "main.btq")]


def test_a_model_with_the_ports_of_a_built_in_is_one_that_an_editor_wrote() -> None:
    text = "Action Sleep\n    input msec : int\nBehaviorTree Main\n    Sleep (msec = 1)\n"
    workspace = workspace_of({"main.btq": text}, Project(engines=("3.8",)))
    assert "newer-engine-node" in [diagnostic.rule for diagnostic in check(workspace, "main.btq")]


def test_a_model_makes_a_word_a_node() -> None:
    assert_clean("Action PopFromQueue\n" + tree("PopFromQueue"))


@pytest.mark.parametrize(
    ("engines", "problem"),
    [
        (("4.10",), None),
        (("4.9", "4.10"), None),
        (
            ("4.8",),
            "error newer-engine-node «TryCatch» `TryCatch` requires BehaviorTree.CPP 4.9; 4.8 does not have it",
        ),
        (
            ("4.6", "4.10"),
            "error newer-engine-node «TryCatch» `TryCatch` requires BehaviorTree.CPP 4.9; 4.6 does not have it",
        ),
    ],
)
def test_the_engines_that_a_project_names(engines: tuple[str, ...], problem: str | None) -> None:
    text = tree("TryCatch\n            X\n            Y")
    assert_problems(text, *([f"3:9 {problem}"] if problem else []), project=Project(engines=engines))


# ---- category-mismatch -----------------------------------------------------------------------------------------------


def test_only_what_can_stay_as_it_is_is_mended_safely() -> None:
    fits = "Condition Open\n" + tree("Action Open")
    assert_problems(
        fits,
        "4:9 warning category-mismatch «Action» `Open` is written as Action, but its model declares it as Condition",
    )
    assert_fix(fits, "Replace it with `Condition`", fits.replace("        Action", "        Condition"), safe=True)
    childless = "Decorator Slow\n" + tree("Action Slow")  # a decorator without a child would be the next mistake
    assert_problems(
        childless,
        "4:9 warning category-mismatch «Action» `Slow` is written as Action, but its model declares it as Decorator",
    )
    assert_fix(childless, "Replace it with `Decorator`", childless.replace("        Action", "        Decorator"))


def test_categories_that_agree_or_that_nobody_knows() -> None:
    assert_clean("Condition Open\n" + tree("Condition Open"))
    assert_clean(tree("Control Sequence\n            X"))
    assert_clean(tree("Control Own\n            X"))
    assert_clean(
        "SubTree Pick\n    input object : string\n" + tree("SubTree Pick (object = cup)") + "BehaviorTree Pick\n    X\n"
    )


def test_a_category_in_small_letters() -> None:
    assert_fix(
        "BehaviorTree A\n    action Lower\n", "Replace `action` with `Action`", "BehaviorTree A\n    Action Lower\n"
    )
    assert_clean("BehaviorTree A\n    action\n")


# ---- clause-as-node --------------------------------------------------------------------------------------------------


def test_a_node_may_be_called_as_a_clause() -> None:
    assert_clean(tree('"keeps"'))
    assert_clean(tree("Action keeps"))
    assert_clean("Action goal\n" + tree("goal"))
    assert_problems(tree("every\n            X"), "3:9 hint unknown-node «every» unknown node `every`")
    assert_fix(tree("goal"), 'Write "goal" for a node of that name', tree('"goal"'))


def test_a_clause_that_the_parser_has_told_is_not_told_again() -> None:
    assert_problems(
        tree("takes at most 30 s"),
        "3:9 error syntax-error «takes» unexpected clause `takes` in a tree; clauses go in a requirement",
    )


# ---- duplicate-definition --------------------------------------------------------------------------------------------


def test_models_with_one_interface_repeat_each_other() -> None:
    assert_clean(
        'Action A "one"\n    input x : int = 1 "x"\nAction A "two"\n    input x : int = 1\nBehaviorTree T\n    A\n'
    )
    assert_problems(
        "Action A\n    input x : int = 1\nAction A\n    input x : int = 2\n",
        "3:8 warning duplicate-definition «A» duplicate definition of the node model `A`",
    )
    assert_problems(
        "Action A\nCondition A\n",
        "2:11 warning duplicate-definition «A» duplicate definition of the node model `A`",
    )


def test_what_differs_between_two_models_is_said() -> None:
    first = "Action A\n    input x : int = 1\n    input y\n    input z\n"
    second = "Condition A\n    input x : string = 2\n    output y\n"
    workspace = workspace_of({"main.btq": first + second})
    (found,) = check(workspace, "main.btq")
    assert found.notes == (
        "they differ in the category (Action, Condition), the type of `x`, the default of `x`, the direction of `y`, "
        "the port `z`, which only one has",
    )


def test_one_name_for_things_of_different_kinds() -> None:
    assert_clean('signal load : kg\ncontext heavy : load > 3 kg\nquality load : safety\nQualityReq load "light"\n')


def test_two_includes_that_clash_are_told_where_they_meet() -> None:
    assert_problems(
        """
        //- main.btq
        include "a.btq"
        include "b.btq"
        //- a.btq
        signal load : kg
        Action Lift
        //- b.btq
        signal load : N
        Action Lift
        """,
        'main.btq:2:9 error duplicate-definition «"b.btq"» this file includes a second definition of the signal `load`',
    )


def test_a_file_that_comes_in_two_ways_clashes_with_nothing() -> None:
    assert_clean(
        """
        //- main.btq
        include "a.btq"
        include "b.btq"
        include "base.btq"
        //- a.btq
        include "base.btq"
        //- b.btq
        include "base.btq"
        //- base.btq
        signal load : kg
        """
    )


def test_a_clash_inside_an_included_file_is_told_there() -> None:
    assert_problems(
        """
        //- main.btq
        include "other.btq"
        include "a.btq"
        //- a.btq
        include "base.btq"
        signal load : N
        //- base.btq
        signal load : kg
        //- other.btq
        signal speed : m/s
        """,
        "a.btq:2:8 error duplicate-definition «load» duplicate definition of the signal `load`",
    )
