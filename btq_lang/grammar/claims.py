"""The part of the parser that reads claims: what a node must do, and within which bounds.

Each function is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.catalog.units import dimension_name, parse_unit
from btq_lang.catalog.verbs import VERBS, words
from btq_lang.diagnostics.model import Fix, replace_fix, write_fix
from btq_lang.grammar.clause_slips import clause_slip
from btq_lang.grammar.conditions import COMPARISONS, HEADS, RELATIONS, ConditionParser
from btq_lang.grammar.cursor import shown
from btq_lang.grammar.prose import MODALS, clause_meant, state_meant
from btq_lang.lexer import Lexer
from btq_lang.syntax.scan import number_end
from btq_lang.syntax.tokens import CLOSE, NAME, NEWLINE, NUMBER, OPEN, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import (
    Amount,
    Between,
    Bound,
    Bounded,
    Case,
    Claim,
    Condition,
    Event,
    Every,
    Mission,
    Path,
    Subject,
    Sum,
    Table,
    Word,
    quote,
)
from btq_lang.util.spelling import near
from btq_lang.util.text import Span

VERB_WORDS: Final = frozenset(VERBS)
HAPPENINGS: Final = frozenset(("starts", "succeeds", "fails", "finishes", "halts"))
MAX_CASES: Final = 100  # in one value: each case of a table may be another table


class ClaimParser(ConditionParser):
    """A cursor that can read claims.

    Attributes:
        clause_starts: where the last two clauses begin, in the file.
        title_at: where the title of the last requirement goes, in the file; -1 if it has one.
    """

    def __init__(self, lexer: Lexer) -> None:
        super().__init__(lexer)
        self.clause_starts = -1, -1
        self.title_at = -1

    # ---- mistakes ----

    def expected(self, what: str, notes: tuple[str, ...] = (), fixes: tuple[Fix, ...] = ()) -> None:
        """Report that something else was expected, or a clause in the words of other notations."""
        if self.whole_clause_slip():
            self.recover()
        else:
            super().expected(what, notes, fixes)

    def misspelt(self, span: Span, word: str, likely: str) -> None:
        """Report a misspelt word, or a clause in the words of other notations."""
        if not self.whole_clause_slip():
            super().misspelt(span, word, likely)

    def whole_clause_slip(self) -> bool:
        """Report that the clause is written otherwise, if it is known how."""
        last = len(self.kinds) - 2
        for start in self.clause_starts:  # `succeeds` may be read as a clause before `in 30 s`
            if start < self.starts[0] or last < 0:
                continue  # of another line
            meant = clause_slip(self.text[start : self.starts[last] + len(self.raws[last])])
            if meant is not None and start + meant.length > self.clause_starts[1]:
                self.written_instead(Span(start, start + meant.length), meant.clauses, meant.note)
                return True
        return False

    def written_instead(self, span: Span, clauses: tuple[str, ...], note: str) -> None:
        """Report what is written instead of a clause, if it is known; otherwise only the note."""
        if not clauses:
            self.complain(span, note)
            return
        fixes = [write_fix(clause, span) for clause in clauses if not _OPEN.search(clause)]
        message = " or ".join(f"`{shown(clause)}`" for clause in clauses)
        self.complain(span, f"this clause is written {message}", *fixes, notes=(note,) if note else ())

    # ---- claims ----

    def claim(self) -> Claim | None:
        """Claim = [ Subject ] Verb"""
        start = self.start()
        subject: Subject | None = None
        if not (self.kind == NAME and self.raw in VERB_WORDS):
            subject = self.subject()
        if not (self.kind == NAME and self.raw in VERB_WORDS) and not self.blank_in_path(subject, VERB_WORDS):
            if subject is not None:
                self.no_verb(subject)
            return None
        if isinstance(subject, Path) and subject.names[0].raw in MODALS and len(subject.names) == 1:
            self.verb_in_other_words(self.index - 1, "")
            subject = None
        return self.verb(start, subject)

    def verb(self, start: int, subject: Subject | None) -> Claim:
        """Verb = "takes" Bound | "succeeds" [ "within" Bounded ] | "needs" Cond | …; the verb of a subject"""
        verb = self.take()
        bound: Bound | None = None
        condition: Condition | None = None
        resource: Word | None = None
        per: Path | Word | None = None
        event: Event | None = None
        every = False
        operand = VERBS[verb.raw].operand
        if operand == "duration":
            bound = self.bound()
        elif operand == "deadline":
            if self.accept_word("within"):
                bound = self.within()
            elif self.kind == QUANTITY:
                self.no_within()
        elif operand == "condition":
            if verb.raw == "never" and self.raw in HAPPENINGS and self.kinds[self.index + 1] == NEWLINE:
                self.expected("a condition", (_NEVER_FAILS,))
            elif self.at_word("to") and self.verb_in_other_words(self.index - 1, self.before_verb(subject)):
                self.recover()
            elif not self.signal_last(verb.raw):
                condition = self.cond()
        elif operand == "use":
            bound = self.bound()
            resource = self.plain_name("a signal") if self.expect_word("of", forgotten=self.kind == NAME) else None
        elif operand == "count":
            bound = self.bound()
            per = self.path("a node") if self.accept_word("per") else None
        elif operand == "rate":
            if self.accept_word("every"):
                every = True
                bound = self.within()
                if self.raws[self.index - 1].endswith("Hz") and self.whole_clause_slip():
                    bound = None
            else:
                bound = self.bound()
                if self.kind == NEWLINE:
                    self.expected("`per` and a time", ("a rate is written `runs at least 10 per 1 s`",))
                else:
                    per = self.quantity("a duration: 1 s") if self.expect_word("per") else None
        elif operand == "event":
            event = self.event()
        else:
            bound = self.within() if self.expect_word("within") else None
            event = self.event() if self.expect_word("after", ("of", "from", "since")) else None
        return Claim(start, self.last_end(), subject, verb, bound, condition, resource, per, event, every)

    def every_meant(self) -> bool:
        """Report `all MoveBase`, and read it as `every`."""
        if self.kind != NAME or self.raw not in ("all", "each", "any"):
            return False
        if self.kinds[self.index + 1] != NAME or self.raws[self.index + 1] in VERB_WORDS:
            return False
        fix = replace_fix(f"Replace `{self.raw}` with `every`", self.here(), "every", safe=True)
        self.complain(self.here(), "all nodes of a kind are written `every …`", fix)
        self.advance()
        return True

    def is_verb(self, further: int) -> bool:
        """Whether the word `further` tokens ahead is a verb."""
        index = self.index + further
        return index < len(self.kinds) and self.kinds[index] == NAME and self.raws[index] in VERB_WORDS

    def no_verb(self, subject: Subject) -> None:
        """Report a subject without a verb, or of a misspelt verb that was read as a subject."""
        first = subject.names[0] if isinstance(subject, Path) and len(subject.names) == 1 else None
        if isinstance(subject, Path) and (self.in_other_words(subject) or self.situation(first)):
            self.recover()
        elif isinstance(subject, Path) and self.kind == NAME and self.raw in NO_VERBS:
            self.expected(_A_VERB, (NO_VERBS[self.raw],))
        elif isinstance(subject, Path) and (self.at_word("and") or self.at(",")):
            note = "a clause applies to one node; write it for each, or `sum of A, B` for the time of both"
            self.expected(_A_VERB, (note,))
        elif first is not None and first.raw == "at" and (fixes := self.takes_before(first)):
            self.expected(f"a verb before `at {self.raw}`", (MEANT["at"],), fixes)
        elif first is not None and first.kind == NAME and (noted := MEANT.get(first.raw) or NO_VERBS.get(first.raw)):
            self.expected(f"a verb after `{first.raw}` (takes, succeeds, needs, keeps, …)", (noted,))
        elif first is not None and self.kind == OPERATOR and self.raw in COMPARISONS and self.whole_clause_slip():
            self.recover()
        elif first is not None and self.kind == OPERATOR and self.raw in COMPARISONS:
            start = first.start + self.base
            fix = replace_fix("Put `keeps` before it", Span(start, start), "keeps ")
            message = "expected a verb before the condition: `keeps`, `never`, `needs` or `leaves`"
            notes = ("`keeps` holds while the node runs, `needs` when it starts, `leaves` when it has succeeded",)
            self.complain(Span(start, self.here().end), message, fix, notes=notes)
            self.recover()
        elif self.kind == NAME and (likely := near(self.raw, VERB_WORDS, limit=1)):
            self.misspelt(self.here(), self.raw, likely[0])
            self.recover()
        elif not isinstance(subject, Path):
            self.expected(_A_VERB)
        elif len(subject.names) == 1 and (likely := near(subject.names[0].raw, VERB_WORDS | HEADS, limit=1)):
            self.misspelt(subject.span.shifted(self.base), subject.names[0].raw, likely[0])
            self.recover()
        else:
            name = "/".join(word.raw for word in subject.names)
            note = (
                f"btq reads `{shown(name)}` as the subject of a clause; write a verb after it, or begin with a "
                "clause word: in at least, while, on violation, goal, …"
            )
            if subject.names[0].kind == STRING:
                note = "a requirement has one title, after its name; reasons are written `because …`"
            elif self.kind == NAME and self.raw in MEANT:
                note = MEANT[self.raw]
            elif self.kind == STRING:
                note = 'a quality goes after `:` and a title in quotes: QualityReq ID : quality "title"'
            self.expected(f"a verb after `{shown(name)}` (takes, succeeds, needs, keeps, …)", (note,))

    def in_other_words(self, subject: Path) -> bool:
        """Report `must take at most 30 s`, `Go should be reached within 30 s` and `speed must stay below 1 m/s`."""
        word = subject.names[0]
        is_word = len(subject.names) == 1 and word.kind == NAME
        if is_word and self.verb_in_other_words(self.index - 1, ""):
            return True
        if self.verb_in_other_words(self.index, self.before_verb(subject)):
            return True
        state = state_meant(self.raws, self.index) if is_word else None
        if state is not None:
            self.written_as(self.index - 1, state[0], "", f"keeps {word.raw} {state[1]}")
        return state is not None

    def before_verb(self, subject: Subject | None) -> str:
        """The text of a subject that is a path."""
        if not isinstance(subject, Path):
            return ""
        return self.text[subject.span.start + self.base : subject.span.end + self.base]

    def verb_in_other_words(self, begin: int, subject: str) -> bool:
        """Report `must take`, which begins at a token after the subject."""
        times = [is_time(raw) for kind, raw in zip(self.kinds, self.raws, strict=True) if kind == QUANTITY]
        meant = clause_meant(self.raws, begin, is_time=bool(times) and all(times))
        if meant is not None:
            end, verb = meant
            is_verb = not verb  # after a word like `must`
            self.written_as(begin, end + is_verb, subject, verb or self.raws[end])
        return meant is not None

    def written_as(self, begin: int, end: int, subject: str, words: str) -> None:
        """Report that the words between two tokens, after a subject, are others here."""
        span = Span(self.starts[begin], self.starts[end - 1] + len(self.raws[end - 1]))
        tail = self.text[span.end : self.starts[-1]].strip()
        whole = " ".join(part for part in (subject, words, tail) if part)
        self.complain(span, f"this clause is written `{shown(whole)}`", write_fix(words, span))

    def next_head(self) -> int:
        """The next token that begins another clause, or ends the line or the brackets."""
        end = self.index
        depth = 0
        while self.kinds[end] != NEWLINE and not (self.kinds[end] == NAME and self.raws[end] in HEADS):
            depth += (self.kinds[end] == OPEN) - (self.kinds[end] == CLOSE)
            if depth < 0:
                break
            end += 1
        return end

    def situation(self, first: Word | None) -> bool:
        """Report `unless humans_near`, with the condition that is written there."""
        if first is None or first.kind != NAME or first.raw not in ("unless", "if") or self.kind == NEWLINE:
            return False
        end = self.next_head()
        if end == self.index:
            return False
        condition = self.text[self.here().start : self.starts[end - 1] + len(self.raws[end - 1])]
        span = Span(first.start + self.base, self.here().start + len(condition))
        if first.raw == "if":
            note = f"to limit a clause to a situation, write `while {condition}` or `when {condition}`"
            self.complain(span, "a clause has no `if`", notes=(note,))
            return True
        joined = any(word in ("and", "or") for word in self.raws[self.index : end])
        written = f"while not ({condition})" if joined else f"while not {condition}"
        self.complain(span, f"this clause is written `{shown(written)}`", write_fix(written, span))
        return True

    def blank_in_path(self, path: Subject | None, follow: frozenset[str]) -> bool:
        """Report `Inspect Dock succeeds`, where a path is written `Inspect/Dock`, and skip the rest."""
        index = self.index
        while self.kinds[index] in (NAME, STRING) and not (self.kinds[index] == NAME and self.raws[index] in follow):
            index += 1
        names = self.raws[self.index : index]
        is_path = isinstance(path, Path) and path.names[0].raw not in MEANT and NO_VERBS.keys().isdisjoint(names)
        if not names or not is_path or _NO_NAMES.intersection(names) or self.raws[index] not in follow:
            return False
        if self.whole_clause_slip():
            return False
        start = path.span.start + self.base if isinstance(path, Path) else 0
        end = self.starts[index - 1] + len(self.raws[index - 1])
        written = "/".join((self.text[start : self.last_end() + self.base], *names))
        message = f"a path is written with `/`: `{shown(written)}`"
        note = f"a name of several words goes in quotes: {quote(self.text[start:end])}"
        self.complain(Span(start, end), message, write_fix(written, Span(start, end)), notes=(note,))
        self.go_to(index)
        return True

    def no_within(self) -> None:
        """Report `succeeds 30 s` and `succeeds 98 %`."""
        is_deadline = is_time(self.raw)
        note = "a deadline is written `within 30 s`, a probability `in at least 98 % of runs`"
        self.expected("`within`, or the end of the line", (note,), (self.put_before("within"),) if is_deadline else ())

    def signal_last(self, verb: str) -> bool:
        """Report `leaves at least 3 % battery`, whose signal goes first."""
        bound = self.bound_ahead() if self.kind == NAME else None
        length, relation = bound or (0, ("at", "least"))
        value = self.index + length
        if self.kinds[value] not in (QUANTITY, NUMBER):
            return False
        signal = value + (2 if self.raws[value + 1] == "of" else 1)
        if self.kinds[signal] != NAME or self.raws[signal] in _NO_NAMES:
            return False
        meant = f"{self.raws[signal]} {RELATIONS[relation]} {self.raws[value]}"
        span = Span(self.here().start, self.starts[signal] + len(self.raws[signal]))
        fixes = (write_fix(meant, span),) if bound else ()
        self.expected("a condition, which begins with its signal", (f"write `{verb} {meant}`",), fixes)
        return True

    def takes_before(self, first: Word) -> tuple[Fix, ...]:
        """The fix for `at most 30 s`, which lacks its verb."""
        value = self.index + 1
        is_bound = ("at", self.raw) in RELATIONS and self.kinds[value] == QUANTITY and is_time(self.raws[value])
        start = first.start + self.base
        return (replace_fix("Put `takes` before it", Span(start, start), "takes "),) if is_bound else ()

    def subject(self) -> Subject | None:
        """Subject = Path | "mission" | "every" Name | "from" Event "to" Event | "sum" "of" Path { "," Path }"""
        start = self.start()
        if self.accept_word("mission"):
            return Mission(start, self.last_end())
        if self.accept_word("every") or self.every_meant():
            name = self.name("a node's ID or kind")
            return Every(start, self.last_end(), name) if name else None
        if self.accept_word("from"):
            first = self.event()
            last = self.event() if self.expect_word("to") else None
            return Between(start, self.last_end(), first, last)
        if self.accept_word("sum"):
            if not self.expect_word("of"):
                return None
            paths = self.listed(lambda: self.path("a node"), lambda: self.accept_and() or self.accept(","))
            return Sum(start, self.last_end(), paths)
        return self.path("a node")

    def event(self) -> Event | None:
        """Event = ( Path | "mission" ) ( "starts" | "succeeds" | … ) | "when" Cond"""
        start = self.start()
        if self.accept_word("when"):
            condition = self.cond()
            return Event(start, self.last_end(), None, "when", condition)
        path = None if self.accept_word("mission") else self.path("an event: a node and what happens to it")
        if not (self.kind == NAME and self.raw in HAPPENINGS) and not self.blank_in_path(path, HAPPENINGS):
            note = "an event is a node and what happens to it: `Pick starts`, `Place succeeds`"
            self.expected("starts, succeeds, fails, finishes or halts", (note,), self.replaced_by(HAPPENINGS))
            return None
        happening = self.take().raw
        return Event(start, self.last_end(), path, happening)

    # ---- bounds ----

    def bound(self) -> Bound | None:
        """ "at" "most" Bounded | "at" "least" Bounded | "less" … | "more" … | "between" Simple "and" Simple"""
        self.skip_sign(":")
        start = self.start()
        if self.accept_word("between"):
            lower = self.simple()
            upper = self.simple() if self.expect_word("and") else None
            return Bound(start, self.last_end(), "between", lower, upper)
        relation = self.relation()
        if relation is None:
            self.no_relation()
            return None
        value = self.bounded()
        return Bound(start, self.last_end(), relation, value)

    def relation(self) -> str | None:
        """ "at" "most" | "at" "least" | "less" "than" | "more" "than"; other words for it are reported"""
        bound = self.bound_ahead() if self.kind == NAME or self.kind == OPERATOR else None
        if bound is None:
            return None
        length, meant = bound
        if tuple(self.raws[self.index : self.index + length]) != meant:
            self.written_otherwise("this bound", length, " ".join(meant))
        self.go_to(self.index + length)
        return RELATIONS[meant]

    def no_relation(self) -> None:
        """Report a bound without its first words."""
        is_value = self.kind in (QUANTITY, NUMBER)
        note = f"write the kind of bound before the value: `at most {self.raw if is_value else '30 s'}`"
        fixes: tuple[Fix, ...] = ()
        if is_value and self.raws[self.index + 1] in ("-", "to"):
            note = "a range is written `between 10 s and 20 s`"
        elif self.kind == QUANTITY and self.raws[self.index - 1] in _OF_DURATIONS:
            fixes = (self.put_before("at most"),)
        self.expected("a bound: at most, at least, less than, more than or between", (note,), fixes)

    def within(self) -> Bound:
        """Bounded, as the upper bound after `within` and `every`"""
        start = self.start()
        value = self.bounded()
        end = self.last_end()
        return Bound(min(start, end), end, "<=", value)

    def bounded(self) -> Bounded | None:
        """Bounded = Simple | Simple "if" Cond { "," Simple "if" Cond } "else" Simple"""
        if self.at_word("if") or (
            "?" in self.raws[self.index :] and self.raws.index("?", self.index) < self.next_head()
        ):
            return self.choice_in_other_words()
        value = self.simple()
        if value is None or not self.at_word("if"):
            return value
        cases: list[Case] = []
        while self.accept_word("if"):
            cases.append(Case(value, self.cond()))
            if not self.accept(","):
                break
            if len(cases) == MAX_CASES:
                note = "compute the value in a node, and declare a signal for its output"
                self.complain(
                    self.here(), f"more than {MAX_CASES} cases in one value", notes=(note,), rule="nested-too-deep"
                )
                self.recover()
                return Table(tuple(cases))
            value = self.simple()
            if value is None:
                return Table(tuple(cases))
            if not self.at_word("if"):
                self.expected("`if` and a condition, or `else` instead of the comma")
                return Table(tuple(cases))
        otherwise = self.simple() if self.expect_word("else") else None
        return Table(tuple(cases), otherwise)

    def choice_in_other_words(self) -> Amount | None:
        """Report `low ? 60 s : 30 s`, as in C++, and `if low then 60 s else 30 s`; the first of the values."""
        begin, raws = self.index, self.raws
        has_if = self.at_word("if")
        middle, last = ("then", "else") if has_if else ("?", ":")
        first = raws.index(middle, begin) if middle in raws[begin:] else begin
        second = self.end_of_simple(first + 1)
        third = self.end_of_simple(second + 1) if raws[second] == last else second
        condition, note = self.between(begin + has_if, first), f"a choice is written `{_A_CHOICE}`"
        if not condition or third <= second + 1:
            self.expected("a value", (note,))
            return None
        span = Span(self.here().start, self.starts[third - 1] + len(raws[third - 1]))
        written = f"{self.between(first + 1, second)} if {condition} else {self.between(second + 1, third)}"
        self.complain(span, f"a choice is written `{shown(written)}`", write_fix(written, span))
        self.go_to(first + 1)
        value = self.simple()
        self.go_to(third)
        return value

    def end_of_simple(self, index: int) -> int:
        """The token after the value that begins at a token; the same token if none does."""
        begin = index + (self.raws[index : index + 1] == ["-"])
        is_value = begin < len(self.kinds) and self.kinds[begin] in (QUANTITY, NUMBER, NAME)
        return begin + 1 if is_value else min(index, len(self.kinds) - 1)

    def between(self, begin: int, end: int) -> str:
        """The text of some tokens."""
        return self.text[self.starts[begin] : self.starts[end - 1] + len(self.raws[end - 1])] if begin < end else ""

    def simple(self, strings: bool = False) -> Amount | None:
        """Simple = [ "-" ] ( QUANTITY | NUMBER ) | NAME;  with `strings` a STRING too"""
        self.skip_sign(":")
        negative = self.accept("-")
        if self.kind == QUANTITY or self.kind == NUMBER:
            return Amount(self.take(), negative)
        if not negative and (self.kind == NAME or (strings and self.kind == STRING)):
            return Amount(self.take())
        self.expected("a value with its unit: 30 s")
        return None


def is_time(raw: str) -> bool:
    """Whether a quantity is a time: `30 s`."""
    unit = parse_unit(raw[number_end(raw, 0) :].strip())
    return unit is not None and dimension_name(unit) == "time"


QUALITY_IN_HEAD: Final = "a requirement's quality goes after its name: `QualityReq fast : reliability`"
NO_VERBS: Final = {  # what else people write before or as a verb
    **dict.fromkeys(MODALS, "a clause begins with its verb, without such a word: `takes at most 30 s`"),
    **dict.fromkeys(("finishes", "ends", "completes"), "write `succeeds within 30 s`, or `takes at most 30 s`"),
    "fails": "`tries at most 3` limits the attempts, `succeeds` demands that the node does not fail",
    **dict.fromkeys(("stays", "remains", "is"), "what holds while a node runs is written `keeps battery >= 15 %`"),
}
MEANT: Final = {  # by the word that is read as a node before a verb
    "at": "a bound goes after its verb, `takes at most 3 s`; a probability is written `in at least 95 % of runs`",
    **dict.fromkeys(("violation", "otherwise"), "write `on violation fail`"),
    **dict.fromkeys(("max", "maximum"), "an upper bound goes after its verb: `takes at most 30 s`"),
    **dict.fromkeys(("min", "minimum"), "a lower bound goes after its verb: `takes at least 1 s`"),
    "within": "write `succeeds within 30 s`, or `takes at most 30 s`",
    "if": "to limit a clause to a situation, add `while humans_near` or `when fragile`",
    "unless": "write `while not humans_near`",
    "after": "write `follows Look succeeds`, or `starts within 2 s after Look succeeds`",
    "before": "write `from Pick starts to Place succeeds takes at most 45 s`, or `Place follows Pick succeeds`",
    "between": "a range is written `keeps 0 N <= force <= 3 N`",
    "always": "write `keeps battery >= 15 %`",
    "not": "write `never lamp_on`, or `keeps not lamp_on`",
    "quality": QUALITY_IN_HEAD,
    **dict.fromkeys(
        ("title", "description", "text"), 'a requirement has one title, after its name: `QualityReq fast "in time"`'
    ),
}
_NO_NAMES: Final = HEADS | {"and", "or", "not", "if", "else", "is", "to", "of", "by", "per", "at", "within", "after"}
_OPEN: Final = re.compile("<[a-z]+>")  # what is left to choose in a clause
_A_CHOICE: Final = "60 s if battery_low else 30 s"
_A_VERB: Final = "a verb: takes, succeeds, needs, keeps, …"
_NEVER_FAILS: Final = (
    "write `succeeds` for a node that must not fail, or `never node Dock` for a node that must not run"
)
_OF_DURATIONS: Final = words(operands=("duration",))
