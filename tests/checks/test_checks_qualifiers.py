"""qualifier-of-all, and what duplicate-clause and dead-bound advise where a qualifier is on the line of one claim."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, problems

HEAD = "signal speed : m/s from {@speed} initially 0 m/s\nsignal near : bool from {@near} initially false\n"
TREE = "Action X\nBehaviorTree Main\n    X satisfies r\n"


def mission(clauses: str) -> str:
    return f"{HEAD}QualityReq r : safety\n{clauses}{TREE}"


def of_all(place: str, qualifier: str, claims: int = 2) -> str:
    message = f"`{qualifier}` holds for all {claims} claims of this requirement"
    return f"{place} warning qualifier-of-all «{qualifier}» {message}"


@pytest.mark.parametrize(
    "qualifier",
    [
        *("while near", "when near", "assuming near", "from mission starts until when near"),
        *("in at least 95 % of runs", "on violation warn"),
    ],
)
def test_a_qualifier_on_the_line_of_one_claim_is_told(qualifier: str) -> None:
    clauses = f"    keeps speed <= 1 m/s {qualifier}\n    never near and speed > 2 m/s\n"
    assert_problems(mission(clauses), of_all("4:26", qualifier))
    fixed = f"    keeps speed <= 1 m/s\n    {qualifier}\n    never near and speed > 2 m/s\n"
    assert_fix(mission(clauses), f"Put `{qualifier}` on its own line", mission(fixed))
    assert_clean(mission(fixed))


def test_each_of_several_qualifiers_is_told() -> None:
    clauses = "    keeps speed <= 1 m/s while near\n    takes at most 30 s when near\n    leaves speed == 0 m/s\n"
    assert_problems(mission(clauses), of_all("4:26", "while near", 3), of_all("5:24", "when near", 3))


def test_a_qualifier_before_its_claim_gets_its_own_line() -> None:
    clauses = "    while near keeps speed <= 1 m/s\n    takes at most 30 s\n"
    fixed = "    while near\n    keeps speed <= 1 m/s\n    takes at most 30 s\n"
    assert_fix(mission(clauses), "Put `while near` on its own line", mission(fixed))


def test_a_qualifier_on_the_line_of_the_head_is_indented_as_the_other_claims() -> None:
    head = f"{HEAD}QualityReq r : safety keeps speed <= 1 m/s"
    text = f"{head} while near in at least 95 % of runs\n    takes at most 30 s\n{TREE}"
    fixed = f"{head}\n    while near\n    in at least 95 % of runs\n    takes at most 30 s\n{TREE}"
    assert_fix(text, "Put `while near` on its own line", fixed)


@pytest.mark.parametrize(
    "clauses",
    [
        "    keeps speed <= 1 m/s while near\n    because 'people'\n",  # one claim
        "    keeps speed <= 1 m/s takes at most 30 s while near\n",  # nothing looks as if it were of one of them
        "    keeps speed <= 1 m/s\n    takes at most 30 s\n    while near\n",
        "    keeps speed <= 1 m/s while near\n    takes at most 30 s while near\n",  # they say what holds
    ],
)
def test_a_layout_that_does_not_deceive_is_not_told(clauses: str) -> None:
    assert_clean(mission(clauses))


def test_shares_of_which_only_one_counts_lead_to_two_requirements() -> None:
    clauses = "    X takes at most 3 s in at least 95 % of runs\n    Y takes at most 4 s in at least 90 % of runs\n"
    text = f"QualityReq r : safety\n{clauses}Action X\nAction Y\nBehaviorTree Main\n    ->\n        X\n        Y\n"
    (found,) = problems(text, "duplicate-clause")
    note = "each holds for all claims of this requirement; to have it for one claim alone, split the requirement"
    assert found.notes == (note,)


def test_a_bound_without_effect_leads_to_two_requirements() -> None:
    clauses = "    takes at most 3 s while near\n    takes at most 30 s\n"
    (found,) = problems(mission(clauses), "dead-bound")
    note = "`while near` holds for all its claims; to have it for one claim alone, split the requirement"
    assert found.notes == (note,)


def test_a_span_beside_a_verb_that_has_none_leads_to_two_requirements() -> None:
    span = "from mission starts until when near"
    clauses = f"    mission keeps speed <= 1 m/s {span}\n    each when near is followed by speed <= 0 m/s within 1 s\n"
    split = "to have it for one claim alone, split the requirement"
    (found,) = problems(mission(clauses), "qualifier-of-all")
    assert (found.notes, found.fixes) == ((f"{split}: `from … until` is for `keeps` and `never` only",), ())
    (other,) = problems(mission(clauses), "requirement-without-subject")
    assert other.notes[0].startswith(f"{split}; `from … until` is for `keeps` and `never`")
    own, answer = clauses.splitlines(keepends=True)
    assert_clean(mission(f"{own}QualityReq s : safety\n{answer}").replace("satisfies r", "satisfies r, s"))
