"""forbidden-name, duplicate-instance-name: what their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems

from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

OLD = Project(engines=("4.6",))


def tree(*lines: str) -> str:
    return "".join(f"{line}\n" for line in ("BehaviorTree Main", *(f"    {line}" for line in lines)))


# ---- forbidden-name --------------------------------------------------------------------------------------------------


def test_a_tree_is_renamed_wherever_it_is_named() -> None:
    text = """
        //- main.btq
        include "parts.btq"
        Root "Move tubes"
        BehaviorTree "Move tubes"
            SubTree "3 tubes"
        //- parts.btq
        BehaviorTree "3 tubes"
            X
        """
    assert_problems(
        text,
        'main.btq:3:14 warning forbidden-name «"Move tubes"» '
        "the engine refuses the tree ID `Move tubes`: it contains a space",
        'parts.btq:1:14 warning forbidden-name «"3 tubes"» '
        "the engine refuses the tree ID `3 tubes`: it contains a space",
    )
    assert_fix(text, "Rename it to `Move_tubes` everywhere", text.replace('"Move tubes"', "Move_tubes"))
    parts = '//- parts.btq\nBehaviorTree "3 tubes"\n    X\n//- main.btq\ninclude "parts.btq"\n' + tree(
        'SubTree "3 tubes"'
    )
    assert_fix(parts, "Rename it to `_3_tubes` everywhere", parts.replace('"3 tubes"', "_3_tubes"))


def test_a_new_name_is_not_taken() -> None:
    text = 'Root "a b"\nBehaviorTree "a b"\n    SubTree a_b\nBehaviorTree a_b\n    X\n'
    assert_fix(text, "Rename it to `a_b_` everywhere", text.replace('"a b"', "a_b_"))


@pytest.mark.parametrize(
    ("name", "others", "taken", "free"),
    [
        ("Charged?", "BehaviorTree Charged\n    X\n", "`Charged`, which is the tree `Charged`", "Charged_"),
        ("a b", 'BehaviorTree "a.b"\n    X\n', "`a_b`, which is the tree `a.b`", "a_b_"),
        ("Dock?", "Action Dock\n", "`Dock`, which is the node `Dock`", "Dock_"),
        ("Fallback?", "", "`Fallback`, which is a built-in node", "Fallback_"),
    ],
)
@pytest.mark.parametrize("place", ["here", "included", "including"])
def test_a_tree_whose_mended_name_is_taken_is_an_error(
    name: str, others: str, taken: str, free: str, place: str
) -> None:
    text = f'Root "{name}"\nBehaviorTree "{name}"\n    Y\n'
    files = {"main.btq": text + others}
    if place == "included":
        files = {"main.btq": f'include "other.btq"\n{text}', "other.btq": others or "Action X\n"}
    elif place == "including":
        files = {"main.btq": text, "other.btq": f'include "main.btq"\n{others}'}
    workspace = Workspace.of(files)
    (found,) = [each for each in check(workspace, "main.btq") if each.rule == "forbidden-name" and name in each.message]
    assert (found.effective_severity, found.notes) == (Severity.ERROR, (f"`btq build` cannot write it as {taken}",))
    assert found.fixes[0].title == f"Rename it to `{free}` everywhere"


def test_a_forbidden_name_is_told_where_the_tree_is() -> None:
    """Not at each of its SubTrees, nor where a SubTree names a missing tree."""
    assert_problems(
        tree("->", '    SubTree "a b"', '    SubTree "a b"') + 'BehaviorTree "a b"\n    X\n',
        '5:14 warning forbidden-name «"a b"» the engine refuses the tree ID `a b`: it contains a space',
    )
    assert_problems(
        tree('SubTree "a b"'),
        '2:13 error unknown-tree «"a b"» unknown tree `a b`; neither this file nor its includes define it',
    )
    assert_problems(
        'include "parts.xml" (ros_pkg = "robot")\n' + tree('SubTree "a b"'),
        '3:13 warning forbidden-name «"a b"» the engine refuses the tree ID `a b`: it contains a space',
    )


def test_the_first_engine_takes_every_name() -> None:
    assert_clean('BehaviorTree "a b"\n    "c d" "e\\n"\n', OLD)


@pytest.mark.parametrize("name", ["BatteryLow?", '"Move Base"', '"a.b"'])
def test_a_node_may_have_any_id_in_the_explicit_form(name: str) -> None:
    shown = name.strip('"')
    text = tree(name)
    (why,) = [why for mark, why in ((" ", "a space"), ("?", "`?`"), (".", "`.`")) if mark in shown]
    assert_problems(
        text, f"2:5 error forbidden-name «{name}» the engine refuses the node ID `{shown}`: it contains {why}"
    )
    assert_fix(text, f"Add its category: `Action {name}`", tree(f"Action {name}"))
    assert_clean(tree(f"Action {name}"))


def test_the_category_follows_the_model_or_the_children() -> None:
    model = "Condition BatteryLow?\n"
    assert_fix(
        model + tree("BatteryLow?"),
        "Add its category: `Condition BatteryLow?`",
        model + tree("Condition BatteryLow?"),
    )
    assert_fix(tree("Slow?", "    X"), "Add its category: `Decorator Slow?`", tree("Decorator Slow?", "    X"))


def test_an_instance_may_be_called_anything_but_this() -> None:
    assert_clean(tree('X "Drive to the shelf: 3 * 4 < 5?"'))
    assert_clean(tree('X "two\\nlines"'))
    assert_problems(
        tree('X "a\x07b"'),
        '2:7 error forbidden-name «"a\x07b"» '
        "the engine refuses the instance name `a\x07b`: it contains the control character U+0007",
    )


def test_ports_of_a_subtrees_model() -> None:
    """Those of other nodes' models the engine never reads."""
    assert_problems(
        "SubTree Pick\n    input name\nAction Move\n    input name\n",
        "2:11 error forbidden-name «name» "
        "the engine refuses the port name `name`: it is the name of a reserved attribute",
    )


def test_a_tree_without_an_id() -> None:
    assert_clean("BehaviorTree\n    X\n")
    assert_clean("quality a : safety\nBehaviorTree\n    X\n")  # which is not in the XML
    for other in ("Action X\n", "BehaviorTree Other\n    X\n"):
        assert_problems(
            f"BehaviorTree\n    X\n{other}",
            "1:1 error forbidden-name «BehaviorTree» missing ID of this tree: write `BehaviorTree <ID>`",
        )


# ---- duplicate-instance-name -----------------------------------------------------------------------------------------


def test_names_that_are_not_doubled() -> None:
    assert_clean(tree("->", "    X One", "    X Two", "    X", "    X"))
    assert_clean(tree("->", "    X X", "    X X"))  # the ID is no name: the engine adds a number
    assert_clean(tree("->", '    X ""', '    Y ""'))
    assert_clean(tree("->", "    X One", "    SubTree Pick One") + "BehaviorTree Pick\n    X One\n")


def test_every_further_node_of_a_name_is_told() -> None:
    assert_problems(
        tree("->", "    X One", "    Y (name = One)", '    Z "One"'),
        "4:19 hint duplicate-instance-name «One» "
        "two nodes of this tree have the name `One`: logs show the same path for both",
        '5:11 hint duplicate-instance-name «"One"» '
        "two nodes of this tree have the name `One`: logs show the same path for both",
    )


def test_subtrees_without_a_name_of_their_own() -> None:
    pick = "BehaviorTree Pick\n    X\n"
    assert_clean(tree("->", "    SubTree Pick", "    SubTree Pick") + pick)
    assert_problems(
        tree("->", "    SubTree Pick Pick", "    SubTree Pick Pick") + pick,
        "4:22 warning duplicate-instance-name «Pick» the engine refuses two SubTrees with the name `Pick` in one tree",
    )
    assert_problems(
        tree('SubTree Pick ""') + pick,
        '2:18 warning forbidden-name «""» '
        "the engine refuses the instance name ``: it is empty, like the name of the main tree",
    )
    assert_clean(tree("SubTree Pick") + 'BehaviorTree Pick\n    SubTree Place ""\nBehaviorTree Place\n    X\n')


def test_what_a_forgotten_quote_may_have_swallowed_is_not_called_unknown() -> None:
    assert_problems(
        """
        Root a

        BehaviorTree a
            ->
                SubTree b
                Go (place = "home)
                Go (place = "shelf")
                SubTree c

        BehaviorTree b
            Act (x = "y")

        BehaviorTree c
            Act (x = "y z")
        """,
        '6:21 error unclosed-string «"home)» a closing " is probably missing: '
        "this string ends at the next one, on another line",
    )


def test_an_empty_name_of_a_subtree_is_told_once() -> None:
    assert_problems(
        'include "x.btq"\nBehaviorTree Main\n    SubTree ""\n',
        '1:9 error missing-include «"x.btq"» cannot find the file `x.btq`',
        "3:5 error unknown-tree «SubTree» missing tree of this SubTree: write `SubTree <ID>`",
    )
