"""The lexer and the parser take every text: no exception, nothing lost, no time beyond what the length asks for.

Each run invents the same texts, and other ones with another seed (`tests/README.md`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise, product
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from seeds import share_of
from syntax_asserts import assert_diagnostics, assert_entries, assert_invariants, assert_tokens, show_problems

from btq_lang.parser import parse
from btq_lang.syntax.tokens import SYMBOLS
from btq_lang.util.text import LINE_END

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted(path for path in (ROOT / "examples").rglob("*") if path.suffix in (".btq", ".qualitybtcpp"))
TEXTS = {str(path.relative_to(ROOT)): path.read_bytes().decode("utf-8") for path in EXAMPLES}

invented = settings(suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


# ---- invented texts -------------------------------------------------------------------------------------------------

WORDS = (
    *SYMBOLS,
    *("BehaviorTree", "Root", "TreeNodesModel", "QualityReq", "include", "signal", "context", "apply", "quality"),
    *("qualities", "xml", "Action", "Condition", "Control", "Decorator", "SubTree", "input", "output", "inout"),
    *("metadata", "satisfices", "satisfies", "tags", "parameters", "Quality", "ID", "description", "name"),
    *("takes", "succeeds", "needs", "keeps", "never", "leaves", "uses", "tries", "runs", "starts", "ends", "follows"),
    *("until", "each", "is", "followed", "occurrences"),
    *("at", "most", "least", "less", "than", "more", "between", "and", "or", "not", "if", "else", "of", "per", "every"),
    *("within", "after", "mission", "from", "to", "sum", "when", "while", "in", "with", "probability", "confidence"),
    *("for", "assuming", "visits", "order", "time", "average"),
    *("over", "last", "activations", "on", "violation", "fail", "goal", "because", "verified", "by", "review", "node"),
    *("source", "refines", "mitigates", "priority", "approved", "hazard", "severity"),
    *("scenario", "given", "expect", "verifies", "answers", "skips", "does", "end", "twice", "times", "then", "writes"),
    *("have", "passed", "halts", "finally", "violated", "satisfied", "applicable", "exercised", "{x}", "2", "first"),
    *(
        "except",
        "under",
        "tagged",
        "fresh",
        "initially",
        "level",
        "max",
        "true",
        "a",
        "rq1",
        "MoveBase",
        "a-b",
        "Ready?",
    ),
    *(
        "(",
        ")",
        "((",
        "))",
        "=",
        "==",
        ":",
        "::",
        ",",
        ".",
        "/",
        "<",
        ">",
        "<=",
        "!=",
        "+",
        "-",
        "*",
        "%",
        "^",
        "!",
        "&&",
    ),
    *(
        '"a"',
        "'b'",
        '"',
        "'",
        '"a\nb"',
        "\\",
        "{a}",
        "{",
        "}",
        "{=}",
        "6",
        "-1",
        "0.25",
        "1e3",
        "30 s",
        "3 %",
        "30sek",
        "1/s",
    ),
    *("# c\n", "// c\n", "/* c */", "/*", "*/", "#", "°", "\ufeff", "\f", "\u2028", "\x00", "\xa0", ";", "é"),
    *("\n", "\n", "\n    ", "\n        ", "\n\t", "\n\t\t", "\n  ", "\n   ", "\r\n", "\r", " ", " ", "\t"),
)


@invented
@given(st.text(max_size=200))
@example("\ufeff\ufeff")
@example("\r\r\n\n\r")
@example("\ud800 = '\udfff'")
def test_any_text(text: str) -> None:
    assert_invariants(parse(text))


@invented
@given(st.lists(st.sampled_from(WORDS), max_size=60), st.sampled_from(["", " "]))
def test_texts_of_the_languages_own_words(words: list[str], between: str) -> None:
    assert_invariants(parse(between.join(words)))


@invented
@given(st.lists(st.lists(st.sampled_from(WORDS), max_size=6), max_size=12), st.lists(st.integers(0, 5), min_size=12))
def test_trees_of_the_languages_own_words(lines: list[list[str]], indents: list[int]) -> None:
    text = "BehaviorTree t\n" + "".join(
        f"{'    ' * indent}{' '.join(words)}\n" for words, indent in zip(lines, indents, strict=False)
    )
    assert_invariants(parse(text))


@invented
@given(
    st.sampled_from(sorted(TEXTS)),
    st.integers(0),
    st.lists(st.tuples(st.integers(0), st.integers(0, 12), st.sampled_from(WORDS)), max_size=4),
)
def test_examples_with_something_replaced(name: str, where: int, changes: list[tuple[int, int, str]]) -> None:
    text = TEXTS[name]
    for at, length, word in changes:
        start = (where + at) % (len(text) + 1)
        text = text[:start] + word + text[start + length :]
    assert_invariants(parse(text))


# ---- the examples, damaged at every place ---------------------------------------------------------------------------


def pieces() -> Iterator[object]:
    """The items of the examples one by one, a Root with all that it holds: damage to one says nothing new of others."""
    for name, text in TEXTS.items():
        starts = [entry.start for entry in parse(text).entries if not entry.in_root]
        for start, end in zip(starts, [*starts[1:], len(text)], strict=True):
            yield pytest.param(text[start:end], id=f"{name}:{text.count(chr(10), 0, start) + 1}")


def prefixes(text: str) -> Iterator[str]:
    return (text[:end] for end in range(len(text)))


def without_one_token(text: str) -> Iterator[str]:
    return (text[: token.start] + text[token.end :] for token in parse(text).tokens if token.text)


def without_one_line(text: str) -> Iterator[str]:
    starts = [0, *(end.end() for end in LINE_END.finditer(text)), len(text)]
    return (text[:start] + text[end:] for start, end in pairwise(starts))


@pytest.mark.parametrize("damage", [prefixes, without_one_token])
@pytest.mark.parametrize("text", list(pieces()))
def test_every_damage_to_an_item(text: str, damage: Callable[[str], Iterator[str]]) -> None:
    for damaged in share_of(damage(text), 8):
        parsed = parse(damaged)
        assert_diagnostics(parsed)
        assert_entries(parsed)


@pytest.mark.parametrize("name", TEXTS)
def test_every_example_without_one_line_and_up_to_the_end_of_any(name: str) -> None:
    text = TEXTS[name]
    for damaged in share_of(without_one_line(text), 8):
        assert_diagnostics(parse(damaged))
    for end in share_of(LINE_END.finditer(text), 8):
        assert_diagnostics(parse(text[: end.start()]))


def test_there_are_examples() -> None:
    assert len(TEXTS) >= 5
    assert sum(map(len, TEXTS.values())) > 10_000


# ---- depth ----------------------------------------------------------------------------------------------------------

DEEP = 5_000


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (
            "BehaviorTree t\n" + "".join(f"{' ' * level}->\n" for level in range(1, DEEP)),
            "258:258 nested-too-deep «->» more than 256 levels of nodes, which BehaviorTree.CPP refuses",
        ),
        (
            "BehaviorTree t\n  X " + "(" * DEEP + ")" * DEEP + "\n  Y\n",
            "2:6 syntax-error «(» expected an attribute: key = value, found `(`",
        ),
        ("BehaviorTree t\n  X " + "(" * DEEP + "\n", "2:5 unclosed-bracket «(» missing `)` for this `(`"),
        (
            "BehaviorTree t\n  X (satisfies a" + "(b = " * DEEP + ")" * DEEP + ")",
            "2:22 syntax-error «(» expected a value with its unit: 30 s, found `(`",
        ),
        (
            "context a : " + "(" * DEEP + "b" + ")" * DEEP,
            "1:64 nested-too-deep «(» more than 50 nested brackets",
        ),
        (
            "QualityReq a keeps " + "not (" * DEEP + "b" + ")" * DEEP,
            "1:275 nested-too-deep «not» more than 50 nested brackets",
        ),
        ("context a : " + "not " * DEEP + "b", "1:21 syntax-error «not» expected the end of the line, found `not`"),
        (
            "context a : " + "-" * DEEP + "b",
            "1:14 syntax-error «-» expected a number or a quantity after `-`, found `-`",
        ),
    ],
)
def test_what_is_nested_too_deep_is_one_diagnostic(text: str, problem: str) -> None:
    parsed = parse(text)
    assert show_problems(text, parsed.diagnostics) == problem
    assert_tokens(parsed)
    assert_entries(parsed)


def test_blocks_without_end() -> None:
    """Items inside items, requirements inside models, …: whatever a level begins with, it costs no stack."""
    words = ("Root a", "signal a : m", "QualityReq a", "Action a", "TreeNodesModel", "X", "satisfies QualityReq a")
    for word in words:
        text = "".join(f"{' ' * level}{word}\n" for level in range(DEEP))
        parsed = parse(text)
        assert_entries(parsed)
        assert parsed.entries


# ---- length ---------------------------------------------------------------------------------------------------------

HOSTILE = (
    "(",
    ")",
    '"',
    "'",
    "{",
    "}",
    "\\",
    "/*",
    "*/",
    "#",
    "a = ",
    "a.",
    "- ",
    "->",
    "7",
    "a ",
    "a, ",
    "a/",
    "30sek ",
    ";",
)
HEADS = (
    "",
    "context a : ",
    "QualityReq a ",
    "QualityReq a refines ",
    "QualityReq a\n  verified by test ",
    "signal a : m ",
    "apply a to ",
    "BehaviorTree t\n  X ",
    "BehaviorTree t\n  X (a = ",
)


@pytest.mark.parametrize("unit", HOSTILE)
def test_a_hostile_line_without_end(unit: str) -> None:
    """They end at all: what is quadratic takes minutes.  And they do not drown anybody in diagnostics."""
    parsed = parse(unit * (100_000 // len(unit)))
    assert len(parsed.diagnostics) <= (20 if unit == "30sek " else 1)


@pytest.mark.parametrize("unit", HOSTILE)
def test_hostile_lines_behind_something_else(unit: str) -> None:
    for head in HEADS:
        parsed = parse(head + unit * (10_000 // len(unit)))
        assert_tokens(parsed)
        assert len(parsed.diagnostics) <= (21 if unit == "30sek " else 2)


HOSTILE_LINES = ("/* a", '"a', "'a", "a (b", ")", "X (", "30sek,", "a = 1", "   a", "\ta", "->", "# a", "x 'a\\")


@pytest.mark.parametrize(("line", "end"), list(product(HOSTILE_LINES, ("\n", "\r", "\n  ", "\n\t"))))
def test_hostile_lines_one_below_another(line: str, end: str) -> None:
    """As items, all of them in one tree, or in one pair of brackets: no line looks at all the lines before it."""
    for head in ("", "BehaviorTree t\n", "BehaviorTree t\n  X (\n"):
        assert_tokens(parse(head + (line + end) * (4_000 // len(line + end))))
    parsed = parse(f"BehaviorTree t\n  X (\n    {line}\n" * 2_000)
    assert len(parsed.entries) > 500
