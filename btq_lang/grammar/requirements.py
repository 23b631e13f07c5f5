"""The part of the parser that reads requirements, except their clauses, and the units of declarations.

Each function is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.claims import MEANT, VERB_WORDS
from btq_lang.grammar.clauses import ENDS_CLAUSES, ClauseParser
from btq_lang.grammar.conditions import HEADS, RELATIONS
from btq_lang.grammar.prose import MODALS
from btq_lang.syntax.scan import is_unit, path_end, unit_run
from btq_lang.syntax.suggestions import unknown_unit
from btq_lang.syntax.tokens import CLOSE, NAME, NEWLINE, NUMBER, OPEN, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import Argument, Parameter, QualityPath, ReqRef, Requirement, Word, quote, unquote
from btq_lang.util.spelling import near
from btq_lang.util.text import Span

UNITLESS: Final = frozenset(("bool", "text", "1"))  # allowed instead of a unit after the `:` of a signal


class RequirementParser(ClauseParser):
    """A cursor that can read requirements."""

    # ---- requirements ----

    def requirement(self) -> Requirement:
        """Requirement = ReqHead { Clause }; the current word is QualityReq"""
        start = self.start()
        self.advance()
        self.skip_glued_colon()
        if self.kind == OPEN and self.is_word(self.index + 1, "ID"):
            self.skip_brackets("a requirement's ID goes after `QualityReq`, without brackets")
        if self.at_word("ID") and (self.is_operator(self.index + 1, "=") or self.lacks_equals()):
            return self.classic_requirement(start)
        name = self.requirement_id("the requirement's ID")
        parameters = self.params() if self.kind == OPEN and name is not None else ()
        if self.at(":") and self.adjacent(self.index):
            self.skip_last_sign()
        quality = self.quality_path() if self.accept(":") or self.skip_key(("quality",), ":") else None
        if quality is not None:
            self.spaced_quality(quality)
        self.skip_key(_TITLES, "")
        title = self.take() if self.kind == STRING else self.bare_title(quality is not None)
        if quality is None and title is not None and self.at(":"):
            self.complain(self.here(), "a requirement's quality goes before its title")
            self.advance()
            quality = self.quality_path()
        self.title_at = self.last_end() + self.base if title is None else -1
        clauses = self.clauses()
        return Requirement(start, self.last_end(), name, False, parameters, quality, title, clauses)

    def skip_brackets(self, message: str) -> None:
        """Report the current brackets, which do not belong there, and continue as if there were none."""
        if self.kind != OPEN or CLOSE not in self.kinds[self.index :]:
            return
        closing = self.kinds.index(CLOSE, self.index)
        if self.raws[closing] != ")" or OPEN in self.kinds[self.index + 1 : closing]:
            return
        ends = self.here(), Span(self.starts[closing], self.starts[closing] + 1)
        fix = Fix("Remove the brackets", tuple([FixEdit(Place(end), "") for end in ends]), safe=True)
        self.complain(self.here(), message, fix)
        for index in (closing, self.index):
            del self.kinds[index], self.starts[index], self.raws[index]
        self.go_to(self.index)

    def skip_key(self, words: tuple[str, ...], instead: str) -> bool:
        """Report and skip an attribute's key where only the value belongs, as in `description = "in time"`."""
        value = self.index + 2
        if self.kind != NAME or self.raw not in words or self.kinds[value] not in (NAME, STRING):
            return False
        if not (self.is_operator(self.index + 1, "=") or self.is_operator(self.index + 1, ":")):
            return False
        key = Span(self.here().start, self.starts[self.index + 1] + 1)
        written = self.text[key.start : key.end]
        if instead:
            fix = write_fix(instead, key, safe=True)
            message = f"expected `{instead}` before the quality, found `{written}`"
        else:
            fix = replace_fix(f"Remove `{written}`", Span(key.start, self.starts[value]), "", safe=True)
            message = f"a title goes after the ID without `{written}`"
        self.complain(key, message, fix)
        self.go_to(value)
        return True

    def lacks_equals(self) -> bool:
        """Whether the `=` after `ID` is missing: `QualityReq ID rq1 description "x"`."""
        name = self.index + 1
        return self.kinds[name] == NAME and self.raws[name + 1] in ("description", ",", "\n", "\r\n", "\r", "")

    def requirement_id(self, what: str) -> Word | None:
        """Name; `REQ.001`, `1.2` and `4711` are accepted, and reported to need quotes"""
        start = self.start()
        first = self.starts[self.index]
        if self.kind in (NUMBER, QUANTITY):
            end = max(path_end(self.text, first), first + len(self.raw))
        elif self.kind == NAME and self.is_operator(self.index + 1, ".") and self.adjacent(self.index + 1):
            end = path_end(self.text, first)
        else:
            return self.name(what)
        text = self.text[first:end].rstrip(",:")
        fix = replace_fix("Put quotes around it", Span(first, first + len(text)), quote(text), safe=True)
        self.complain(Span(first, first + len(text)), "this ID needs quotes", fix)
        while self.kind != NEWLINE and self.starts[self.index] < first + len(text):
            self.advance()
        return Word(NAME, start, text)

    def spaced_quality(self, quality: QualityPath) -> None:
        """Report `time behaviour`: a quality's name has no spaces."""
        last = quality.names[-1]
        if self.kind != NAME or last.kind != NAME or self.kinds[self.index + 1] not in (STRING, NEWLINE):
            return
        if self.raw not in VERB_WORDS and self.raw not in HEADS:
            fix = write_fix("-", Span(last.end + self.base, self.here().start))
            span = Span(last.start + self.base, self.here().end)
            self.complain(span, "a quality's name has no spaces", fix)
            self.advance()

    def second_quality(self, requirement: Requirement) -> None:
        """Report a list of qualities at a requirement that is not an element of a list itself: `QualityReq r : safety,
        usability`.
        """
        is_open = requirement.quality is not None and not (requirement.clauses or requirement.text)
        if is_open and self.kind == OPERATOR and self.raw in (",", "&", "+"):
            self.one_quality()

    def one_quality(self) -> None:
        """Report another quality of a requirement: the current sign or `and`, and what follows."""
        following = self.index + 1
        end = self.starts[following] + len(self.raws[following])
        note = "write a second requirement for the other one, or choose the one that matters most"
        self.complain(Span(self.here().start, end), "a requirement has one quality", notes=(note,))
        self.recover()

    def bare_title(self, has_quality: bool) -> Word | None:
        """Report and accept a title without quotes; or report a quality without its `:`."""
        following = self.index + 1
        if has_quality and self.at_word("and") and self.kinds[following + 1] == NEWLINE:
            self.one_quality()
            return None
        if self.kind != NAME or self.group or self.raw in VERB_WORDS or self.raw in HEADS or self.raw in ENDS_CLAUSES:
            return None
        is_word = self.kinds[following] == NEWLINE
        if self.kinds[following] == STRING and not has_quality:
            self.complain(self.here(), _A_QUALITY, self.put_before(":"))
            self.advance()
            return self.take()
        if not (is_word or self.is_prose(following)):
            return None
        if self.raw in MEANT or self.raw in MODALS:
            return None
        if near(self.raw, VERB_WORDS | HEADS, limit=1) and not self.is_long_prose():
            return None
        end = following
        while self.kinds[end] != NEWLINE and not self.is_clause(end):
            end += 1
        start = self.starts[self.index]
        span = Span(start, self.starts[end - 1] + len(self.raws[end - 1]))
        text = self.text[start : span.end]
        fixes = [replace_fix("Put quotes around it", span, quote(text))]
        if is_word and not has_quality:
            fixes.append(self.put_before(":"))
        self.complain(span, f"{_A_TITLE}, and {_A_QUALITY}" if len(fixes) > 1 else _A_TITLE, *(tuple(fixes)))
        self.go_to(end)
        return Word(NAME, start - self.base, text)

    def is_prose(self, index: int) -> bool:
        """Whether the word at `index`, after another, does not make a claim of both, as a verb, or `must` and a verb,
        would.
        """
        if self.kinds[index] != NAME or self.raws[index] in VERB_WORDS or self.raws[index] in ENDS_CLAUSES:
            return False
        if self.raws[index] in MODALS:
            return not (self.kinds[index + 1] == NAME and near(self.raws[index + 1], VERB_WORDS, limit=1))
        return not (self.is_clause(index) or near(self.raws[index], VERB_WORDS, limit=1))

    def is_long_prose(self) -> bool:
        """Whether the rest of the line is more than two words: `keep the arm still`."""
        return len(self.kinds) - 1 - self.index > 2 and all(kind == NAME for kind in self.kinds[self.index : -1])

    def is_clause(self, index: int) -> bool:
        """Whether the token at `index` can only begin a clause, even after prose."""
        if self.kinds[index] != NAME:
            return False
        raw, second = self.raws[index], self.raws[index + 1] if self.kinds[index + 1] == NAME else ""
        if raw in VERB_WORDS and second:
            return second == "between" or (second, self.raws[index + 2]) in RELATIONS
        is_reason = raw == "because" and self.kinds[index + 1] == STRING
        return is_reason or raw in ENDS_CLAUSES or (raw, second) in _BEGIN_CLAUSES

    def classic_requirement(self, start: int) -> Requirement:
        """ "QualityReq" "ID" "=" Name [ [ "," ] "description" "=" Name ] { Clause }"""
        lacking = [] if self.is_operator(self.index + 1, "=") else [self.index]
        self.go_to(self.index + (1 if lacking else 2))
        name = self.name("the requirement's ID")
        key = self.index + (1 if self.at(",") else 0)
        text = None
        if self.is_word(key, "description") and (self.is_operator(key + 1, ":") or self.kinds[key + 1] == STRING):
            lacking.append(key)
        if lacking:
            self.no_equals(lacking)
        if self.is_word(key, "description") and (lacking[-1:] == [key] or self.is_operator(key + 1, "=")):
            self.go_to(key + (1 if self.kinds[key + 1] == STRING else 2))
            text = self.name("the description")
        clauses = self.clauses()
        return Requirement(start, self.last_end(), name, True, (), None, text, clauses)

    def no_equals(self, keys: list[int]) -> None:
        """Report that the `=` after some words of the classic form is missing."""
        changes: list[FixEdit] = []
        for key in keys:
            end = self.starts[key] + len(self.raws[key])
            sign = self.starts[key + 1] + 1 if self.is_operator(key + 1, ":") else end
            changes.append(FixEdit(Place(Span(end, sign)), " ="))
        span = Span(self.starts[keys[0]], self.starts[keys[0]] + len(self.raws[keys[0]]))
        self.complain(span, f"expected `=` after `{self.raws[keys[0]]}`", Fix("Write `=`", tuple(changes), safe=True))

    def params(self) -> tuple[Parameter, ...]:
        """Params = "(" Param { "," Param } ")\""""
        self.advance()
        self.group += 1
        parameters = self.listed(self.param)
        self.close_group("`,` or `)`")
        return parameters

    def param(self) -> Parameter | None:
        """Param = NAME ":" UNIT [ "=" Bounded ]"""
        name = self.plain_name("a parameter's name")
        if name is None:
            return None
        unit = None
        if self.at("="):
            note = "write its unit after `:`, and its default after that: `limit : m = 3 m`"
            self.expected("`:` and the parameter's unit", (note,))
        elif self.expect(":"):
            unit = self.unit()
        default = self.bounded() if self.accept("=") else None
        return Parameter(name, unit, default)

    def req_ref(self, name: Word) -> ReqRef:
        """ReqRef = Name [ "(" NAME "=" Bounded { "," NAME "=" Bounded } ")" ]; the name is already read"""
        if self.kind != OPEN:
            return ReqRef(name)
        self.advance()
        self.group += 1
        arguments = self.listed(self.argument)
        self.close_group("`,` or `)`")
        return ReqRef(name, arguments)

    def argument(self) -> Argument | None:
        """NAME "=" Bounded"""
        if self.kind in (NUMBER, QUANTITY):
            self.expected("a parameter's name", (f"a value goes after the name of its parameter: `x = {self.raw}`",))
            return None
        name = self.plain_name("a parameter's name")
        if name is None:
            return None
        return Argument(name, self.bounded() if self.expect("=") else None)

    def quality_path(self) -> QualityPath | None:
        """QualityPath = Name [ "<" Name ">" ] { "." Name }"""
        first = self.name("a quality")
        if first is None:
            return None
        names = [first]
        if self.at("<"):
            self.advance()
            if name := self.name("a sub-characteristic"):
                names.append(name)
                self.expect(">")
        while self.at("."):
            self.advance()
            name = self.name("a sub-characteristic")
            if name is None:
                break
            names.append(name)
        return QualityPath(tuple(names))

    # ---- units ----

    def unit(self) -> Word | None:
        """UNIT, after the `:` of a signal or a parameter, where it is not part of a QUANTITY"""
        first = self.starts[self.index]
        start = self.start()
        if self.kind not in (NAME, NUMBER, QUANTITY, STRING) and not self.at("%"):
            self.expected("a unit: s, m/s, %, 1, bool, text, …")
            return None
        end = max(unit_run(self.text, first), first + len(self.raw))  # valid or not
        word = self.text[first:end]
        if self.kind == NAME and (type_ := _TYPE.match(self.text, first)) and (sort := sort_of(type_[0])):
            end = max(end, type_.end())
            self.no_unit(type_[0], Span(first, type_.end()), sort)
        elif self.kind == STRING and is_unit(inner := unquote(word)):
            self.complain(self.here(), "a unit takes no quotes", write_fix(inner, self.here(), safe=True))
        elif self.kind == STRING:
            self.expected("a unit: s, m/s, %, 1, bool, text, …")
            return None
        elif word not in UNITLESS and not is_unit(word):
            self.report(unknown_unit(self.text, first, end))
        while self.starts[self.index] < end and self.kind != NEWLINE:
            self.advance()
        return Word(NAME, start, self.text[first:end])

    def no_unit(self, word: str, span: Span, sort: str) -> None:
        """Report a type of C++ or ROS in place of a unit."""
        if sort == TYPE:
            owner = "signal" if self.is_word(0, "signal") else "parameter"
            note = "write the unit of its values: `m/s`, `s`, `%`, …; or `1` if they have none"
            message = f"unknown unit `{word}`: a {owner} has a unit, not a type"
            self.report(Diagnostic("unknown-unit", span, message, notes=(note,)))
        else:
            message = f"unknown unit `{word}`; did you mean `{sort}`?"
            self.report(Diagnostic("unknown-unit", span, message, fixes=(write_fix(sort, span),)))


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
    (("in", "at"), ("with", "probability"), ("on", "violation"), ("over", "last"), ("verified", "by"))
)
