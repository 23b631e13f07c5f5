"""Plain lines of requirements, read word by word: a short cut past the tokens, as `plain` is for the lines of nodes.

One invariant, that of `plain`: what is read here is what `ClauseParser` makes of it, with nothing to complain of, and
of anything unusual the answer is None.  Plain is a line whose words stand one blank apart, with nothing behind them,
so a word is what `str.split` finds.  Only the commonest clauses are known here, each without a subject.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import cache
from typing import Final

from btq_lang.claims import RELATIONS
from btq_lang.clauses import ACTIONS, EXPERIMENTS, METHODS
from btq_lang.conditions import COMPARISONS, HEADS
from btq_lang.scan import is_name, is_unit, unit_at
from btq_lang.syntax import (
    Amount,
    Because,
    Bound,
    Claim,
    Clause,
    Comparison,
    Condition,
    Goal,
    How,
    Odds,
    OnViolation,
    Operand,
    QualityPath,
    Requirement,
    Scope,
    Window,
    Word,
)
from btq_lang.tokens import NAME, NUMBER, QUANTITY, STRING


def plain_requirement(text: str, start: int, base: int) -> tuple[Requirement, int] | None:
    """ "QualityReq" Name [ ":" QualityPath ] [ STRING ] NL

    Args:
        start: where the word QualityReq begins.
        base: where the item begins; offsets in the tree count from there.

    Returns:
        The requirement without the clauses of its block, and where the next line begins.
    """
    line, following = line_at(text, start)
    if following < 0:
        return None
    head, quote, title = line.partition('"')
    words = head.split(" ")
    if quote and words.pop() != "":
        return None
    at = start - base
    end = at + len(line)
    said = None
    if quote:
        said = _string(quote + title, end - len(title) - 1)
        if said is None:
            return None
    if len(words) not in (2, 4) or not is_name(words[1]):
        return None
    name = Word(NAME, at + len("QualityReq "), words[1])
    quality = None
    if len(words) == 4:
        quality = _quality_path(words[3], name.end + len(" : "))
        if words[2] != ":" or quality is None:
            return None
    return Requirement(at, end, name, False, (), quality, said, ()), following


def plain_clause_line(text: str, start: int, base: int) -> tuple[list[Clause], int, int] | None:
    """Clause { Clause } NL: a line in the block of a requirement

    Returns:
        The clauses, where the last of them ends, counted from the item, and where the next line begins.
    """
    line, following = line_at(text, start)
    if following < 0:
        return None
    words = line.split(" ")
    found: list[Clause] = []
    index = 0
    at = start - base
    try:
        while index < len(words):
            clause, index = _CLAUSES[words[index]](words, index, at)
            found.append(clause)
            at = clause.end + 1
    except (KeyError, IndexError):
        return None
    return found, at - 1, following


def line_at(text: str, start: int) -> tuple[str, int]:
    """The line without its end, and where the next begins; -1 where none does"""
    end = text.find("\n", start)
    line = text[start:end].removesuffix("\r")
    return line, end + 1 if end >= 0 and "\r" not in line else -1


# ---- clauses --------------------------------------------------------------------------------------------------------
# Each gets the words, the index of the one it begins with, and where that one stands; it returns the clause and the
# index behind it.  A word that is missing is an IndexError, one that is not plain a KeyError.


def _bound_claim(words: list[str], index: int, at: int) -> tuple[Claim, int]:
    """( "takes" | "tries" ) ( "at" "most" | … ) ( QUANTITY | NUMBER )"""
    verb = Word(NAME, at, words[index])
    start = verb.end + 1
    first, second = words[index + 1], words[index + 2]
    value, index = _value(words, index + 3, start + len(first) + len(second) + 2)
    bound = Bound(start, value.end, RELATIONS[first, second], Amount(value))
    return Claim(at, value.end, None, verb, bound, None, None, None, None, False), index


def _condition_claim(words: list[str], index: int, at: int) -> tuple[Claim, int]:
    """( "needs" | "keeps" | "never" | "leaves" ) Cond"""
    verb = Word(NAME, at, words[index])
    condition, index = _condition(words, index + 1, verb.end + 1)
    return Claim(at, condition.end, None, verb, None, condition, None, None, None, False), index


def _succeeds(words: list[str], index: int, at: int) -> tuple[Claim, int]:
    """ "succeeds" [ "within" ( QUANTITY | NUMBER ) ]"""
    verb = Word(NAME, at, words[index])
    if words[index + 1 : index + 2] != ["within"]:
        return Claim(at, verb.end, None, verb, None, None, None, None, None, False), index + 1
    value, index = _value(words, index + 2, verb.end + len(" within "))
    bound = Bound(value.start, value.end, "<=", Amount(value))
    return Claim(at, value.end, None, verb, bound, None, None, None, None, False), index


def _scope(words: list[str], index: int, at: int) -> tuple[Scope, int]:
    """( "while" | "when" ) Cond"""
    word = Word(NAME, at, words[index])
    condition, index = _condition(words, index + 1, word.end + 1)
    return Scope(at, condition.end, word, condition), index


def _odds(words: list[str], index: int, at: int) -> tuple[Odds, int]:
    """ "in" "at" "least" QUANTITY "of" Experiments"""
    if words[index + 1 : index + 3] != ["at", "least"]:
        raise KeyError
    value, index = _value(words, index + 3, at + len("in at least "))
    if value.kind != QUANTITY or words[index] != "of":
        raise KeyError
    experiments = _one_of(EXPERIMENTS, words[index + 1], value.end + len(" of "))
    return Odds(at, experiments.end, ">=", value, experiments), index + 2


def _window(words: list[str], index: int, at: int) -> tuple[Window, int]:
    """ "over" "last" ( NUMBER Experiments | QUANTITY )"""
    if words[index + 1] != "last":
        raise KeyError
    size, index = _value(words, index + 2, at + len("over last "))
    if size.kind == QUANTITY:
        return Window(at, size.end, size, None), index
    experiments = _one_of(EXPERIMENTS, words[index], size.end + 1)
    return Window(at, experiments.end, size, experiments), index + 1


def _on_violation(words: list[str], index: int, at: int) -> tuple[OnViolation, int]:
    """ "on" "violation" ( "fail" | "halt" | "warn" | "log" )"""
    if words[index + 1] != "violation":
        raise KeyError
    action = _one_of(ACTIONS, words[index + 2], at + len("on violation "))
    return OnViolation(at, action.end, action), index + 3


def _goal(words: list[str], index: int, at: int) -> tuple[Goal, int]:
    """ "goal" ( QUANTITY | NUMBER )"""
    value, index = _value(words, index + 1, at + len("goal "))
    return Goal(at, value.end, Amount(value)), index


def _because(words: list[str], index: int, at: int) -> tuple[Because, int]:
    """ "because" STRING, to the end of the line"""
    reason = _string(" ".join(words[index + 1 :]), at + len("because "))
    if reason is None:
        raise KeyError
    return Because(at, reason.end, reason), len(words)


def _how(words: list[str], index: int, at: int) -> tuple[How, int]:
    """ "verified" "by" ( "monitor" | "analysis" | "test" | "review" )"""
    if words[index + 1] != "by":
        raise KeyError
    method = _one_of(METHODS, words[index + 2], at + len("verified by "))
    return How(at, method.end, method), index + 3


# ---- what they are made of ------------------------------------------------------------------------------------------


def _condition(words: list[str], index: int, at: int) -> tuple[Operand | Comparison, int]:
    """NAME [ Cmp ( QUANTITY | NUMBER ) ]"""
    name = words[index]
    if name in _NO_OPERANDS or not is_name(name):
        raise KeyError
    left = Operand(Word(NAME, at, name))
    if index + 1 == len(words) or words[index + 1] not in COMPARISONS:
        return left, index + 1
    sign = words[index + 1]
    value, index = _value(words, index + 2, left.end + len(sign) + 2)
    operands: tuple[Condition, ...] = (left, Operand(value))
    return Comparison(at, value.end, (sign,), operands), index


def _value(words: list[str], index: int, at: int) -> tuple[Word, int]:
    """QUANTITY | NUMBER"""
    number = words[index]
    whole, _, fraction = number.partition(".")
    if not (number.isascii() and whole.isdecimal() and (fraction.isdecimal() or "." not in number)):
        raise KeyError
    if index + 1 == len(words) or (unit := words[index + 1]) in _BEHIND_NUMBERS:
        return Word(NUMBER, at, number), index + 1
    if not _is_unit(unit):
        raise KeyError
    return Word(QUANTITY, at, f"{number} {unit}"), index + 2


@cache
def _is_unit(word: str) -> bool:
    """Whether a word behind a number is its unit"""
    return unit_at(word, 0) == len(word) and is_unit(word)


def _string(raw: str, at: int) -> Word | None:
    """STRING in double quotes, without a backslash"""
    if len(raw) < 2 or raw.find('"', 1) != len(raw) - 1 or raw[0] != '"' or "\\" in raw:
        return None
    return Word(STRING, at, raw)


def _one_of(known: Collection[str], word: str, at: int) -> Word:
    if word not in known:
        raise KeyError
    return Word(NAME, at, word)


def _quality_path(raw: str, at: int) -> QualityPath | None:
    """Name { "." Name }"""
    names: list[Word] = []
    for name in raw.split("."):
        if not is_name(name):
            return None
        names.append(Word(NAME, at, name))
        at += len(name) + 1
    return QualityPath(tuple(names))


_CLAUSES: Final[dict[str, Callable[[list[str], int, int], tuple[Clause, int]]]] = {
    "takes": _bound_claim,
    "tries": _bound_claim,
    "needs": _condition_claim,
    "keeps": _condition_claim,
    "never": _condition_claim,
    "leaves": _condition_claim,
    "succeeds": _succeeds,
    "while": _scope,
    "when": _scope,
    "in": _odds,
    "over": _window,
    "on": _on_violation,
    "goal": _goal,
    "because": _because,
    "verified": _how,
}
_BEHIND_NUMBERS: Final = frozenset((*_CLAUSES, *EXPERIMENTS, "of"))
_NO_OPERANDS: Final = HEADS | {"and", "or", "not", "if", "else", "node"}
