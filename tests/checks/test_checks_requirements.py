"""unknown-requirement, conflicting-requirement, unused-requirement, requirement-without-text: what their pages do not
show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, fixes, problems

from btq_lang.checks.requirements import AS_PROSE, CLAIMS_OF_MISSION
from btq_lang.grammar.clause_slips import OF_MISSION

TREE = "BehaviorTree Main\n    X satisfies rq1\n"


# ---- unknown-requirement ---------------------------------------------------------------------------------------------


def test_every_way_to_name_a_requirement() -> None:
    assert_problems(
        """
        apply rq1 to every X
        BehaviorTree Main
            satisfies rq2
            X (satisfies QualityReq ID = "rq3")
                satisfies rq4(limit = 3 s)
        """,
        "1:7 error unknown-requirement «rq1» unknown requirement `rq1`; neither this file nor its includes define it",
        "3:15 error unknown-requirement «rq2» unknown requirement `rq2`; neither this file nor its includes define it",
        '4:34 error unknown-requirement «"rq3"» unknown requirement `rq3`; '
        "neither this file nor its includes define it",
        "5:19 error unknown-requirement «rq4» unknown requirement `rq4`; neither this file nor its includes define it",
    )


def test_a_requirement_of_a_file_that_is_not_included() -> None:
    text = f'//- main.btq\n{TREE}//- rules.btq\nQualityReq rq1 "In time"\n'
    assert_fix(text, "Include `rules.btq`", text.replace("BehaviorTree", 'include "rules.btq"\nBehaviorTree', 1))
    assert_clean(text.replace("BehaviorTree", 'include "rules.btq"\nBehaviorTree', 1))
    assert_clean(f'include "rules.xml" (ros_pkg = "robot")\n{TREE}')


def test_a_name_that_needs_quotes() -> None:
    text = 'QualityReq "in time" "Be quick"\nBehaviorTree Main\n    X satisfies "in tme"\n'
    assert_fix(text, "Replace `in tme` with `in time`", text.replace("tme", "time"))


# ---- conflicting-requirement -----------------------------------------------------------------------------------------


def classic(*texts: str) -> str:
    nodes = "".join(f'        X (satisfies QualityReq ID = "rq1" description = "{text}")\n' for text in texts)
    return f"BehaviorTree Main\n    ->\n{nodes}"


def test_one_requirement_in_several_places() -> None:
    assert_clean(classic("In  time", "In time", "In\n        time"))
    assert_clean(classic("In time") + "        Y satisfies rq1\n" + '        Z (satisfies QualityReq ID = "rq1")\n')
    assert_clean('QualityReq rq1 "In time"\nBehaviorTree Main\n    satisfies QualityReq ID = "rq1"\n    X\n')


def test_each_other_text_is_told_against_the_first() -> None:
    told = "conflicting definitions of the requirement `rq1`"
    assert_problems(
        classic("one", "two", "one", "three"),
        f'4:38 error conflicting-requirement «"rq1"» {told}',
        f'6:38 error conflicting-requirement «"rq1"» {told}',
    )


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ('"In time"', '"In time"\n    takes at most 3 s'),
        ('"In time"\n    takes at most 3 s', '"In time"\n    takes at most 4 s'),
        (': safety "In time"', ': security "In time"'),
    ],
)
def test_clauses_and_qualities_are_part_of_what_is_said(first: str, second: str) -> None:
    text = f"QualityReq rq1 {first}\nQualityReq rq1 {second}\n"
    line = first.count("\n") + 2
    assert_problems(
        text,
        f"{line}:12 error conflicting-requirement «rq1» conflicting definitions of the requirement `rq1`",
    )
    assert_clean(f"QualityReq rq1 {second}\nQualityReq rq1 {second}\n")


def test_only_a_definition_at_a_node_can_become_a_reference() -> None:
    (found,) = problems('QualityReq rq1 "one"\nQualityReq rq1 "two"\n', "conflicting-requirement")
    assert found.notes == ("keep one definition, or give this requirement another ID",)
    (found,) = problems(classic("one", "two"), "conflicting-requirement")
    assert found.notes == ("write `satisfies rq1` to refer to it, or use another ID",)


def test_a_definition_that_says_nothing_is_told_for_that_only() -> None:
    assert_problems(
        'QualityReq rq1 "In time"\nQualityReq rq1\n',
        "2:12 warning requirement-without-text «rq1» the requirement `rq1` demands nothing",
    )


def test_two_includes_that_contradict_each_other() -> None:
    assert_problems(
        """
        //- main.btq
        include "a.btq"
        include "b.btq"
        //- a.btq
        QualityReq rq1 "one"
        QualityReq rq2 "same"
        //- b.btq
        QualityReq rq1 "two"
        QualityReq rq2 "same"
        """,
        'main.btq:2:9 error conflicting-requirement «"b.btq"» '
        "this file includes a second requirement `rq1` with different content",
    )


# ---- unused-requirement ----------------------------------------------------------------------------------------------

RULE = 'QualityReq rq1 "In time"\n    takes at most 30 s\n'


@pytest.mark.parametrize(
    "text",
    [
        RULE,  # a file of requirements
        RULE + TREE,
        RULE + "apply rq1 to every X\nBehaviorTree Main\n    X\n",
        RULE.replace("takes", "mission takes") + "BehaviorTree Main\n    X\n",
        RULE.replace("takes", "Main/X takes") + "BehaviorTree Main\n    X\n",
        f'//- a.btq\n{RULE}BehaviorTree A\n    X\n//- main.btq\ninclude "a.btq"\nBehaviorTree Main\n    SubTree A\n',
    ],
)
def test_requirements_that_somebody_uses(text: str) -> None:
    assert_clean(text)


def test_an_unused_requirement_names_the_ways_to_attach_it() -> None:
    assert_problems(
        RULE + "BehaviorTree Main\n    X\n",
        "1:12 warning unused-requirement «rq1» "
        "unused requirement `rq1`: no `satisfies` or `apply` attaches it to a node",
    )


@pytest.mark.parametrize(
    ("clauses", "notes"),
    [
        ("takes at most 30 s", ("of mission",)),
        ('takes at most 30 s|verified by test "TC-1"', ("of mission", "prose")),
        ("takes at most 30 s|verified by review, analysis", ("of mission", "prose")),
        ("takes at most 30 s|verified by monitor, test", ("of mission",)),
        ('verified by test "TC-1"', ("attached to mission",)),
    ],
)
def test_what_is_about_no_node_is_about_the_mission_or_prose(clauses: str, notes: tuple[str, ...]) -> None:
    text = 'QualityReq rq1 "In time"\n    ' + clauses.replace("|", "\n    ") + "\nBehaviorTree Main\n    X\n"
    (found,) = problems(text, "unused-requirement")
    texts = {"attached to mission": OF_MISSION, "of mission": CLAIMS_OF_MISSION, "prose": AS_PROSE}
    assert found.notes == ("attach it to a node with `satisfies rq1` or `apply`", *(texts[each] for each in notes))


def test_a_misspelt_use_is_one_mistake() -> None:
    assert_problems(
        RULE + TREE.replace("rq1", "rq11"),
        "4:17 error unknown-requirement «rq11» unknown requirement `rq11`; did you mean `rq1`?",
    )
    assert_problems(
        RULE + TREE.replace("satisfies", "satisfy"),
        "4:7 error syntax-error «satisfy» unknown word `satisfy`; did you mean `satisfies`?",
    )


# ---- requirement-without-text ----------------------------------------------------------------------------------------


def test_what_could_not_be_read_may_be_what_is_said() -> None:
    assert_problems(
        "QualityReq rq1\n    take at most 30 s\n",
        "2:5 error syntax-error «take» unknown word `take`; did you mean `takes`?",
    )


def test_an_empty_text_says_nothing() -> None:
    assert_problems(
        'QualityReq rq1 " "\n', "1:12 warning requirement-without-text «rq1» the requirement `rq1` demands nothing"
    )
    assert_clean("QualityReq rq1\n    verified by review\n")


# ---- the other word --------------------------------------------------------------------------------------------------


def test_a_requirement_where_a_quality_is_meant_to_stand() -> None:
    message = "`rq1` is a requirement, not a quality"
    text = RULE + "BehaviorTree Main\n    X satisfices {}\n"
    assert_problems(text.format("rq1"), f"4:18 warning unknown-quality «rq1» {message}")
    assert_fix(text.format("rq1"), "Replace `satisfices` with `satisfies`", RULE + TREE, safe=True)
    with_parameter = "QualityReq rq1(d : s)\n    takes at most d\nBehaviorTree Main\n    X {} rq1\n"
    title = "Replace `satisfices` with `satisfies`"
    assert_fix(with_parameter.format("satisfices"), title, with_parameter.format("satisfies"), safe=False)
    assert_problems(text.format("safety, rq1"), f"4:26 warning unknown-quality «rq1» {message}")
    assert_problems(
        RULE + "BehaviorTree Main\n    satisfices rq1\n    X\n", f"4:16 warning unknown-quality «rq1» {message}"
    )


def test_a_quality_where_a_requirement_is_meant_to_stand() -> None:
    text = "quality gentle : safety\nBehaviorTree Main\n    X satisfies {}\n"
    message = "error unknown-requirement «{0}» `{0}` is a quality, not a requirement"
    for quality, safe in (("safety", True), ("gentle", True), ("performance", False)):
        assert_problems(text.format(quality), f"3:17 {message.format(quality)}")
        fixed = text.format(quality).replace("satisfies", "satisfices")
        assert_fix(text.format(quality), "Replace `satisfies` with `satisfices`", fixed, safe=safe)
    assert_problems("apply safety to X\nBehaviorTree Main\n    X\n", f"1:7 {message.format('safety')}")


def test_a_requirement_of_another_file_may_be_called_as_a_quality() -> None:
    assert_problems(
        """
        //- main.btq
        BehaviorTree Main
            X satisfies safety
        //- rules.btq
        QualityReq safety "Carefully"
        """,
        "main.btq:2:17 error unknown-requirement «safety» "
        "unknown requirement `safety`; neither this file nor its includes define it",
    )


# ---- a clause that is misspelt ---------------------------------------------------------------------------------------

MEANT = "did you mean `satisfies`?"


@pytest.mark.parametrize("parent", ["Action X", "->", "Inverter", "X"])
def test_a_misspelt_clause_line_is_read_as_a_node(parent: str) -> None:
    text = f"{RULE}BehaviorTree Main\n    {parent}\n        satisfys rq1\n"
    assert_problems(text, f"5:9 warning clause-as-node «satisfys» btq reads `satisfys` as a node here; {MEANT}")
    if "X" in parent:
        assert_fix(text, "Replace `satisfys` with `satisfies`", text.replace("satisfys", "satisfies"))


def test_a_misspelt_clause_line_with_a_list() -> None:
    text = f"{RULE}BehaviorTree Main\n    Action X\n        satisfys rq1, rq2\n"
    assert_problems(text, "5:9 error syntax-error «satisfys» unknown word `satisfys`; did you mean `satisfies`?")


def test_nodes_that_look_like_clauses() -> None:
    nodes = ("Satisfied a", "satisfied", "satisfy (a = 1)", 'satisfy "b"')
    assert_clean("BehaviorTree Main\n    ->\n" + "".join(f"        {node}\n" for node in nodes))
    assert_clean("Action satisfy\nBehaviorTree Main\n    satisfy hunger\n")


def test_an_action_without_a_claim() -> None:
    text = 'QualityReq rq1 "t"\n    {}\nBehaviorTree Main\n    Action X satisfies rq1\n'
    told = "the requirement `rq1` demands nothing that can be violated, so `on violation {}` has no effect"
    for action in ("fail", "halt", "warn", "log"):
        assert_problems(
            text.replace("{}", f"on violation {action}"),
            f"1:12 warning requirement-without-text «rq1» {told.replace('{}', action)}",
        )
    assert_clean(text.replace("{}", "takes at most 30 s on violation fail"))


WEATHER = """\
signal snow : cm from {{@snow}} initially 0 cm
QualityReq rq1 "Weather"
    assuming snow  <  3 cm
{}BehaviorTree Main
    Action X satisfies rq1
"""


def test_an_assumption_without_a_claim() -> None:
    text = WEATHER.format('    source "client"\n')
    (found,) = problems(text, "requirement-without-text")
    assert found.message == (
        "the requirement `rq1` demands nothing that can be violated, so `assuming snow < 3 cm` has no effect"
    )
    assert found.notes == (
        "an assumption counts for the clauses of its own requirement only: write it in each that relies on it",
    )


@pytest.mark.parametrize("line", ["takes at most 3 s", "verified by review", 'verified by test "T-1"'])
def test_an_assumption_that_counts(line: str) -> None:
    assert_clean(WEATHER.format(f"    {line}\n"))


# ---- what can be said once only ----

USER = "BehaviorTree X\n    Action A\n"


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        ("\n    goal 2 s\n    goal 1 s\n", "a goal: `goal 2 s`"),
        ("\n    confidence 90 %\n    confidence 95 %\n", "a confidence: `confidence 90 %`"),
        ("\n    over last 9 runs\n    over last 3 d\n", "a window: `over last 9 runs`"),
        (
            "\n    in at least 9 % of runs\n    with probability > 9 %\n",
            "how often it must hold: `in at least 9 % of runs`",
        ),
        (" verified by test verified by review\n", "how to verify it: `verified by test`"),
        (
            "\n    in at least 9 % of time\n    in at least 9 % of runs\n    in at least 8 % of time\n",
            "a share of time: `in at least 9 % of time`",
        ),
    ],
)
def test_a_clause_of_a_kind_that_is_said_once(clauses: str, expected: str) -> None:
    text = f'QualityReq a "t"\n    A takes at most 3 s{clauses}{USER}'
    (found,) = problems(text, "duplicate-clause")
    assert found.message == f"the requirement already states {expected}"
    assert [related.message for related in found.related] == ["this one takes effect"]
    assert [fix.safe for fix in found.fixes] == [False, False]


def test_clauses_that_can_be_said_again() -> None:
    text = (
        f'QualityReq a "t"\n    A takes at most 3 s\n    A takes at least 1 s\n    because "x"\n    because "y"\n{USER}'
    )
    assert problems(text, "duplicate-clause") == []


@pytest.mark.parametrize(
    ("before", "after_"),
    [
        ("\n    on violation fail\n    on  violation fail\n", "\n    on violation fail\n"),
        ("\n    on violation fail on violation fail\n", "\n    on violation fail\n"),
        ("\n    on violation fail\n    on violation fail  # so be it\n", "\n    on violation fail\n    # so be it\n"),
        ("\r\n    goal 1 s\r\n    goal 1 s\r\n    because 'y'\r\n", "\r\n    goal 1 s\r\n    because 'y'\r\n"),
        ("\n    goal 1 s\n    goal 1 s because 'y'\n", "\n    goal 1 s\n    because 'y'\n"),
    ],
)
def test_one_that_says_the_same_goes(before: str, after_: str) -> None:
    text = f'QualityReq a "t"\n    A takes at most 3 s{before}{USER}'
    ((_, safe, fixed),) = fixes(text, "duplicate-clause")
    assert safe
    assert fixed == f'QualityReq a "t"\n    A takes at most 3 s{after_}{USER}'


def test_in_one_of_two_equal_definitions_removing_it_would_make_them_differ() -> None:
    definition = 'QualityReq a "t"\n    A takes at most 3 s\n    on violation fail\n    on violation fail\n'
    assert [safe for _, safe, _ in fixes(2 * definition + USER, "duplicate-clause")] == [False, False]


def test_clauses_of_a_requirement_at_its_node() -> None:
    text = (
        "BehaviorTree X\n    A\n        satisfies QualityReq a takes at most 3 s on violation fail on violation log\n"
    )
    assert fixes(text, "duplicate-clause") == [
        ("Remove `on violation log`", False, text.replace(" on violation log", "")),
        ("Remove `on violation fail`", False, text.replace(" on violation fail", "")),
    ]
