"""The part of the parser that reads requirements, except their clauses, and the units of declarations.

Each `parse_…` is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.catalog.verbs import COUNTING
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.claim_mistakes import MEANT
from btq_lang.grammar.claim_words import VERB_WORDS, at_verb, followed_ahead
from btq_lang.grammar.claims import parse_bounded
from btq_lang.grammar.clauses import ENDS_CLAUSES, is_assumption, parse_clauses
from btq_lang.grammar.conditions import HEADS, RELATIONS, close_group
from btq_lang.grammar.cursor import Cursor
from btq_lang.grammar.metadata import is_metadata, parse_requirement_id
from btq_lang.grammar.prose import MODALS
from btq_lang.syntax.scan import is_unit, unit_run
from btq_lang.syntax.suggestions import unknown_unit
from btq_lang.syntax.tokens import CLOSE, NAME, NEWLINE, NUMBER, OPEN, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import Argument, Parameter, QualityPath, ReqRef, Requirement, Word, quote, unquote
from btq_lang.util.spelling import near
from btq_lang.util.text import Span

UNITLESS: Final = frozenset(("bool", "text", "1"))  # allowed instead of a unit after the `:` of a signal


def parse_requirement(cursor: Cursor) -> Requirement:
    """Requirement = ReqHead { Clause }; the current word is QualityReq"""
    start = cursor.start()
    cursor.advance()
    cursor.skip_glued_colon()
    if cursor.kind == OPEN and cursor.is_word(cursor.index + 1, "ID"):
        skip_brackets(cursor, "a requirement's ID goes after `QualityReq`, without brackets")
    if cursor.at_word("ID") and (cursor.is_operator(cursor.index + 1, "=") or lacks_equals(cursor)):
        return parse_classic_requirement(cursor, start)
    name = parse_requirement_id(cursor, "the requirement's ID")
    parameters = parse_params(cursor) if cursor.kind == OPEN and name is not None else ()
    if cursor.at(":") and cursor.adjacent(cursor.index):
        cursor.skip_last_sign()
    quality = parse_quality_path(cursor) if cursor.accept(":") or skip_key(cursor, ("quality",), ":") else None
    further = parse_further_qualities(cursor) if quality is not None else ()
    if quality is not None:
        spaced_quality(cursor, (quality, *further)[-1])
    skip_key(cursor, _TITLES, "")
    title = cursor.take() if cursor.kind == STRING else bare_title(cursor, quality is not None)
    if quality is None and title is not None and cursor.at(":"):
        cursor.complain(cursor.here(), "a requirement's quality goes before its title")
        cursor.advance()
        quality = parse_quality_path(cursor)
    cursor.title_at = cursor.last_end() + cursor.base if title is None else -1
    clauses = parse_clauses(cursor)
    return Requirement(start, cursor.last_end(), name, False, parameters, quality, further, title, clauses)


def parse_classic_requirement(cursor: Cursor, start: int) -> Requirement:
    """ "QualityReq" "ID" "=" Name [ [ "," ] "description" "=" Name ] { Clause }"""
    lacking = [] if cursor.is_operator(cursor.index + 1, "=") else [cursor.index]
    cursor.go_to(cursor.index + (1 if lacking else 2))
    name = cursor.name("the requirement's ID")
    key = cursor.index + (1 if cursor.at(",") else 0)
    text = None
    if cursor.is_word(key, "description") and (cursor.is_operator(key + 1, ":") or cursor.kinds[key + 1] == STRING):
        lacking.append(key)
    if lacking:
        no_equals(cursor, lacking)
    if cursor.is_word(key, "description") and (lacking[-1:] == [key] or cursor.is_operator(key + 1, "=")):
        cursor.go_to(key + (1 if cursor.kinds[key + 1] == STRING else 2))
        text = cursor.name("the description")
    clauses = parse_clauses(cursor)
    return Requirement(start, cursor.last_end(), name, True, (), None, (), text, clauses)


def parse_params(cursor: Cursor) -> tuple[Parameter, ...]:
    """Params = "(" Param { "," Param } ")\""""
    cursor.advance()
    cursor.group += 1
    parameters = cursor.listed(parse_param)
    close_group(cursor, "`,` or `)`")
    return parameters


def parse_param(cursor: Cursor) -> Parameter | None:
    """Param = NAME ":" UNIT [ "=" Bounded ]"""
    name = cursor.plain_name("a parameter's name")
    if name is None:
        return None
    unit = None
    if cursor.at("="):
        note = "write its unit after `:`, and its default after that: `limit : m = 3 m`"
        cursor.expected("`:` and the parameter's unit", (note,))
    elif cursor.expect(":"):
        unit = parse_unit(cursor)
    default = parse_bounded(cursor) if cursor.accept("=") else None
    return Parameter(name, unit, default)


def parse_req_ref(cursor: Cursor, name: Word) -> ReqRef:
    """ReqRef = Name [ "(" NAME "=" Bounded { "," NAME "=" Bounded } ")" ]; the name is already read"""
    if cursor.kind != OPEN:
        return ReqRef(name)
    cursor.advance()
    cursor.group += 1
    arguments = cursor.listed(parse_argument)
    close_group(cursor, "`,` or `)`")
    return ReqRef(name, arguments)


def parse_argument(cursor: Cursor) -> Argument | None:
    """NAME "=" Bounded"""
    if cursor.kind in (NUMBER, QUANTITY):
        cursor.expected("a parameter's name", (f"a value goes after the name of its parameter: `x = {cursor.raw}`",))
        return None
    name = cursor.plain_name("a parameter's name")
    if name is None:
        return None
    return Argument(name, parse_bounded(cursor) if cursor.expect("=") else None)


def parse_quality_path(cursor: Cursor) -> QualityPath | None:
    """QualityPath = Name [ "<" Name ">" ] { "." Name }"""
    first = cursor.name("a quality")
    if first is None:
        return None
    names = [first]
    if cursor.at("<"):
        cursor.advance()
        if name := cursor.name("a sub-characteristic"):
            names.append(name)
            cursor.expect(">")
    while cursor.at("."):
        cursor.advance()
        name = cursor.name("a sub-characteristic")
        if name is None:
            break
        names.append(name)
    return QualityPath(tuple(names))


def parse_further_qualities(cursor: Cursor) -> tuple[QualityPath, ...]:
    """{ "and" QualityPath }"""
    qualities: list[QualityPath] = []
    while cursor.accept_word("and"):
        quality = parse_quality_path(cursor)
        if quality is None:
            break
        qualities.append(quality)
    return tuple(qualities)


def parse_unit(cursor: Cursor) -> Word | None:
    """UNIT, after the `:` of a signal or a parameter, where it is not part of a QUANTITY"""
    first = cursor.starts[cursor.index]
    start = cursor.start()
    if cursor.kind not in (NAME, NUMBER, QUANTITY, STRING) and not cursor.at("%"):
        cursor.expected("a unit: s, m/s, %, 1, bool, text, …")
        return None
    end = max(unit_run(cursor.text, first), first + len(cursor.raw))  # valid or not
    word = cursor.text[first:end]
    if cursor.kind == NAME and (type_ := _TYPE.match(cursor.text, first)) and (sort := sort_of(type_[0])):
        end = max(end, type_.end())
        no_unit(cursor, type_[0], Span(first, type_.end()), sort)
    elif cursor.kind == STRING and is_unit(inner := unquote(word)):
        cursor.complain(cursor.here(), "a unit takes no quotes", write_fix(inner, cursor.here(), safe=True))
    elif cursor.kind == STRING:
        cursor.expected("a unit: s, m/s, %, 1, bool, text, …")
        return None
    elif word not in UNITLESS and not is_unit(word):
        cursor.report(unknown_unit(cursor.text, first, end))
    while cursor.starts[cursor.index] < end and cursor.kind != NEWLINE:
        cursor.advance()
    return Word(NAME, start, cursor.text[first:end])


# ---- what productions ask and report ----


def skip_brackets(cursor: Cursor, message: str) -> None:
    """Report the current brackets, which do not belong there, and continue as if there were none."""
    if cursor.kind != OPEN or CLOSE not in cursor.kinds[cursor.index :]:
        return
    closing = cursor.kinds.index(CLOSE, cursor.index)
    if cursor.raws[closing] != ")" or OPEN in cursor.kinds[cursor.index + 1 : closing]:
        return
    ends = cursor.here(), Span(cursor.starts[closing], cursor.starts[closing] + 1)
    fix = Fix("Remove the brackets", tuple([FixEdit(Place(end), "") for end in ends]), safe=True)
    cursor.complain(cursor.here(), message, fix)
    for index in (closing, cursor.index):
        del cursor.kinds[index], cursor.starts[index], cursor.raws[index]
    cursor.go_to(cursor.index)


def skip_key(cursor: Cursor, words: tuple[str, ...], instead: str) -> bool:
    """Report and skip an attribute's key where only the value belongs, as in `description = "in time"`."""
    value = cursor.index + 2
    if cursor.kind != NAME or cursor.raw not in words or cursor.kinds[value] not in (NAME, STRING):
        return False
    if not (cursor.is_operator(cursor.index + 1, "=") or cursor.is_operator(cursor.index + 1, ":")):
        return False
    key = Span(cursor.here().start, cursor.starts[cursor.index + 1] + 1)
    written = cursor.text[key.start : key.end]
    if instead:
        fix = write_fix(instead, key, safe=True)
        message = f"expected `{instead}` before the quality, found `{written}`"
    else:
        fix = replace_fix(f"Remove `{written}`", Span(key.start, cursor.starts[value]), "", safe=True)
        message = f"a title goes after the ID without `{written}`"
    cursor.complain(key, message, fix)
    cursor.go_to(value)
    return True


def lacks_equals(cursor: Cursor) -> bool:
    """Whether the `=` after `ID` is missing: `QualityReq ID rq1 description "x"`."""
    name = cursor.index + 1
    return cursor.kinds[name] == NAME and cursor.raws[name + 1] in ("description", ",", "\n", "\r\n", "\r", "")


def spaced_quality(cursor: Cursor, quality: QualityPath) -> None:
    """Report `time behaviour`: a quality's name has no spaces."""
    last = quality.names[-1]
    if cursor.kind != NAME or last.kind != NAME or cursor.kinds[cursor.index + 1] not in (STRING, NEWLINE):
        return
    if cursor.raw not in VERB_WORDS and cursor.raw not in HEADS and not is_clause_by_context(cursor):
        fix = write_fix("-", Span(last.end + cursor.base, cursor.here().start))
        span = Span(last.start + cursor.base, cursor.here().end)
        cursor.complain(span, "a quality's name has no spaces", fix)
        cursor.advance()


def is_clause_by_context(cursor: Cursor) -> bool:
    """Whether the current word begins a clause by what follows it."""
    if cursor.raw == "each":
        return followed_ahead(cursor) > 0
    return is_assumption(cursor) if cursor.raw == "assuming" else is_metadata(cursor)


def second_quality(cursor: Cursor, requirement: Requirement) -> None:
    """Report a list of qualities at a requirement that is not an element of a list itself: `QualityReq r : safety,
    usability`.
    """
    is_open = requirement.quality is not None and not (requirement.clauses or requirement.text)
    if is_open and cursor.kind == OPERATOR and cursor.raw in (",", "&", "+"):
        fix = replace_fix("Write `and`", Span(cursor.last_end() + cursor.base, cursor.here().end), " and")
        cursor.complain(cursor.here(), f"qualities are joined by `and`, not by `{cursor.raw}`", fix)
        cursor.recover()


def bare_title(cursor: Cursor, has_quality: bool) -> Word | None:
    """Report and accept a title without quotes; or report a quality without its `:`."""
    following = cursor.index + 1
    if (
        cursor.kind != NAME
        or cursor.group
        or at_verb(cursor)
        or cursor.raw in HEADS
        or cursor.raw in ENDS_CLAUSES
        or is_clause_by_context(cursor)
    ):
        return None
    is_word = cursor.kinds[following] == NEWLINE
    if cursor.kinds[following] == STRING and not has_quality:
        cursor.complain(cursor.here(), _A_QUALITY, cursor.put_before(":"))
        cursor.advance()
        return cursor.take()
    if not (is_word or is_prose(cursor, following)):
        return None
    if cursor.raw in MEANT or cursor.raw in MODALS:
        return None
    if near(cursor.raw, VERB_WORDS | HEADS, limit=1) and not is_long_prose(cursor):
        return None
    end = following
    while cursor.kinds[end] != NEWLINE and not is_clause(cursor, end):
        end += 1
    start = cursor.starts[cursor.index]
    span = Span(start, cursor.starts[end - 1] + len(cursor.raws[end - 1]))
    text = cursor.text[start : span.end]
    fixes = [replace_fix("Put quotes around it", span, quote(text))]
    if is_word and not has_quality:
        fixes.append(cursor.put_before(":"))
    cursor.complain(span, f"{_A_TITLE}, and {_A_QUALITY}" if len(fixes) > 1 else _A_TITLE, *(tuple(fixes)))
    cursor.go_to(end)
    return Word(NAME, start - cursor.base, text)


def is_prose(cursor: Cursor, index: int) -> bool:
    """Whether the word at `index`, after another, does not make a claim of both, as a verb, or `must` and a verb,
    would.
    """
    if cursor.kinds[index] != NAME or cursor.raws[index] in VERB_WORDS or cursor.raws[index] in ENDS_CLAUSES:
        return False
    if cursor.raws[index] in MODALS:
        return not (cursor.kinds[index + 1] == NAME and near(cursor.raws[index + 1], VERB_WORDS, limit=1))
    return not (is_clause(cursor, index) or near(cursor.raws[index], VERB_WORDS, limit=1))


def is_long_prose(cursor: Cursor) -> bool:
    """Whether the rest of the line is more than two words: `keep the arm still`."""
    return len(cursor.kinds) - 1 - cursor.index > 2 and all(kind == NAME for kind in cursor.kinds[cursor.index : -1])


def is_clause(cursor: Cursor, index: int) -> bool:
    """Whether the token at `index` can only begin a clause, even after prose."""
    if cursor.kinds[index] != NAME:
        return False
    raw, second = cursor.raws[index], cursor.raws[index + 1] if cursor.kinds[index + 1] == NAME else ""
    if (raw in VERB_WORDS or raw in COUNTING) and second:
        return second == "between" or (second, cursor.raws[index + 2]) in RELATIONS
    is_reason = raw in ("because", "source") and cursor.kinds[index + 1] == STRING
    return is_reason or raw in ENDS_CLAUSES or (raw, second) in _BEGIN_CLAUSES


def no_equals(cursor: Cursor, keys: list[int]) -> None:
    """Report that the `=` after some words of the classic form is missing."""
    changes: list[FixEdit] = []
    for key in keys:
        end = cursor.starts[key] + len(cursor.raws[key])
        sign = cursor.starts[key + 1] + 1 if cursor.is_operator(key + 1, ":") else end
        changes.append(FixEdit(Place(Span(end, sign)), " ="))
    span = Span(cursor.starts[keys[0]], cursor.starts[keys[0]] + len(cursor.raws[keys[0]]))
    cursor.complain(span, f"expected `=` after `{cursor.raws[keys[0]]}`", Fix("Write `=`", tuple(changes), safe=True))


def no_unit(cursor: Cursor, word: str, span: Span, sort: str) -> None:
    """Report a type of C++ or ROS in place of a unit."""
    if sort == TYPE:
        owner = "signal" if cursor.is_word(0, "signal") else "parameter"
        note = "write the unit of its values: `m/s`, `s`, `%`, …; or `1` if they have none"
        message = f"unknown unit `{word}`: a {owner} has a unit, not a type"
        cursor.report(Diagnostic("unknown-unit", span, message, notes=(note,)))
    else:
        message = f"unknown unit `{word}`; did you mean `{sort}`?"
        cursor.report(Diagnostic("unknown-unit", span, message, fixes=(write_fix(sort, span),)))


def sort_of(type_: str) -> str:
    """What a type of C++ or ROS is as the unit of a signal: `bool`, `text`, or TYPE if it does not tell; empty if the
    word names none."""
    if type_ in UNITLESS:
        return ""
    last = _PART.split(type_)[-1].casefold()
    if last in _SORTS:
        return _SORTS[last]
    return TYPE if _NUMBER_TYPE.fullmatch(last) or "::" in type_ or _MESSAGE.search(type_) else ""


TYPE: Final = "type"
_TYPE: Final = re.compile(
    r"(?:(?:const|(?:un)?signed|long|short)[ \t]+(?=(?:(?:un)?signed|long|short|int|char|double)\b))*"
    r"[^\W\d]\w*(?:(?:::|/)[^\W\d]\w*)*(?:[ \t]*<[^\"#\r\n=]*>)?"
)
_PART: Final = re.compile("::|[/ \t]+")
_MESSAGE: Final = re.compile(r"_msgs\b|_interfaces\b|\bmsg/|<")
_SORTS: Final = {
    **dict.fromkeys(("boolean", "flag", "bool"), "bool"),
    **dict.fromkeys(("string", "str", "string_view", "wstring"), "text"),
    **dict.fromkeys(("number", "count"), "1"),
    **dict.fromkeys(("speed", "velocity"), "m/s"),
    **dict.fromkeys(("distance", "length", "height", "width"), "m"),
    **dict.fromkeys(("time", "duration"), "s"),
    **{"temperature": "degC", "angle": "rad", "force": "N", "voltage": "V", "power": "W", "energy": "J", "mass": "kg"},
}
_NUMBER_TYPE: Final = re.compile(
    r"u?int(?:eger)?(?:8|16|32|64)?(?:_t)?|float(?:32|64)?|double|real|unsigned|signed|long|short|char|byte|size_t"
    r"|auto|any|object|enum|list|vector|array|dict|map|tuple|pose|twist|point"
)
_TITLES: Final = ("description", "title", "text")
_A_TITLE: Final = "a title goes in quotes"
_A_QUALITY: Final = "a quality goes after `:`"
_BEGIN_CLAUSES: Final = frozenset(
    (
        ("in", "at"),
        ("with", "probability"),
        ("on", "violation"),
        ("on", "average"),
        ("over", "last"),
        ("verified", "by"),
        ("approved", "by"),
    )
)
