"""The words of the language: all of them, each in a form that can be written, and as docs/language.md has them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from btq_lang.catalog.language import PHRASES, Phrase, beginning, phrase_at, phrases_of
from btq_lang.catalog.verbs import COUNTING
from btq_lang.grammar.claim_words import HAPPENINGS, VERB_WORDS
from btq_lang.grammar.clauses import ACTIONS, AVERAGE, EXPERIMENTS, METHODS, TIME
from btq_lang.grammar.conditions import FUNCTIONS, HEADS, METADATA_HEADS
from btq_lang.grammar.hazards import HAZARD_HEADS
from btq_lang.grammar.item_words import ITEM_WORDS
from btq_lang.grammar.scenario_words import DURATIONS, ORDINALS, RESULTS, STEPS, TIMES, VERDICTS
from btq_lang.parser import parse
from btq_lang.syntax.tokens import NODE_CLAUSES

DOCS = (Path(__file__).resolve().parents[2] / "docs" / "language.md").read_text("utf-8")
FORMS = {
    "part of a model": "Action X\n    {}\n",
    "clause of a node": "BehaviorTree X\n    A {}\n",
    "attribute of a node": "BehaviorTree X\n    {}\n",
    "clause of a hazard": "hazard x\n    {}\n",
    "event": "QualityReq x\n    {}\n",
    **dict.fromkeys(("step of a scenario", "behavior of a node", "change during the run"), 'scenario "x"\n    {}\n'),
    "expectation": 'scenario "x"\n    {}\n',
    **dict.fromkeys(
        ("item", "part of a signal", "part of a scenario", "selector", "attribute of the file", "classic form"), "{}\n"
    ),
}


def words_of(*parts: str) -> set[str]:
    return {word for phrase in PHRASES if not parts or phrase.part in parts for word in phrase.words.split()}


def test_no_word_of_the_grammar_is_left_out() -> None:
    others = {"every", "is", "followed", "by", "with", "for", "of", "time", "at", "least", "most", "per", "on", AVERAGE}
    assert words_of("claim") - others == VERB_WORDS | COUNTING
    assert words_of("event") - {"when", "or"} == HAPPENINGS
    assert words_of("action") == set(ACTIONS)
    assert words_of("method") == set(METHODS)
    assert words_of("item") == set(ITEM_WORDS)
    assert words_of("clause of a node") - {"parameters"} == set(NODE_CLAUSES)
    assert words_of("step of a scenario") == set(STEPS)
    assert words_of("behavior of a node") == {
        *(*RESULTS, *DURATIONS, *TIMES, "not", "end", "times", "then", "and", "writes"),
    }
    assert words_of("change during the run") >= set(ORDINALS)
    assert words_of("expectation") >= {word for verdict in VERDICTS for word in verdict}
    assert words_of() >= HEADS | METADATA_HEADS | FUNCTIONS | EXPERIMENTS | {*HAZARD_HEADS, TIME}


@pytest.mark.parametrize("phrase", PHRASES, ids=lambda phrase: f"{phrase.words}, {phrase.part}")
def test_a_form_can_be_written(phrase: Phrase) -> None:
    form = phrase.form
    if phrase.words == "parameters":
        form = f"({form})"
    text = FORMS.get(phrase.part, "QualityReq x\n    {}\n").format(form)
    if phrase.words in ("BehaviorTree",):
        text += "    A\n"
    assert [found.message for found in parse(text).diagnostics] == []
    assert set(phrase.words.split()) <= set(re.findall(r"[\w-]+", form))


def test_the_page_says_the_same() -> None:
    """Of claims and clauses; `with probability` stands in the rows of others."""
    left_out = {("clause", words) for words in ("with probability", "activations", "runs", "occurrences")}
    rows = [
        f"| `{phrase.form}` | {phrase.meaning} |"
        for phrase in PHRASES
        if phrase.part in ("claim", "clause") and (phrase.part, phrase.words) not in left_out
    ]
    assert [row for row in rows if row not in DOCS] == []


def test_words_are_found() -> None:
    assert [phrase.part for phrase in phrases_of("starts")] == ["claim", "event"]
    assert [phrase.words for phrase in phrases_of("violation")] == ["on violation"]
    assert [phrase.words for phrase in phrases_of("on  violation")] == ["on violation"]
    assert phrases_of("violation on") == phrases_of("") == ()
    assert [beginning(words).words for words in ("takes at most", "runs every", "runs at least")] == [
        *("takes", "runs every", "runs"),
    ]


def test_places_in_a_line() -> None:
    line = "takes at most 30 s on violation fail"
    assert [phrase_at(line, at) for at in (0, 6, 10, 13, 15, 21, 36)] == [
        *((0, "takes"), (6, "at most"), (6, "at most"), (6, "at most"), None, (19, "on violation"), (32, "fail")),
    ]
    assert phrase_at("never_mind", 3) is None
    assert phrase_at("fail-safe", 3) is None
