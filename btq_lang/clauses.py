"""The part of the parser that reads requirements, their clauses, and the lists that hold them.

Each function is a production of language.md §3 and named as it; its docstring shows the production.
"""

from __future__ import annotations

from btq_lang.conditions import HEADS, SUBJECT_HEADS, ConditionParser
from btq_lang.cursor import shown
from btq_lang.diagnostics import replace_fix
from btq_lang.lexer import unknown_unit
from btq_lang.near import near
from btq_lang.scan import is_unit, unit_run
from btq_lang.syntax import (
    Amount,
    Argument,
    Because,
    Between,
    Bound,
    Bounded,
    Case,
    Claim,
    Clause,
    Condition,
    Confidence,
    Event,
    Every,
    Goal,
    How,
    Mission,
    Odds,
    OnViolation,
    Parameter,
    Path,
    QualityPath,
    ReqRef,
    Requirement,
    Scope,
    Subject,
    Sum,
    Table,
    Window,
    Word,
    unquote,
)
from btq_lang.text import Span
from btq_lang.tokens import NAME, NEWLINE, NUMBER, OPEN, OPERATOR, QUANTITY, STRING

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

VERBS: Final = frozenset(
    ("takes", "succeeds", "needs", "keeps", "never", "leaves", "uses", "tries", "runs", "starts", "ends", "follows")
)
HAPPENINGS: Final = frozenset(("starts", "succeeds", "fails", "finishes", "halts"))
EXPERIMENTS: Final = frozenset(("activations", "runs"))
ACTIONS: Final = ("fail", "halt", "warn", "log")
METHODS: Final = ("monitor", "analysis", "test", "review")
RELATIONS: Final = {("at", "most"): "<=", ("at", "least"): ">=", ("less", "than"): "<", ("more", "than"): ">"}
UNITLESS: Final = frozenset(("bool", "text", "1"))  # what may stand for a unit behind the `:` of a signal


class ClauseParser(ConditionParser):
    """A cursor that can read requirements."""

    # ---- requirements ----

    def requirement(self) -> Requirement:
        """Requirement = ReqHead { Clause };  the word QualityReq is at hand"""
        start = self.start()
        self.advance()
        if self.at_word("ID") and self.is_operator(self.index + 1, "="):
            return self.classic_requirement(start)
        name = self.name("the requirement's ID")
        parameters = self.params() if self.kind == OPEN and name is not None else ()
        quality = self.quality_path() if self.accept(":") else None
        title = self.take() if self.kind == STRING else None
        clauses = self.clauses()
        return Requirement(start, self.last_end(), name, False, parameters, quality, title, clauses)

    def classic_requirement(self, start: int) -> Requirement:
        """ "QualityReq" "ID" "=" Name [ [ "," ] "description" "=" Name ] { Clause }"""
        self.advance()
        self.advance()
        name = self.name("the requirement's ID")
        comma = 1 if self.at(",") else 0
        text = None
        if self.is_word(self.index + comma, "description") and self.is_operator(self.index + comma + 1, "="):
            self.go_to(self.index + comma + 2)
            text = self.name("the description")
        clauses = self.clauses()
        return Requirement(start, self.last_end(), name, True, (), None, text, clauses)

    def params(self) -> tuple[Parameter, ...]:
        """Params = "(" NAME ":" UNIT [ "=" Bounded ] { "," NAME ":" UNIT [ "=" Bounded ] } ")\""""
        self.advance()
        self.group += 1
        found: list[Parameter] = []
        while name := self.plain_name("a parameter's name"):
            unit = self.unit() if self.expect(":") else None
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
        while key := self.plain_name("a parameter's name"):
            value = self.bounded() if self.expect("=") else None
            found.append(Argument(key, value))
            if not self.accept(","):
                break
        self.close_group("`,` or `)`")
        return ReqRef(name, tuple(found))

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
        if at_least_one and not found:
            self.expected(_A_CLAUSE)
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
            value = self.quantity("a percentage: 95 %")
            return Confidence(start, self.last_end(), value)
        if word == "over":
            return self.window()
        if word == "on":
            self.advance()
            self.expect_word("violation")
            action = self.one_of(ACTIONS)
            return OnViolation(start, self.last_end(), action)
        if word == "goal":
            self.advance()
            bounded = self.bounded()
            return Goal(start, self.last_end(), bounded)
        if word == "because":
            self.advance()
            text = self.take() if self.kind == STRING else self.missing_word("the reason in quotes")
            return Because(start, self.last_end(), text)
        if word == "verified":
            self.advance()
            self.expect_word("by")
            method = self.one_of(METHODS)
            return How(start, self.last_end(), method)
        if (self.lost_quote() or self.wrong_unit()) and not self.is_verb(1):
            self.expected(_A_CLAUSE)
            return None
        return self.claim()

    def odds(self) -> Odds:
        """ "in" "at" "least" QUANTITY "of" Experiments | "with" "probability" ( ">=" | ">" ) QUANTITY [ "of" … ]"""
        start = self.start()
        relation = ">="
        experiments = None
        if self.accept_word("in"):
            ok = self.expect_word("at") and self.expect_word("least")
            value = self.quantity("a percentage: 98 %") if ok else None
            if value is not None and self.expect_word("of"):
                experiments = self.one_of(("activations", "runs"))
            return Odds(start, self.last_end(), relation, value, experiments)
        self.advance()
        value = None
        if self.expect_word("probability"):
            if self.at(">=") or self.at(">"):
                relation = self.raw
                self.advance()
                value = self.quantity("a percentage: 98 %")
            else:
                self.expected("`>=` or `>` and a percentage")
            if self.accept_word("of"):
                experiments = self.one_of(("activations", "runs"))
        return Odds(start, self.last_end(), relation, value, experiments)

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
        if self.kind == NAME and self.raw in words:
            return self.take()
        what = f"{', '.join(words[:-1])} or {words[-1]}"
        meant = near(self.raw, words, limit=1) or tuple(word for word in words if self.raw.startswith(word))
        if self.kind != NAME or not meant:
            return self.missing_word(what)
        fix = replace_fix(f"Replace `{self.raw}` by `{meant[0]}`", self.here(), meant[0])
        self.complain("syntax-error", self.here(), f"expected {what}, found {self.found()}", (), (fix,))
        self.advance()
        return None

    # ---- claims ----

    def claim(self) -> Claim | None:
        """Claim = [ Subject ] Verb"""
        start = self.start()
        subject: Subject | None = None
        if not (self.kind == NAME and self.raw in VERBS):
            subject = self.subject()
        if not (self.kind == NAME and self.raw in VERBS):
            if subject is not None:
                self.no_verb(subject)
            return None
        verb = self.take()
        bound: Bound | None = None
        condition: Condition | None = None
        resource: Word | None = None
        per: Path | Word | None = None
        event: Event | None = None
        every = False
        word = verb.raw
        if word == "takes":
            bound = self.bound()
        elif word == "succeeds":
            bound = self.within() if self.accept_word("within") else None
        elif word in _OF_CONDITIONS:
            condition = self.cond()
        elif word == "uses":
            bound = self.bound()
            resource = self.plain_name("a signal") if self.expect_word("of") else None
        elif word == "tries":
            bound = self.bound()
            per = self.path("a node") if self.accept_word("per") else None
        elif word == "runs":
            if self.accept_word("every"):
                every = True
                bound = self.within()
            else:
                bound = self.bound()
                per = self.quantity("a duration: 1 s") if self.expect_word("per") else None
        elif word == "follows":
            event = self.event()
        else:
            bound = self.within() if self.expect_word("within") else None
            event = self.event() if self.expect_word("after") else None
        return Claim(start, self.last_end(), subject, verb, bound, condition, resource, per, event, every)

    def is_verb(self, further: int) -> bool:
        """Whether the next word but `further` is a verb."""
        index = self.index + further
        return index < len(self.kinds) and self.kinds[index] == NAME and self.raws[index] in VERBS

    def no_verb(self, subject: Subject) -> None:
        """Complain of a subject without a verb, or of a misspelt verb that was read as a subject."""
        if self.kind == NAME and (likely := near(self.raw, VERBS, limit=1)):
            self.misspelt(self.here(), self.raw, likely[0])
        elif not isinstance(subject, Path):
            self.expected(_A_VERB)
        elif len(subject.names) == 1 and (likely := near(subject.names[0].raw, VERBS | HEADS, limit=1)):
            self.misspelt(subject.span.shifted(self.base), subject.names[0].raw, likely[0])
        else:
            name = "/".join(word.raw for word in subject.names)
            note = _INSTEAD_OF_A_NODE
            if subject.names[0].kind == STRING:
                note = "a requirement has one title; reasons are written `because …`"
            elif self.kind == STRING:
                note = '`:` stands before a quality, and quotes around a title: QualityReq ID : quality "title"'
            elif len(subject.names) == 1:
                note = _MEANT.get(name, note)
            self.expected(f"a verb behind `{shown(name)}` (takes, succeeds, needs, keeps, …)", (note,))

    def misspelt(self, span: Span, word: str, likely: str) -> None:
        """Complain of a word that begins no clause, and pass over the rest."""
        fix = replace_fix(f"Replace `{word}` by `{likely}`", span, likely)
        self.complain("syntax-error", span, f"`{word}` begins no clause: did you mean `{likely}`?", (), (fix,))
        self.recover()

    def subject(self) -> Subject | None:
        """Subject = Path | "mission" | "every" Name | "from" Event "to" Event | "sum" "of" Path { "," Path }"""
        start = self.start()
        if self.accept_word("mission"):
            return Mission(start, self.last_end())
        if self.accept_word("every"):
            name = self.name("a node's ID or kind")
            return Every(start, self.last_end(), name) if name else None
        if self.accept_word("from"):
            first = self.event()
            last = self.event() if self.expect_word("to") else None
            return Between(start, self.last_end(), first, last)
        if self.accept_word("sum"):
            paths: list[Path] = []
            if not self.expect_word("of"):
                return None
            while path := self.path("a node"):
                paths.append(path)
                if not self.accept(","):
                    break
            return Sum(start, self.last_end(), tuple(paths))
        return self.path("a node")

    def event(self) -> Event | None:
        """Event = ( Path | "mission" ) ( "starts" | "succeeds" | … ) | "when" Cond"""
        start = self.start()
        if self.accept_word("when"):
            condition = self.cond()
            return Event(start, self.last_end(), None, "when", condition)
        path = None if self.accept_word("mission") else self.path("an event: a node and what happens to it")
        if not (self.kind == NAME and self.raw in HAPPENINGS):
            self.expected("starts, succeeds, fails, finishes or halts")
            return None
        happening = self.take().raw
        return Event(start, self.last_end(), path, happening)

    # ---- bounds ----

    def bound(self) -> Bound | None:
        """ "at" "most" Bounded | "at" "least" Bounded | "less" … | "more" … | "between" Simple "and" Simple"""
        start = self.start()
        if self.accept_word("between"):
            lower = self.amount()
            upper = self.amount() if self.expect_word("and") else None
            return Bound(start, self.last_end(), "between", lower, upper)
        relation = None
        if self.kind == NAME and self.kinds[self.index + 1] == NAME:
            relation = RELATIONS.get((self.raw, self.raws[self.index + 1]))
        if relation is None:
            meant = _INSTEAD_OF_BOUNDS.get(self.raw) if self.kind in (NAME, OPERATOR) else None
            if meant is None:
                example = self.raw if self.kind in (QUANTITY, NUMBER) else "30 s"
                note = f"how much is said before the value: `at most {example}`"
                self.expected("a bound: at most, at least, less than, more than or between", (note,))
                return None
            relation = RELATIONS[meant]
            written = " ".join(meant)
            fix = replace_fix(f"Write `{written}`", self.here(), written, safe=True)
            self.complain("syntax-error", self.here(), f"this bound is written `{written}`", (), (fix,))
        else:
            self.advance()
        self.advance()
        value = self.bounded()
        return Bound(start, self.last_end(), relation, value)

    def within(self) -> Bound:
        """Bounded, as the upper bound that `within` and `every` mean"""
        start = self.start()
        value = self.bounded()
        end = self.last_end()
        return Bound(min(start, end), end, "<=", value)

    def bounded(self) -> Bounded | None:
        """Bounded = Simple | Simple "if" Cond { "," Simple "if" Cond } "else" Simple"""
        value = self.amount()
        if value is None or not self.at_word("if"):
            return value
        cases: list[Case] = []
        while self.accept_word("if"):
            cases.append(Case(value, self.cond()))
            if not self.accept(","):
                break
            value = self.amount()
            if value is None:
                return Table(tuple(cases))
            if not self.at_word("if"):
                self.expected("`if` and a condition, or `else` instead of the comma")
                return Table(tuple(cases))
        otherwise = self.amount() if self.expect_word("else") else None
        return Table(tuple(cases), otherwise)

    def amount(self, strings: bool = False) -> Amount | None:
        """Simple = [ "-" ] ( QUANTITY | NUMBER ) | NAME;  with `strings` a STRING too"""
        negative = self.accept("-")
        if self.kind == QUANTITY or self.kind == NUMBER:
            return Amount(self.take(), negative)
        if not negative and (self.kind == NAME or (strings and self.kind == STRING)):
            return Amount(self.take())
        self.expected("a value with its unit: 30 s")
        return None

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
            self.complain("syntax-error", self.here(), "a unit stands without quotes", (), (fix,))
        elif self.kind == STRING:
            self.expected("a unit: s, m/s, %, 1, bool, text, …")
            return None
        elif word not in UNITLESS and not is_unit(word):
            self.report(unknown_unit(self.text, first, end))
        while self.starts[self.index] < end and self.kind != NEWLINE:
            self.advance()
        return Word(NAME, start, self.text[first:end])


_MEANT: Final = {  # by what is read as a node in front of a verb
    "at": "a bound stands behind its verb, `takes at most 3 s`; odds are written `in at least 95 % of runs`",
    "violation": "write `on violation fail`",
}
_A_CLAUSE: Final = "a clause: takes, keeps, in at least, on violation, …"
_A_VERB: Final = "a verb: takes, succeeds, needs, keeps, …"
_INSTEAD_OF_A_NODE: Final = "it is read as a node, for it begins no clause: in at least, while, on violation, goal, …"
_OF_CONDITIONS: Final = frozenset(("needs", "keeps", "never", "leaves"))
_ENDS_CLAUSES: Final = frozenset(("satisfices", "satisfies", "tags", "parameters", "QualityReq", "Quality"))
_INSTEAD_OF_BOUNDS: Final = {
    "<=": ("at", "most"),
    ">=": ("at", "least"),
    "<": ("less", "than"),
    ">": ("more", "than"),
    "under": ("less", "than"),
    "below": ("less", "than"),
    "above": ("more", "than"),
    "within": ("at", "most"),
}
