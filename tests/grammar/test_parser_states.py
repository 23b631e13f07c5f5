"""Clauses about states: how they are read, in which form they are only names, and what leads to them."""

from __future__ import annotations

import pytest

from btq_lang.parser import parse
from btq_lang.syntax.tree import Claim, Clause, Requirement


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
        ("Move ends within 2 s after Pick succeeds", "ends"),
    ],
)
def test_the_row_of_a_verb(text: str, row: str) -> None:
    assert claim(text).row == row


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Move finishes with battery >= 3 %", "this clause is written `Move ends with battery >= 3 %`"),
        ("Move shall end with calm", "this clause is written `Move ends with calm`"),
        ("Move ends with at least 3 % battery", "expected a condition, which begins with its signal, found `at`"),
        ("Move ends in 3 s", "this clause is written `Move succeeds within 3 s` or `Move takes at most 3 s`"),
    ],
)
def test_near_forms_lead_to_it(text: str, message: str) -> None:
    assert [each.message for each in parse(f"QualityReq r : safety\n    {text}\n").diagnostics] == [message]
