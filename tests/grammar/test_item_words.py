"""What items begin with: what was meant by a misspelt word, and includes that are found without parsing."""

from __future__ import annotations

import random

import pytest
from seeds import seeds

from btq_lang.grammar.item_words import item_word_meant, read_as
from btq_lang.parser import parse
from btq_lang.syntax.tree import Include
from btq_lang.workspace.file import File

PIECES = (
    *("enclude", "Include", "inclde", "incldue", "inc", "lude", "_", "-", "?", "1", "ä", "$", "import"),
    *(' "a.btq"', '"a.btq"', " a.btq", " (ros_pkg = x)", "(", ")", '"', "#", "/*", "*/", " x ", "\ufeff", "\xa0"),
    *("\n", "\r", "\r\n", "\u2028", "    ", "\t", "Root x\n", "BehaviorTree M\n    Go\n", "QualityReq r\n"),
)


@pytest.mark.parametrize(
    ("word", "meant", "read"),
    [
        ("enclude", "include", "include"),
        ("INCLUDE", "include", "include"),
        ("inlcude", "include", "include"),
        ("indlute", "include", ""),
        ("Rot", "Root", "Root"),
        ("Acton", "Action", ""),
        ("skills", "", ""),
        ("", "", ""),
    ],
)
def test_a_misspelt_word(word: str, meant: str, read: str) -> None:
    assert item_word_meant(word) == meant
    assert read_as(word) == read


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        ("import require use", "include"),
        ("requirement req qualityrequirement", "QualityReq"),
        ("mission Mission tree behaviourtree bt def class", "BehaviorTree"),
        ("sensor variable var measure metric", "signal"),
        ("mode situation", "context"),
    ],
)
def test_a_word_of_another_language(words: str, meant: str) -> None:
    for word in words.split():
        (problem,) = parse(f"{word} M\n").diagnostics
        assert problem.message == f"unknown word `{word}`; did you mean `{meant}`?"


def test_a_word_with_one_slip_is_read_as_include() -> None:
    word, letters = "include", "abcdefghijklmnopqrstuvwxyzä"
    slips = {word[:at] + word[at + 1 :] for at in range(7)}
    slips.update(word[:at] + word[at + 1 : at + 2] + word[at : at + 1] + word[at + 2 :] for at in range(7))
    slips.update(word[:at] + letter + word[at + gone :] for at in range(8) for letter in letters for gone in (0, 1))
    assert {read_as(slip) for slip in slips - {word}} == {"include"}


@pytest.mark.parametrize("word", ["include", "enclude", "Include", "incl_ude", "inclute"])
@pytest.mark.parametrize(
    "line", ['{} "a.btq"\n', '\n\t{}"a.btq"', "Root\r{} a.btq\r", '/* a\n*/ {} "a.btq"', "\ufeff{} a"]
)
def test_an_include_however_it_is_spelt(word: str, line: str) -> None:
    assert [type(each) for each in File("/p/m.btq", line.format(word)).includes] == [Include]


def test_what_has_none_is_not_parsed() -> None:
    file = File("/p/m.btq", "Root M\nBehaviorTree M\n    Drive # exclusively\n")
    assert file.includes == ()
    assert not file.is_parsed


@pytest.mark.parametrize("seed", seeds(20))
def test_no_include_is_overlooked(seed: int) -> None:
    chance = random.Random(seed)
    for _ in range(200):
        text = "".join(chance.choices(PIECES, k=chance.randrange(1, 12)))
        assert File("/p/m.btq", text).includes == parsed_includes(text), text


def parsed_includes(text: str) -> tuple[Include, ...]:
    return tuple([entry.item for entry in parse(text).entries if isinstance(entry.item, Include)])
