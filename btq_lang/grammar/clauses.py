"""The part of the parser that reads clauses: a claim, or what limits, weighs or explains the claims of a requirement.

Each function is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.verbs import measured
from btq_lang.diagnostics.model import Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.grammar.claims import QUALITY_IN_HEAD, VERB_WORDS, ClaimParser, is_time
from btq_lang.grammar.conditions import HEADS, SUBJECT_HEADS
from btq_lang.syntax.scan import line_end, line_start
from btq_lang.syntax.suggestions import unknown_unit
from btq_lang.syntax.tokens import CLOSE, NAME, NEWLINE, NUMBER, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import (
    Because,
    Clause,
    Confidence,
    Goal,
    How,
    Odds,
    OnViolation,
    ScopeClause,
    Window,
    Word,
    quote,
)
from btq_lang.util.spelling import near
from btq_lang.util.text import Span

EXPERIMENTS: Final = frozenset(("activations", "runs"))
ACTIONS: Final = ("fail", "halt", "warn", "log")
METHODS: Final = ("monitor", "analysis", "test", "review")
ENDS_CLAUSES: Final = frozenset(("satisfices", "satisfies", "tags", "parameters", "QualityReq", "Quality"))


class ClauseParser(ClaimParser):
    """A cursor that can read clauses."""

    def clauses(self, at_least_one: bool = False) -> tuple[Clause, ...]:
        """{ Clause }, to the end of the line or of the brackets"""
        clauses: list[Clause] = []
        while self.kind == NAME or self.kind == STRING:
            following = self.index + 1
            if self.kind == NAME and self.raw in ENDS_CLAUSES and self.raw not in HEADS:
                break
            if self.group and self.is_operator(following, "="):
                break
            self.clause_starts = self.clause_starts[1], self.starts[self.index]
            clause = self.clause()
            if clause is None:
                return tuple(clauses)
            clauses.append(clause)
        if at_least_one and not clauses and self.kind == OPERATOR and self.raw in ("<=", "<", ">=", ">"):
            self.bare_bound()
        elif at_least_one and not clauses:
            self.expected(_A_CLAUSE, (QUALITY_IN_HEAD,) if self.at_word("satisfices") else ())
        return tuple(clauses)

    def clause(self) -> Clause | None:
        """Clause = Claim | Scope | Odds | Confidence | Window | OnViolation | Goal | Because | How"""
        word = self.raw if self.kind == NAME else ""
        if word in VERB_WORDS or word in SUBJECT_HEADS:
            return self.claim()
        if word == "while" or word == "when":
            return self.scope()
        if word == "in" or word == "with":
            return self.odds()
        if word == "confidence":
            return self.confidence()
        if word == "over":
            return self.window()
        if word == "on" or word == "on_violation":
            return self.on_violation()
        if word == "goal":
            return self.goal()
        if word == "because":
            return self.because()
        if word == "verified":
            return self.how()
        if word.lower() in _NOT_IN_BTQ and self.is_other_clause():
            self.other_clause(_NOT_IN_BTQ[word.lower()])
            return None
        if (self.lost_quote() or self.wrong_unit()) and not self.is_verb(1):
            self.expected(_A_CLAUSE)
            return None
        if self.is_no_time():
            start = self.starts[self.index]
            self.report(unknown_unit(self.text, start, start + len(self.raw)))
            self.advance()
            return self.clause() if self.kind == NAME else None
        return self.claim()

    def is_other_clause(self) -> bool:
        """Whether the current word, of other notations, begins a clause of them and is not the subject of one."""
        following = self.index + 1
        if self.kinds[following] == NAME and self.raws[following] in VERB_WORDS:
            return False
        return self.kinds[following] in (NAME, STRING, NUMBER, QUANTITY) or self.raws[following] in (":", "=")

    def other_clause(self, nearest: str) -> None:
        """Report a clause of another notation, with the nearest of this one."""
        word, value = self.here(), self.index + 1 + (self.raws[self.index + 1] in (":", "="))
        fixes: tuple[Fix, ...] = ()
        if nearest == _BECAUSE and self.kinds[value] == STRING:
            fixes = (replace_fix("Write `because`", Span(word.start, self.starts[value]), "because "),)
        elif nearest == _TITLE and self.title_at >= 0 and self.index == 0 and self.kinds[value : value + 2] == _STRING:
            moved = FixEdit(Place(Span(self.title_at, self.title_at)), f" {self.raws[value]}")
            line = Span(line_start(self.text, 0, word.start), self.lexer.position)
            fixes = (Fix("Move it after the name", (moved, FixEdit(Place(line), ""))),)
        elif nearest == _COMMENT and self.index == 0:
            fixes = (replace_fix("Write it as a comment", Span(word.start, word.start), "# "),)
        self.complain(word, f"`{self.raw}` is not in btq; nearest is {nearest}", *fixes)
        self.recover()

    def scope(self) -> ScopeClause:
        """Scope = ( "while" | "when" ) Cond"""
        word = self.take()
        self.skip_sign(":")
        condition = self.cond()
        return ScopeClause(word.start, self.last_end(), word, condition)

    def odds(self) -> Odds:
        """ "in" "at" "least" QUANTITY "of" Experiments | "with" "probability" ( ">=" | ">" ) QUANTITY [ "of" … ]"""
        start = self.start()
        return self.share(start) if self.accept_word("in") else self.probability(start)

    def share(self, start: int) -> Odds:
        """ "at" "least" QUANTITY "of" Experiments"""
        value: Word | None = None
        experiments = None
        if self.kind == QUANTITY:
            if not self.whole_clause_slip():
                message = f"a probability is written `in at least {self.raw}`"
                self.complain(self.here(), message, self.put_before("at least"))
            value = self.take()
        elif self.kind == NUMBER:
            value = self.percentage("at least 98 %", "at least ")
        elif self.expect_word("at") and self.expect_word("least"):
            value = self.percentage("98 %")
        if value is not None and self.expect_word("of", forgotten=self.raw in EXPERIMENTS):
            experiments = self.experiments()
        return Odds(start, self.last_end(), ">=", value, experiments)

    def probability(self, start: int) -> Odds:
        """ "with" "probability" ( ">=" | ">" ) QUANTITY [ "of" Experiments ]"""
        relation = ">="
        value: Word | None = None
        experiments = None
        self.advance()
        if self.kind == QUANTITY:
            value = self.after_missing("probability >=")
        elif self.expect_word("probability"):
            if self.at(">=") or self.at(">"):
                relation = self.raw
                self.advance()
                value = self.percentage("98 %")
            elif self.kind == QUANTITY:
                value = self.after_missing(">=")
            else:
                fixes: tuple[Fix, ...] = ()
                if self.kind == NUMBER and 0 < float(self.raw) <= 1:
                    written = f">= {float(self.raw) * 100:.10g} %"
                    fixes = (write_fix(written, self.here()),)
                self.expected("`>=` or `>` and a percentage", (), fixes)
        if value is not None and self.accept_word("of"):
            experiments = self.experiments()
        return Odds(start, self.last_end(), relation, value, experiments)

    def confidence(self) -> Confidence:
        """ "confidence" QUANTITY"""
        start = self.take().start
        value = self.percentage("95 %")
        return Confidence(start, self.last_end(), value)

    def window(self) -> Window:
        """ "over" "last" ( NUMBER Experiments | QUANTITY )"""
        start = self.take().start
        self.expect_word("last")
        size = experiments = None
        if self.kind == QUANTITY:
            size = self.take()
        elif self.kind == NUMBER:
            size = self.take()
            experiments = self.experiments()
        else:
            self.expected("a number of runs or activations, or a duration")
        return Window(start, self.last_end(), size, experiments)

    def on_violation(self) -> OnViolation:
        """ "on" "violation" ( "fail" | "halt" | "warn" | "log" )"""
        start = self.start()
        if self.at_word("on_violation"):
            fix = write_fix("on violation", self.here(), safe=True)
            self.complain(self.here(), "expected `on violation`, found `on_violation`", fix)
            self.advance()
        else:
            self.advance()
            if not self.accept_word("violation"):
                self.no_violation()
        self.skip_sign("=")
        action = self.one_of(ACTIONS)
        return OnViolation(start, self.last_end(), action)

    def goal(self) -> Goal:
        """ "goal" Bounded"""
        start = self.take().start
        value = self.bounded()
        return Goal(start, self.last_end(), value)

    def because(self) -> Because:
        """ "because" STRING"""
        start = self.take().start
        self.skip_sign(":", "=")
        text = self.take() if self.kind == STRING else None
        if text is None:
            begin = self.here().start
            reason = self.text[begin : line_end(self.text, begin)].partition(" #")[0].rstrip()
            fix = replace_fix("Put quotes around it", Span(begin, begin + len(reason)), quote(reason))
            self.expected("the reason in quotes", (), (fix,) if reason and not self.group else ())
        return Because(start, self.last_end(), text)

    def how(self) -> How:
        """ "verified" "by" ( "monitor" | "analysis" | "test" | "review" )"""
        start = self.take().start
        self.expect_word("by")
        method = self.one_of(METHODS)
        return How(start, self.last_end(), method)

    def experiments(self) -> Word | None:
        """ "activations" | "runs" """
        return self.one_of(("activations", "runs"))

    def percentage(self, example: str, before: str = "") -> Word | None:
        """QUANTITY; `before`: the words that a fix puts before it"""
        fixes: tuple[Fix, ...] = ()
        if self.kind == NUMBER:
            share, span = float(self.raw), self.here()
            percent = f"{share * 100:.10g} %" if 0 < share <= 1 else f"{self.raw} %"
            whole = self.index + 2
            if self.raws[self.index + 1] == "of" and self.kinds[whole] == NUMBER and float(self.raws[whole]) > 0:
                percent = f"{share * 100 / float(self.raws[whole]):.10g} % of"
                span = Span(span.start, self.starts[whole] + len(self.raws[whole]))
            fixes = (write_fix(before + percent, span),)
        if self.kind == QUANTITY:
            return self.take()
        self.expected(f"a percentage: {example}", (), fixes)
        return None

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
        self.complain(self.here(), f"expected {what}, found {self.found()}", *fixes)
        self.advance()
        return None

    def no_violation(self) -> None:
        """Report that `violation` is missing, and skip the word in its place: `on failure fail`."""
        following = self.index + 1
        if self.kind == NAME and self.kinds[following] == NAME and self.raws[following] in ACTIONS:
            fix = replace_fix(f"Replace `{self.raw}` with `violation`", self.here(), "violation")
            self.complain(self.here(), f"expected `violation`, found `{self.raw}`", fix)
            self.advance()
        elif self.kind == NAME and self.raw in ACTIONS:
            self.expect_word("violation", forgotten=True)
        else:
            self.expected("`violation`", (_ON_VIOLATION,))

    def after_missing(self, words: str) -> Word:
        """Read the current percentage; report that `words` are missing before it."""
        message = f"a probability is written `with probability >= {self.raw}`"
        self.complain(self.here(), message, self.put_before(words))
        return self.take()

    def bare_bound(self) -> None:
        """Report `<= 30 s` without a verb."""
        sign, value = self.raw, self.index + 1
        bound = {"<=": "at most", "<": "less than", ">=": "at least", ">": "more than"}.get(sign)
        fixes: tuple[Fix, ...] = ()
        if bound is not None and self.kinds[value] == QUANTITY and is_time(self.raws[value]):
            written = f"takes {bound} {self.raws[value]}"
            span = Span(self.here().start, self.starts[value] + len(self.raws[value]))
            fixes = (write_fix(written, span),)
        self.expected(_A_CLAUSE, ("a bound goes after its verb: `takes at most 30 s`",), fixes)

    def is_no_time(self) -> bool:
        """Whether a number is followed by a word that can only be a wrong unit of time."""
        if self.kind != NAME or self.index == 0 or self.kinds[self.index - 1] != NUMBER:
            return False
        following = self.index + 1
        ends = self.kinds[following] in (NEWLINE, CLOSE) or (
            self.kinds[following] == NAME and self.raws[following] in HEADS
        )
        is_misspelt = near(self.raw, VERB_WORDS | HEADS, limit=1)
        return ends and not is_misspelt and measured(self.raws[: self.index]) == "s"


_STRING: Final = [STRING, NEWLINE]
_ON_VIOLATION: Final = (
    "`on violation` is followed by fail, halt, warn or log; to try again, put a Retry around the node"
)
_OTHER_WORDS: Final = {  # for actions and methods
    **dict.fromkeys(("stop", "abort"), ("halt", "fail")),
    **dict.fromkeys(("alert", "notify", "report"), ("warn", "log")),
    **dict.fromkeys(("inspection", "demonstration"), ("review", "test")),
    **dict.fromkeys(("simulation", "proof", "calculation"), ("analysis", "test")),
}
_A_CLAUSE: Final = "a clause: takes, keeps, in at least, on violation, …"
_BECAUSE: Final = '`because "…"`'
_COMMENT: Final = "a comment `# …`"
_TITLE: Final = 'the title in quotes after the name: `QualityReq fast "in time"`'
# Words with which other notations begin a part of a requirement, each with what is nearest to it.
_NOT_IN_BTQ: Final = {
    **dict.fromkeys(("rationale", "reason", "justification", "motivation", "why"), _BECAUSE),
    **dict.fromkeys(("description", "desc", "title", "text", "summary", "statement", "label"), _TITLE),
    **dict.fromkeys(
        ("status", "state", "owner", "author", "source", "stakeholder", "version", "date", "note", "comment", "doc"),
        _COMMENT,
    ),
    **dict.fromkeys(
        ("priority", "severity", "criticality", "importance", "risk"), "`on violation` with what happens then"
    ),
    **dict.fromkeys(("wish", "desire", "target", "ideal", "optional"), "`goal`, a better bound than the required one"),
    **dict.fromkeys(("verification", "verify", "validation"), "`verified by` with a method"),
    **dict.fromkeys(("precondition", "assumption", "context"), "`while` or `when` with a condition"),
}
