"""The part of the parser that reads what is attached to a node: attributes in brackets, qualities and requirements.

One invariant: it stays on the current logical line; `nodes` handles lines and blocks.
"""

from __future__ import annotations

from typing import Final

from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.conditions import close_group
from btq_lang.grammar.cursor import VALUES, Cursor, shown
from btq_lang.grammar.metadata import parse_requirement_id
from btq_lang.grammar.requirements import (
    parse_quality_path,
    parse_req_ref,
    parse_requirement,
    skip_brackets,
)
from btq_lang.syntax.suggestions import CHILDREN, value_meant
from btq_lang.syntax.tokens import (
    BRACED,
    CATEGORIES,
    CLOSE,
    NAME,
    NEWLINE,
    NODE_CLAUSES,
    NUMBER,
    OPEN,
    OPERATOR,
    QUANTITY,
    STRING,
    SYMBOL,
)
from btq_lang.syntax.tree import (
    NodeClause,
    Pair,
    ReqRef,
    Requirement,
    SatisficedQuality,
    Satisfices,
    Satisfies,
    Tags,
    Word,
)
from btq_lang.util.spelling import near
from btq_lang.util.text import Span


def parse_pairs(cursor: Cursor) -> tuple[Pair, ...]:
    """Pairs = "(" { ( "parameters" Pair { "," Pair } | Pair ) [ "," ] } ")";  none where no bracket opens"""
    if cursor.kind != OPEN:
        return ()
    clauses: list[NodeClause] = []
    pairs = parse_attributes(cursor, clauses)
    if clauses:
        span = Span(clauses[0].start, clauses[0].end).shifted(cursor.base)
        note = "write qualities and requirements after a node, or on a line of their own in the block of a tree"
        cursor.complain(span, "only `key = value` pairs are allowed in these brackets", notes=(note,))
    return pairs


def parse_attributes(cursor: Cursor, clauses: list[NodeClause]) -> tuple[Pair, ...]:
    """Attributes = "(" { Attribute [ "," ] } ")";  Attribute = "parameters" Pair … | NodeClause | Pair"""
    pairs: list[Pair] = []
    cursor.advance()
    cursor.group += 1
    while cursor.kind != CLOSE and cursor.kind != NEWLINE:
        if cursor.at_key():
            pairs.append(parse_pair(cursor))
        elif cursor.kind == NAME and cursor.raw in NODE_CLAUSES:
            clauses.append(parse_node_clause(cursor))
        elif cursor.at_word("parameters"):
            cursor.advance()
            if not cursor.at_key():
                cursor.expected("`key = value` after `parameters`")
            continue
        else:
            not_an_attribute(cursor, pairs, clauses)
        if cursor.raw == ",":
            cursor.advance()
    cursor.group -= 1
    cursor.advance()
    return tuple(pairs)


def parse_pair(cursor: Cursor) -> Pair:
    """Pair = Name "=" Value"""
    index = cursor.index
    key = Word(cursor.kind, cursor.starts[index] - cursor.base, cursor.raw)
    cursor.go_to(index + 2)
    return Pair(key, parse_value(cursor))


def parse_value(cursor: Cursor) -> Word | None:
    """Value = STRING | NAME | NUMBER | QUANTITY | BRACED"""
    whole = cursor.kind in VALUES
    if not whole and (cursor.kind not in (SYMBOL, OPERATOR) or cursor.raw in ("=", ",")):
        cursor.expected("a value: a string, a name, a number, a quantity or {key}")
        return None
    word = cursor.take()
    if whole and (cursor.kind == CLOSE or not joins(cursor) or cursor.at_key()):
        return word
    if cursor.kind == STRING and word.kind != STRING:
        return half_quoted(cursor, word)
    return needs_quotes(cursor, word)


def parse_node_clause(cursor: Cursor, meant: str = "") -> NodeClause:
    """ "satisfices" Quality { "," Quality } | "satisfies" ReqUse { "," ReqUse } | "tags" Name { "," Name }

    Args:
        meant: the word to read instead of the current one.
    """
    start = cursor.start()
    word = cursor.take().raw
    if meant:
        word = meant
    if word == "satisfices":
        qualities = parse_satisfices(cursor)
        return Satisfices(start, cursor.last_end(), qualities)
    if word == "satisfies":
        uses = parse_satisfies(cursor)
        return Satisfies(start, cursor.last_end(), uses)
    names = cursor.listed(lambda cursor: cursor.name("a tag"), list_goes_on)
    return Tags(start, cursor.last_end(), names)


def parse_satisfices(cursor: Cursor) -> tuple[SatisficedQuality, ...]:
    """Quality { "," Quality };  classic files omit the commas"""
    cursor.skip_sign(":")
    return cursor.listed(parse_quality, lambda cursor: at_quality(cursor) or list_goes_on(cursor, qualities=True))


def parse_quality(cursor: Cursor) -> SatisficedQuality | None:
    """ "Quality" "=" QualityPath [ "(" Requirement { [ "," ] Requirement } ")" ] | QualityPath"""
    classic = at_quality(cursor)
    if classic:
        cursor.advance()
        cursor.advance()
    elif cursor.at_word("Quality") and (
        cursor.is_operator(cursor.index + 1, ":") or names_follow(cursor, cursor.index + 1)
    ):
        cursor.advance()
        has_sign = cursor.at(":")
        place = Span(cursor.last_end() + cursor.base, cursor.here().end if has_sign else cursor.here().start)
        blank = "" if cursor.text[place.end : place.end + 1] in (" ", "\t") else " "
        message = f"expected `=` after `Quality`, found {cursor.found()}"
        cursor.complain(cursor.here(), message, replace_fix("Write `=`", place, f" ={blank}", safe=True))
        cursor.accept(":")
        classic = True
    path = parse_quality_path(cursor)
    if path is None:
        return None
    if not classic or cursor.kind != OPEN:
        return SatisficedQuality(path)
    cursor.advance()
    cursor.group += 1
    requirements: list[Requirement] = []
    while cursor.at_word("QualityReq"):
        requirements.append(parse_requirement(cursor))
        cursor.accept(",")
    close_group(cursor, "QualityReq or `)`")
    return SatisficedQuality(path, tuple(requirements))


def parse_satisfies(cursor: Cursor) -> tuple[Requirement | ReqRef, ...]:
    """ReqUse { "," ReqUse };  classic files omit the commas"""
    cursor.skip_sign(":", "=")
    if cursor.at_word("by") and cursor.kinds[cursor.index + 1] in (NAME, STRING):
        cursor.advance()  # `satisfied by r`, reported at its first word
    if not cursor.group:
        skip_brackets(cursor, "requirements of a node need no brackets")
    return cursor.listed(parse_req_use, lambda cursor: cursor.at_word("QualityReq") or list_goes_on(cursor))


def parse_req_use(cursor: Cursor) -> Requirement | ReqRef | None:
    """ReqUse = Requirement | ReqRef"""
    if cursor.at_word("QualityReq"):
        return parse_requirement(cursor)
    if cursor.kind == NAME and cursor.raw.lower() in _REQUIREMENTS and cursor.kinds[cursor.index + 1] in (NAME, STRING):
        return requirement_in_other_words(cursor)
    if cursor.kind == NEWLINE and cursor.index and cursor.raws[cursor.index - 1] == ",":
        end = cursor.last_end() + cursor.base
        fix = replace_fix("Remove `,`", Span(end - 1, end), "", safe=True)
        cursor.expected("another requirement after the comma", (), (fix,))
        return None
    name = parse_requirement_id(cursor, "a requirement: its ID, or QualityReq and a definition")
    return parse_req_ref(cursor, name) if name is not None else None


# ---- what productions ask and report ----


def not_an_attribute(cursor: Cursor, pairs: list[Pair], clauses: list[NodeClause]) -> None:
    """Report what is in brackets and is not an attribute, and read it as what it was probably meant to be."""
    index = cursor.index
    if cursor.at_name() and (cursor.is_operator(index + 1, ":") or cursor.is_operator(index + 1, "==")):
        sign = cursor.starts[index + 1]
        is_assignment = cursor.text.startswith(":=", sign)
        span = Span(sign, sign + (2 if is_assignment else len(cursor.raws[index + 1])))
        written = "=" if cursor.text[sign - 1] in " \t" else " ="
        message = f"expected `=` between key and value, found `{cursor.text[span.start : span.end]}`"
        cursor.complain(span, message, replace_fix("Write `=`", span, written, safe=True))
        if is_assignment:
            cursor.advance()
        pairs.append(parse_pair(cursor))
        return
    if cursor.kind == NAME and cursor.kinds[index + 1] in (NAME, STRING) and (meant := misspelt_clause(cursor)):
        clauses.append(parse_node_clause(cursor, meant))
        return
    notes: tuple[str, ...] = ()
    if cursor.kinds[index - 1] in (NAME, NUMBER, QUANTITY) and cursor.kind in (NAME, NUMBER, QUANTITY):
        notes = ("a value or name of several words goes in quotes",)
    elif cursor.kinds[index - 1] == OPEN and cursor.kind in (NUMBER, QUANTITY, STRING):
        notes = (f"a value goes after the name of its port: `port = {shown(cursor.raw)}`",)
    elif cursor.kinds[index - 1] == OPEN and cursor.kind == NAME and cursor.raws[index + 1] == ",":
        notes = (CHILDREN,)
    elif cursor.raw in ("+", "%") and cursor.kinds[index - 1] in (STRING, NAME, BRACED):
        cursor.complain(cursor.here(), _PUT_TOGETHER, notes=(_LITERAL_OR_ENTRY,))
        cursor.recover()
        return
    fixes = id_in_brackets(cursor) or classic_quality(cursor, clauses)
    if cursor.kind == NAME and cursor.kinds[index + 1] in (STRING, NUMBER, QUANTITY, BRACED):
        gap = Span(cursor.here().end, cursor.starts[index + 1])
        fixes = (replace_fix("Put `=` after it", gap, " = "),)
    cursor.expected("an attribute: key = value", notes, fixes)
    if cursor.index == index:
        cursor.advance()


def id_in_brackets(cursor: Cursor) -> tuple[Fix, ...]:
    """The fix for `SubTree (PickPlace)`, where the ID needs no brackets."""
    index = cursor.index
    if index != 2 or cursor.kind != NAME or cursor.raws[0] not in CATEGORIES or cursor.kinds[index + 1] != CLOSE:
        return ()
    before = Span(cursor.starts[0] + len(cursor.raws[0]), cursor.here().start)
    after = Span(cursor.here().end, cursor.starts[index + 1] + len(cursor.raws[index + 1]))
    return (Fix("Remove the brackets", (FixEdit(Place(before), " "), FixEdit(Place(after), ""))),)


def classic_quality(cursor: Cursor, clauses: list[NodeClause]) -> tuple[Fix, ...]:
    """The fix for `satisfices performance (QualityReq …)`, which lacks `Quality =` before the quality."""
    if cursor.kind != OPEN or not cursor.is_word(cursor.index + 1, "QualityReq") or not clauses:
        return ()
    last = clauses[-1]
    if not isinstance(last, Satisfices) or not last.qualities or last.end != cursor.last_end():
        return ()
    start = last.qualities[-1].path.span.start + cursor.base
    return (replace_fix("Put `Quality =` before the quality", Span(start, start), "Quality = "),)


def half_quoted(cursor: Cursor, word: Word) -> Word:
    """`charger" …`: the rest is a string only because a quote is missing; or Python is meant: `f"dock{n}"`."""
    span = word.span.shifted(cursor.base)
    if word.raw.lower() in _STRING_PREFIXES and cursor.adjacent(cursor.index):
        end = cursor.here().end
        cursor.complain(Span(span.start, end), _PUT_TOGETHER, notes=(_LITERAL_OR_ENTRY,))
        cursor.recover()
        return Word(NAME, word.start, cursor.text[span.start : end])
    fix = Fix(f"Put {cursor.raw[0]} before it", (FixEdit(Place(Span(span.start, span.start)), cursor.raw[0]),))
    start = cursor.starts[cursor.index]
    unclosed = [problem for problem in cursor.lexer.problems[cursor.known :] if problem.span.start == start]
    message = f"missing quote before `{word.raw}`"
    if cursor.complain_instead(unclosed, Diagnostic("syntax-error", span, message, fixes=(fix,))):
        cursor.inside_out = min(cursor.inside_out, span.end)
    cursor.recover()
    return word


def joins(cursor: Cursor) -> bool:
    """Whether the current token forms one value with the one before it: there is no blank between."""
    if not cursor.adjacent(cursor.index):
        return False
    return cursor.kind not in (NEWLINE, OPEN, CLOSE) and cursor.raw not in (",", "=")


def ends_value(cursor: Cursor) -> bool:
    """Whether the next token may follow a value."""
    return cursor.kind in (NEWLINE, CLOSE) or cursor.raw == "," or cursor.raw in _ATTRIBUTE_WORDS or cursor.at_key()


def needs_quotes(cursor: Cursor, word: Word) -> Word:
    """`map/frame`, `/map`: read what is written without a blank as one value, and report that it needs quotes."""
    cause = cursor.lost_quote() or cursor.wrong_unit()
    while joins(cursor):
        cursor.advance()
    start = word.start + cursor.base
    end = cursor.last_end() + cursor.base
    raw = cursor.text[start:end]
    if cause is not None:
        cursor.report(cause)
    elif word.kind == STRING:
        note = "write a quote in a string as \\\", in a script as '; or add a closing quote that is missing above"
        fixes: tuple[Fix, ...] = ()
        if raw[0] == raw[-1] == '"' and raw.count('"') == 4 and "'" not in raw and ends_value(cursor):
            note = "write a quote in a string as \\\", in a script as '"
            single = raw[1:-1].replace('"', "'")
            fixes = (write_fix(f'"{single}"', Span(start, end)),)
        cursor.complain(Span(start, end), "unexpected text right after a string", *fixes, notes=(note,))
    else:
        # A quote or a brace in it indicates another mistake.
        safe = ends_value(cursor) and not set(raw) & set("\"'{}\\")
        cursor.complain(Span(start, end), "this value needs quotes", value_meant(cursor.text, start, end, safe=safe))
    return Word(NAME, word.start, raw)


def misspelt_clause(cursor: Cursor) -> str | None:
    """Report a misspelt word, `satisfys rq1`, and return the one that was probably meant."""
    meant = meant_clause(cursor.raw) if cursor.raw not in _ATTRIBUTE_WORDS else None
    if meant is not None:
        attaches_nothing(cursor, cursor.here(), meant)
    return meant


def attaches_nothing(cursor: Cursor, span: Span, meant: str) -> None:
    """Report a misspelt satisfices, satisfies or tags."""
    word = cursor.text[span.start : span.end]
    by = cursor.index + 1
    place = span
    if word == "satisfied" and cursor.is_word(by, "by") and cursor.kinds[by + 1] in (NAME, STRING):
        place = Span(span.start, cursor.starts[by] + len("by"))
    message = f"unknown word `{word}`; did you mean `{meant}`?"
    cursor.complain(span, message, replace_fix(f"Replace `{word}` with `{meant}`", place, meant))


def at_quality(cursor: Cursor) -> bool:
    return cursor.kind == NAME and cursor.raw == "Quality" and cursor.is_operator(cursor.index + 1, "=")


def names_follow(cursor: Cursor, index: int) -> bool:
    """Whether a quality's name follows, so that `Quality` before it lacks its `=`."""
    if cursor.kinds[index] not in (NAME, STRING) or cursor.raws[index] in _ATTRIBUTE_WORDS:
        return False
    return not cursor.is_operator(index + 1, "=")


def requirement_in_other_words(cursor: Cursor) -> Requirement | ReqRef | None:
    """`satisfies QualityRequirement ID = r`, `satisfies requirement r`"""
    word = cursor.here()
    if cursor.is_word(cursor.index + 1, "ID") and cursor.is_operator(cursor.index + 2, "="):
        message = f"unknown word `{cursor.raw}`; did you mean `QualityReq`?"
        cursor.complain(word, message, replace_fix(f"Replace `{cursor.raw}` with `QualityReq`", word, "QualityReq"))
        return parse_requirement(cursor)
    if cursor.raws[cursor.index + 1] in _ATTRIBUTE_WORDS or cursor.is_operator(cursor.index + 2, "="):
        return parse_req_ref(cursor, cursor.take())
    fix = replace_fix(f"Remove `{cursor.raw}`", Span(word.start, cursor.starts[cursor.index + 1]), "")
    cursor.complain(word, "a requirement is named by its ID alone", fix)
    cursor.advance()
    return parse_req_ref(cursor, cursor.take())


def list_goes_on(cursor: Cursor, qualities: bool = False) -> bool:
    """Skip a comma if another element follows it; in brackets an attribute may follow instead."""
    if cursor.at_word("and") and cursor.kinds[cursor.index + 1] in (NAME, STRING) and not cursor.group:
        return cursor.accept_and()
    if not cursor.at(","):
        return False
    following = cursor.index + 1
    if cursor.group:
        if cursor.kinds[following] == CLOSE:
            return False
        if cursor.is_operator(following + 1, "=") and not (qualities and cursor.is_word(following, "Quality")):
            return False
        if cursor.kinds[following] == NAME and cursor.raws[following] in _ATTRIBUTE_WORDS:
            return False
    elif cursor.raws[following] in NODE_CLAUSES and cursor.kinds[following + 1] in (NAME, STRING):
        comma = Span(cursor.last_end() + cursor.base, cursor.here().end)
        message = f"there is no comma before `{cursor.raws[following]}`"
        cursor.complain(cursor.here(), message, replace_fix("Remove `,`", comma, "", safe=True))
        cursor.advance()
        return False
    cursor.advance()
    return True


def meant_clause(word: str) -> str | None:
    """Which of satisfices, satisfies and tags a word probably means."""
    if likely := near(word, NODE_CLAUSES, limit=1):
        return likely[0]
    return "satisfies" if word.startswith("satisf") else None


_ATTRIBUTE_WORDS: Final = NODE_CLAUSES | {"parameters"}
_STRING_PREFIXES: Final = frozenset(("f", "r", "b", "u", "fr", "rf", "br", "rb"))
_PUT_TOGETHER: Final = "a value is one literal or one entry, and nothing puts several together"
_LITERAL_OR_ENTRY: Final = "write a text in quotes or an entry `{key}`, to which a Script before can give `'dock' .. n`"
_REQUIREMENTS: Final = frozenset(("requirement", "req", "qualityrequirement", "qualityreq"))
