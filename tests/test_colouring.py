"""What the editors' colouring is made of follows from the tables of btq_lang."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools"))

import vocabulary  # noqa: E402  # the tools are scripts, no package

from btq_lang.catalog.nodes import BUILTINS, spellings  # noqa: E402  # as above


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
