"""child-count, switch-cases, parallel-threshold: what their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, fixes, problems


def tree(*lines: str) -> str:
    return "".join(f"{line}\n" for line in ("BehaviorTree Main", *(f"    {line}" for line in lines)))


def test_numbers_of_children() -> None:
    assert_clean(tree("->", "    X"))
    assert_clean(tree("IfThenElse", "    X", "    Y", "    Z"))
    assert_clean("Control Own\n" + tree("Own", "    X", "    Y"))
    assert_clean(tree("PipelineSequence", "    X", "    Y"))  # of Nav2, whose category nobody knows
    assert_clean(tree("->", '    xml "<X/>"'))
    assert_problems(tree("->"), "2:5 error child-count «->» `->` requires 1 or more children, found none")
    assert_problems(
        tree("Inverter", "    X", "    Y"),
        "2:5 error child-count «Inverter» `Inverter` requires exactly 1 child, found 2",
    )
    assert_problems(
        tree("WhileDoElse", "    W", "    X", "    Y", "    Z"),
        "2:5 error child-count «WhileDoElse» `WhileDoElse` requires 2 to 3 children, found 4",
    )
    assert_problems(
        tree("SubTree Pick", "    X") + "BehaviorTree Pick\n    X\n",
        "2:13 error child-count «Pick» `Pick` requires no children, found 1",
    )


def test_what_the_category_says() -> None:
    assert_problems(
        tree("Decorator Slow"),
        "2:15 error child-count «Slow» the Decorator `Slow` requires exactly 1 child, found none",
    )
    assert_problems(
        "Action Move\n" + tree("Move", "    X"),
        "3:5 error child-count «Move» the Action `Move` requires no children, found 1",
    )


def test_where_two_categories_disagree_only_that_is_told() -> None:
    assert_problems(
        "Decorator Slow\n" + tree("Action Slow", "    X"),
        "3:5 warning category-mismatch «Action» `Slow` is written as Action, but its model declares it as Decorator",
    )


def test_a_child_that_could_not_be_read_is_not_missed() -> None:
    assert_problems(
        tree("->", "    Inverter", "        = X", "    Y"),
        "4:13 error syntax-error «=» expected a node: its kind, or a symbol: -> ? || …, found `=`",
    )
    assert_problems(
        tree("->", "    Inverter", "    Y", "    = X"),
        "3:9 error child-count «Inverter» `Inverter` requires exactly 1 child, found none",
        "5:9 error syntax-error «=» expected a node: its kind, or a symbol: -> ? || …, found `=`",
    )


def test_children_too_many_are_told_where_something_before_them_could_not_be_read() -> None:
    assert_problems(
        tree("Inverter", "    = X", "    Y", "    Z"),
        "2:5 error child-count «Inverter» `Inverter` requires exactly 1 child, found 2",
        "3:9 error syntax-error «=» expected a node: its kind, or a symbol: -> ? || …, found `=`",
    )


# ---- Switch ----------------------------------------------------------------------------------------------------------

CASES = "variable = {x} case_1 = a case_2 = b"


def test_a_switch_by_its_children() -> None:
    assert_clean(tree(f"Switch ({CASES})", "    X", "    Y", "    Z"))
    assert_problems(tree(f"Switch ({CASES})", "    X"), "2:5 error switch-cases «Switch» `Switch` has 1 child")
    assert_problems(tree("Switch"), "2:5 error switch-cases «Switch» `Switch` has no children")
    assert_problems(
        tree(f"Switch ({CASES})", *["    X"] * 8), "2:5 error switch-cases «Switch» `Switch` has 8 children"
    )
    assert_problems(
        tree(f"Switch ({CASES})", *["    X"] * 5),
        "2:5 warning switch-cases «Switch» `Switch` lacks `case_3` and `case_4`",
    )


@pytest.mark.parametrize("switch", ["Switch", "Switch2", '"Switch2"'])
def test_a_case_too_many_is_told_once(switch: str) -> None:
    text = tree(f"{switch} ({CASES} case_3 = c)", "    X", "    Y", "    Z")
    column = text.index("case_3") - text.index("\n")
    shown = switch.strip('"')
    assert_problems(text, f"2:{column} error switch-cases «case_3» `{shown}` has no case `case_3`")
    of_children = "with 3 children its cases are `case_1` to `case_2`: one child for each, and the last for the default"
    note = of_children if switch == "Switch" else "three cases need `Switch3`, with four children"
    assert [problem.notes for problem in problems(text, "switch-cases")] == [(note,)]


def test_a_numbered_switch_counts_its_children() -> None:
    assert_problems(
        tree(f"Switch2 ({CASES})", "    X", "    Y"),
        "2:5 error child-count «Switch2» `Switch2` requires exactly 3 children, found 2",
    )


def test_strange_numbers_of_cases() -> None:
    for key in ("case_0", "case_" + "9" * 5_000):
        text = tree(f"Switch2 ({CASES} {key} = c)", "    X", "    Y", "    Z")
        column = text.index(key) - text.index("\n")
        assert_problems(text, f"2:{column} error switch-cases «{key}» `Switch2` has no case `{key}`")
    assert_problems(
        tree(f"Switch2 ({CASES} case_x = c)", "    X", "    Y", "    Z"),
        "2:51 error unknown-port «case_x» `Switch2` has no port `case_x`",
    )


# ---- Parallel --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "ports", ["", " (success_count = 2)", " (success_count = -1 failure_count = 2)", " (success_count = {n})"]
)
def test_thresholds_that_can_be_reached(ports: str) -> None:
    assert_clean(tree(f"||{ports}", "    X", "    Y"))


def test_thresholds_out_of_reach() -> None:
    text = tree("|| (success_count = 2)", "    X")
    assert_problems(text, "2:25 error parallel-threshold «2» `success_count` is 2, but the node has only 1 child")
    assert_fix(text, "Write `-1` for all children", text.replace("= 2", "= -1"))
    assert_problems(
        tree("All|| (max_failures = 3)", "    X", "    Y"),
        "2:27 error parallel-threshold «3» `max_failures` is 3, but the node has only 2 children",
    )


def test_without_children_that_is_the_mistake() -> None:
    assert_problems(
        tree("|| (success_count = 2)"), "2:5 error child-count «||» `||` requires 1 or more children, found none"
    )


@pytest.mark.parametrize(
    "parent", ["Parallel (success_count = 3)", "Switch2 (variable = {x} case_1 = 1 case_2 = 2)", "Inverter"]
)
def test_nothing_is_said_of_children_that_forgotten_brackets_may_have_swallowed(parent: str) -> None:
    assert_problems(
        f"BehaviorTree Main\n    {parent}\n        X (x = 1\n        Y\n        Z\n",
        "3:11 error unclosed-bracket «(» missing `)` for this `(`",
    )


BELOW_ONE = "Put them below a Sequence `->`"


def test_two_children_are_put_below_a_sequence() -> None:
    text = tree("Inverter", "    Action A (x = 1", "        y = 2)", "", "    # why", "    ?", "        B", "        C")
    after = tree(
        *("Inverter", "    ->", "        Action A (x = 1", "            y = 2)", ""),
        *("        # why", "        ?", "            B", "            C"),
    )
    assert_fix(text, BELOW_ONE, after)


def test_two_nodes_of_a_tree_are_put_below_a_sequence() -> None:
    assert_fix("BehaviorTree Main\n\tA\n\tB\n", BELOW_ONE, "BehaviorTree Main\n\t->\n\t\tA\n\t\tB\n")
    ports = "BehaviorTree Main\n    input x\n"
    assert_fix(f"{ports}    A\n    B\n# end\n", BELOW_ONE, f"{ports}    ->\n        A\n        B\n# end\n")


def test_a_string_over_lines_is_not_indented() -> None:
    assert fixes(tree("Inverter", '    A (x = "1', '    2")', "    B"), "child-count") == []


LEAF = "Action Go\nAction Turn\n"
NOT_IN = "`Go` takes no children: it goes where those below it are"


@pytest.mark.parametrize("before", [(), ("    Turn",), ("    ?", "        Turn")])
def test_a_line_at_the_top_that_is_indented_less_than_its_siblings(before: tuple[str, ...]) -> None:
    text = LEAF + tree("->", *before, "Go", "    Turn", "    ?", "        Turn")
    assert_problems(
        text,
        f"{5 + len(before)}:5 error tree-root-count «Go» a tree must have one node at its top, found 2",
    )
    assert [problem.notes for problem in problems(text, "tree-root-count")] == [(NOT_IN,)]
    assert_fix(text, "Indent it below `->`", LEAF + tree("->", *before, "    Go", "    Turn", "    ?", "        Turn"))


def test_a_line_in_a_tree_that_is_indented_less_than_its_siblings() -> None:
    text = LEAF + tree("?", "    ->", "    Go", "        Turn", "        Turn")
    assert_problems(text, "6:9 error child-count «Go» the Action `Go` requires no children, found 2")
    assert_fix(text, "Indent it below `->`", LEAF + tree("?", "    ->", "        Go", "        Turn", "        Turn"))


def test_another_line_that_may_be_indented_wrongly() -> None:
    text = LEAF + tree("->", "    Turn", "Go", "  Turn")
    assert [problem.rule for problem in problems(text, "child-count", "tree-root-count")] == [
        *("child-count", "tree-root-count")
    ]
    assert fixes(text, "child-count") == []


def test_nothing_is_said_of_enforcement_at_a_node_with_a_wrong_number_of_children() -> None:
    claim = "QualityReq r : reliability\n    takes at most 3 s\n    on violation halt\n"
    main = tree("->", "    Go satisfies r", '        Precondition (if = "a")', "            Turn")
    text = LEAF + claim + main
    assert [problem.message for problem in problems(text, "child-count")] == [
        "the Action `Go` requires no children, found 1"
    ]
    assert problems(text, "not-enforced") == []


def test_a_leaf_gets_no_sequence() -> None:
    assert fixes(tree("AlwaysSuccess", "    A", "    B"), "child-count") == []


def test_a_branch_of_several_nodes() -> None:
    (found,) = problems(tree("IfThenElse", "    Near", "    Go", "    Turn", "    Stop"), "child-count")
    assert found.notes == (
        "the engine loads this and throws when the node is ticked",
        "put the nodes of each branch below a Sequence",
    )
