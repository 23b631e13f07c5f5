"""The mistakes that newcomers make first: from BehaviorTree.CPP's XML, from Python and YAML, from the published syntax.

Each mission has one mistake and each gets one diagnostic, which says what to write; where that is certain, a fix writes
it, and the mission is clean afterwards.
"""

from __future__ import annotations

import pytest
from check_asserts import MAIN, after, show

from btq_lang.checks import check
from btq_lang.diagnostics import Diagnostic
from btq_lang.workspace import Workspace


def tree(*lines: str) -> str:
    return "\n    ".join(("BehaviorTree Main", *lines)) + "\n"


def requirement(*lines: str) -> str:
    return tree("Go satisfies r") + "\n    ".join(("QualityReq r", *lines)) + "\n"


def condition(text: str) -> str:
    signals = "signal lit : bool from {lit}\nsignal far : m from {far}\n"
    return f"{signals}context c : {text}\n" + tree("Go satisfies r") + "QualityReq r\n    keeps c\n"


R = 'QualityReq r "in time"\n'
OTHER = "BehaviorTree Other\n    Go\n"
FROM_XML = [
    (
        tree('SubTree ID="Other"') + OTHER,
        '2:13 error syntax-error «ID="Other"» attributes stand in brackets: `( key = value )`',
        tree('SubTree (ID="Other")') + OTHER,
    ),
    (
        tree('Retry num_attempts="3"', "    Go"),
        '2:11 error syntax-error «num_attempts="3"» attributes stand in brackets: `( key = value )`',
        tree('Retry (num_attempts="3")', "    Go"),
    ),
    (
        tree('-> name="all"', "    Go"),
        '2:8 error syntax-error «name="all"» attributes stand in brackets: `( key = value )`',
        tree('-> (name="all")', "    Go"),
    ),
    (
        tree('Script (code = "a := True")'),
        "2:26 warning misspelt-entry «True» in a script `True` is the name of an entry: the engine's word is `true`",
        tree('Script (code = "a := true")'),
    ),
]
FROM_PYTHON = [
    (
        tree("Sequence:", "    Go"),
        "2:13 error syntax-error «:» expected the end of the line, found `:`",
        tree("Sequence", "    Go"),
    ),
    (
        tree('Go (station: "charger")'),
        "2:16 error syntax-error «:» key and value are joined by `=`",
        tree('Go (station = "charger")'),
    ),
    (tree("Go (a == 3)"), "2:11 error syntax-error «==» key and value are joined by `=`", tree("Go (a = 3)")),
    (
        tree("Retry (attempts=3)", "    Go"),
        "2:12 error unknown-port «attempts» `Retry` has no port `attempts`",
        tree("Retry (num_attempts=3)", "    Go"),
    ),
    (
        condition("lit && far > 2 m"),
        "3:17 error syntax-error «&&» in conditions `&&` is written `and`",
        condition("lit and far > 2 m"),
    ),
    (
        condition("lit || far > 2 m"),
        "3:17 error syntax-error «||» in conditions `||` is written `or`",
        condition("lit or far > 2 m"),
    ),
    (condition("!lit"), "3:13 error syntax-error «!» in conditions `!` is written `not`", condition("not lit")),
    (
        condition("far = 2 m"),
        "3:17 error syntax-error «=» values are compared with `==`",
        condition("far == 2 m"),
    ),
]
FROM_THE_PUBLISHED_SYNTAX = [
    (
        tree("Go satisfy r") + R,
        "2:8 error syntax-error «satisfy» `satisfy` attaches nothing to a node: did you mean `satisfies`?",
        tree("Go satisfies r") + R,
    ),
    (
        tree("Go satisfies: r") + R,
        "2:17 error syntax-error «:» no `:` stands here",
        tree("Go satisfies r") + R,
    ),
    (
        requirement("takes <= 30 s"),
        "4:11 error syntax-error «<=» this bound is written `at most`",
        requirement("takes at most 30 s"),
    ),
    (
        requirement("takes at most 30 Sekunden"),
        "4:22 error unknown-unit «Sekunden» `Sekunden` is no unit: did you mean `s`?",
        requirement("takes at most 30 s"),
    ),
    (
        tree("Go (satisfices Quality = safety"),
        "2:8 error unclosed-bracket «(» this `(` has no `)`",
        tree("Go (satisfices Quality = safety)"),
    ),
]


@pytest.mark.parametrize(("text", "problem", "mended"), FROM_XML + FROM_PYTHON + FROM_THE_PUBLISHED_SYNTAX)
def test_one_mistake_is_one_diagnostic(text: str, problem: str, mended: str | None) -> None:
    found = mistakes(text)
    assert show(text, found) == [problem]
    assert [after(text, fix) for fix in found[0].fixes] == ([mended] if mended else [])
    assert mistakes(mended or "") == []


def test_two_mistakes_are_mended_one_after_the_other() -> None:
    text = tree("Retry attempts=3", "    Go")
    for _ in range(2):
        (fix,) = mistakes(text)[0].fixes
        text = after(text, fix)
    assert text == tree("Retry (num_attempts=3)", "    Go")
    assert mistakes(text) == []


def mistakes(text: str) -> list[Diagnostic]:
    """What is wrong with a mission, but that its nodes have no models."""
    return [found for found in check(Workspace.of({MAIN: text}), MAIN) if found.rule != "no-models"]
