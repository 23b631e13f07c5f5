"""Comments: to which element each belongs."""

from __future__ import annotations

from textwrap import dedent

import pytest
from hypothesis import given
from hypothesis import strategies as st
from layouts import relaid

from btq_lang.lexer import tokens
from btq_lang.parser import parse
from btq_lang.syntax.tokens import COMMENT
from btq_lang.workspace.comments import Comment, Comments, comments

PLACES = ("before", "within", "after", "first", "last")


def places(text: str) -> dict[str, dict[str, list[str]]]:
    """The comments' texts by the first line of their element, and the end of the file as ``."""
    text = dedent(text)
    found: dict[str, dict[str, list[str]]] = {}
    for start, by_place in comments(parse(text)).items():
        line = text[start:].split("\n")[0]
        found[line] = {
            place: [comment.text.strip() for comment in getattr(by_place, place)]
            for place in PLACES
            if getattr(by_place, place)
        }
    return found


def test_the_key_is_where_the_element_begins_in_the_file() -> None:
    text = "# of the signal\nsignal b : %\nBehaviorTree A\n    Foo  // of Foo \n"
    parsed = parse(text)
    (_, tree) = parsed.entries
    (foo,) = parsed.trees[0].children
    assert comments(parsed) == {
        text.index("signal b"): Comments(before=(Comment(0, "# of the signal"),)),
        tree.start + foo.start: Comments(after=(Comment(text.index("//"), "// of Foo"),)),
    }


def test_no_comments() -> None:
    assert comments(parse('BehaviorTree A\n    Foo (x = "/#")\n')) == {}


def test_a_comment_line_belongs_to_the_last_line_above_that_stands_further_left() -> None:
    assert places("""
        # 1
        BehaviorTree A
            # 2
            ->
                # 3
                Foo
                    # 4
            # 5
                Bar
                # 6
              # 7
            # 8
          # 9
        # 10
        BehaviorTree B
            Baz
            # 11
        # 12
    """) == {
        "BehaviorTree A": {"before": ["1"], "last": ["8", "9"]},
        "->": {"before": ["2"], "last": ["6", "7"]},
        "Foo": {"before": ["3"], "last": ["4"]},
        "Bar": {"before": ["5"]},
        "BehaviorTree B": {"before": ["10"], "last": ["11"]},
        "": {"before": ["12"]},
    }


def test_a_tab_before_a_comment_is_four_columns() -> None:
    text = "BehaviorTree A\n\t->\n\t\tFoo\n    # of A\n        # of the sequence\n             # of Foo\n"
    assert places(text) == {
        "BehaviorTree A": {"last": ["of A"]},
        "->": {"last": ["of the sequence"]},
        "Foo": {"last": ["of Foo"]},
    }


def test_a_comment_behind_a_line_with_a_block_is_the_first_in_the_block() -> None:
    assert places("""
        BehaviorTree A  # 1
            ->  # 2
                Foo  # 3
                Bar  # 4
                    # 5
                Baz  # 6
                    satisfices safety  # 7
    """) == {
        "BehaviorTree A  # 1": {"first": ["1"]},
        "->  # 2": {"first": ["2"]},
        "Foo  # 3": {"after": ["3"]},
        "Bar  # 4": {"first": ["4"], "last": ["5"]},
        "Baz  # 6": {"first": ["6"]},
        "satisfices safety  # 7": {"after": ["7"]},
    }


def test_comments_in_brackets_and_in_front_are_within() -> None:
    assert places("""
        BehaviorTree A
            /* 1 */ /* 2 */ Foo ( # 3
                x = 1  # 4
                // 5
            ) /* 6 */ satisfices safety # 7
            /* 8
        */  Bar
    """) == {
        "Foo ( # 3": {"within": ["1", "2", "3", "4", "5", "6"], "after": ["7"]},
        "Bar": {"within": ["8"]},
    }


def test_lines_of_clauses_ports_and_models_are_elements() -> None:
    assert places("""
        Action Foo
            # 1
            input x : string  # 2
            # 3
        BehaviorTree A
            # 4
            input y : string
            # 5
            satisfices safety
            # 6
            Foo
                # 7
                satisfies QualityReq r
                    # 8
                    takes at most 3 s  # 9
                    # 10
                # 11
    """) == {
        "Action Foo": {"last": ["3"]},
        "input x : string  # 2": {"before": ["1"], "after": ["2"]},
        "input y : string": {"before": ["4"]},
        "satisfices safety": {"before": ["5"]},
        "Foo": {"before": ["6"], "last": ["11"]},
        "satisfies QualityReq r": {"before": ["7"], "last": ["10"]},
        "takes at most 3 s  # 9": {"before": ["8"], "after": ["9"]},
    }


def test_the_block_of_a_root() -> None:
    assert places("""
        # 1
        Root A  # 2
            # 3
            BehaviorTree A
                Foo
            # 4
        # 5
    """) == {
        "Root A  # 2": {"before": ["1"], "first": ["2"], "last": ["4"]},
        "BehaviorTree A": {"before": ["3"]},
        "": {"before": ["5"]},
    }


def test_a_file_of_comments() -> None:
    assert places("\ufeff# 1\n\n  # 2\n    // 3") == {"": {"before": ["1", "2", "3"]}}


@pytest.mark.parametrize(
    ("raw", "text"),
    [
        ("# t", " t"),
        ("#t", "t"),
        ("//# t", "# t"),
        ("#", ""),
        ("/* t\r\n  u */", " t\n  u "),
        ("/**/", ""),
        ("/*/", "/"),  # not closed
    ],
)
def test_the_text_of_a_comment(raw: str, text: str) -> None:
    assert Comment(0, raw).text == text


def placed(text: str) -> list[int]:
    found = comments(parse(text)).values()
    return sorted(comment.start for by_place in found for place in PLACES for comment in getattr(by_place, place))


def written(text: str) -> list[int]:
    return [token.start for token in tokens(text) if token.kind == COMMENT]


@given(st.text('A# /*\n\t("){=\r', max_size=60))
def test_every_comment_of_any_text_is_placed_once(text: str) -> None:
    assert placed(text) == written(text)


@given(st.integers(0, 1 << 32))
def test_every_comment_of_a_file_is_placed_once(seed: int) -> None:
    text = "BehaviorTree A\n    ->\n        Foo (x = 1 satisfies q)\n        satisfies r\n    Bar\nsignal b : %\n"
    text = relaid(text, seed)
    assert placed(text) == written(text)
