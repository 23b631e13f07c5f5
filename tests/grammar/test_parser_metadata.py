"""Hazards, and the clauses of a requirement that demand nothing; elsewhere their words are names, as before."""

from __future__ import annotations

import pytest
from syntax_asserts import assert_fix, assert_parse

from btq_lang.parser import parse


def test_hazards() -> None:
    assert_parse(
        """
        hazard H1 "Collision with a person"
            source "FMEA-12"
            severity catastrophic
            because "people walk there"
        hazard "4.2"
        """,
        """
        hazard H1 "Collision with a person"
          source "FMEA-12"
          severity catastrophic
          because "people walk there"
        hazard "4.2"
        """,
    )


def test_clauses_that_demand_nothing() -> None:
    assert_parse(
        """
        QualityReq slow : safety and reliability.availability "Slow"
            source "ISO 13482, 5.10.2"
            refines REQ-7, "4.2"
            mitigates H1, H2
            priority high
            verified by test "TC-12", review "R-3"
            approved by "Kim" on "2026-11-29" of "1:0123456789ab"
            approved by "Lee" on "2026-11-30"
        """,
        """
        requirement slow : safety and reliability.availability "Slow"
          source "ISO 13482, 5.10.2"
          refines REQ-7, "4.2"
          mitigates H1, H2
          priority high
          verified by test "TC-12", review "R-3"
          approved by "Kim" on "2026-11-29" of "1:0123456789ab"
          approved by "Lee" on "2026-11-30"
        """,
    )


def test_several_clauses_on_a_line() -> None:
    assert_parse(
        'QualityReq r source "S" refines a, b mitigates H1 priority high takes at most 3 s\n',
        """
        requirement r
          source "S"
          refines a, b
          mitigates H1
          priority high
          takes <= 3s
        """,
    )


def test_after_satisfies_a_comma_separates_requirements() -> None:
    assert_parse(
        """
        BehaviorTree T
            A satisfies QualityReq r refines a, b, QualityReq s verified by test "1", review "2", review
            B (satisfies QualityReq t mitigates H1, c)
            C
                satisfies QualityReq u
                    refines a, b
        """,
        """
        tree T
          A
            satisfies {r; refines a}, b, {s; verified by test "1", review "2"}, review
          B
            satisfies {t; mitigates H1}, c
          C
            satisfies {u; refines a, b}
        """,
    )


def test_the_words_are_names_where_nothing_follows_that_makes_a_clause_of_them() -> None:
    assert_parse(
        """
        QualityReq r
            source takes at most 3 s
            refines/priority succeeds
            mitigates keeps source or priority
            priority leaves severity < 3 N
            approved succeeds within source if priority else refines
            needs node source
            follows hazard succeeds
        BehaviorTree source
            priority
                hazard
                source approved
                refines (mitigates = 3)
        """,
        """
        requirement r
          <source> takes <= 3s
          <refines/priority> succeeds
          <mitigates> keeps (or source priority)
          <priority> leaves (severity < 3N)
          <approved> succeeds <= [source if priority, refines else]
          needs (node source)
          follows hazard succeeds
        tree source
          priority
            hazard
            source as approved
            refines (mitigates=3)
        """,
    )


@pytest.mark.parametrize(
    ("clause", "problem", "title", "fixed"),
    [
        ("source ISO 13482", "source in quotes, found `ISO`", "Put quotes around it", 'source "ISO 13482"'),
        ('reference "x"', '`reference` is not in btq; nearest is `source "…"`', "Write `source`", 'source "x"'),
        ("priority 1", "expected a priority: high, must, …, found `1`", "Put quotes around it", 'priority "1"'),
        (
            "approved by Kim Lee on 2026-11-29",
            "expected a name in quotes, found `Kim`",
            "Put quotes around it",
            'approved by "Kim Lee" on 2026-11-29',
        ),
        ('approved "Kim" on "2026-11-29"', "expected `by`", "Put `by` before it", 'approved by "Kim" on "2026-11-29"'),
        ("refine a", "did you mean `refines`?", "Replace `refine` with `refines`", "refines a"),
        ("mitigate H1", "did you mean `mitigates`?", "Replace `mitigate` with `mitigates`", "mitigates H1"),
        ("mitigates H1 and H2", "expected `,` instead of `and`", "Write `,`", "mitigates H1, H2"),
        (
            "verified by test TC-12",
            "the ID of a test or a report goes in quotes",
            "Put quotes around it",
            'verified by test "TC-12"',
        ),
        ("priority: high", "unexpected `:`", "Remove `:`", "priority high"),
    ],
)
def test_near_forms(clause: str, problem: str, title: str, fixed: str) -> None:
    text = "QualityReq r\n    {}\n    takes at most 3 s\n"
    assert problem in only_message(text.format(clause))
    assert_fix(text.format(clause), title, text.format(fixed), safe=title in ("Write `,`", "Remove `:`"))


def only_message(text: str) -> str:
    """The message of the only problem of a text."""
    (problem,) = parse(text).diagnostics
    return problem.message


@pytest.mark.parametrize(
    ("clause", "problem"),
    [
        ("risk H1", "`risk` is not in btq; nearest is `mitigates` with the ID of a hazard"),
        ("derived from a", "`derived` is not in btq; nearest is `refines` with the ID of a requirement"),
        ("importance high", "`importance` is not in btq; nearest is `priority` with a word"),
        ("source", "expected the source in quotes, found the end of the line"),
        ("refines a,", "expected the ID of a requirement, found the end of the line"),
        ("approved", "expected `by`, found the end of the line"),
    ],
)
def test_what_is_not_in_btq(clause: str, problem: str) -> None:
    assert only_message(f"QualityReq r\n    {clause}\n    takes at most 3 s\n") == problem


def test_what_a_hazard_cannot_have() -> None:
    assert_parse(
        """
        hazard H1 Collision
            mitigates H2
            severty high
            severity 3
        """,
        None,
        "1:11 syntax-error «Collision» expected the hazard's title in quotes, found `Collision`",
        "2:5 syntax-error «mitigates» expected source, because or severity, found `mitigates`",
        "3:5 syntax-error «severty» expected source, because or severity, found `severty`",
        "4:14 syntax-error «3» expected a severity: high, catastrophic, …, found `3`",
    )


def test_a_title_may_begin_with_such_a_word() -> None:
    for title in ("priority lanes must stay free", "source of errors must be found"):
        text = f"QualityReq r {title}\n"
        assert only_message(text) == "a title goes in quotes"
        assert_fix(text, "Put quotes around it", f'QualityReq r "{title}"\n')
