"""Patterns for the interpreter: the commonest spelling of what `plain` reads, in one step instead of many.

One invariant: what is read here, `plain` reads alike, character by character; the compiled `plain` does without.  So
it is only what needs no second look: words of letters, digits and `_`, single blanks, strings on one line.
"""

from __future__ import annotations

import re

from btq_lang.syntax import Pair, Word
from btq_lang.tokens import BRACED, CATEGORIES, DIRECTIONS, NAME, NODE_CLAUSES, NUMBER, STRING, SYMBOL, SYMBOLS

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

Head = tuple["Word | None", "Word | None", "Word | None", int]


def read_head(text: str, start: int, base: int) -> Head | None:
    """Kind [ Label ], before a bracket or the line's end: the category, the kind, the label, and where they end"""
    match = _HEAD(text, start)
    if match is None:
        return None
    first, second, third = match.groups()
    role = _ROLES.get(first, NAME)
    if role == _CATEGORY:
        word = Word(NAME, start - base, first)
        if second is None:
            return word, None, None, match.end()
        kind = Word(_KINDS.get(second[0], NAME), match.start(2) - base, second)
        if third is None:
            return word, kind, None, match.end()
        return word, kind, Word(_KINDS.get(third[0], NAME), match.start(3) - base, third), match.end()
    if role == _NO_NODE or third is not None:
        return None
    kind = Word(role, start - base, first)
    if second is None:
        return None, kind, None, match.end()
    return None, kind, Word(_KINDS.get(second[0], NAME), match.start(2) - base, second), match.end()


def read_pairs(text: str, at: int, blanks: str, base: int, pairs: list[Pair]) -> int:
    """{ Pair [ "," ] }; where the first attribute begins that is none, or is written in another way"""
    while match := _PAIR(text, at):
        key, value, line = match.groups()
        if line is not None and not line.startswith(blanks):
            break
        pairs.append(Pair(Word(NAME, at - base, key), Word(_KINDS.get(value[0], NAME), match.start(2) - base, value)))
        at = match.end()
    return at


_NAME: Final = r"[A-Za-z_]\w*"
_STRING: Final = r"\"[^\"\\\r\n]*\"|'[^'\\\r\n]*'"
# `(?:…|)` and not `(?:…)?`: it means the same and costs the engine a third.
_LABEL: Final = rf"(?: (?!satisfi|tags)({_NAME}|{_STRING})|)"
_HEAD: Final = re.compile(rf"({_NAME}|->|\?|\|\||[RAM]->|[RA]\?|All\|\|){_LABEL}{_LABEL}(?= ?\(|[\r\n])").match
# A number may have a unit; before a comma, a bracket, the line's end or the next key it has none.
_PAIR: Final = re.compile(
    rf"({_NAME}) ?= ?({_STRING}|{_NAME}|\{{[^{{}}\"'\r\n]*\}}|-?[0-9]+(?:\.[0-9]+|)(?=[,)\r\n]| \w+ ?=))"
    r"(?:,? |,?\n([ \t]+)(?=[\w)])|(?=[,)\r\n]))"
).match
_KINDS: Final = dict.fromkeys("\"'", STRING) | dict.fromkeys("-0123456789", NUMBER) | {"{": BRACED}
_CATEGORY: Final = -1
_NO_NODE: Final = -2  # a line may begin with it and perhaps be no node, or end brackets
_ROLES: Final = (
    dict.fromkeys(SYMBOLS, SYMBOL)
    | dict.fromkeys(CATEGORIES, _CATEGORY)
    | dict.fromkeys((*NODE_CLAUSES, *DIRECTIONS, "xml", "BehaviorTree", "Root", "TreeNodesModel"), _NO_NODE)
)
