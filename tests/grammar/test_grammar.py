"""docs/grammar.md: sentences that it makes are read without a complaint, and no word of the parser is left out."""

from __future__ import annotations

import importlib
import pkgutil
import random
import re
from itertools import pairwise
from pathlib import Path
from typing import TypeAlias

import pytest
from seeds import seeds

from btq_lang import grammar as productions
from btq_lang.grammar.claim_words import HAPPENINGS, VERB_WORDS
from btq_lang.grammar.clauses import ACTIONS, EXPERIMENTS, METHODS
from btq_lang.grammar.conditions import COMPARISONS, FUNCTIONS, HEADS, METADATA_HEADS
from btq_lang.grammar.hazards import HAZARD_HEADS
from btq_lang.grammar.item_words import ITEM_WORDS
from btq_lang.grammar.scenario_words import ANSWERS, DURATIONS, ORDINALS, RESULTS, STEPS, TIMES, VERDICTS
from btq_lang.parser import parse
from btq_lang.syntax.tokens import DIRECTIONS, NODE_CLAUSES, SYMBOLS

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "grammar.md").read_text(encoding="utf-8")
TOKENS = {
    "NAME": ("alpha", "beta-2", "gamma_", "Größe", "delta?"),
    "STRING": ('"a string"', "'another'"),
    "NUMBER": ("6", "0.25", "1e3"),
    "COUNT": ("1", "6"),
    "QUANTITY": ("30 s", "3 %", "0.25 m/s"),
    "UNIT": ("s", "%", "m/s", "1", "bool"),
    "BRACED": ("{entry}", "{@entry}", "{=}"),
    "SYMBOL": tuple(sorted(SYMBOLS)),
}
LAYOUT = ("NL", "INDENT", "DEDENT")
WITHOUT_A_FUNCTION = {  # productions, and why
    "Edition": "a name to the parser; the checks know the editions",
    "Category": "a set of words",
    "Kind": "`parse_node` decides between it and a label by what follows",
    "Label": "as Kind",
    "Attribute": "the branches of the loop in `parse_attributes`, of which a file has thousands",
    "ReqHead": "of two forms, which `parse_requirement` and `parse_classic_requirement` read with their clauses",
    "Name": "a word of two kinds, which `Cursor.name` takes",
    "Cmp": "a set of words",
    "Func": "a set of words",
}

# A part of a rule: ("word", its text), ("name", of a production), ("one" or "all", parts), ("maybe" or "many", part).
Part: TypeAlias = tuple[str, "str | Part | list[Part]"]


def grammar() -> dict[str, Part]:
    """The productions of the page."""
    (text,) = re.findall(r"^```ebnf\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    text = re.sub(r"\(\*.*?\*\)", "", text)
    words = re.findall(r'"[^"]*"|\w+|[=;|{}\[\]()]', text)
    found: dict[str, Part] = {}
    while words:
        name, equals = words.pop(0), words.pop(0)
        assert (name.isidentifier(), equals, name in found) == (True, "=", False)
        found[name] = _either(words)
        assert words.pop(0) == ";"
    return found


def _either(words: list[str]) -> Part:
    parts = [_sequence(words)]
    while words[0] == "|":
        words.pop(0)
        parts.append(_sequence(words))
    return parts[0] if len(parts) == 1 else ("one", parts)


def _sequence(words: list[str]) -> Part:
    closing = {"(": ")", "[": "]", "{": "}"}
    parts: list[Part] = []
    while words[0] not in ("|", ";", ")", "]", "}"):
        word = words.pop(0)
        if word in closing:
            inner = _either(words)
            assert words.pop(0) == closing[word]
            parts.append({"(": inner, "[": ("maybe", inner), "{": ("many", inner)}[word])
        else:
            parts.append(("word", word[1:-1]) if word.startswith('"') else ("name", word))
    return ("all", parts)


RULES = grammar()


def sentence(chance: random.Random) -> str:
    """A random file."""
    words: list[str] = []
    _derive(("name", "File"), chance, words, 0)
    for index in [at for at, pair in enumerate(pairwise(words)) if pair[0] in TOKENS["QUANTITY"] and pair[1] == "("]:
        words[index] = TOKENS["NUMBER"][0]  # a word before a bracket is no unit
    lines, line, level = [], "", 0
    for word in words:
        if word in ("INDENT", "DEDENT"):
            level += 1 if word == "INDENT" else -1
        elif word == "NL":
            lines.append("    " * level + line.strip())
            line = ""
        else:
            if word == "(":  # what is before it is no unit
                line = re.sub(r"(?<=\d) (?:s|%|m/s)$", "", line)
            line += word if word == "::" or line.endswith("::") else f" {word}"
    return "\n".join(lines) + "\n"


def _derive(part: Part, chance: random.Random, words: list[str], depth: int) -> None:
    kind, what = part
    if kind == "one" and not in_scenario(words):
        what = [each for each in what if each != ("all", [("name", "Entry")])]  # type: ignore[misc]  # a list here
    likely = 0.5 * 0.85**depth  # less and less goes deeper
    if kind == "word":
        words.append(str(what))
    elif kind == "name":
        if what in TOKENS:
            words.append(chance.choice(TOKENS[str(what)]))
        elif what in LAYOUT:
            words.append(str(what))
        else:
            _derive(RULES[str(what)], chance, words, depth + 1)
    elif kind == "all":
        for each in what:
            _derive(each, chance, words, depth)  # type: ignore[arg-type]  # a list here
    elif kind == "one":
        # Below a certain depth only first alternatives, which are not recursive.
        _derive(chance.choice(what if depth < 25 else what[:1]), chance, words, depth)  # type: ignore[arg-type]  # as above
    elif kind == "maybe":
        if chance.random() < likely:
            _derive(what, chance, words, depth)  # type: ignore[arg-type]  # a part here
    else:
        while chance.random() < (0.9 if depth < 3 else likely):
            _derive(what, chance, words, depth)  # type: ignore[arg-type]  # as above


def in_scenario(words: list[str]) -> bool:
    """Whether the open block is that of a scenario."""
    tail = words[-1 - words[::-1].index("scenario") :] if "scenario" in words else []
    return "INDENT" in tail and tail[tail.index("NL") + 1] == "INDENT" and "DEDENT" not in tail


def test_every_production_is_used_and_defined() -> None:
    used = set(re.findall(r"\('name', '(\w+)'\)", repr(list(RULES.values()))))
    assert used - set(TOKENS) - set(LAYOUT) == set(RULES) - {"File"}


def test_every_production_is_a_function_of_the_same_name() -> None:
    modules = [module.name for module in pkgutil.iter_modules(productions.__path__, "btq_lang.grammar.")]
    functions = set().union(*(vars(importlib.import_module(name)) for name in [*modules, "btq_lang.parser"]))
    named = {production: re.sub(r"(?<!^)(?=[A-Z])", "_", production).lower() for production in RULES}
    without = {production for production, name in named.items() if f"parse_{name}" not in functions}
    assert without == set(WITHOUT_A_FUNCTION)


@pytest.mark.parametrize("seed", seeds(400))
def test_what_the_grammar_makes_is_read(seed: int) -> None:
    text = sentence(random.Random(seed))
    found = [each for each in parse(text).diagnostics if each.rule == "syntax-error"]
    found = [
        each for each in found if not each.message.startswith("unexpected given")
    ]  # the page: only before scenarios
    assert [(text[each.span.start :].split("\n")[0], each.message) for each in found] == []


def test_no_word_of_the_parser_is_left_out() -> None:
    words = set(re.findall(r"\('word', '([^']+)'\)", repr(list(RULES.values()))))
    known = {
        *ITEM_WORDS,
        *NODE_CLAUSES,
        *DIRECTIONS,
        *VERB_WORDS,
        *HEADS,
        *METADATA_HEADS,
        *HAZARD_HEADS,
        *HAPPENINGS,
        *EXPERIMENTS,
        *ACTIONS,
        *METHODS,
        *STEPS,
        *RESULTS,
        *DURATIONS,
        *ANSWERS,
        *TIMES,
        *ORDINALS,
        *(word for verdict in VERDICTS for word in verdict),
    }
    assert known | set(FUNCTIONS) | set(COMPARISONS) <= words
    assert all(f"`{symbol}`".replace("|", "\\|") in PAGE for symbol in SYMBOLS if symbol.isascii())
