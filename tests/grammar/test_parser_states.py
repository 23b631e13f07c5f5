"""Clauses about states: how they are read, in which form they are only names, and what leads to them."""

from __future__ import annotations

import pytest

from btq_lang.parser import parse
from btq_lang.syntax.tree import Assuming, Binary, Choice, Claim, Clause, Operand, Path, Requirement, walk


def clauses(text: str) -> tuple[Clause, ...]:
    """The clauses of a requirement that is read without a complaint."""
    parsed = parse(f"QualityReq r : safety\n    {text}\n")
    assert [each.message for each in parsed.diagnostics] == []
    (requirement,) = (entry.item for entry in parsed.entries if isinstance(entry.item, Requirement))
    return requirement.clauses


def claim(text: str) -> Claim:
    """The only clause of a requirement."""
    (clause,) = clauses(text)
    assert isinstance(clause, Claim)
    return clause


@pytest.mark.parametrize(
    ("text", "row"),
    [
        ("Move ends with battery >= 3 %", "ends with"),
        ("ends with calm", "ends with"),
        ("never calm for more than 3 s", "never for"),
        ("Move never speed > 3 m/s for more than 3 s if calm else 5 s", "never for"),
        ("never calm", "never"),
        ("never for", "never"),  # a signal of that name
        ("never for for more than 3 s", "never for"),
        ("Move ends within 2 s after Pick succeeds", "ends"),
    ],
)
def test_the_row_of_a_verb(text: str, row: str) -> None:
    assert claim(text).row == row


@pytest.mark.parametrize(
    ("condition", "cases"),
    [
        ("speed <= (1 m/s if near else 2 m/s)", 1),
        ("(-1 m/s if near, limit if far and calm else - 2 m/s) < speed", 2),
        ("speed * (2 if near else 3) < 6 m/s or calm", 1),
    ],
)
def test_an_assumption() -> None:
    first, second = clauses("Move takes at most 3 s assuming visible and not node Pick")
    assert isinstance(first, Claim)
    assert isinstance(second, Assuming)
    assert isinstance(second.condition, Binary)


@pytest.mark.parametrize(
    "text", ["assuming takes at most 3 s", "assuming/Move takes at most 3 s", "Go/assuming needs calm"]
)
def test_a_node_that_is_called_assuming(text: str) -> None:
    subject = claim(text).subject
    assert isinstance(subject, Path)
    assert "assuming" in [name.raw for name in subject.names]


def test_a_tree_with_a_node_that_is_called_assuming() -> None:
    assert parse("BehaviorTree Main\n    ->\n        assuming\n        assuming (a = 1)\n").diagnostics == ()


def test_a_signal_that_is_called_age() -> None:
    assert [each.word.text for each in walk(claim("keeps age <= 3 s")) if isinstance(each, Operand)] == ["age", "3 s"]


def test_a_choice_in_a_condition(condition: str, cases: int) -> None:
    found = [each for each in walk(claim(f"keeps {condition}")) if isinstance(each, Choice)]
    assert [(len(each.table.cases), each.table.otherwise is not None) for each in found] == [(cases, True)]


def test_a_node_that_is_called_for() -> None:
    first, second = clauses("never calm for takes at most 3 s")
    assert isinstance(first, Claim)
    assert isinstance(second, Claim)
    assert (first.row, second.row) == ("never", "takes")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Move finishes with battery >= 3 %", "this clause is written `Move ends with battery >= 3 %`"),
        ("Move shall end with calm", "this clause is written `Move ends with calm`"),
        ("Move ends with at least 3 % battery", "expected a condition, which begins with its signal, found `at`"),
        ("never calm for longer than 3 s", "this time is written `more than`"),
        (
            "keeps calm for 3 s",
            "only `never` says how long a condition may hold: `never low for more than 30 s`",
        ),
        ("keeps speed <= (1 m/s if near)", "expected `else`, found `)`"),
        ("keeps speed <= (2 * speed if near else 3 m/s)", "expected `)`, found `if`"),
        (
            "takes at most 3 s assumption visible",
            "`assumption` is not in btq; nearest is `assuming` with a condition",
        ),
        ("Move ends in 3 s", "this clause is written `Move succeeds within 3 s` or `Move takes at most 3 s`"),
    ],
)
def test_near_forms_lead_to_it(text: str, message: str) -> None:
    assert [each.message for each in parse(f"QualityReq r : safety\n    {text}\n").diagnostics] == [message]
