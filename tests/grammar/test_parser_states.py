"""Clauses about states: how they are read, in which form they are only names, and what leads to them."""

from __future__ import annotations

import pytest
from check_asserts import workspace_of

from btq_lang.checks import check
from btq_lang.parser import parse
from btq_lang.syntax.tree import Assuming, Binary, Choice, Claim, Clause, Operand, Path, Requirement, Tags, walk


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


@pytest.mark.parametrize(
    ("condition", "cases"),
    [
        ("speed <= (1 m/s if near else 2 m/s)", 1),
        ("(-1 m/s if near, limit if far and calm else - 2 m/s) < speed", 2),
        ("speed * (2 if near else 3) < 6 m/s or calm", 1),
    ],
)
def test_a_choice_in_a_condition(condition: str, cases: int) -> None:
    found = [each for each in walk(claim(f"keeps {condition}")) if isinstance(each, Choice)]
    assert [(len(each.table.cases), each.table.otherwise is not None) for each in found] == [(cases, True)]


@pytest.mark.parametrize(
    ("text", "paths", "in_order"),
    [
        ("mission visits A, B in order", ["A", "B"], True),
        ("visits A/B, 'C d', E", ["A/B", "'C d'", "E"], False),
        ('visits MoveTo (to = "A" speed = 3 m/s), Dock', None, False),
        ("visits visits A, B", ["A", "B"], False),  # a node of that name
        ("visits A, B in at least 90 % of runs", ["A", "B"], False),
    ],
)
def test_nodes_to_visit(text: str, paths: list[str] | None, in_order: bool) -> None:
    found, *_ = clauses(text.replace(" speed", ", speed"))
    assert isinstance(found, Claim)
    shown = ["/".join(name.raw for name in visit.path.names) for visit in found.visits]
    assert (shown, found.order is not None) == (paths or ["MoveTo", "Dock"], in_order)
    if paths is None:
        pairs = [(pair.key.text, pair.value.text) for pair in found.visits[0].pairs if pair.value is not None]
        assert pairs == [("to", "A"), ("speed", "3 m/s")]


@pytest.mark.parametrize(
    ("line", "visited", "after"),
    [
        ("Go (satisfies QualityReq r visits A, B, tags t)", ["A", "B"], [["t"]]),
        ("Go (satisfies QualityReq r visits A, B, x = 3)", ["A", "B"], []),
        ("Go (satisfies QualityReq r visits A, B, satisfices safety)", ["A", "B"], []),
        ("Go (satisfies QualityReq r visits A, tags)", ["A", "tags"], []),  # a node of that name
        ("Go satisfies QualityReq r visits A, B tags t", ["A", "B"], [["t"]]),
        ("Go satisfies QualityReq r visits A, B, QualityReq s succeeds", ["A", "B"], []),
    ],
)
def test_what_follows_nodes_to_visit_on_the_line_of_a_node(
    line: str, visited: list[str], after: list[list[str]]
) -> None:
    parsed = parse(f"BehaviorTree Main\n    {line}\n")
    assert parsed.diagnostics == ()
    claims = [each for entry in parsed.entries for each in walk(entry.item) if isinstance(each, Claim) and each.visits]
    assert [visit.path.names[0].text for visit in claims[0].visits] == visited
    tags = [each for entry in parsed.entries for each in walk(entry.item) if isinstance(each, Tags)]
    assert [[name.text for name in each.names] for each in tags] == after


@pytest.mark.parametrize("before", ["satisfies r", "satisfies QualityReq r visits A, B", "satisfices safety", "tags a"])
@pytest.mark.parametrize("word", ["tags", "satisfies", "satisfices"])
def test_a_comma_before_another_clause_of_a_node(before: str, word: str) -> None:
    text = f"BehaviorTree Main\n    Go {before}, {word} t\n"
    (found,) = parse(text).diagnostics
    (fix,) = found.fixes
    assert (found.message, fix.title, fix.safe) == (f"there is no comma before `{word}`", "Remove `,`", True)
    assert parse(text.replace(f", {word}", f" {word}")).diagnostics == ()


@pytest.mark.parametrize(
    ("text", "fixes"),
    [
        ("never lamp_on longer than 30 s", {"Write `for more than`": False, "Write `>`": False}),
        ("never lamp_on no more than 30 s", {"Write `for more than`": False, "Write `<=`": False}),
        ("never lamp_on no longer than 30 s", {"Write `for more than`": False, "Write `<=`": False}),
        ("never lamp_on for longer than 30 s", {"Write `for more than`": True}),
        ("never lamp_on for over 30 s while near", {"Write `for more than`": True}),
        ("never lamp_on for no more than 30 s", {"Write `for more than`": False}),
        ("never lamp_on for at most 30 s", {"Write `for more than`": False}),
        ("never speed > 1 m/s longer than 30 s", {"Write `for more than`": True}),
        ("never speed > limit longer than 30 s", {"Write `for more than`": True}),
        ("never lamp_on and near longer than 30 s", {"Write `for more than`": False, "Write `>`": False}),
        ("never (lamp_on or near) longer than 30 s", {"Write `for more than`": True}),
        ("never lamp_on for 30 s", {"Put `more than` before it": False}),
        ("never lamp_on more than 30 s", {"Write `>`": True}),  # as of any comparison
        ("never speed longer than 30 m/s", {"Write `>`": True}),  # no time
    ],
)
def test_how_long_in_other_words(text: str, fixes: dict[str, bool]) -> None:
    source = f"QualityReq r : safety\n    {text}\n"
    (found,) = parse(source).diagnostics
    assert {fix.title: fix.safe for fix in found.fixes} == fixes
    for fix in found.fixes:
        (change,) = fix.changes
        span = change.place.span
        fixed = source[: span.start] + change.text + source[span.end :]
        assert parse(fixed).diagnostics == (), fixed


@pytest.mark.parametrize("text", ["visits takes at most 3 s", "visits/Move needs calm", "Go/visits needs calm"])
def test_a_node_that_is_called_visits(text: str) -> None:
    found = claim(text)
    assert isinstance(found.subject, Path)
    assert found.verb.raw != "visits"


def test_a_tree_with_a_node_that_is_called_visits() -> None:
    workspace = workspace_of(
        {"main.btq": "Root Main\nBehaviorTree Main\n    ->\n        visits\n        visits (a = 1)\n"}
    )
    assert [each.rule for each in check(workspace, "main.btq") if each.rule in ("clause-as-node", "syntax-error")] == []


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
        ("never calm for longer than 3 s", "this time is written `for more than`"),
        ("never calm for 3 s", "this time is written `for more than`"),
        ("never speed > 1 m/s over 3 s", "this time is written `for more than`"),
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
        ("visits A", "expected `,` and another node, found the end of the line"),
        ("visits A (to), B", "expected `=`, found `)`"),
        ("Move ends in 3 s", "this clause is written `Move succeeds within 3 s` or `Move takes at most 3 s`"),
    ],
)
def test_near_forms_lead_to_it(text: str, message: str) -> None:
    assert [each.message for each in parse(f"QualityReq r : safety\n    {text}\n").diagnostics] == [message]
