"""What the checks of requirements' measurable part report, and fix, that their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems

from btq_lang.checks import check
from btq_lang.workspace.workspace import Workspace

SPEED = "signal speed : m/s from {speed} initially 0 m/s\n"


@pytest.mark.parametrize(
    ("clause", "title", "mended"),
    [
        ("keeps speed <= 3", "Write `3 m/s`", "keeps speed <= 3 m/s"),
        ("keeps speed <= -3", "Write `-3 m/s`", "keeps speed <= -3 m/s"),
        ("takes at most 30", "Write `30 s`", "takes at most 30 s"),
        ("keeps speed <= 3 m/s²", "Write `^2`", "keeps speed <= 3 m/s^2"),
        ("keeps sped <= 3 m/s", "Replace `sped` with `speed`", "keeps speed <= 3 m/s"),
        ("Mian/X takes at most 3 s", "Replace `Mian` with `Main`", "Main/X takes at most 3 s"),
        ("every Y takes at most 3 s", "Replace `Y` with `X`", None),
        ("Xylophon takes at most 3 s", "Replace `Xylophon` with `Xylophone`", "Xylophone takes at most 3 s"),
    ],
)
def test_what_was_probably_meant(clause: str, title: str, mended: str | None) -> None:
    text = SPEED + 'QualityReq rq1 "t"\n    {}\nBehaviorTree Main\n    ->\n        Action X satisfies rq1\n'
    text += '        Script (code = "@speed := 1.0")\n        Action Xylophone\n'
    if mended is None:
        with pytest.raises(AssertionError):
            assert_fix(text.replace("{}", clause), title, "")
    else:
        wrong, right = (text.replace("{}", each) for each in (clause, mended))
        assert_fix(wrong, title, right)


def test_a_name_that_needs_quotes_is_offered_with_them() -> None:
    text = 'QualityReq rq1 "t"\n    keeps true\n    while {}\nBehaviorTree A\n    ->\n        Pick "dock it"\n'
    text += "        Action X satisfies rq1\n"
    assert_fix(text.format("dock_it"), "Replace `dock_it` with `dock it`", text.format('"dock it"'))


def test_the_names_of_several_nodes_are_offered() -> None:
    text = 'QualityReq rq1 "t"\n    {} takes at most 3 s\nBehaviorTree A\n    ->\n        Action X\n'
    text += "        Action X Last\n        SubTree B\nBehaviorTree B\n    Action X\n"
    for path in ("Last", "B/X"):
        assert_fix(text.replace("{}", "X"), f"Write `{path}`", text.replace("{}", path))


def test_one_mistake_in_a_definition_is_told_once() -> None:
    assert_problems(
        SPEED
        + 'QualityReq slow(limit : m/s = 1 m/s) "t"\n    keeps sped <= limit\n'
        + "apply slow to every X\napply slow(limit = 3) to One\n"
        + 'BehaviorTree Main\n    ->\n        Script (code = "@speed := 1.0")\n'
        + "        Action X One\n        Action X Two\n",
        "3:11 error unknown-signal «sped» unknown signal `sped`; did you mean `speed`?",
        "5:20 error number-without-unit «3» missing unit after `3`; expected a speed",
    )


def test_what_an_included_file_says_is_told_in_it() -> None:
    assert_problems(
        """
        //- main.btq
        include "rules.btq"
        BehaviorTree Main
            Action X satisfies rq1
        //- rules.btq
        QualityReq rq1 "t"
            takes at most 3 m
        """,
        "rules.btq:2:19 error unit-mismatch «3 m» expected a time, found `3 m` (a length)",
    )


def test_a_signal_that_fits_nothing() -> None:
    assert_problems(
        """
        signal a : m initially 3
        signal b : bool initially 3
        signal c : text initially 3 m
        signal d : 1 fresh within 3 m
        """,
        "1:24 error number-without-unit «3» missing unit after `3`; expected a length",
        "2:27 error unit-mismatch «3» expected `true` or `false`, found `3`",
        "3:27 error unit-mismatch «3 m» expected a text in quotes, found `3 m`",
        "4:27 error unit-mismatch «3 m» expected a time, found `3 m` (a length)",
    )


def test_a_file_without_any_tree_is_for_others() -> None:
    assert_clean('QualityReq rq1 "t"\n    Somewhere/Else takes at most 3 s\n')


def test_a_number_with_an_unknown_unit_is_told_once() -> None:
    assert_problems(
        'QualityReq rq1 "t"\n    takes at most 45 sek\nBehaviorTree Main\n    Action X satisfies rq1\n',
        "2:22 error unknown-unit «sek» unknown unit `sek`; did you mean `s`?",
    )


def test_an_unknown_signal_is_declared_in_the_unit_of_what_is_wanted() -> None:
    text = "QualityReq soon\n    takes at most PT30S\nBehaviorTree Main\n    Dock satisfies soon\n"
    (found,) = check(Workspace.of({"main.btq": text}), "main.btq")
    assert found.notes == ("declare it: `signal PT30S : s from {PT30S}`",)


@pytest.mark.parametrize(
    ("compared", "unit"),
    [("< 20 %", "%"), ("< 3 m/s", "m/s"), ("< speed", "m/s"), ('== "full"', "text"), ("== true", "bool")],
)
def test_an_unknown_signal_is_declared_in_the_unit_of_what_it_is_compared_with(compared: str, unit: str) -> None:
    workspace = Workspace.of({"main.btq": f"signal speed : m/s from {{speed}}\ncontext low : batery {compared}\n"})
    (found,) = check(workspace, "main.btq")
    assert found.notes == (f"declare it: `signal batery : {unit} from {{batery}}`",)


def test_the_near_name_comes_before_the_declaration() -> None:
    text = "signal battery : % from {battery}\ncontext low : batery < 20 %\n"
    (found,) = check(Workspace.of({"main.btq": text}), "main.btq")
    assert found.notes == ("or declare it: `signal batery : % from {batery}`",)
    assert [fix.title for fix in found.fixes] == ["Replace `batery` with `battery`"]


@pytest.mark.parametrize(
    ("subject", "clause", "of"),
    [
        ("from X starts to Y succeeds", "succeeds within 3 s", "the time from one event to another"),
        ("from X starts to Y succeeds", "keeps speed <= 3 m/s", "the time from one event to another"),
        ("sum of X, Y", "tries at most 3", "a sum of durations"),
    ],
)
def test_what_only_a_node_can_do(subject: str, clause: str, of: str) -> None:
    verb = clause.partition(" ")[0]
    tree = 'BehaviorTree Main\n    ->\n        Action X\n        Action Y\n        Script (code = "@speed := 1.0")\n'
    assert_problems(
        f'{SPEED}QualityReq rq1 "t"\n    {subject} {clause}\n    X keeps speed <= 3 m/s\n{tree}',
        f"3:5 warning requirement-without-subject «{subject} {clause}» "
        f"`{verb}` is about a node, not about {of}, so nothing can check it",
    )
    assert_clean(f'{SPEED}QualityReq rq1 "t"\n    {subject} takes at most 3 s\n    X keeps speed <= 3 m/s\n{tree}')


@pytest.mark.parametrize("confidence", ["0 %", "100 %", "120 %"])
def test_a_confidence_that_no_number_of_runs_gives(confidence: str) -> None:
    assert_problems(
        'QualityReq rq1 "t"\n    X succeeds\n    in at least 90 % of runs\n'
        f"    confidence {confidence}\nBehaviorTree Main\n    Action X\n",
        f"4:16 error impossible-odds «{confidence}» "
        f"expected a confidence above 0 and below 100 %, found `{confidence}`",
    )
