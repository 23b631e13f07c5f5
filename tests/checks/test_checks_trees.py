"""nested-too-deep, unknown-tree, duplicate-tree, recursive-tree, unused-tree, unreachable-tree, unknown-main-tree,
tree-root-count, tree-named-like-node: what their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, problems

from btq_lang.catalog.versions import VERSIONS
from btq_lang.workspace.config import Project

PICK = "BehaviorTree Pick\n    X\n"


# ---- nested-too-deep -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("engines", "severity"), [(("4.6",), "error"), (("4.6", "4.10"), "error"), (("4.8",), None), (VERSIONS, "warning")]
)
def test_a_tree_that_4_6_does_not_read(engines: tuple[str, ...], severity: str | None) -> None:
    def nested(levels: int) -> str:
        lines = [f"{' ' * level}Inverter" for level in range(1, levels)]
        return "\n".join(["BehaviorTree Main", *lines, f"{' ' * levels}Action Drive", ""])

    project = Project(engines=engines)
    assert_clean(nested(97), project=project)
    told = f"99:106 {severity} nested-too-deep «Drive» BehaviorTree.CPP 4.6 reads at most 97 levels of nodes"
    assert_problems(nested(98), *([told] if severity is not None else []), project=project)


# ---- unknown-tree ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("runs", "end"),
    [("SubTree Other", "; did you mean `Pick`?"), ("Dock", "; neither this file nor its includes define it")],
)
def test_an_unknown_main_tree_may_be_the_only_one_that_no_other_runs(runs: str, end: str) -> None:
    text = f"Root MainTree\nBehaviorTree Pick\n    {runs}\nBehaviorTree Other\n    Dock\n"
    (found,) = problems(text, "unknown-tree")
    assert found.message == f"unknown tree `MainTree`{end}"


def test_the_way_to_an_unknown_tree() -> None:
    misspelt = "BehaviorTree Main\n    SubTree Pik\n" + PICK
    assert_problems(misspelt, "2:13 error unknown-tree «Pik» unknown tree `Pik`; did you mean `Pick`?")
    assert_fix(misspelt, "Replace `Pik` with `Pick`", misspelt.replace("Pik\n", "Pick\n"))
    node = "Action Pick\nBehaviorTree Main\n    SubTree Pick First\n"
    assert_problems(node, "3:13 error unknown-tree «Pick» `Pick` is a node, not a tree")
    assert_fix(node, "Write only `Pick`", node.replace("SubTree ", ""))


def test_an_include_brings_the_tree() -> None:
    text = """
        //- missions/main.btq
        include "a.btq"
        BehaviorTree Main
            SubTree Pick
        //- missions/a.btq
        //- parts/pick.btq
        BehaviorTree Pick
            X
        """
    assert_problems(
        text,
        "missions/main.btq:3:13 error unknown-tree «Pick» unknown tree `Pick`; "
        "neither this file nor its includes define it",
    )
    fixed = text.replace('include "a.btq"\n', 'include "a.btq"\n        include "../parts/pick.btq"\n')
    assert_fix(text, "Include `../parts/pick.btq`", fixed)


def test_a_file_with_several_definitions_is_proposed_once() -> None:
    (one,) = problems("BehaviorTree Main\n    SubTree Pick\n", "unknown-tree", parts=2 * PICK)
    assert [fix.title for fix in one.fixes] == ["Include `parts.btq`"]


def test_an_include_goes_where_the_others_are() -> None:
    parts = "//- parts.btq\nBehaviorTree Pick\n    X\n"
    for head, fixed in [
        ("", 'include "parts.btq"\n'),
        ("\ufeff", '\ufeffinclude "parts.btq"\n'),
        (
            'include "a.btq" (\n    note = 1\n)  # kept\n',
            'include "a.btq" (\n    note = 1\n)  # kept\ninclude "parts.btq"\n',
        ),
    ]:
        tree = "BehaviorTree Main\n    SubTree Pick\n"
        rest = f"//- a.btq\n{parts}"
        assert_fix(f"//- main.btq\n{head}{tree}{rest}", "Include `parts.btq`", f"//- main.btq\n{fixed}{tree}{rest}")
    in_root = '//- main.btq\nRoot Main\n    include "a.btq"\n    BehaviorTree Main\n        SubTree Pick\n//- a.btq\n'
    assert_fix(
        in_root + parts,
        "Include `parts.btq`",
        in_root.replace('"a.btq"\n', '"a.btq"\n    include "parts.btq"\n', 1) + parts,
    )


def test_a_root_names_a_tree_in_two_ways() -> None:
    for root in ("Root Pik", "Root (main_tree_to_execute = Pik)"):
        column = root.index("Pik") + 1
        assert_problems(
            f"{root}\n{PICK}",
            f"1:{column} error unknown-tree «Pik» unknown tree `Pik`; did you mean `Pick`?",
        )
    assert_clean(f'Root (main_tree_to_execute = "")\n{PICK}')  # 4.10 runs the only tree


def test_what_cannot_be_known_is_not_told() -> None:
    assert_clean('include "parts.xml" (ros_pkg = "robot")\nBehaviorTree Main\n    SubTree Pick\n')
    assert_problems(
        'include "parts.btq"\nBehaviorTree Main\n    SubTree Pick\n',
        '1:9 error missing-include «"parts.btq"» cannot find the file `parts.btq`',
    )
    assert_problems(
        "BehaviorTree Main\n    SubTree Pick\nBehaviorTree = Pick\n    X\n",
        "3:14 error syntax-error «=» expected the end of the line, found `=`",
    )


def test_a_subtree_without_a_name() -> None:
    for subtree in ("SubTree", 'SubTree ""', "SubTree (speed = 1)"):
        assert_problems(
            f"BehaviorTree Main\n    {subtree}\n",
            "2:5 error unknown-tree «SubTree» missing tree of this SubTree: write `SubTree <ID>`",
        )
    assert_problems(
        "BehaviorTree Main\n    SubTree (Pick)\n",
        "2:14 error syntax-error «Pick» expected an attribute: key = value, found `Pick`",
    )


# ---- duplicate-tree, recursive-tree ----------------------------------------------------------------------------------


def test_a_tree_of_two_files() -> None:
    assert_problems(
        f'//- main.btq\ninclude "a.btq"\nBehaviorTree Main\n    SubTree Pick\n{PICK}//- a.btq\n{PICK}',
        "main.btq:4:14 error duplicate-tree «Pick» duplicate tree `Pick`",
    )
    assert_problems(
        f'//- main.btq\ninclude "a.btq"\ninclude "b.btq"\n//- a.btq\n{PICK}//- b.btq\n{PICK}',
        'main.btq:2:9 error duplicate-tree «"b.btq"» this file includes a second tree `Pick`',
    )


def test_doubled_trees_are_told_for_nothing_else() -> None:
    assert_problems(
        "BehaviorTree A\n    X\nBehaviorTree A\n    X\nBehaviorTree A\n    X\n",
        "3:14 error duplicate-tree «A» duplicate tree `A`",
        "5:14 error duplicate-tree «A» duplicate tree `A`",
    )


@pytest.mark.parametrize(
    ("trees", "problems"),
    [
        ({"A": "A"}, ["2:13 error recursive-tree «A» the tree `A` contains itself"]),
        ({"A": "B", "B": "A"}, ["2:13 error recursive-tree «B» the tree `A` contains itself: `A` → `B` → `A`"]),
        (
            {"A": "B", "B": "C", "C": "B"},
            ["4:13 error recursive-tree «C» the tree `B` contains itself: `B` → `C` → `B`"],
        ),
        ({"A": "B", "B": ""}, []),
    ],
)
def test_circles(trees: dict[str, str], problems: list[str]) -> None:
    text = "".join(
        f"BehaviorTree {name}\n    {f'SubTree {called}' if called else 'X'}\n" for name, called in trees.items()
    )
    assert_problems(text, *problems)


@pytest.mark.parametrize(
    "text",
    [
        # What the node of `A` is, only a model says, and the parser could not say of which item it is a part.
        "BehaviorTree A\n    Go (value = {x})\n        A\nTreeNodesModel\n    SubTree A\n",
        "BehaviorTree A\n    ->\n        Go (value = {x})\n        A (value = {x})\nSubTree A\n",
        "BehaviorTree A\n    SubTree B (x = {x})\nBehaviorTree B\n    Inverter\n        A (x = {x})\nSubTree A\n",
        "BehaviorTree A\n    SubTreePlus (ID = B x = {y})\nBehaviorTree B\n    A\nSubTree A\nSubTree B\n",
        "BehaviorTree SubTreePlus\n    SubTreePlus (ID = B x = {y})\nBehaviorTree B\n    SubTree SubTreePlus\n",
        'BehaviorTree ""\n    SubTree "" (x = {y})\n',
    ],
)
def test_circles_through_trees_that_are_declared_have_an_end(text: str) -> None:
    for order in (text, "".join(reversed([f"BehaviorTree {each}" for each in text.split("BehaviorTree ")[1:]]))):
        assert [each.rule for each in problems(order, "recursive-tree")] == ["recursive-tree"]


def test_a_node_that_a_model_declares_runs_its_tree() -> None:
    assert_problems(
        "Root A\nBehaviorTree A\n    ->\n        B\n        X\nBehaviorTree B\n    A\nTreeNodesModel\n"
        "    SubTree A\n    SubTree B\n    Action X\n",
        "4:9 error recursive-tree «B» the tree `A` contains itself: `A` → `B` → `A`",
        "4:9 error unknown-node «B» `B` is a tree, not a node",
        "7:5 error unknown-node «A» `A` is a tree, not a node",
    )


def test_a_knot_of_circles_is_told_once_with_the_shortest_way() -> None:
    assert_problems(
        """
        Root A
        BehaviorTree A
            ->
                SubTree B
                SubTree C
        BehaviorTree B
            SubTree C
        BehaviorTree C
            ->
                SubTree B
                SubTree A
        """,
        "5:17 error recursive-tree «C» the tree `A` contains itself: `A` → `C` → `A`",
    )


def test_the_same_tree_twice_is_no_circle() -> None:
    assert_clean(
        "BehaviorTree A\n    ->\n        SubTree B\n        SubTree C\n"
        "BehaviorTree B\n    SubTree C\nBehaviorTree C\n    X\n"
    )


# ---- unused-tree, unreachable-tree, unknown-main-tree ----------------------------------------------------------------


def test_a_library_may_hold_more_than_is_used() -> None:
    text = (
        f'//- main.btq\ninclude "parts.btq"\nBehaviorTree Main\n    X\n//- parts.btq\n{PICK}BehaviorTree Place\n    X\n'
    )
    assert_clean(text)


def test_nothing_is_unused_where_a_name_is_unknown() -> None:
    assert_problems(
        "Root Main\nBehaviorTree Main\n    SubTree Pik\n" + PICK,
        "3:13 error unknown-tree «Pik» unknown tree `Pik`; did you mean `Pick`?",
    )
    assert_problems(
        "Root Main\nBehaviorTree Main\n    Subtree Pick\n" + PICK,
        "3:5 warning unknown-node «Subtree» unknown node `Subtree`; did you mean `SubTree`?",
    )
    assert_problems(
        "BehaviorTree Main\n    Pick\n" + PICK, "2:5 error unknown-node «Pick» `Pick` is a tree, not a node"
    )
    assert_problems(
        "Root Main\nBehaviorTree Main\n    > SubTree Pick\n" + PICK,
        "3:5 error syntax-error «>» expected a node: its kind, or a symbol: -> ? || …, found `>`",
    )
    assert_clean(f'include "more.xml" (ros_pkg = "robot")\nRoot Main\nBehaviorTree Main\n    X\n{PICK}')


@pytest.mark.parametrize(
    "text",
    [
        "BehaviorTree A\n    SubTree B\nBehaviorTree B\n    X\n",
        "Root B\nBehaviorTree A\n    SubTree B\nBehaviorTree B\n    SubTree A\n",
        "//- a.btq\nBehaviorTree A\n    X\nBehaviorTree B\n    X\n"
        '//- main.btq\ninclude "a.btq"\nBehaviorTree Main\n    SubTree A\n',
    ],
)
def test_the_mission_is_known(text: str) -> None:
    problems = ["3:13 error recursive-tree «B» the tree `A` contains itself: `A` → `B` → `A`"] if "Root" in text else []
    assert_problems(text, *problems)


def test_naming_the_mission() -> None:
    two = "BehaviorTree A\n    X\nBehaviorTree B\n    X\n"
    problem = "warning unknown-main-tree «A» ambiguous main tree: no other tree refers to `A` or `B`"
    assert_problems(two, f"1:14 {problem}")
    assert_fix(two, "Make `B` the main tree", f"Root B\n{two}")
    assert_problems(f"Root ()\n{two}", f"2:14 {problem}")
    assert_fix(f"Root ()\n{two}", "Make `A` the main tree", f"Root A ()\n{two}")
    with_include = f'//- main.btq\n# Both.\ninclude "c.btq"\n{two}//- c.btq\n'
    assert_fix(with_include, "Make `A` the main tree", with_include.replace('"c.btq"\n', '"c.btq"\nRoot A\n', 1))


# ---- tree-root-count, tree-named-like-node ---------------------------------------------------------------------------


def test_a_tree_with_a_node_of_its_own_name() -> None:
    """Such a node cannot mean the tree that it is in; one elsewhere can."""
    error = "1:14 error tree-named-like-node «Hover» a tree cannot have the name `Hover`: a node in it has it"
    assert_problems("BehaviorTree Hover\n    ->\n        Action Hover\n        Hover\n", error)


def test_one_diagnostic_for_all_the_nodes_too_many() -> None:
    assert_problems(
        "BehaviorTree A\n    X (\n        a = 1\n    )\n    Y\n    Z\n",
        "5:5 error tree-root-count «Y» a tree must have one node at its top, found 3",
    )


def test_what_counts_as_the_node_of_a_tree() -> None:
    assert_clean('BehaviorTree A\n    xml "<X/>"\n')
    assert_problems(
        "BehaviorTree\n    input a : int\n",
        "1:1 error tree-root-count «BehaviorTree» a tree must have one node at its top, found none",
    )
    assert_problems(
        "BehaviorTree A\n    = X\n",
        "2:5 error syntax-error «=» expected a node: its kind, or a symbol: -> ? || …, found `=`",
    )


def test_names_of_nodes_that_a_tree_may_have() -> None:
    assert_clean("SubTree Pick\n    input a : int\n" + PICK)  # the tree's own model
    assert_clean("BehaviorTree Retry\n    X\n")  # a word of the language, no tag of the engine
