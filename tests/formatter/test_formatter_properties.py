"""The formatter, whatever the text: nothing that the file says is lost or moved, and once is enough."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from layouts import has_errors, places, relaid, said, words
from missions import mission
from seeds import share_of

from btq_lang.formatter import FormatOptions, format_range, format_text
from btq_lang.lexer import tokens
from btq_lang.parser import parse
from btq_lang.syntax.tokens import BLANK, COMMENT, DEDENT, INDENT
from btq_lang.util.text import apply_edits

ROOT = Path(__file__).resolve().parents[2]
EVERY_FORM = (ROOT / "tests" / "every_form.btq").read_text("utf-8")
EXAMPLES = sorted(path for path in (ROOT / "examples").rglob("*") if path.suffix in (".btq", ".qualitybtcpp"))
TEXTS = (
    EVERY_FORM,
    *(path.read_text("utf-8") for path in EXAMPLES),
    mission(40, 1, "classic"),
    mission(40, 2, "short"),
)
DEFAULTS = FormatOptions()

LAYOUTS = st.builds(relaid, st.sampled_from((EVERY_FORM, *TEXTS)), st.integers(0, 2**32))
OPTIONS = st.builds(FormatOptions, st.sampled_from((100, 60, 30, 8)), st.sampled_from((4, 2, 1, 8)))
# Words of the language and separators: a random text of these is now and then valid.
PIECES = [
    *sorted({token.text for token in tokens(EVERY_FORM) if token.kind != COMMENT}),
    *("# c\n", "/* c */", "\n", "\n    ", "\n        ", "\t", "\r", "(", ")", "- ", "-1", "\ufeff", "\x0c", "\u2028"),
]


def assert_holds(text: str, options: FormatOptions = DEFAULTS) -> None:
    """What the formatter promises of every text."""
    done = format_text(text, options)
    assert (done.refused is not None) == has_errors(text)
    assert apply_edits(text, done.edits) == done.text
    if done.refused is not None:
        assert done.text == text
        return
    assert not has_errors(done.text)
    assert format_text(done.text, options).text == done.text
    assert_says_the_same(text, done.text)
    line_end = re.search(r"\r\n|\n|\r", text)
    if line_end is not None and line_end[0] == "\r\n":
        assert done.text.count("\n") == done.text.count("\r\n")
        done = format_text(text.replace("\r\n", "\n"), options)
    assert not re.search(r"[ \t]\n|\r|\n\n\n|^\n|[^\n]\Z", without_texts(done.text))


def assert_says_the_same(before: str, after: str) -> None:
    """The same tree; the same words as they were written; every comment where it belonged."""
    assert said(after) == said(before)
    old, new = places(before), places(after)
    if words(after) == words(before):
        assert new == old
    else:  # clauses are sorted
        assert sorted(words(after)) == sorted(words(before))
        assert sorted(map(repr, new)) == sorted(map(repr, old))


def without_texts(text: str) -> str:
    """A file with `…` for each string and comment, which may hold anything."""
    kept = (token.text if token.text[:1] not in ("#", "/", '"', "'") else "…" for token in tokens(text))
    return "".join(kept)


def top_items() -> list[str]:
    """The items of `EVERY_FORM`, one by one: a whole `Root` is one."""
    starts = [entry.start for entry in parse(EVERY_FORM).entries if not entry.in_root]
    return [EVERY_FORM[start:end] for start, end in zip(starts, [*starts[1:], None], strict=True)]


@pytest.mark.parametrize("text", TEXTS, ids=["every form", *(path.name for path in EXAMPLES), "classic", "short"])
def test_every_example(text: str) -> None:
    assert not has_errors(text)
    assert_holds(text)


@given(LAYOUTS, OPTIONS)
def test_every_layout(text: str, options: FormatOptions) -> None:
    assert_holds(text, options)


@given(st.sampled_from(TEXTS), st.integers(0, 2**32))
def test_texts_with_words_put_in_left_out_and_exchanged(text: str, seed: int) -> None:
    draw = random.Random(seed)
    pieces = [token.text for token in tokens(text)]
    for _ in range(draw.randint(1, 3)):
        start = draw.randrange(len(pieces))
        pieces[start : start + draw.randrange(2)] = draw.choices(PIECES, k=draw.randrange(2))
    assert_holds("".join(pieces))


@given(st.text() | st.lists(st.sampled_from(PIECES)).map("".join))
def test_any_text(text: str) -> None:
    assert_holds(text)


@pytest.mark.parametrize("item", [pytest.param(text, id=text.split("\n")[0][:30]) for text in top_items()])
def test_every_beginning_and_every_word_left_out(item: str) -> None:
    for token in share_of([each for each in tokens(item) if each.kind not in (BLANK, INDENT, DEDENT)], 4):
        assert_holds(item[: token.start])
        assert_holds(item[: token.start] + item[token.end :])


@given(LAYOUTS, st.integers(0, 2**32), st.booleans())
def test_every_range(text: str, seed: int, formatted: bool) -> None:
    draw = random.Random(seed)
    if formatted:  # but for a line here and there
        text = "".join(
            line.replace(" = ", "=") + draw.choice(("", "", "", "  # c\n", "\n"))
            for line in format_text(text).text.splitlines(keepends=True)
        )
    start = draw.randrange(len(text) + 1)
    end = draw.randint(start, len(text))
    done = format_text(text)
    edits = format_range(text, start, end)
    assert set(edits) <= set(done.edits)
    assert format_range(text, 0, len(text)) == done.edits
    if done.refused is None:
        after = apply_edits(text, edits)
        assert not has_errors(after)
        assert_says_the_same(text, after)
        assert format_text(after).text == done.text
