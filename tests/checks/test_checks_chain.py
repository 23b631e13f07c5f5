"""Hazards and the requirements that mitigate them, requirements that refine others, and what their IDs must not be."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems

HAZARD = 'hazard H1 "Collision"\n'
TOP = 'QualityReq top "Top"\n    mission takes at most 1 h\n'


def test_a_hazard_is_declared_once() -> None:
    assert_problems(
        HAZARD + 'hazard H1 "Crushing"\n',
        "2:8 error duplicate-definition «H1» duplicate definition of the hazard `H1`",
    )


def test_hazards_and_requirements_share_their_ids() -> None:
    assert_problems(
        HAZARD + 'QualityReq H1 "Safe"\n',
        "1:8 error duplicate-definition «H1» the hazard and the requirement `H1` cannot share an ID",
    )


def test_a_hazard_in_an_included_file() -> None:
    assert_clean(f'//- main.btq\ninclude "hazards.btq"\n{TOP}    mitigates H1\n//- hazards.btq\n{HAZARD}')


def test_unknown_hazards() -> None:
    text = "hazard collision\n" + TOP + "    mitigates colision\n"
    message = "unknown hazard `colision`; did you mean `collision`?"
    assert_problems(text, f"4:15 error unknown-hazard «colision» {message}")
    assert_fix(text, "Replace `colision` with `collision`", "hazard collision\n" + TOP + "    mitigates collision\n")


@pytest.mark.parametrize(
    ("head", "name", "other", "rule", "kinds"),
    [
        ("refines", "H1", "mitigates", "unknown-requirement", "hazard, not a requirement"),
        ("mitigates", "other", "refines", "unknown-hazard", "requirement, not a hazard"),
    ],
)
def test_the_other_clause(head: str, name: str, other: str, rule: str, kinds: str) -> None:
    text = HAZARD + 'QualityReq other "Other"\n' + TOP
    column = 6 + len(head)
    assert_problems(text + f"    {head} {name}\n", f"5:{column} error {rule} «{name}» `{name}` is a {kinds}")
    assert_fix(text + f"    {head} {name}\n", f"Replace `{head}` with `{other}`", text + f"    {other} {name}\n")


def test_unknown_requirements_that_are_refined() -> None:
    nowhere = "unknown requirement `safety`; neither this file nor its includes define it"
    assert_problems(
        TOP + "    refines topp, safety\n",
        "3:13 error unknown-requirement «topp» unknown requirement `topp`; did you mean `top`?",
        f"3:19 error unknown-requirement «safety» {nowhere}",
    )


def test_what_refines_others_at_a_node() -> None:
    nowhere = "unknown requirement `nope`; neither this file nor its includes define it"
    assert_problems(
        TOP + "Action A\nBehaviorTree Main\n    A satisfies QualityReq r refines top, nope\n",
        f"5:43 error unknown-requirement «nope» {nowhere}",
    )


def test_a_refined_requirement_is_used() -> None:
    assert_clean(
        'QualityReq general "In general"\nAction A\nBehaviorTree Main\n    A\n'
        "        satisfies QualityReq r\n            takes at most 3 s\n            refines general\n"
    )


def test_circles() -> None:
    assert_problems(
        'QualityReq a "A"\n    refines a, b\nQualityReq b "B"\n    refines c\nQualityReq c "C"\n    refines b\n',
        "2:13 error cyclic-refinement «a» the requirement `a` refines itself",
        "4:13 error cyclic-refinement «c» the requirement `b` refines itself through `c`",
        "6:13 error cyclic-refinement «b» the requirement `c` refines itself through `b`",
    )


def test_one_priority() -> None:
    assert_problems(
        TOP + "    priority high\n    priority low\n",
        "4:5 error duplicate-clause «priority low» the requirement already states a priority: `priority high`",
    )


def test_empty_texts() -> None:
    assert_problems(
        'hazard H1 ""\n    source ""\n' + TOP + '    verified by test ""\n    approved by "" on "2026-11-29"\n',
        '1:11 hint empty-text «""» this title is empty',
        '2:12 warning empty-text «""» this source is empty',
        '5:22 warning empty-text «""» the ID of the test or report is empty',
        '6:17 warning empty-text «""» the name of who approved it is empty',
    )


def test_a_date_is_one() -> None:
    assert_problems(
        TOP + '    approved by "Kim" on "29.11.2026"\n    approved by "Lee" on "2026-02-30"\n',
        '3:26 error invalid-literal «"29.11.2026"» expected a date as `2026-11-29`, found `29.11.2026`',
        '4:26 error invalid-literal «"2026-02-30"» expected a date as `2026-11-29`, found `2026-02-30`',
    )
