"""The missions drawn for the benchmark of the parser: legal, of the size asked for, and of every production."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from drawn_missions import mission, missions
from seeds import seeds, share_of

from btq_lang.parser import parse

GRAMMAR = (Path(__file__).resolve().parents[2] / "docs" / "grammar.md").read_text(encoding="utf-8")


def nodes(text: str) -> int:
    return sum(1 for tree in parse(text).trees for _ in tree.walk())


@pytest.mark.parametrize("seed", share_of(seeds(60), 4))
def test_a_drawn_mission_has_no_syntax_error(seed: int) -> None:
    text = mission(80, seed)
    found = [(text[each.span.start :].split("\n")[0], each.message) for each in parse(text).diagnostics]
    assert found == []
    assert nodes(text) == 80


def test_missions_have_the_nodes_asked_for_and_are_those_of_their_seed() -> None:
    drawn = missions(1_000, 20261125)
    assert sum(map(nodes, drawn)) == 1_000
    assert drawn == missions(1_000, 20261125)
    assert set(drawn).isdisjoint(missions(1_000, 20261126))


def test_every_word_of_the_grammar_is_drawn() -> None:
    (rules,) = re.findall(r"^```ebnf\n(.*?)^```$", GRAMMAR, re.DOTALL | re.MULTILINE)
    (symbols,) = re.findall(r"^\| SYMBOL \| (.*) \|$", GRAMMAR, re.MULTILINE)
    words = {*re.findall(r'"([^"]+)"', rules), *symbols.replace("`", "").replace("\\", "").split()}
    text = "\n".join(mission(80, seed) for seed in range(300))
    drawn = set(re.findall(r"[\w-]+", text))
    assert {word for word in words if word not in (drawn if word.replace("-", "").isalnum() else text)} == set()


def test_all_layouts_are_drawn() -> None:
    text = "".join(mission(80, seed) for seed in range(60))
    for written in ("\r\n", "\n\t", "\n  ", "\n   ", "# ", "// ", "/* ", "\n\n", " \n", "(\n", "→"):
        assert written in text
