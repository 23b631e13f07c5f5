"""Patterns for the interpreter: the commonest spelling of what `plain` reads, in one step instead of many.

One invariant: what is read here, `plain` reads alike, character by character; the compiled `plain` does without.  So
it is only what needs no second look: words of letters, digits and `_`, single blanks, strings on one line.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from btq_lang.record import fields_of
from btq_lang.scan import COMPILED, number_at
from btq_lang.syntax import (
    Node,
    NodeClause,
    Pair,
    Quality,
    QualityPath,
    ReqRef,
    Requirement,
    Satisfices,
    Satisfies,
    Word,
)
from btq_lang.tokens import (
    BRACED,
    CATEGORIES,
    COMMENT,
    DIRECTIONS,
    ERROR,
    NAME,
    NODE_CLAUSES,
    NUMBER,
    OPERATOR,
    STRING,
    SYMBOL,
    SYMBOLS,
)

if TYPE_CHECKING:
    import re


def read_attributes(
    text: str, at: int, blanks: str, base: int, pairs: list[Pair], clauses: list[NodeClause]
) -> tuple[int, bool]:
    """{ Attribute [ "," ] } ")"

    Returns:
        Where that ends and True; or where something is written in another way, and False.
    """
    while match := _ATTRIBUTE(text, at):
        line, key, value, closing = match.groups()
        if line is not None and not line.startswith(blanks):
            break
        if key is not None:
            pairs.append(pair_of(key, match.start(2) - base, value, match.start(3) - base))
            at = match.end()
        elif closing is not None:
            return match.end(), True
        else:
            clause, end = _last_clause(text, match.end(), blanks, base)
            if clause is None:
                break
            clauses.append(clause)
            return end, True
    return at, False


def read_list(text: str, start: int, base: int) -> NodeClause | None:
    """ "satisfices" QualityPath { "," QualityPath } | "satisfies" Name { "," Name }, at the end of a line"""
    match = None if read_line is _nothing else _LINE_LIST.match(text, start)
    return None if match is None else _listed(match, base)


def _last_clause(text: str, start: int, blanks: str, base: int) -> tuple[NodeClause | None, int]:
    """The clause with which the brackets end, and where they do"""
    match = _BRACKETED_CLAUSE.match(text, start)
    if match is None:
        return None, start
    if match[1] is not None:
        return _listed(match, base), match.end()
    quality, bracket_line, name, line, description = match.group(5, 6, 8, 9, 10)
    if bracket_line is not None and not bracket_line.startswith(blanks):
        return None, start
    inner = blanks if quality is None else bracket_line
    if line is not None and (inner is None or not line.startswith(inner)):
        return None, start
    requirement = Requirement(
        match.start(7) - base,
        (match.end(8) if description is None else match.end(10)) - base,
        Word(VALUE_KINDS[name[0]], match.start(8) - base, name),
        True,
        (),
        None,
        None if description is None else Word(VALUE_KINDS[description[0]], match.start(10) - base, description),
        (),
    )
    start, end = match.span(4)
    if quality is None:
        return Satisfies(start - base, end - base, (requirement,)), match.end()
    qualities = (Quality(_path(match.start(5) - base, quality), (requirement,)),)
    return Satisfices(start - base, end - base, qualities), match.end()


def _listed(match: re.Match[str], base: int) -> NodeClause:
    start, end = match.span(1)
    text = match.string
    if match[2] is not None:
        qualities = [Quality(_path(path.start(1) - base, path[1])) for path in _PATHS.finditer(text, *match.span(2))]
        return Satisfices(start - base, end - base, tuple(qualities))
    uses = [ReqRef(Word(NAME, name.start() - base, name[0])) for name in _NAMES.finditer(text, *match.span(3))]
    return Satisfies(start - base, end - base, tuple(uses))


def read_tokens(text: str, at: int, kinds: list[int], starts: list[int], raws: list[str]) -> int:
    """Words, strings, numbers and signs in a row; where the first thing begins that needs a second look"""
    while match := _TOKEN(text, at):
        group = match.lastindex
        start, at = match.span(group)  # type: ignore[arg-type]  # a token is one of the groups
        kind = _TOKEN_KINDS[group]  # type: ignore[index]  # as above
        if kind == NUMBER:
            kind, at = number_at(text, start)
            if kind == ERROR:
                return start
        kinds.append(kind)
        starts.append(start)
        raws.append(text[start:at])
    return at


def read_pieces(text: str) -> list[tuple[int, int, str]] | None:
    """Kind, start and text of all words, signs and comments of a text; None where anything needs a second look"""
    found: list[tuple[int, int, str]] = []
    at = 0
    kind = last_kind = ERROR
    last = ""
    for between, raw in _piece().findall(text):
        at += len(between)
        if not raw:
            break
        kind = _piece_kind(raw[0], NAME)
        if kind == ERROR:
            kind = SYMBOL if raw in _SYMBOLS else NUMBER if raw[0] == "-" else NAME
        if kind == NUMBER:
            if raw[0] == "-" and (last_kind != OPERATOR or ")" in between):
                return None
            kind, end = number_at(text, at)
            if kind == ERROR or end != at + len(raw):
                return None
        elif kind == COMMENT and last == "=":
            return None
        found.append((kind, at, raw))
        at += len(raw)
        last_kind = kind
        last = raw
    return found if at == len(text) else None  # else some characters were passed over


def pair_of(key: str, start: int, value: str, value_start: int) -> Pair:
    """`key = value` of two words that a pattern has found"""
    pair = BlankPair()
    pair.key = word = BlankWord()
    word.kind = NAME
    word.start = start
    word.raw = key
    pair.value = word = BlankWord()
    word.kind = VALUE_KINDS[value[0]]
    word.start = value_start
    word.raw = value
    return pair  # type: ignore[no-any-return]  # see `_blank`


def _path(start: int, raw: str) -> QualityPath:
    words = []
    for name in raw.split("."):
        words.append(Word(NAME, start, name))
        start += len(name) + 1
    return QualityPath(tuple(words))


# ---- pieces of patterns: `(?:…|)` means the same as `(?:…)?` and costs the engine two thirds -------------------------

_NAME: Final = r"[A-Za-z_][A-Za-z0-9_]*"  # `\w` means more letters and takes the engine five times as long
_STRING: Final = r"\"[^\"\\\r\n]*\"|'[^'\\\r\n]*'"
_LABEL: Final = rf" (?=[A-Za-z_\"'])(?!satisfi|tags)({_NAME}|{_STRING})"  # nearly always a bracket stands there
# A number may have a unit; before a comma, a bracket, the line's end or the next key it has none.
_VALUE: Final = rf"{_STRING}|{_NAME}|\{{[^{{}}\"'\r\n]*\}}|-?[0-9]+(?:\.[0-9]+|)(?=[,)\r\n]| \w+ ?=)"
_PAIR: Final = rf"({_NAME})(?: = |= ?| =)({_VALUE})"
_DEEPER: Final = r"[\r\n]+(?! *satisfi)\1[ \t]*"  # a line in the brackets of a node, seldom a clause
_NEXT: Final = rf"(?: |, |,?{_DEEPER}){_PAIR}"
_REMARK: Final = r"(?:\#|//)[^\r\n]*"
_COMMENT: Final = rf"{_REMARK}|/\*[^*]*(?:\*+[^*/][^*]*)*\*+/[ \t]*"
_LISTED: Final = rf"(?!satisfi|tags|parameters|Quality){_NAME}(?:-\w+)*"
_PATH: Final = rf"{_LISTED}(?:\.{_NAME}(?:-\w+)*)*"
_QUALITY: Final = rf"(?:Quality ?= ?|){_PATH}"
_LIST: Final = rf"(satisfi(?:ces ({_QUALITY}(?:, {_QUALITY})*)|es ({_LISTED}(?:, {_LISTED})*)))"
_TEXT: Final = r"\"[^\"\\\r\n]*(?:[\r\n]+[ \t][^\"\\\r\n]*)*\""  # a string of several lines, none at the margin
_REQUIREMENT: Final = (
    rf"(QualityReq) ID ?= ?({_NAME}|{_STRING})(?:,?(?: |\r?\n([ \t]+))description ?= ?({_TEXT}|{_NAME})|)"
)
_BRACKETS_END: Final = r"(?:\)|\r?\n[ \t]*\))"
_LINE_END: Final = r"(?=[\r\n]| (?:\#|//))"
_UNIT: Final = r" (?:ms|s|min|h|%|m/s|m)(?![\w?!^*/-]|[ \t]*[=(])"  # the commonest
_BETWEEN: Final = " \t\r\n()"  # what may stand between two words and says nothing of either

# ---- patterns -------------------------------------------------------------------------------------------------------


def expect(size: int) -> None:
    """Tell that so many characters are to be read: when there are enough of them, the patterns are compiled.

    Until then they match nothing, so `plain` reads everything itself: a small file is read before they are compiled.
    """
    global _expected
    _expected += size
    if _expected >= _WORTH and read_line is _nothing:
        _compile()


def _compile() -> None:
    import re

    global read_head, read_line, _ATTRIBUTE, _TOKEN
    # The line that begins a tree: its name.
    read_head = re.compile(rf"BehaviorTree (?:ID ?= ?(?!=)|)({_NAME}|{_STRING})\r?\n").match
    # A line of a tree, or a blank one or a comment, of which there is only the first group; any other may be missing:
    #     1 blanks  2 to 4 up to three words  5 to 10 three pairs, the further ones within those before them
    #     11 the end of the line, with the bracket that closes the pairs and the comment; empty where the line goes on
    read_line = re.compile(
        rf"( *|\t*)(?:(->|\?|\|\||M->|[RA](?:->|\?)|All\|\||{_NAME})(?:{_LABEL}(?:{_LABEL}|)|)"
        rf"(?: ?\((?:{_DEEPER}|){_PAIR}(?:{_NEXT}(?:{_NEXT}|)|)|)"
        rf"(?:(?(5)\)|)(\n|\r\n| +{_REMARK}\r?\n)|)|(?:{_COMMENT}|)\r?\n)"
    ).match
    # 1 the blanks of the line it begins, if it does  2, 3 a pair  4 a closing bracket; none of them: a clause follows
    _ATTRIBUTE = re.compile(rf"(?: |\r?\n([ \t]*)|)(?:{_PAIR}(?:,|(?=[ )\r\n]))|(\))|(?=satisfi))").match
    # A name has a follower, for in `Ready?`, `M->` and `a#` it is more or less than a name.
    _TOKEN = re.compile(
        rf"[ \t]*(?:({_NAME}(?:-\w+)*)(?=[ \t,()=:.<>\r\n])|({_STRING})|([0-9]+)|(==?|,|::?|\.|[<>]=?))"
    ).match


def _nothing(text: str, at: int) -> re.Match[str] | None:
    return None


read_head = read_line = _ATTRIBUTE = _TOKEN = _nothing
_TOKEN_KINDS: Final = (ERROR, NAME, STRING, NUMBER, OPERATOR)  # of the groups of _TOKEN
_WORTH: Final = 25_000  # to read so many characters without patterns takes as long as to compile them
_expected = 0


# ---- patterns that not every file needs -----------------------------------------------------------------------------

_NAMES: Final = re.compile(rf"{_NAME}(?:-\w+)*")
_PATHS: Final = re.compile(rf"(?:Quality ?= ?|)({_PATH})")
# 1 the clause, 2 its qualities or 3 its names of requirements
_LINE_LIST: Final = re.compile(_LIST + _LINE_END)
_DEFINING: Final = rf"(satisfi(?:es |ces Quality ?= ?({_PATH})(?: ?|\r?\n([ \t]+))\(){_REQUIREMENT}(?(5)\)))"
# 1 to 3 as of a line, or else 4 a clause that defines a requirement; 5 the quality that encloses it, if one does,
# and 6 the blanks of the line that its bracket begins, if it does; 7 to 10 the requirement: its first word, its name,
# the blanks of the line that its description begins, if it does, and the description; the closing bracket
_BRACKETED_CLAUSE: Final = re.compile(rf"(?:{_LIST}|{_DEFINING}){_BRACKETS_END}")


@cache
def _piece() -> re.Pattern[str]:
    """1 what is between, 2 a word, a sign or a comment, nothing at the end"""
    import re

    strings = "|".join(rf"{quote}[^{quote}\\]*(?:\\[\s\S][^{quote}\\]*)*{quote}" for quote in "\"'")
    symbols = "|".join(map(re.escape, sorted(SYMBOLS, key=len, reverse=True)))
    return re.compile(
        rf"([{_BETWEEN}]*)({_NAME}(?:-\w+)*(?=[ \t,()=:.<>\r\n]|\Z)|==?|,|::?|\.|[<>]=?"
        rf"|{strings}|-?[0-9]+(?:\.[0-9]+|)(?:{_UNIT}|)|\{{[^{{}}\"'\r\n]*\}}|(?:{symbols})(?=[ \t\r\n(]|\Z)"
        rf"|(?<![^{_BETWEEN},])(?:{_REMARK}|/\*[^*]*(?:\*+[^*/][^*]*)*\*+/)|\Z)"
    )


# ---- words, pairs and nodes without their values ---------------------------------------------------------------------


def _blank(of: type) -> Any:
    """A class like another whose instances are made without their values: who sets them one by one pays half of what
    calling that one costs, whose `__init__` a call of its own is; `object.__new__` costs a third more than this.

    For words, pairs and nodes alone, of which a file has thousands; the type is Any, for only `__init__` may set what
    is final.
    """
    if COMPILED:  # then nobody reads by patterns, and of a compiled class no such class can be made
        return of

    def __reduce__(self: object) -> tuple[object, ...]:  # a copy, or what is unpickled, is of the class itself
        return of, tuple(getattr(self, field) for field in fields_of(self))

    return type(of.__name__, (of,), {"__slots__": (), "__init__": object.__init__, "__reduce__": __reduce__})


BlankWord: Final = _blank(Word)
BlankPair: Final = _blank(Pair)
BlankNode: Final = _blank(Node)


# ---- tables ---------------------------------------------------------------------------------------------------------

VALUE_KINDS: Final = (  # what the first character of a value or a name says
    dict.fromkeys("_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ", NAME)
    | dict.fromkeys("\"'", STRING)
    | dict.fromkeys("-0123456789", NUMBER)
    | {"{": BRACED}
)
_SYMBOLS: Final = frozenset(SYMBOLS)
_piece_kind: Final = (  # what the first character says; ERROR: not enough
    dict.fromkeys([symbol[0] for symbol in SYMBOLS], ERROR)
    | dict.fromkeys("\"'", STRING)
    | dict.fromkeys("0123456789", NUMBER)
    | dict.fromkeys("=,:.<>", OPERATOR)
    | dict.fromkeys("#/", COMMENT)
    | {"{": BRACED}
).get
CATEGORY: Final = -1
NO_NODE: Final = -2  # a line may begin with it and perhaps be no node, or end brackets
role_of: Final = (
    dict.fromkeys(SYMBOLS, SYMBOL)
    | dict.fromkeys(CATEGORIES, CATEGORY)
    | dict.fromkeys((*NODE_CLAUSES, *DIRECTIONS, "xml", "BehaviorTree", "Root", "TreeNodesModel"), NO_NODE)
).get
