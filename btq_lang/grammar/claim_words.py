"""The words that claims are made of, and whether some of them are next."""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.verbs import VERBS, words
from btq_lang.grammar.conditions import BOUNDS, HEADS, RELATIONS
from btq_lang.grammar.cursor import Cursor
from btq_lang.syntax.tokens import CLOSE, NAME, NEWLINE, OPEN, STRING

_BEFORE_BOUNDS: Final = frozenset(("fails", "finishes"))  # verbs there alone: elsewhere events, or names
# Those that follow a subject; `followed` is one only after `each … is`.
VERB_WORDS: Final = (
    frozenset(verb.partition(" ")[0] for verb in VERBS.keys() - words(operands=("answer",))) - _BEFORE_BOUNDS
)
HAPPENINGS: Final = frozenset(("starts", "succeeds", "fails", "finishes", "halts"))


def at_verb(cursor: Cursor) -> bool:
    """Whether the current word is a verb, as `fails` is before a bound alone."""
    if cursor.kind != NAME:
        return False
    if cursor.raw == "visits":  # one only where nodes follow
        return cursor.kinds[cursor.index + 1] in (NAME, STRING) and not is_verb_ahead(cursor, 1)
    return cursor.raw in VERB_WORDS or (cursor.raw in _BEFORE_BOUNDS and bound_follows(cursor, cursor.index + 1))


def bound_follows(cursor: Cursor, index: int) -> bool:
    """Whether a bound begins at a token; in a count, `within` does not begin one."""
    first = cursor.raws[index]
    if first == "between" or (first, *cursor.raws[index + 1 : index + 2]) in RELATIONS:
        return True
    if first == "within" or (first == "over" and cursor.is_word(index + 1, "last")):
        return False
    return any(tuple(cursor.raws[index : index + length]) in BOUNDS for length in (1, 2, 3, 4, 5))


def is_verb_ahead(cursor: Cursor, further: int) -> bool:
    """Whether the word `further` tokens ahead is a verb."""
    index = cursor.index + further
    return index < len(cursor.kinds) and cursor.kinds[index] == NAME and cursor.raws[index] in VERB_WORDS


def followed_ahead(cursor: Cursor) -> int:
    """The token `followed` of a clause that begins here; 0 if none does."""
    raws = cursor.raws
    for index in range(cursor.index + 2, len(raws) - 1):
        if raws[index] == "QualityReq" and raws[index - 1] == ",":
            return 0
        if raws[index] == "followed" and (raws[index - 1] == "is" or raws[index + 1] == "by"):
            return index
    return 0


def is_event_ahead(cursor: Cursor) -> bool:
    """Whether a path and what happens to it are next, rather than a condition and the verb of another clause."""
    last, kinds, raws = cursor.index, cursor.kinds, cursor.raws
    if kinds[last] not in (NAME, STRING):
        return False
    while raws[last + 1] == "/" and kinds[last + 2] in (NAME, STRING):
        last += 2
    last += 1
    if kinds[last] != NAME or raws[last] not in HAPPENINGS:
        return False
    if raws[last + 1] == "within":
        later = next((raw for raw in raws[last + 2 :] if raw == "after" or raw in VERB_WORDS or raw in HEADS), "")
        return later != "after"  # `starts within 2 s after …`
    return raws[last + 1] != "between" and tuple(raws[last + 1 : last + 3]) not in RELATIONS


def next_head(cursor: Cursor) -> int:
    """The next token that begins another clause, or ends the line or the brackets."""
    end = cursor.index
    depth = 0
    while cursor.kinds[end] != NEWLINE and not (cursor.kinds[end] == NAME and cursor.raws[end] in HEADS):
        depth += (cursor.kinds[end] == OPEN) - (cursor.kinds[end] == CLOSE)
        if depth < 0:
            break
        end += 1
    return end
