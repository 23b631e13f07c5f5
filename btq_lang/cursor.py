"""The cursor: where a parse stands in its logical line, and the few moves and complaints every production is made of.

One invariant: no move goes behind the NEWLINE that ends the line, so a production may look at what follows without
asking whether anything does.  One mistake gives one complaint: a second one on the same line of text is not reported.
"""

from __future__ import annotations

from typing import Final

from btq_lang.diagnostics import Diagnostic, Fix
from btq_lang.lexer import Lexer
from btq_lang.syntax import Word
from btq_lang.text import Span
from btq_lang.tokens import BRACED, CLOSE, NAME, NEWLINE, NUMBER, OPEN, OPERATOR, QUANTITY, STRING


class Cursor:
    """A place in a logical line.

    Attributes:
        base: where the open item begins; the offsets of the tree count from there.
        kind, raw: the token at hand.
        index: its index in `kinds`, `starts` and `raws`, the lexer's lists for this line.
        problems: what is wrong, counted from the start of the file.
        group: how many brackets are open around the token at hand.
        more: a further line is open (the lexer stands at its first character), not yet scanned.
    """

    def __init__(self, text: str) -> None:
        self.text: Final = text
        self.lexer: Final = Lexer(text)
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
        self._complained_at = -1

    # ---- lines ----

    def scan(self) -> None:
        """Cut the open line into tokens and stand on the first."""
        lexer = self.lexer
        lexer.scan()
        self.kinds, self.starts, self.raws = lexer.kinds, lexer.starts, lexer.raws
        self.index = 0
        self.kind = self.kinds[0]
        self.raw = self.raws[0]

    def end_line(self) -> int:
        """NL: complain of what is left of the line, open the next one; return where this one's last token ends."""
        if self.kind != NEWLINE:
            self.expected("the end of the line")
        last = len(self.kinds) - 2
        end = self.starts[last] + len(self.raws[last]) if last >= 0 else self.starts[0]
        self.more = self.lexer.open_line()
        return end - self.base

    def deeper(self, level: int) -> bool:
        """Whether the open line stands in a block below `level`."""
        return self.more and self.lexer.level > level

    def skip_block(self, level: int) -> None:
        """Pass over all lines deeper than `level`; what the lexer finds in them is not worth a word."""
        while self.deeper(level):
            known = len(self.lexer.problems)
            self.lexer.scan()
            del self.lexer.problems[known:]
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
        """The token at hand as a word, and on to the next."""
        word = Word(self.kind, self.starts[self.index] - self.base, self.raw)
        self.advance()
        return word

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

    def accept_word(self, word: str) -> bool:
        if self.kind == NAME and self.raw == word:
            self.advance()
            return True
        return False

    def expect(self, operator: str) -> bool:
        if self.accept(operator):
            return True
        self.expected(f"`{operator}`")
        return False

    def expect_word(self, word: str) -> bool:
        if self.accept_word(word):
            return True
        self.expected(f"`{word}`")
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
        """Complain that a word is missing; there is none."""
        self.expected(what)
        return None

    # ---- places ----

    def start(self) -> int:
        """Where the token at hand begins, counted from the item."""
        return self.starts[self.index] - self.base

    def last_end(self) -> int:
        """Where the token before the one at hand ends, counted from the item."""
        before = self.index - 1
        return self.starts[before] + len(self.raws[before]) - self.base if before >= 0 else self.start()

    def adjacent(self, index: int) -> bool:
        """Whether no blank stands before the token at `index`."""
        before = index - 1
        return self.starts[before] + len(self.raws[before]) == self.starts[index]

    # ---- complaints ----

    def here(self) -> Span:
        """The token at hand, counted from the start of the file."""
        at = self.starts[self.index]
        return Span(at, at + len(self.raw))

    def found(self) -> str:
        """The token at hand, as a message names it."""
        if self.kind == NEWLINE:
            return "the end of the line"
        if self.kind == CLOSE and not self.raw:
            return "the end of the brackets"
        shown = self.raw.split("\n", 1)[0]
        return f"`{shown if len(shown) <= 40 else shown[:37] + '…'}`"

    def expected(self, what: str, notes: tuple[str, ...] = (), fixes: tuple[Fix, ...] = ()) -> None:
        """Complain that something else was expected, and pass over what stands here: to the end of the brackets'
        attribute, or to the end of the line."""
        at = self.starts[self.index]
        self.complain(
            "syntax-error", Span(at, at + len(self.raw)), f"expected {what}, found {self.found()}", notes, fixes
        )
        self.recover()

    def complain(
        self, rule: str, span: Span, message: str, notes: tuple[str, ...] = (), fixes: tuple[Fix, ...] = ()
    ) -> None:
        """Report, if nothing was reported on this line of text yet; `span` counts from the start of the file."""
        last = self._complained_at
        if last >= 0 and self._same_line(last, span.start):
            return
        self._complained_at = span.start
        for problem in reversed(self.lexer.problems):
            if problem.span.end < self.starts[0]:
                break
            if problem.rule in _SAID and self._same_line(problem.span.end, span.start):
                return  # the lexer has said what is wrong here
        self.problems.append(Diagnostic(rule, span, message, (), notes, fixes))

    def recover(self) -> None:
        """To the next `key =` or the closing bracket of the group at hand; outside brackets to the end of the line."""
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

    def _same_line(self, first: int, second: int) -> bool:
        return self.text.find("\n", first, second) < 0 and self.text.find("\r", first, second) < 0


VALUES: Final = frozenset((STRING, NAME, NUMBER, QUANTITY, BRACED))
# Mistakes that the lexer reports and that leave something missing for the parser.
_SAID: Final = frozenset(("syntax-error", "unclosed-bracket", "unclosed-string", "misplaced-comment", "unknown-unit"))
