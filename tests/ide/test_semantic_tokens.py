"""Semantic tokens: what each word is."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest
from feature_asserts import check_delta, check_tokens, decoded
from seeds import seeds

from btq_lang.ide.colours import TokenEdit, colours, delta
from btq_lang.lexer import tokens
from btq_lang.syntax.tokens import COMMENT
from btq_lang.util.text import LINE_END, LineIndex, Span
from btq_lang.workspace.workspace import Workspace

AROUND_COMMENTS = (
    *("\n#", "\n# why", "\n    # why", "# why", "//", "/*", "*/", "#", '"', "'", "(", ")", "{", "=", ":", "\n", "\r"),
    *("\n\n", "    ", " ", "\u2028", "\xa0", "ä", "x", "30 s", "\nBehaviorTree M", "\n    Go", " (a = 1)"),
    *("\nQualityReq r", "\n    takes at most 3 s"),
)


def test_a_tree() -> None:
    check_tokens(
        """
        //- main.btq
        BehaviorTree Main  # it runs
            -> First
                Pick (from = {shelf} n = 6) satisfies rq1
                Retry (num_attempts = 3)
                    SubTree Dock (_skipIf = "a > 1")
        """,
        "keyword BehaviorTree",
        "class.definition Main",
        "comment # it runs",
        "operator.defaultLibrary ->",
        "label.definition First",
        "function Pick",
        "property from",
        "variable {",
        "variable shelf",
        "variable }",
        "property n",
        "number 6",
        "keyword satisfies",
        "interface rq1",
        "type.defaultLibrary Retry",
        "property num_attempts",
        "number 3",
        "keyword SubTree",
        "class Dock",
        "property _skipIf",
        'string "',
        "variable a",
        'string  > 1"',
    )


def test_built_in_actions_and_conditions_are_functions_as_those_of_the_robot_are() -> None:
    check_tokens(
        "BehaviorTree Main\n    Sequence\n        AlwaysSuccess\n        ScriptCondition\n        Pick\n",
        "keyword BehaviorTree",
        "class.definition Main",
        "type.defaultLibrary Sequence",
        "function.defaultLibrary AlwaysSuccess",
        "function.defaultLibrary ScriptCondition",
        "function Pick",
    )


def test_a_requirement() -> None:
    check_tokens(
        "QualityReq slow(limit : m/s) : performance <time-behavior> 'Slow\n'\n    keeps speed <= limit and fast\n",
        "keyword QualityReq",
        "interface.definition slow",
        "parameter.definition limit",
        "type m/s",
        "enumMember.defaultLibrary performance",
        "enumMember.defaultLibrary time-behavior",
        "string 'Slow",
        "string '",
        "keyword keeps",
        "variable.readonly speed",
        "parameter limit",
        "keyword and",
        "variable.readonly fast",
    )


def test_a_keyword_may_be_a_name() -> None:
    check_tokens(
        "BehaviorTree satisfies\n    takes\n",
        "keyword BehaviorTree",
        "class.definition satisfies",
        "function takes",
    )


@pytest.mark.parametrize("seed", seeds(8))
def test_comments_are_those_of_the_text(seed: int) -> None:
    chance = random.Random(seed)
    for _ in range(300):
        text = "".join(chance.choices(AROUND_COMMENTS, k=chance.randrange(2, 14)))
        data = colours(Workspace.of({"main.btq": text}), "main.btq", "utf-16").data
        found = [span for span, look in decoded(data, LineIndex(text), "utf-16") if look == "comment"]
        assert found == [*comment_lines(text)], text


def comment_lines(text: str) -> Iterator[Span]:
    """The comments of a text, line by line."""
    for token in tokens(text):
        at = token.start
        for line in LINE_END.split(token.text) if token.kind == COMMENT else ():
            at = text.index(line, at)
            if line:
                yield Span(at, at + len(line))
            at += len(line)


def test_wide_characters_count_as_the_encoding_has_them() -> None:
    check_tokens(
        'BehaviorTree "🤖" # ä\n    Grüße\n',
        "keyword BehaviorTree",
        'class.definition "🤖"',
        "comment # ä",
        "function Grüße",
    )


@pytest.mark.parametrize(
    ("before", "old", "new"),
    [
        ("signal a : m\nsignal b : m\n\nRoot X\n", "signal b", "# signal b"),
        ("signal a : m\nsignal b : m\n\nRoot X\n", "signal b : m\n", ""),
        ('include "a.btq"\ninclude "a.btq"\n\nRoot X\n', '\ninclude "a.btq"', ""),
        ("BehaviorTree A\n    Go\nBehaviorTree B\n    Go\n", "BehaviorTree B\n    Go\n", "/* B */\n"),
    ],
)
def test_what_stands_behind_an_item_becomes_another_text(before: str, old: str, new: str) -> None:
    workspace = Workspace.of({"main.btq": before})
    for text in (before, before.replace(old, new), before):
        workspace = workspace.with_file("main.btq", text)
        shown = colours(workspace, "main.btq", "utf-16").data
        assert shown == colours(Workspace.of({"main.btq": text}), "main.btq", "utf-16").data


def test_delta() -> None:
    one, two, three = [0, 0, 1, 1, 0], [1, 0, 1, 2, 0], [0, 5, 1, 3, 0]
    check_delta(one + two + three, one + two + three, None)
    check_delta(one + three, one + two + three, (5, 0, two))
    check_delta(one + two + three, one + three, (5, 5, []))
    check_delta(one + two, one + three, (5, 5, three))
    check_delta([], one, (0, 0, one))
    check_delta(one + one, one, (5, 5, []))


def test_each_place_that_has_changed_is_a_change_of_its_own() -> None:
    trees = [f"BehaviorTree T{number}\n    Go\n" for number in range(9)]
    before = Workspace.of({"main.btq": "".join(trees)})
    shown, after = colours(before, "main.btq", "utf-16"), before
    for number, tree in ((2, "BehaviorTree T2\n    Stay\n"), (6, "BehaviorTree T6\n    Go\n    Go\n")):
        trees[number] = tree
        after = after.with_file("main.btq", "".join(trees))
    assert delta(shown, colours(after, "main.btq", "utf-16")) == [
        TokenEdit(2 * 15 + 10, 5, [1, 4, 4, 7, 0]),  # a longer word
        TokenEdit(7 * 15, 0, [1, 4, 2, 7, 0]),  # a line more, which stands before the next tree's first
    ]
