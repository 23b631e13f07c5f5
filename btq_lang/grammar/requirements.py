"""The part of the parser that reads requirements, their clauses, and the lists that hold them.

Each function is a production of docs/grammar.md and named as it; its docstring shows the production.
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.measured import measured
from btq_lang.diagnostics.model import Change, Diagnostic, Fix, Place, replace_fix
from btq_lang.grammar.claims import MEANT, MODALS, QUALITY_IN_HEAD, RELATIONS, VERBS, ClaimParser, is_time
from btq_lang.grammar.conditions import HEADS, SUBJECT_HEADS
from btq_lang.syntax.scan import is_unit, line_end, path_end, unit_run
from btq_lang.syntax.suggestions import unknown_unit
from btq_lang.syntax.tokens import CLOSE, NAME, NEWLINE, NUMBER, OPEN, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import (
    Argument,
    Because,
    Clause,
    Confidence,
    Goal,
    How,
    Odds,
    OnViolation,
    Parameter,
    QualityPath,
    ReqRef,
    Requirement,
    Scope,
    Window,
    Word,
    quote,
    unquote,
)
from btq_lang.util.spelling import near
from btq_lang.util.text import Span

EXPERIMENTS: Final = frozenset(("activations", "runs"))
ACTIONS: Final = ("fail", "halt", "warn", "log")
METHODS: Final = ("monitor", "analysis", "test", "review")
UNITLESS: Final = frozenset(("bool", "text", "1"))  # what may stand for a unit behind the `:` of a signal


class ClauseParser(ClaimParser):
    """A cursor that can read requirements."""

    # ---- requirements ----

    def requirement(self) -> Requirement:
        """Requirement = ReqHead { Clause };  the word QualityReq is at hand"""
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
            self.torn_quality(quality)
        self.skip_key(_TITLES, "")
        title = self.take() if self.kind == STRING else self.bare_title(quality is not None)
        if quality is None and title is not None and self.at(":"):
            self.complain("syntax-error", self.here(), "a requirement's quality goes before its title")
            self.advance()
            quality = self.quality_path()
        clauses = self.clauses()
        return Requirement(start, self.last_end(), name, False, parameters, quality, title, clauses)

    def skip_brackets(self, message: str) -> None:
        """Report the brackets at hand, which do not belong there, and go on as if there were none."""
        if self.kind != OPEN or CLOSE not in self.kinds[self.index :]:
            return
        closing = self.kinds.index(CLOSE, self.index)
        if self.raws[closing] != ")" or OPEN in self.kinds[self.index + 1 : closing]:
            return
        ends = self.here(), Span(self.starts[closing], self.starts[closing] + 1)
        fix = Fix("Remove the brackets", tuple([Change(Place(end), "") for end in ends]), safe=True)
        self.complain("syntax-error", self.here(), message, (), (fix,))
        for index in (closing, self.index):
            del self.kinds[index], self.starts[index], self.raws[index]
        self.go_to(self.index)

    def skip_key(self, words: tuple[str, ...], instead: str) -> bool:
        """Report an attribute's key where the value alone belongs, `description = "in time"`, and pass over it.

        Args:
            instead: what is written instead of the key.
        """
        value = self.index + 2
        if self.kind != NAME or self.raw not in words or self.kinds[value] not in (NAME, STRING):
            return False
        if not (self.is_operator(self.index + 1, "=") or self.is_operator(self.index + 1, ":")):
            return False
        key = Span(self.here().start, self.starts[self.index + 1] + 1)
        written = self.text[key.start : key.end]
        if instead:
            fix = replace_fix(f"Write `{instead}`", key, instead, safe=True)
            message = f"expected `{instead}` before the quality, found `{written}`"
        else:
            fix = replace_fix(f"Remove `{written}`", Span(key.start, self.starts[value]), "", safe=True)
            message = f"a title goes after the ID without `{written}`"
        self.complain("syntax-error", key, message, (), (fix,))
        self.go_to(value)
        return True

    def lacks_equals(self) -> bool:
        """Whether the `=` after `ID` is missing: `QualityReq ID rq1 description "x"`."""
        name = self.index + 1
        return self.kinds[name] == NAME and self.raws[name + 1] in ("description", ",", "\n", "\r\n", "\r", "")

    def requirement_id(self, what: str) -> Word | None:
        """Name;  `REQ.001`, `1.2` and `4711` are told to need quotes, and taken"""
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
        self.complain("syntax-error", Span(first, first + len(text)), "this ID needs quotes", (), (fix,))
        while self.kind != NEWLINE and self.starts[self.index] < first + len(text):
            self.advance()
        return Word(NAME, start, text)

    def torn_quality(self, quality: QualityPath) -> None:
        """Complain of `time behaviour`: a quality's name has no spaces."""
        last = quality.names[-1]
        if self.kind != NAME or last.kind != NAME or self.kinds[self.index + 1] not in (STRING, NEWLINE):
            return
        if self.raw not in VERBS and self.raw not in HEADS:
            fix = replace_fix("Write `-`", Span(last.end + self.base, self.here().start), "-")
            span = Span(last.start + self.base, self.here().end)
            self.complain("syntax-error", span, "a quality's name has no spaces", (), (fix,))
            self.advance()

    def second_quality(self, requirement: Requirement) -> None:
        """Complain of a comma behind a requirement that is no element of a list: `QualityReq r : safety, usability`."""
        if requirement.quality is not None and not requirement.clauses and self.at(","):
            self.expected("the requirement's title, or its clauses", ("a requirement has one quality",))

    def bare_title(self, has_quality: bool) -> Word | None:
        """Complain of a title without its quotes, and take it; or of a quality without its `:`."""
        following = self.index + 1
        if self.kind != NAME or self.group or self.raw in VERBS or self.raw in HEADS or self.raw in _ENDS_CLAUSES:
            return None
        is_word = self.kinds[following] == NEWLINE
        if self.kinds[following] == STRING and not has_quality:
            self.complain("syntax-error", self.here(), _A_QUALITY, (), (self.colon_before(),))
            self.advance()
            return self.take()
        if not (is_word or self.is_prose(following)):
            return None
        if self.raw in MEANT or (near(self.raw, VERBS | HEADS, limit=1) and not self.is_long_prose()):
            return None
        end = following
        while self.kinds[end] != NEWLINE and not self.is_clause(end):
            end += 1
        start = self.starts[self.index]
        span = Span(start, self.starts[end - 1] + len(self.raws[end - 1]))
        text = self.text[start : span.end]
        fixes = [replace_fix("Put quotes around it", span, quote(text))]
        if is_word and not has_quality:
            fixes.append(self.colon_before())
        message = f"{_A_TITLE}, and {_A_QUALITY}" if len(fixes) > 1 else _A_TITLE
        self.complain("syntax-error", span, message, (), tuple(fixes))
        self.go_to(end)
        return Word(NAME, start - self.base, text)

    def colon_before(self) -> Fix:
        at = self.here().start
        return replace_fix("Put `:` before it", Span(at, at), ": ")

    def is_prose(self, index: int) -> bool:
        """Whether a word behind another is none that makes a claim of both: a verb, or `must` and a verb."""
        if self.kinds[index] != NAME or self.raws[index] in VERBS or self.raws[index] in _ENDS_CLAUSES:
            return False
        if self.raws[index] in MODALS:
            return not (self.kinds[index + 1] == NAME and near(self.raws[index + 1], VERBS, limit=1))
        return not (self.is_clause(index) or near(self.raws[index], VERBS, limit=1))

    def is_long_prose(self) -> bool:
        """Whether nothing but words stands here to the end of the line, and more than two: `keep the arm still`."""
        return len(self.kinds) - 1 - self.index > 2 and all(kind == NAME for kind in self.kinds[self.index : -1])

    def is_clause(self, index: int) -> bool:
        """Whether what stands at `index` can be nothing but the beginning of a clause, even behind prose."""
        if self.kinds[index] != NAME:
            return False
        raw, second = self.raws[index], self.raws[index + 1] if self.kinds[index + 1] == NAME else ""
        if raw in VERBS and second:
            return second == "between" or (second, self.raws[index + 2]) in RELATIONS
        is_reason = raw == "because" and self.kinds[index + 1] == STRING
        return is_reason or raw in _ENDS_CLAUSES or (raw, second) in _BEGIN_CLAUSES

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
        """Complain that the `=` after some words of the classic form is missing."""
        changes: list[Change] = []
        for key in keys:
            end = self.starts[key] + len(self.raws[key])
            sign = self.starts[key + 1] + 1 if self.is_operator(key + 1, ":") else end
            changes.append(Change(Place(Span(end, sign)), " ="))
        span = Span(self.starts[keys[0]], self.starts[keys[0]] + len(self.raws[keys[0]]))
        fix = Fix("Write `=`", tuple(changes), safe=True)
        self.complain("syntax-error", span, f"expected `=` after `{self.raws[keys[0]]}`", (), (fix,))

    def params(self) -> tuple[Parameter, ...]:
        """Params = "(" NAME ":" UNIT [ "=" Bounded ] { "," NAME ":" UNIT [ "=" Bounded ] } ")\""""
        self.advance()
        self.group += 1
        found: list[Parameter] = []
        while name := self.plain_name("a parameter's name"):
            unit = None
            if self.at("="):
                note = "write its unit after `:`, and its default after that: `limit : m = 3 m`"
                self.expected("`:` and the parameter's unit", (note,))
            elif self.expect(":"):
                unit = self.unit()
            default = self.bounded() if self.accept("=") else None
            found.append(Parameter(name, unit, default))
            if not self.accept(","):
                break
        self.close_group("`,` or `)`")
        return tuple(found)

    def req_ref(self, name: Word) -> ReqRef:
        """ReqRef = Name [ "(" NAME "=" Bounded { "," NAME "=" Bounded } ")" ];  the name is taken"""
        if self.kind != OPEN:
            return ReqRef(name)
        self.advance()
        self.group += 1
        found: list[Argument] = []
        while key := self.argument_name():
            value = self.bounded() if self.expect("=") else None
            found.append(Argument(key, value))
            if not self.accept(","):
                break
        self.close_group("`,` or `)`")
        return ReqRef(name, tuple(found))

    def argument_name(self) -> Word | None:
        """NAME"""
        if self.kind in (NUMBER, QUANTITY):
            self.expected("a parameter's name", (f"a value goes after the name of its parameter: `x = {self.raw}`",))
            return None
        return self.plain_name("a parameter's name")

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

    # ---- clauses ----

    def clauses(self, at_least_one: bool = False) -> tuple[Clause, ...]:
        """{ Clause }, to the end of the line or of what holds them"""
        found: list[Clause] = []
        while self.kind == NAME or self.kind == STRING:
            following = self.index + 1
            if self.kind == NAME and self.raw in _ENDS_CLAUSES and self.raw not in HEADS:
                break
            if self.group and self.is_operator(following, "="):
                break
            clause = self.clause()
            if clause is None:
                return tuple(found)
            found.append(clause)
        if at_least_one and not found and self.kind == OPERATOR and self.raw in ("<=", "<", ">=", ">"):
            self.bare_bound()
        elif at_least_one and not found:
            self.expected(_A_CLAUSE, (QUALITY_IN_HEAD,) if self.at_word("satisfices") else ())
        return tuple(found)

    def clause(self) -> Clause | None:
        """Clause = Claim | Scope | Odds | Confidence | Window | OnViolation | Goal | Because | How"""
        start = self.start()
        word = self.raw if self.kind == NAME else ""
        if word in VERBS or word in SUBJECT_HEADS:
            return self.claim()
        if word == "while" or word == "when":
            scope = self.take()
            condition = self.cond()
            return Scope(start, self.last_end(), scope, condition)
        if word == "in" or word == "with":
            return self.odds()
        if word == "confidence":
            self.advance()
            value = self.percentage("95 %")
            return Confidence(start, self.last_end(), value)
        if word == "over":
            return self.window()
        if word == "on":
            self.advance()
            if not self.accept_word("violation"):
                self.no_violation()
            self.skip_sign("=")
            action = self.one_of(ACTIONS)
            return OnViolation(start, self.last_end(), action)
        if word == "on_violation":
            fix = replace_fix("Write `on violation`", self.here(), "on violation", safe=True)
            self.complain("syntax-error", self.here(), "expected `on violation`, found `on_violation`", (), (fix,))
            self.advance()
            self.skip_sign("=")
            return OnViolation(start, self.last_end(), self.one_of(ACTIONS))
        if word == "goal":
            self.advance()
            bounded = self.bounded()
            return Goal(start, self.last_end(), bounded)
        if word == "because":
            self.advance()
            text = self.take() if self.kind == STRING else None
            if text is None:
                said = self.here().start
                rest = self.text[said : line_end(self.text, said)].partition(" #")[0].rstrip()
                fix = replace_fix("Put quotes around it", Span(said, said + len(rest)), quote(rest))
                self.expected("the reason in quotes", (), (fix,) if rest and not self.group else ())
            return Because(start, self.last_end(), text)
        if word == "verified":
            self.advance()
            self.expect_word("by")
            method = self.one_of(METHODS)
            return How(start, self.last_end(), method)
        if (self.lost_quote() or self.wrong_unit()) and not self.is_verb(1):
            self.expected(_A_CLAUSE)
            return None
        if self.is_no_time():
            at = self.starts[self.index]
            self.report(unknown_unit(self.text, at, at + len(self.raw)))
            self.advance()
            return self.clause() if self.kind == NAME else None
        return self.claim()

    def no_violation(self) -> None:
        """Complain that `violation` is missing, and pass over what is meant for it: `on failure fail`."""
        following = self.index + 1
        if self.kind == NAME and self.kinds[following] == NAME and self.raws[following] in ACTIONS:
            fix = replace_fix(f"Replace `{self.raw}` with `violation`", self.here(), "violation")
            self.complain("syntax-error", self.here(), f"expected `violation`, found `{self.raw}`", (), (fix,))
            self.advance()
        else:
            self.expect_word("violation", forgotten=self.kind == NAME and self.raw in ACTIONS)

    def bare_bound(self) -> None:
        """Complain of `<= 30 s` without a verb."""
        sign, value = self.raw, self.index + 1
        bound = {"<=": "at most", "<": "less than", ">=": "at least", ">": "more than"}.get(sign)
        fixes: tuple[Fix, ...] = ()
        if bound is not None and self.kinds[value] == QUANTITY and is_time(self.raws[value]):
            written = f"takes {bound} {self.raws[value]}"
            span = Span(self.here().start, self.starts[value] + len(self.raws[value]))
            fixes = (replace_fix(f"Write `{written}`", span, written),)
        self.expected(_A_CLAUSE, ("a bound goes after its verb: `takes at most 30 s`",), fixes)

    def is_no_time(self) -> bool:
        """Whether a word stands behind a number where its unit of time should be, and is nothing else."""
        if self.kind != NAME or self.index == 0 or self.kinds[self.index - 1] != NUMBER:
            return False
        following = self.index + 1
        ends = self.kinds[following] in (NEWLINE, CLOSE) or (
            self.kinds[following] == NAME and self.raws[following] in HEADS
        )
        is_misspelt = near(self.raw, VERBS | HEADS, limit=1)
        return ends and not is_misspelt and measured(self.raws[: self.index]) == "s"

    def odds(self) -> Odds:
        """ "in" "at" "least" QUANTITY "of" Experiments | "with" "probability" ( ">=" | ">" ) QUANTITY [ "of" … ]"""
        start = self.start()
        relation = ">="
        value: Word | None = None
        experiments = None
        if self.accept_word("in"):
            if self.kind == QUANTITY:
                fix = replace_fix("Put `at least` before it", Span(self.here().start, self.here().start), "at least ")
                self.complain(
                    "syntax-error", self.here(), f"a probability is written `in at least {self.raw}`", (), (fix,)
                )
                value = self.take()
            else:
                ok = self.expect_word("at") and self.expect_word("least")
                value = self.percentage("98 %") if ok else None
            if value is not None and self.expect_word("of", forgotten=self.raw in EXPERIMENTS):
                experiments = self.one_of(("activations", "runs"))
            return Odds(start, self.last_end(), relation, value, experiments)
        self.advance()
        if self.kind == QUANTITY:
            at = self.here()
            fix = replace_fix("Put `probability >=` before it", Span(at.start, at.start), "probability >= ")
            self.complain("syntax-error", at, f"a probability is written `with probability >= {self.raw}`", (), (fix,))
            value = self.take()
        elif self.expect_word("probability"):
            if self.at(">=") or self.at(">"):
                relation = self.raw
                self.advance()
                value = self.percentage("98 %")
            elif self.kind == QUANTITY:
                fix = replace_fix("Put `>=` before it", Span(self.here().start, self.here().start), ">= ")
                message = f"a probability is written `with probability >= {self.raw}`"
                self.complain("syntax-error", self.here(), message, (), (fix,))
                value = self.take()
            else:
                fixes: tuple[Fix, ...] = ()
                if self.kind == NUMBER and 0 < float(self.raw) <= 1:
                    written = f">= {float(self.raw) * 100:.10g} %"
                    fixes = (replace_fix(f"Write `{written}`", self.here(), written),)
                self.expected("`>=` or `>` and a percentage", (), fixes)
        if value is not None and self.accept_word("of"):
            experiments = self.one_of(("activations", "runs"))
        return Odds(start, self.last_end(), relation, value, experiments)

    def percentage(self, example: str) -> Word | None:
        """QUANTITY"""
        fixes: tuple[Fix, ...] = ()
        if self.kind == NUMBER:
            share = float(self.raw)
            percent = f"{share * 100:.10g} %" if 0 < share <= 1 else f"{self.raw} %"
            fixes = (replace_fix(f"Write `{percent}`", self.here(), percent),)
        if self.kind == QUANTITY:
            return self.take()
        self.expected(f"a percentage: {example}", (), fixes)
        return None

    def window(self) -> Window:
        """ "over" "last" ( NUMBER Experiments | QUANTITY )"""
        start = self.start()
        self.advance()
        self.expect_word("last")
        size = experiments = None
        if self.kind == QUANTITY:
            size = self.take()
        elif self.kind == NUMBER:
            size = self.take()
            experiments = self.one_of(("activations", "runs"))
        else:
            self.expected("a number of runs or activations, or a duration")
        return Window(start, self.last_end(), size, experiments)

    def one_of(self, words: tuple[str, ...]) -> Word | None:
        self.skip_sign(":")
        if self.kind == NAME and self.raw in words:
            return self.take()
        what = f"{', '.join(words[:-1])} or {words[-1]}"
        meant = near(self.raw, words, limit=1) or tuple(word for word in words if self.raw.startswith(word))
        meant = meant or tuple(word for word in _OTHER_WORDS.get(self.raw, ()) if word in words)
        if self.kind != NAME or not meant:
            return self.missing_word(what)
        fixes = tuple(replace_fix(f"Replace `{self.raw}` with `{word}`", self.here(), word) for word in meant)
        self.complain("syntax-error", self.here(), f"expected {what}, found {self.found()}", (), fixes)
        self.advance()
        return None

    # ---- units ----

    def unit(self) -> Word | None:
        """UNIT, behind the `:` of a signal or a parameter, where it is not part of a QUANTITY"""
        first = self.starts[self.index]
        start = self.start()
        if self.kind not in (NAME, NUMBER, QUANTITY, STRING) and not self.at("%"):
            self.expected("a unit: s, m/s, %, 1, bool, text, …")
            return None
        end = max(unit_run(self.text, first), first + len(self.raw))  # right or wrong
        word = self.text[first:end]
        if self.kind == STRING and is_unit(inner := unquote(word)):
            fix = replace_fix(f"Write `{inner}`", self.here(), inner, safe=True)
            self.complain("syntax-error", self.here(), "a unit takes no quotes", (), (fix,))
        elif self.kind == STRING:
            self.expected("a unit: s, m/s, %, 1, bool, text, …")
            return None
        elif word in _OTHER_SORTS:
            fix = replace_fix(f"Write `{_OTHER_SORTS[word]}`", Span(first, end), _OTHER_SORTS[word])
            message = f"unknown unit `{word}`; did you mean `{_OTHER_SORTS[word]}`?"
            self.report(Diagnostic("unknown-unit", Span(first, end), message, fixes=(fix,)))
        elif word not in UNITLESS and not is_unit(word):
            self.report(unknown_unit(self.text, first, end))
        while self.starts[self.index] < end and self.kind != NEWLINE:
            self.advance()
        return Word(NAME, start, self.text[first:end])


_TITLES: Final = ("description", "title", "text")
_OTHER_WORDS: Final = {  # for actions and methods
    **dict.fromkeys(("stop", "abort"), ("halt", "fail")),
    **dict.fromkeys(("alert", "notify", "report"), ("warn", "log")),
    **dict.fromkeys(("inspection", "demonstration"), ("review", "test")),
    **dict.fromkeys(("simulation", "proof", "calculation"), ("analysis", "test")),
}
_OTHER_SORTS: Final = {
    **dict.fromkeys(("boolean", "Boolean", "Bool", "flag"), "bool"),
    **dict.fromkeys(("string", "String", "str", "std::string"), "text"),
    **dict.fromkeys(("int", "integer", "float", "double", "number", "count"), "1"),
}
_A_TITLE: Final = "a title goes in quotes"
_A_QUALITY: Final = "a quality goes after `:`"
_BEGIN_CLAUSES: Final = frozenset(
    (("in", "at"), ("with", "probability"), ("on", "violation"), ("over", "last"), ("verified", "by"))
)
_A_CLAUSE: Final = "a clause: takes, keeps, in at least, on violation, …"
_ENDS_CLAUSES: Final = frozenset(("satisfices", "satisfies", "tags", "parameters", "QualityReq", "Quality"))
