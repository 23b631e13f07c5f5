"""Plain lines of a tree, read straight from the text: a short cut past the tokens, for nearly all lines are plain.

One invariant: what is read here is what the full path, `NodeParser`, makes of it, with nothing to complain of.  As
soon as a line has anything unusual, a mistake above all, the answer is None and the full path reads the line from its
start.  So nothing here knows of mistakes, of the clauses of a requirement, or of blocks; and a text that ends within a
line is unusual as well, which shows as an IndexError.

`blanks` are those of the line that opened the brackets: a line with fewer may end them (language.md §2, Brackets).
None in their place: no further line may begin, as it may not outside brackets.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from btq_lang.characters import (
    APOSTROPHE,
    BACKSLASH,
    CLOSING,
    COMMA,
    DOT,
    EQUALS,
    HASH,
    LEFT_BRACE,
    LINE_FEED,
    MINUS,
    NINE,
    OPENING,
    QUOTE,
    RETURN,
    SLASH,
    SMALL_A,
    SMALL_Z,
    SPACE,
    TAB,
    ZERO,
    begins_name,
)
from btq_lang.scan import COMPILED, blanks_end, braced_end, line_end, line_opening, name_end, number_at, symbol_at
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
    Tags,
    Word,
)
from btq_lang.tokens import BRACED, CATEGORIES, DIRECTIONS, ERROR, NAME, NODE_CLAUSES, NUMBER, STRING, SYMBOL

if not COMPILED:
    from btq_lang import patterns
    from btq_lang.patterns import VALUE_KINDS, read_attributes, read_list

if TYPE_CHECKING:
    from mypy_extensions import i64


def plain_head(text: str, start: i64, base: i64) -> tuple[Word | None, i64]:
    """ "BehaviorTree" [ "ID" "=" ] Name NL: the line that begins a tree, and no brackets in it

    Args:
        start: where the line's first word begins.
        base: where the item begins; offsets in the tree count from there.

    Returns:
        The tree's name, None where something is unusual, and where the next line begins.
    """
    at = start + len("BehaviorTree ")
    if text[start:at] != "BehaviorTree ":
        return None, start
    if not COMPILED and (match := patterns.read_head(text, start)):
        return Word(VALUE_KINDS[match[1][0]], match.start(1) - base, match[1]), match.end()
    try:
        if text[at : at + len("ID")] == "ID" and (value := _behind_equals(text, at + len("ID"))) >= 0:
            at = value
        name = _name(text, at, base)
        return name, _next_line(text, _behind_word(text, at + len(name.raw)))
    except (Unusual, IndexError):
        return None, start


def plain_node(text: str, start: i64, blanks: str, base: i64) -> tuple[Node | None, i64]:
    """Kind [ Label ] [ Attributes ] { NodeClause } NL

    Args:
        start: where the line's first word begins.
        blanks: what stands before it.
        base: where the item begins; offsets in the tree count from there.

    Returns:
        The node without what its block adds, None where something is unusual, and where the next line begins.
    """
    try:
        category, kind, label, end = _head(text, start, base)
        at = _behind_word(text, end)
        code: i64 = ord(text[at])
        if code == LINE_FEED:
            return Node(start - base, end - base, category, kind, label, (), (), ()), at + 1
        pair: Pair | None = None
        if code == OPENING:
            pair, at = _pair(text, at + 1, base)
            if pair is not None and ord(text[at]) == CLOSING and ord(text[at + 1]) == LINE_FEED:  # spares the lists
                end = at + 1
                return Node(start - base, end - base, category, kind, label, (pair,), (), ()), end + 1
        pairs: list[Pair] = [] if pair is None else [pair]
        clauses: list[NodeClause] = []
        if code == OPENING:
            if pair is not None and ord(text[at]) == COMMA:
                at += 1
            at = end = attributes(text, at, blanks, base, pairs, clauses)
        if ord(text[at]) == LINE_FEED:
            at += 1
        else:
            known = len(clauses)
            at = line_clauses(text, at, base, clauses)
            if len(clauses) > known:
                end = clauses[-1].end + base
        inner = tuple(clauses) if clauses else ()
        return Node(start - base, end - base, category, kind, label, tuple(pairs), inner, ()), at
    except (Unusual, IndexError):
        return None, start


def plain_clauses(text: str, start: i64, base: i64) -> tuple[list[NodeClause] | None, i64]:
    """NodeClause { NodeClause } NL: a line of its own in the block of a node; arguments and result as of a node."""
    clauses: list[NodeClause] = []
    try:
        return clauses, line_clauses(text, start, base, clauses)
    except (Unusual, IndexError):
        return None, start


def _head(text: str, start: i64, base: i64) -> tuple[Word | None, Word | None, Word | None, i64]:
    """Kind [ Label ]: the category, the kind, the label, and where they end"""
    code: i64 = ord(text[start])
    if (code < SMALL_A or code > SMALL_Z) and (symbol := symbol_at(text, start)):
        kind = Word(SYMBOL, start - base, symbol)
        end = start + len(symbol)
        at = _behind_word(text, end)
        label = _label(text, at, base)
        return None, kind, label, end if label is None else at + len(label.raw)
    kind = _name(text, start, base)
    end = start + len(kind.raw)
    at = _behind_word(text, end)
    second = _label(text, at, base)
    if len(kind.raw) > _LONGEST or kind.raw not in _NO_KINDS:
        return None, kind, second, end if second is None else at + len(second.raw)
    if kind.raw not in _CATEGORIES:
        raise Unusual
    if second is None:
        return kind, None, None, end
    end = at + len(second.raw)
    at = _behind_word(text, end)
    third = _label(text, at, base)
    return kind, second, third, end if third is None else at + len(third.raw)


class Unusual(Exception):
    """The full path has to read this line."""


# ---- words ----------------------------------------------------------------------------------------------------------


def _name(text: str, start: i64, base: i64) -> Word:
    """NAME | STRING"""
    code: i64 = ord(text[start])
    if begins_name(code):
        return Word(NAME, start - base, _raw_name(text, start, code))
    return Word(STRING, start - base, _string(text, start, code))


def _raw_name(text: str, start: i64, code: i64) -> str:
    raw = text[start : name_end(text, start)]
    if code < SMALL_A and raw in _NO_NAMES:
        raise Unusual
    return raw


def _label(text: str, start: i64, base: i64) -> Word | None:
    """[ Name ]"""
    code: i64 = ord(text[start])
    if code in (OPENING, LINE_FEED, RETURN, HASH, SLASH):
        return None
    word = _name(text, start, base)
    return None if word.raw in _CLAUSES else word


def _behind_word(text: str, end: i64) -> i64:
    """Behind the blanks that follow a word outside brackets; nothing else but a bracket or the line's end may."""
    code: i64 = ord(text[end])
    if code != SPACE and code != TAB:
        if code != OPENING and code != LINE_FEED and code != RETURN:
            raise Unusual
        return end
    return _behind_blanks(text, end)


def _behind_blanks(text: str, at: i64) -> i64:
    while True:
        code: i64 = ord(text[at])
        if code != SPACE and code != TAB:
            return at
        at += 1


def _value(text: str, start: i64, base: i64) -> Word:
    """Value = STRING | NAME | NUMBER | QUANTITY | BRACED"""
    code: i64 = ord(text[start])
    if code in (QUOTE, APOSTROPHE):
        word = Word(STRING, start - base, _string(text, start, code))
    elif begins_name(code):
        word = Word(NAME, start - base, _raw_name(text, start, code))
    elif code == LEFT_BRACE:
        word = Word(BRACED, start - base, text[start : braced_end(text, start)])
    elif ZERO <= code <= NINE or (code == MINUS and ZERO <= ord(text[start + 1]) <= NINE):
        end = start + 1
        while ZERO <= (code := ord(text[end])) <= NINE:
            end += 1
        kind = NUMBER
        if code not in (CLOSING, COMMA, LINE_FEED):
            kind, end = number_at(text, start)
        word = Word(kind, start - base, text[start:end])
        if kind == ERROR:
            raise Unusual
    else:
        raise Unusual
    _ends_word(text, start + len(word.raw))
    return word


def _ends_word(text: str, at: i64) -> None:
    """What may stand behind a word in brackets or in a list"""
    code: i64 = ord(text[at])
    if code not in (SPACE, CLOSING, COMMA, LINE_FEED, RETURN, TAB):
        raise Unusual


def _string(text: str, start: i64, quote: i64) -> str:
    """STRING without a backslash, none of whose lines may be the start of an item"""
    if quote != QUOTE and quote != APOSTROPHE:
        raise Unusual
    if not COMPILED:
        raw = text[start : text.find(text[start], start + 1) + 1]
        if not raw or "\\" in raw or (("\n" in raw or "\r" in raw) and _OUTER_LINE.search(raw)):
            raise Unusual
        return raw
    end = start + 1
    while (code := ord(text[end])) != quote:
        end += 1
        if code == BACKSLASH:
            raise Unusual
        if code in (LINE_FEED, RETURN) and ord(text[end]) not in (SPACE, TAB, LINE_FEED, RETURN):  # as _OUTER_LINE
            raise Unusual
    return text[start : end + 1]


# ---- what stands in brackets: everything returns where it ends ------------------------------------------------------


def attributes(text: str, at: i64, blanks: str, base: i64, pairs: list[Pair], clauses: list[NodeClause]) -> i64:
    """{ Attribute [ "," ] } ")", from behind the `(`"""
    while True:
        if not COMPILED:
            at, closed = read_attributes(text, at, blanks, base, pairs, clauses)
            if closed:
                return at
        code: i64 = ord(text[at])
        if code == CLOSING:
            return at + 1
        if code in (SPACE, LINE_FEED, RETURN, TAB, HASH, SLASH):
            at = _gap(text, at, blanks)
            continue
        if not begins_name(code):
            raise Unusual
        pair, end = _pair(text, at, base)
        if pair is None:
            end = _clause(text, at, text[at : name_end(text, at)], blanks, base, clauses)
        else:
            pairs.append(pair)
        at = end
        if ord(text[at]) == COMMA:
            at += 1


def _pair(text: str, at: i64, base: i64) -> tuple[Pair | None, i64]:
    """Attribute, and where it ends; None where no `key =` stands"""
    code: i64 = ord(text[at])
    if not begins_name(code):
        return None, at
    end = name_end(text, at)
    start = _behind_equals(text, end)
    if start < 0:
        return None, at
    key = text[at:end]
    if code < SMALL_A and key in _NO_NAMES:
        raise Unusual
    value = _value(text, start, base)
    return Pair(Word(NAME, at - base, key), value), start + len(value.raw)


def _behind_equals(text: str, at: i64) -> i64:
    """Behind a `=` on this line and the blanks around it; -1 where none stands."""
    at = _behind_blanks(text, at)
    if ord(text[at]) != EQUALS or ord(text[at + 1]) == EQUALS:
        return -1
    return _behind_blanks(text, at + 1)


def _gap(text: str, at: i64, blanks: str | None) -> i64:
    """Behind blanks and, in brackets, over line ends and comments"""
    if ord(text[at]) == SPACE:
        at += 1
    code: i64 = ord(text[at])
    if code not in (SPACE, LINE_FEED, RETURN, TAB, HASH, SLASH):
        return at
    if blanks is None:
        return blanks_end(text, at, len(text))
    if COMPILED and code == LINE_FEED:  # most: a line in brackets that says something, deep enough
        end = at + 1 + len(blanks)
        if text[at + 1 : end] == blanks:
            end = _behind_blanks(text, end)
            if ord(text[end]) not in (LINE_FEED, RETURN, HASH, SLASH):
                return end
    line = -1
    while True:
        start, end = line_opening(text, at, blanks)
        if start > at:
            line = start
        at = end
        code = ord(text[at])
        if code != HASH and code != SLASH:
            break
        at = _comment_end(text, at)
    if line >= 0 and not text[line:at].startswith(blanks):
        raise Unusual
    return at


def _comment_end(text: str, at: i64) -> i64:
    """Behind the comment that begins there, if it is one of the rest of a line"""
    if text[at - 1] not in " \t\r\n()," or (ord(text[at]) == SLASH and ord(text[at + 1]) != SLASH):
        raise Unusual
    return line_end(text, at)


# ---- qualities and requirements -------------------------------------------------------------------------------------


def line_clauses(text: str, at: i64, base: i64, clauses: list[NodeClause]) -> i64:
    """{ NodeClause } NL, outside brackets; returns where the next line begins"""
    at = _gap(text, at, None)
    while begins_name(ord(text[at])):
        word = text[at : name_end(text, at)]
        at = _clause(text, at, word, None, base, clauses)
    return _next_line(text, at)


def _next_line(text: str, at: i64) -> i64:
    """NL, and the comment before it"""
    code: i64 = ord(text[at])
    if code in (HASH, SLASH):
        at = _comment_end(text, at)
        code = ord(text[at])
    if code == LINE_FEED:
        return at + 1
    if code == RETURN:
        return at + 2 if ord(text[at + 1]) == LINE_FEED else at + 1
    raise Unusual


def _clause(text: str, start: i64, word: str, blanks: str | None, base: i64, clauses: list[NodeClause]) -> i64:
    """ "satisfices" Quality { "," Quality } | "satisfies" ReqUse { "," ReqUse } | "tags" Name { "," Name }"""
    if word not in _CLAUSES:
        raise Unusual
    if not COMPILED and blanks is None and (read := read_list(text, start, base)) is not None:
        clauses.append(read)
        return _gap(text, read.end + base, blanks)
    qualities: list[Quality] = []
    uses: list[Requirement | ReqRef] = []
    tags: list[Word] = []
    end = behind = start + len(word)
    at = _gap(text, end, blanks)
    while at >= 0:
        if word == "satisfices":
            quality, end = _quality(text, at, blanks, base)
            qualities.append(quality)
        elif word == "satisfies" and text[at : at + len("QualityReq")] == "QualityReq":
            if blanks is None:
                raise Unusual  # clauses may follow, here or in a block
            requirement, end = _requirement(text, at, blanks, base)
            uses.append(requirement)
        else:
            name = _element(text, at, base)
            end = at + len(name.raw)
            if word == "tags":
                tags.append(name)
            else:
                uses.append(ReqRef(name))
        behind = _gap(text, end, blanks)
        at = _next_element(text, behind, word, blanks)
    if word == "satisfices":
        clauses.append(Satisfices(start - base, end - base, tuple(qualities)))
    elif word == "satisfies":
        clauses.append(Satisfies(start - base, end - base, tuple(uses)))
    else:
        clauses.append(Tags(start - base, end - base, tuple(tags)))
    return behind


def _next_element(text: str, at: i64, word: str, blanks: str | None) -> i64:
    """Where the list goes on, behind a comma or, as classic files are written, without one; -1 where it ends"""
    comma = ord(text[at]) == COMMA
    if comma:
        at = _gap(text, at + 1, blanks)
    code: i64 = ord(text[at])
    if not comma and code == CLOSING:
        return -1
    name = text[at : name_end(text, at)] if begins_name(code) else ""
    if name == ("Quality" if word == "satisfices" else "QualityReq") and word != "tags":
        return at
    if not comma:
        return -1
    if blanks is not None and (
        code == CLOSING or name in _CLAUSES or name == "parameters" or _behind_equals(text, at + len(name)) >= 0
    ):
        return -1
    return at


def _element(text: str, at: i64, base: i64) -> Word:
    """Name, and behind it what may follow in a list"""
    name = _name(text, at, base)
    _ends_word(text, at + len(name.raw))
    return name


def _quality(text: str, at: i64, blanks: str | None, base: i64) -> tuple[Quality, i64]:
    """ "Quality" "=" QualityPath [ "(" Requirement { [ "," ] Requirement } ")" ] | QualityPath"""
    classic = text[at : at + len("Quality")] == "Quality"
    if classic:
        at = _behind_equals(text, at + len("Quality"))
        if at < 0:
            raise Unusual
    name = _name(text, at, base)
    names = [name]
    end = at + len(name.raw)
    while ord(text[end]) == DOT:
        name = _name(text, end + 1, base)
        names.append(name)
        end += 1 + len(name.raw)
    if ord(text[end]) != OPENING:
        _ends_word(text, end)
    requirements: list[Requirement] = []
    if classic and ord(text[bracket := _gap(text, end, blanks)]) == OPENING:
        inner = _blanks_before(text, bracket)
        at = _gap(text, bracket + 1, inner)
        while ord(text[at]) != CLOSING:
            requirement, end = _requirement(text, at, inner, base)
            requirements.append(requirement)
            at = _gap(text, end, inner)
            if ord(text[at]) == COMMA:
                at = _gap(text, at + 1, inner)
        end = at + 1
    return Quality(QualityPath(tuple(names)), tuple(requirements)), end


def _blanks_before(text: str, at: i64) -> str | None:
    """The blanks of the line that begins there; None where no line does"""
    start = at
    while (code := ord(text[start - 1])) == SPACE or code == TAB:
        start -= 1
    return text[start:at] if code in (LINE_FEED, RETURN) else None


def _requirement(text: str, start: i64, blanks: str | None, base: i64) -> tuple[Requirement, i64]:
    """ "QualityReq" "ID" "=" Name [ [ "," ] "description" "=" Name ]"""
    end = start + len("QualityReq")
    at = _gap(text, end, blanks)
    if at == end or text[start:end] != "QualityReq" or text[at : at + len("ID")] != "ID":
        raise Unusual
    at = _behind_equals(text, at + len("ID"))
    if at < 0:
        raise Unusual
    name = _element(text, at, base)
    end = at + len(name.raw)
    at = _gap(text, end, blanks)
    if ord(text[at]) == COMMA:
        at = _gap(text, at + 1, blanks)
    description: Word | None = None
    behind = at + len("description")
    if text[at:behind] == "description" and (at := _behind_equals(text, behind)) >= 0:
        description = _element(text, at, base)
        end = at + len(description.raw)
    return Requirement(start - base, end - base, name, True, (), None, description, ()), end


# Under names of this module, for where it is compiled those of another are looked up every time.
_CLAUSES: Final = NODE_CLAUSES
_CATEGORIES: Final = CATEGORIES
_NO_KINDS: Final = CATEGORIES | NODE_CLAUSES | DIRECTIONS | {"xml"}
_LONGEST: Final = max(map(len, _NO_KINDS))  # of those; to look a word up costs more than to know its length
# NAMEs that are none, all with a capital: two are symbols, and a line that begins with one of the others ends all
# brackets.
_NO_NAMES: Final = frozenset(("R?", "A?", "BehaviorTree", "Root", "TreeNodesModel"))
_OUTER_LINE: Final = re.compile(r"[\r\n][^ \t\r\n]")
