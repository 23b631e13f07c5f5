"""The cursor: the position of a parse in its logical line, with the moves and reports that productions consist of.

One invariant: no move goes beyond the NEWLINE that ends the line, so a production may look ahead without checking for
the end.  One mistake gives one diagnostic: a second one on the same physical line is dropped, and so is one where the
lexer has reported a mistake.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable
from typing import Final, TypeVar

from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix, write_fix
from btq_lang.lexer import Lexer
from btq_lang.syntax.composed_times import composed_time
from btq_lang.syntax.scan import line_end, line_start, number_end, unit_run
from btq_lang.syntax.suggestions import close_string, unknown_unit
from btq_lang.syntax.tokens import BRACED, CLOSE, NAME, NEWLINE, NODE_CLAUSES, NUMBER, OPEN, OPERATOR, QUANTITY, STRING
from btq_lang.syntax.tree import Word
from btq_lang.util.spelling import near
from btq_lang.util.text import Span

T = TypeVar("T")


class Cursor:
    """A place in a logical line.

    Attributes:
        base: where the open item begins; the offsets of the tree count from there.
        kind, raw: the current token.
        index: its index in `kinds`, `starts` and `raws`, the lexer's lists for this line.
        problems: what is wrong, counted from the start of the file.
        inside_out: from here on strings are read as code and code as strings, because a quote is missing.
        known: how many problems the lexer had before this logical line.
        group: how many brackets are open around the current token.
        more: another line is open (the lexer is at its first character) but not yet scanned.
        report_slip: reports that a clause is in the words of other notations, if it is; returns whether it is.
        nesting: how many conditions are open, nested in brackets.
        operators: how many operators the outermost condition has so far.
        clause_starts: where the last two clauses begin, in the file.
        title_at: where the title of the last requirement goes, in the file; -1 if it has one.
        bare_until: the end of the last line `key = value` without brackets.
        in_scenario: the line is in the block of a scenario, whose conditions may read entries.
    """

    def __init__(self, lexer: Lexer, report_slip: Callable[[Cursor], bool]) -> None:
        text = lexer.text
        self.text: Final = text
        self.lexer: Final = lexer
        self.base = 0
        self.kinds: list[int] = [NEWLINE]
        self.starts: list[int] = [0]
        self.raws: list[str] = [""]
        self.index = 0
        self.kind = NEWLINE
        self.raw = ""
        self.more = False
        self.group = 0
        self.problems: list[Diagnostic] = []
        self.inside_out = len(text) + 1
        self._silent_from = self._silent_to = -1  # the last physical line with a diagnostic
        self.known = 0
        self._line_start = 0  # of the logical line
        self._lexer_mistakes: list[int] | None = None  # the mistakes that the lexer found in it
        self._in_wake = self._would_complain = False  # the line follows brackets that ended early; it has a mistake
        self._ends_early = False  # it ends brackets early itself
        self._unclosed = len(text)  # the first of its brackets that is not closed
        self.report_slip: Final = report_slip
        self.nesting = 0
        self.operators = 0
        self.clause_starts = -1, -1
        self.title_at = -1
        self.bare_until = -1
        self.in_scenario = False
        self._listing = -1, False  # a line with lists in clauses, and whether its commas separate requirements

    # ---- lines ----

    def scan(self) -> None:
        """Tokenize the open line and go to its first token."""
        lexer = self.lexer
        # The line after one that ends its brackets early is probably the rest of the brackets, and so are further
        # lines; the missing `)` has already been reported.
        wakes = self._would_complain if self._in_wake else self._ends_early
        self._in_wake = wakes and not self.text[self._line_end() : lexer.line_start].strip()
        self._would_complain = False
        self.known = len(lexer.problems)
        self._line_start = lexer.line_start
        lexer.scan()
        self._ends_early = lexer.ends_early
        self.kinds, self.starts, self.raws = lexer.kinds, lexer.starts, lexer.raws
        self.index = 0
        self.kind = self.kinds[0]
        self.raw = self.raws[0]
        self._lexer_mistakes = None

    def is_in_wake(self) -> bool:
        """Whether a mistake on the line just read may hide one on the next."""
        return self._in_wake or self._ends_early

    def _line_end(self) -> int:
        return self.starts[-1] + len(self.raws[-1])

    def end_line(self, notes: tuple[str, ...] = (), fixes: tuple[Fix, ...] = ()) -> int:
        """NL: report what is left of the line and open the next one; returns where this one's last token ends."""
        if self.kind != NEWLINE:
            self.skip_last_sign()
        if self.kind != NEWLINE:
            self.no_end(notes, fixes)
        last = len(self.kinds) - 2
        end = self.starts[last] + len(self.raws[last]) if last >= 0 else self.starts[0]
        self.more = self.lexer.open_line()
        return end - self.base

    def no_end(self, notes: tuple[str, ...], fixes: tuple[Fix, ...]) -> None:
        """Report what is left of the line."""
        if not notes and self.at_name() and self.index > 0 and self.kinds[self.index - 1] == NAME:
            notes = (QUOTES,)
        if not notes and self.at(".") and self.kinds[self.index + 1] == NAME and self.adjacent(self.index + 1):
            notes = ("a name that contains a point goes in quotes",)
        self.expected("the end of the line", notes, fixes)

    def skip_sign(self, *signs: str) -> None:
        """Report and skip a sign that other languages have after a word: `on violation: fail`."""
        if self.kind == OPERATOR and self.raw in signs:
            sign = self.here()
            is_apart = self.text[sign.start - 1] in " \t" and self.text[sign.end : sign.end + 1] in (" ", "\t")
            fix = replace_fix(f"Remove `{self.raw}`", Span(sign.start, sign.end + is_apart), "", safe=True)
            self.complain(sign, f"unexpected `{self.raw}`", fix)
            self.advance()

    def skip_glued_colon(self) -> None:
        """Report and skip a `:` directly after a word that takes none: `QualityReq: rq1`."""
        if self.at(":") and self.adjacent(self.index):
            self.skip_sign(":")

    def skip_last_sign(self) -> None:
        """Report and skip a `:` or `.` at the end of a line."""
        if self.kinds[self.index + 1 :] == [NEWLINE]:
            self.skip_sign(":", ".")

    def deeper(self, level: int) -> bool:
        """Whether the open line is in a block below `level`."""
        return self.more and self.lexer.level > level

    def skip_block(self, level: int) -> None:
        """Skip all lines deeper than `level`, without reporting what the lexer finds in them."""
        while self.deeper(level):
            count = len(self.lexer.problems)
            self.lexer.scan()
            del self.lexer.problems[count:]
            self.more = self.lexer.open_line()

    # ---- moves ----

    def advance(self) -> None:
        if self.kind != NEWLINE:
            self.index += 1
            self.kind = self.kinds[self.index]
            self.raw = self.raws[self.index]

    def go_to(self, index: int) -> None:
        self.index = index
        self.kind = self.kinds[index]
        self.raw = self.raws[index]

    def take(self) -> Word:
        """Return the current token as a word and go to the next."""
        index = self.index
        word = Word(self.kind, self.starts[index] - self.base, self.raw)
        if self.kind != NEWLINE:
            self.index = index + 1
            self.kind = self.kinds[index + 1]
            self.raw = self.raws[index + 1]
        return word

    def at_key(self) -> bool:
        """Whether the next tokens are `key =`."""
        return (self.kind == NAME or self.kind == STRING) and self.raws[self.index + 1] == "="

    def at(self, operator: str) -> bool:
        return self.kind == OPERATOR and self.raw == operator

    def at_word(self, word: str) -> bool:
        return self.kind == NAME and self.raw == word

    def at_name(self) -> bool:
        return self.kind == NAME or self.kind == STRING

    def is_word(self, index: int, word: str) -> bool:
        return self.kinds[index] == NAME and self.raws[index] == word

    def is_operator(self, index: int, operator: str) -> bool:
        return self.kinds[index] == OPERATOR and self.raws[index] == operator

    def accept(self, operator: str) -> bool:
        if self.kind == OPERATOR and self.raw == operator:
            self.advance()
            return True
        return False

    def accept_and(self) -> bool:
        """Report and skip `and` where a comma separates."""
        if not self.at_word("and"):
            return False
        fix = write_fix(",", Span(self.last_end() + self.base, self.here().end), safe=True)
        self.complain(self.here(), "expected `,` instead of `and`", fix)
        self.advance()
        return True

    def accept_word(self, word: str) -> bool:
        if self.kind == NAME and self.raw == word:
            self.advance()
            return True
        return False

    def expect(self, operator: str, further: str = "") -> bool:
        """Skip the operator or report that it is missing; `further`: the end of that message."""
        if self.accept(operator):
            return True
        fixes: tuple[Fix, ...] = ()
        if operator == ":" and (self.at("=") or self.at_word("in") or self.at_word("is")):
            fixes = (write_fix(":", self.here()),)
        self.expected(f"`{operator}`{further}", (), fixes)
        return False

    def expect_word(self, word: str, instead: tuple[str, ...] = (), forgotten: bool = False) -> bool:
        """Skip the word or report that it is missing; `instead`: common mistakes for it; `forgotten`: the current token
        may follow it.
        """
        if self.accept_word(word):
            return True
        fixes: tuple[Fix, ...] = ()
        if self.kind == NAME and self.raw in instead:
            fixes = (replace_fix(f"Replace `{self.raw}` with `{word}`", self.here(), word),)
        elif forgotten:
            fixes = (self.put_before(word),)
        self.expected(f"`{word}`", (), fixes)
        return False

    def name(self, what: str) -> Word | None:
        """Name = NAME | STRING"""
        if self.kind == NAME or self.kind == STRING:
            return self.take()
        return self.missing_word(what)

    def plain_name(self, what: str) -> Word | None:
        """NAME"""
        return self.take() if self.kind == NAME else self.missing_word(what)

    def quantity(self, what: str) -> Word | None:
        """QUANTITY"""
        return self.take() if self.kind == QUANTITY else self.missing_word(what)

    def missing_word(self, what: str) -> Word | None:
        """Report that a word is missing; returns None."""
        self.expected(what)
        return None

    def listed(
        self, element: Callable[[Cursor], T | None], goes_on: Callable[[Cursor], bool] | None = None
    ) -> tuple[T, ...]:
        """Element { "," Element }; `goes_on`: skips what separates them, if another follows"""
        elements: list[T] = []
        while (value := element(self)) is not None:
            elements.append(value)
            if not (goes_on(self) if goes_on is not None else self.accept(",")):
                break
        return tuple(elements)

    def lists_requirements(self) -> bool:
        """Whether a comma separates requirements here: in brackets, and on a line on which `satisfies` precedes the
        first list of a clause.
        """
        if self._listing[0] != self._line_start:
            self._listing = self._line_start, not NODE_CLAUSES.isdisjoint(self.raws[: self.index])
        return self.group > 0 or self._listing[1]

    # ---- places ----

    def start(self) -> int:
        """The start of the current token, relative to the item."""
        return self.starts[self.index] - self.base

    def last_end(self) -> int:
        """The end of the previous token, relative to the item."""
        before = self.index - 1
        return self.starts[before] + len(self.raws[before]) - self.base if before >= 0 else self.start()

    def adjacent(self, index: int) -> bool:
        """Whether the token at `index` directly follows the previous one."""
        before = index - 1
        return self.starts[before] + len(self.raws[before]) == self.starts[index]

    # ---- complaints ----

    def here(self) -> Span:
        """The span of the current token in the file; at the end of the line, the place after its last token."""
        if self.kind == NEWLINE:
            start = self.last_end() + self.base
            return Span(start, start)
        start = self.starts[self.index]
        return Span(start, start + len(self.raw))

    def found(self) -> str:
        """The current token, as a message names it."""
        if self.kind == NEWLINE:
            return "the end of the line"
        if self.kind == CLOSE and not self.raw:
            return "the end of the brackets"
        return f"`{shown(self.raw)}`"

    def expected(self, what: str, notes: tuple[str, ...] = (), fixes: tuple[Fix, ...] = ()) -> None:
        """Report that something else was expected, or a clause in the words of other notations; skip to the end of the
        attribute in brackets, or of the line.
        """
        if self.report_slip(self):
            self.recover()
            return
        cause = (
            self.lost_quote()
            or self.time_of_parts()
            or self.wrong_unit()
            or self.decimal_comma()
            or self.leading_point()
        )
        if cause is not None:
            self.report(cause)
        else:
            self.complain(self.here(), f"expected {what}, found {self.found()}", *fixes, notes=notes)
        self.recover()

    def lost_quote(self) -> Diagnostic | None:
        """A diagnostic if the current token is unexpected because the string before it lacks its closing quote, and
        ends at the quote that should begin another string on a later line.
        """
        before = self.index - 1
        if before < 0 or self.kinds[before] != STRING or self.kind in (NEWLINE, CLOSE):
            return None
        start, raw = self.starts[before], self.raws[before]
        end = line_end(self.text, start)
        if end >= start + len(raw):
            return None
        opens = raw[-2] in " \t=(," and raw[line_start(raw, 0, len(raw)) : -1].strip()
        if not (opens or self.adjacent(self.index)):
            return None
        message = f"a closing {raw[0]} is probably missing: this string ends at the next one, on another line"
        quote = start + len(raw) - 1
        related = (Related(Place(Span(quote, quote + 1)), "the string ends here"),)
        return Diagnostic("unclosed-string", Span(start, end), message, related, (), (close_string(self.text, start),))

    def wrong_unit(self) -> Diagnostic | None:
        """A diagnostic for what is probably meant as a unit: the word after a number, or what follows `30 m/`."""
        if self.index == 0:
            return None
        before = self.kinds[self.index - 1]
        start = self.starts[self.index - 1]
        offset = self.starts[self.index]
        if before == NUMBER and self.kind == NAME and line_end(self.text, start) > offset:
            problem = unknown_unit(self.text, offset, max(unit_run(self.text, offset), offset + len(self.raw)))
            return problem if problem.fixes else None
        if before == QUANTITY and (self.at("/") or self.at("*")) and self.adjacent(self.index):
            unit = number_end(self.text, start)
            unit += len(self.text[unit:offset]) - len(self.text[unit:offset].lstrip())
            end = unit_run(self.text, unit)
            return unknown_unit(self.text, unit, end) if end > offset else None
        return None

    def time_of_parts(self) -> Diagnostic | None:
        """A diagnostic for a time of several numbers, the first of which has been read: `3:30 min`, `1 h 30 min`."""
        is_after = self.index > 0 and self.kinds[self.index - 1] in (NUMBER, QUANTITY)
        return composed_time(self.text, self.starts[self.index - 1]) if is_after else None

    def decimal_comma(self) -> Diagnostic | None:
        """A diagnostic for a comma in a number: `0,5 m/s`."""
        comma = self.index if self.at(",") else self.index - 1
        following = comma + 1
        if comma < 1 or self.raws[comma] != "," or self.kinds[comma - 1] != NUMBER:
            return None
        glued = self.adjacent(comma) and self.adjacent(following)
        if not glued or self.kinds[following] not in (NUMBER, QUANTITY):
            return None
        place = Span(self.starts[comma], self.starts[following])
        fixes = [replace_fix("Write a decimal point", place, ".")]
        if number_end(self.text, self.starts[following]) - self.starts[following] == 3:  # perhaps a thousands separator
            fixes.append(replace_fix("Remove the comma", place, ""))
        message = "a decimal number is written with a point"
        return Diagnostic("syntax-error", place, message, fixes=tuple(fixes))

    def leading_point(self) -> Diagnostic | None:
        """A diagnostic for a number without its first digit: `.5 m/s`."""
        following = self.index + 1
        if not self.at(".") or not self.adjacent(following) or self.kinds[following] not in (NUMBER, QUANTITY):
            return None
        start = self.here().start
        fix = replace_fix("Put `0` before it", Span(start, start), "0", safe=True)
        return Diagnostic("syntax-error", self.here(), "a number begins with a digit", fixes=(fix,))

    def replaced_by(self, words: Iterable[str]) -> tuple[Fix, ...]:
        """The fix if the current word is a misspelling of one of `words`; else none."""
        meant = near(self.raw, words, limit=1) if self.kind == NAME else ()
        return tuple(replace_fix(f"Replace `{self.raw}` with `{word}`", self.here(), word) for word in meant)

    def put_before(self, words: str) -> Fix:
        """The fix that puts words before the current one."""
        start = self.here().start
        return replace_fix(f"Put `{words}` before it", Span(start, start), f"{words} ")

    def put_in_quotes(self) -> Fix:
        """The fix that puts quotes around the current word."""
        return replace_fix("Put quotes around it", self.here(), f'"{self.raw}"')

    def misspelt(self, span: Span, word: str, likely: str) -> None:
        """Report a misspelt word, or a clause in the words of other notations."""
        if self.report_slip(self):
            return
        fix = replace_fix(f"Replace `{word}` with `{likely}`", span, likely)
        self.complain(span, f"unknown word `{word}`; did you mean `{likely}`?", fix)

    def complain(
        self, span: Span, message: str, *fixes: Fix, notes: tuple[str, ...] = (), rule: str = "syntax-error"
    ) -> None:
        """Report, unless something was already reported on this physical line; `span` counts from the start of the
        file.
        """
        self.report(Diagnostic(rule, span, message, (), notes, fixes))

    def report(self, diagnostic: Diagnostic) -> None:
        """Report, unless something was already reported on this physical line."""
        start = diagnostic.span.start
        if diagnostic.rule == "unclosed-string":
            self.inside_out = min(self.inside_out, start + 1)
        in_line = start <= self._line_end()  # the line tokenized last
        if in_line:
            if self.kinds[0] == NEWLINE:
                return  # the lexer has reported a line without tokens
            self._would_complain = True
            if self._in_wake:
                return
        if self._silent_from <= start <= self._silent_to:
            return
        lower = self._silent_to if 0 <= self._silent_to < start else min(self._line_start, start)
        self._silent_from, self._silent_to = line_start(self.text, lower, start), line_end(self.text, start)
        if not (in_line and self._lexer_complained(start)):
            self.problems.append(diagnostic)

    def _lexer_complained(self, start: int) -> bool:
        """Whether the lexer found a mistake on this physical line, or it is in brackets that the lexer closed
        itself.
        """
        if self._lexer_mistakes is None:
            problems = self.lexer.problems[self.known :]
            self._lexer_mistakes = sorted(problem.span.start for problem in problems if problem.rule in _LEAVING_GAPS)
            unclosed = [problem.span.start for problem in problems if problem.rule == "unclosed-bracket"]
            self._unclosed = min(unclosed, default=len(self.text))
        mistakes = self._lexer_mistakes
        following = bisect_left(mistakes, self._silent_from)
        return start > self._unclosed or (following < len(mistakes) and mistakes[following] <= self._silent_to)

    def complain_instead(self, replaced: list[Diagnostic], diagnostic: Diagnostic) -> bool:
        """Report a mistake instead of what the lexer found in this line; if the lexer's diagnostics have already
        suppressed another one, keep them.

        Returns:
            Whether it was reported.
        """
        problems, first, before = self.lexer.problems, self.known, len(self.problems)
        of_line = problems[first:]  # there may be thousands before it
        problems[first:] = [problem for problem in of_line if problem not in replaced]
        self._lexer_mistakes = None
        self.report(diagnostic)
        is_reported = len(self.problems) > before
        if not is_reported:
            problems[first:] = of_line
            self._lexer_mistakes = None
        return is_reported

    def recover(self) -> None:
        """Skip to the next `key =` or the closing bracket of the current group; outside brackets to the end of the
        line.
        """
        depth = 0
        while self.kind != NEWLINE:
            if self.kind == OPEN:
                depth += 1
            elif self.kind == CLOSE:
                if depth == 0:
                    if self.group:
                        return
                else:
                    depth -= 1
            elif depth == 0 and self.at_name() and self.is_operator(self.index + 1, "=") and self.group:
                return
            self.advance()


def shown(raw: str, most: int = 40) -> str:
    """A piece of the source as a message shows it: its first line, with at most so many characters."""
    line = raw[: line_end(raw, 0)]
    return line if len(line) == len(raw) <= most else f"{line[: most - 3]}…"


QUOTES: Final = "a name of several words goes in quotes"
VALUES: Final = frozenset((STRING, NAME, NUMBER, QUANTITY, BRACED))
# Mistakes reported by the lexer after which the parser misses something.
_LEAVING_GAPS: Final = frozenset(
    ("syntax-error", "unclosed-bracket", "unclosed-string", "unclosed-comment", "misplaced-comment", "unknown-unit")
)
