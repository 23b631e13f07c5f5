"""Damaged questions and trees: they are refused, and never raise."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from random import Random

import pytest
from drawn_trees import drawn
from exploring import Exploring
from json_schema import violations
from seeds import seeds

import btq_lang.exploration
from btq_lang.exploration.questions import NoQuestion, parse_question

SCHEMA = json.loads(Path(btq_lang.exploration.__file__).with_name("explore.schema.json").read_text(encoding="utf-8"))
QUESTIONS = (
    "Act starts",
    "Act succeeds before Do fails",
    "mission fails after when {x} == 1",
    "node Act and not ({x} < 3 or {y} >= -2)",
    "Do reads {z} unset",
    "mission does not end",
    "when {x} > 3 and node Act",
)


def damaged(random: Random, text: str) -> str:
    for _ in range(random.randint(1, 4)):
        at = random.randrange(len(text) + 1)
        piece = random.choice(("", " ", "{", "}", '"', "before", "(", "9", "§", "not ", "\n", "<", "&"))
        text = text[:at] + piece + text[at + random.randint(0, 3) :]
    return text


@pytest.mark.parametrize("seed", seeds(20))
def test_damaged_questions(seed: int) -> None:
    random = Random(seed)
    for _ in range(50):
        text = damaged(random, random.choice(QUESTIONS))
        with suppress(NoQuestion):
            assert parse_question(text).text == text


@pytest.mark.parametrize("seed", seeds(40))
def test_drawn_and_damaged_trees(explore: Exploring, seed: int) -> None:
    random = Random(seed)
    xml = drawn(random)
    explore.mission(xml if seed % 2 else damaged(random, xml), "tree.xml")
    question = ["--can", random.choice(QUESTIONS)] if random.random() < 0.7 else []
    code, out, err = explore("--format", "json", "--states", "200", *question)
    assert code in (0, 1, 2)
    if code == 2:
        assert err.startswith("btq explore: ") or "tree.xml" in err
    else:
        assert list(violations(json.loads(out), SCHEMA)) == []


def test_a_tree_of_many_levels(explore: Exploring) -> None:
    explore.tree("<Inverter>" * 3_000 + "<A/>" + "</Inverter>" * 3_000)
    assert explore()[0] == 2


@pytest.mark.parametrize(
    "tree",
    [
        "",
        "<A/><B/>",
        "<Inverter/>",
        "<Sequence/>",
        "<Script/>",
        '<Script code="x :="/>',
        '<ScriptCondition code=""/>',
        '<SetBlackboard output_key="x"/>',
        '<Switch2 variable="{x}"><A/></Switch2>',
        '<Parallel success_count="9"><A/></Parallel>',
        '<Repeat num_cycles="{n}"><A/></Repeat>',
        "<Precondition><A/></Precondition>",
        '<SubTree ID="Main"/>',
        '<SubTree ID="Other"/>',
        "<Unknown><A/></Unknown>",
        '<LoopInt value="{x}"><A/></LoopInt>',
        '<Timeout msec="soon"><A/></Timeout>',
        "<WasEntryUpdated/>",
    ],
)
def test_trees_that_the_engine_refuses_or_that_throw(explore: Exploring, tree: str) -> None:
    explore.tree(tree)
    code, _, err = explore("--strict")
    assert code in (1, 2)
    assert (code == 2) == err.startswith("btq explore: tree.xml: ")
