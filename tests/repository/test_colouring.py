"""What the editors' colouring is made of follows from the tables of btq_lang."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import vocabulary
from lxml import etree

from btq_lang.catalog.nodes import BUILTINS, spellings

ROOT = Path(__file__).resolve().parents[2]


def test_generated_files_are_fresh() -> None:
    run = subprocess.run(
        [sys.executable, str(ROOT / "tools" / "generate.py"), "--check"], capture_output=True, text=True
    )
    assert (run.returncode, run.stderr) == (0, "")


def test_every_node_of_the_engine_is_coloured() -> None:
    known = {*vocabulary.CONTROLS, *vocabulary.DECORATORS, *vocabulary.LEAVES, *vocabulary.NODE_SYMBOLS, "SubTree"}
    assert {word for kind in BUILTINS.values() for word in spellings(kind)} <= known


@pytest.mark.parametrize("words", [vocabulary.UNIT_SYMBOLS, vocabulary.NODE_SYMBOLS, vocabulary.DECORATORS])
def test_a_longer_word_stands_before_its_beginnings(words: tuple[str, ...]) -> None:
    anyone = re.compile("|".join(map(re.escape, words)))
    assert [word for word in words if (found := anyone.match(word)) is None or found.group() != word] == []


def test_kate_finds_the_mode_where_the_documentation_puts_it(tmp_path: Path) -> None:
    (command,) = re.findall(
        r"^mkdir .*kate/btq\.xml.*$", (ROOT / "docs" / "editors.md").read_text("utf-8"), re.MULTILINE
    )
    subprocess.run(["sh", "-euc", command], cwd=ROOT, env={"HOME": str(tmp_path), "PATH": os.defpath}, check=True)
    (mode,) = tmp_path.rglob("syntax/btq.xml")
    language = etree.parse(mode).getroot()
    contexts = {context.get("name") for context in language.iter("context")}
    assert {rule.get("context") for rule in language.iter("*")} - {None, "#stay", "#pop"} <= contexts
    styles = {style.get("name") for style in language.iter("itemData")}
    assert {rule.get("attribute") for rule in language.iter("*")} - {None} <= styles
    words = {item.text for item in language.iter("item")}
    assert {*vocabulary.ITEMS, *vocabulary.CLAUSE_WORDS, *vocabulary.VERB_WORDS, *vocabulary.DECORATORS} <= words


def test_the_recipe_for_emacs_has_the_words_that_begin_a_line() -> None:
    page = (ROOT / "docs" / "editors.md").read_text("utf-8")
    (quoted,) = re.findall(r"\(regexp-opt '\(([^)]*)\)", page)
    words = (*vocabulary.ITEMS, vocabulary.MODELS, *vocabulary.CATEGORY_WORDS, *vocabulary.PORT_WORDS)
    assert sorted(re.findall(r'"(\w+)"', quoted)) == sorted(words)
