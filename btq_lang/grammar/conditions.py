"""The part of the parser that reads conditions, in contexts and clauses.

Each function is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from btq_lang.diagnostics.model import replace_fix, write_fix
from btq_lang.grammar.cursor import Cursor
from btq_lang.lexer import Lexer
from btq_lang.syntax.tokens import CLOSE, ERROR, NAME, NEWLINE, NUMBER, OPEN, OPERATOR, QUANTITY, STRING, SYMBOL
from btq_lang.syntax.tree import Binary, Call, Comparison, Condition, Negative, NodeRuns, Not, Operand, Path
from btq_lang.util.text import Span

# Words that begin a clause and so end the condition before them.
SUBJECT_HEADS: Final = frozenset(("mission", "every", "from", "sum"))
HEADS: Final = SUBJECT_HEADS.union(
    ("while", "when", "in", "with", "confidence", "over", "on", "goal", "because", "verified")
)
FUNCTIONS: Final = frozenset(("max", "min", "mean", "p95", "stddev", "change", "count"))
_OTHER_FUNCTIONS: Final = {
    **dict.fromkeys(("avg", "average"), "mean"),
    **{"maximum": "max", "minimum": "min", "std": "stddev", "delta": "change", "diff": "change"},
}
COMPARISONS: Final = frozenset(("<=", ">=", "<", ">", "==", "!="))
RELATIONS: Final = {("at", "most"): "<=", ("at", "least"): ">=", ("less", "than"): "<", ("more", "than"): ">"}

MAX_NESTING: Final = 50  # of brackets in one condition
MAX_OPERATORS: Final = 100  # in one condition


class ConditionParser(Cursor):
    """A cursor that can read conditions."""

    def __init__(self, lexer: Lexer) -> None:
        super().__init__(lexer)
        self._nesting = 0  # how many conditions are open, nested in brackets
        self._operators = 0  # how many operators the outermost has so far

    def cond(self) -> Condition | None:
        """Cond = Conj { "or" Conj }"""
        if self._nesting == 0:
            self._operators = 0
        if self._nesting > MAX_NESTING:
            self.too_deep(f"more than {MAX_NESTING} nested brackets")
            return None
        self._nesting += 1
        condition = self.joined(self.conj, "or")
        self._nesting -= 1
        return condition

    def joined(self, operand: Callable[[], Condition | None], *operators: str) -> Condition | None:
        """Operand { Operator Operand }"""
        left = operand()
        while left is not None and (operator := self.accept_one(operators)):
            right = operand()
            if right is None:
                break
            left = self.binary(operator, left, right)
        return left

    def accept_one(self, operators: tuple[str, ...]) -> str:
        """The operator that is here, if it is one of these; else empty"""
        operator = self.raw
        if operator in operators and (self.kind == OPERATOR or self.kind == NAME):
            self.advance()
            return operator
        for word in operators if self.kind == SYMBOL or self.kind == ERROR else ():
            if self.accept_instead(_INSTEAD.get(word, ""), word):
                return word
        return ""

    def accept_instead(self, sign: str, word: str) -> bool:
        """Report an operator of another language, and read it as the word that is meant"""
        if self.kind not in (SYMBOL, ERROR) or self.raw != sign:
            return False
        written = word if word != "not" else "not "
        fix = replace_fix(f"Write `{word}`", self.here(), written, safe=True)
        self.complain(self.here(), f"in conditions `{sign}` is written `{word}`", fix)
        self.advance()
        return True

    def binary(self, operator: str, left: Condition, right: Condition) -> Condition:
        """Join two operands; report too many in one condition, because a chain is a deep tree."""
        self._operators += 1
        if self._operators > MAX_OPERATORS:
            self.too_deep(f"more than {MAX_OPERATORS} operators in one condition")
            return left
        return Binary(left.start, right.end, operator, left, right)

    def too_deep(self, message: str) -> None:
        note = "write a part of it as a context of its own: `context part : …`"
        self.complain(self.here(), message, notes=(note,), rule="nested-too-deep")
        self.recover()

    def conj(self) -> Condition | None:
        """Conj = Neg { "and" Neg }"""
        return self.joined(self.neg, "and")

    def neg(self) -> Condition | None:
        """Neg = [ "not" ] Atom"""
        start = self.start()
        if self.accept_word("not") or self.accept_instead("!", "not"):
            operand = self.atom()
            return Not(start, operand.end, operand) if operand else None
        return self.atom()

    def atom(self) -> Condition | None:
        """Atom = Expr [ Cmp Expr [ Cmp Expr ] ] | "node" Path | "(" Cond ")\""""
        if self.at_word("node") and self.kinds[self.index + 1] in (NAME, STRING) and not self.ends_condition():
            start = self.start()
            self.advance()
            path = self.path("a node")
            return NodeRuns(start, self.last_end(), path) if path else None
        first = self.expr()
        if first is None:
            return None
        operators: list[str] = []
        operands = [first]
        if isinstance(first, Operand) and (meant := self.in_words()):
            operators.append(meant)
            operand = self.expr()
            if operand is None:
                return first
            operands.append(operand)
        while self.kind == OPERATOR and (self.raw in COMPARISONS or self.raw == "="):
            if self.raw == "=":
                if self.group and self._nesting < 2:  # of the next attribute
                    break
                self.single_equals()
            if len(operators) == 2:
                self.expected("at most two comparisons in a row")
                break
            operators.append("==" if self.raw == "=" else self.raw)
            self.advance()
            if operators[-1] == "==" and (self.at("<") or self.at(">")) and self.adjacent(self.index):
                self.advance()  # `=<` is reported as a whole
            operand = self.expr()
            if operand is None:
                return first
            operands.append(operand)
        if not operators:
            return first
        return Comparison(first.start, operands[-1].end, tuple(operators), tuple(operands))

    def in_words(self) -> str:
        """Report `wind below 10 m/s`, and go to the value; the comparison that is meant, or empty."""
        bound = self.bound_ahead() if self.kind == NAME and self.raw not in _ENDS_OPERAND else None
        if bound is None or self.kinds[self.index + bound[0]] not in (NUMBER, QUANTITY):
            return ""
        length, meant = bound
        self.written_otherwise("this comparison", length, RELATIONS[meant])
        self.go_to(self.index + length)
        return RELATIONS[meant]

    def bound_ahead(self) -> tuple[int, tuple[str, str]] | None:
        """The number of words here that begin a bound, and the words of this language for them."""
        for length in (5, 4, 3, 2, 1):
            if (meant := BOUNDS.get(tuple(self.raws[self.index : self.index + length]))) is not None:
                return length, meant
        return None

    def written_otherwise(self, what: str, length: int, written: str) -> None:
        """Report that the next words, so many, are written otherwise."""
        last = self.index + length - 1
        span = Span(self.here().start, self.starts[last] + len(self.raws[last]))
        self.complain(span, f"{what} is written `{written}`", write_fix(written, span, safe=True))

    def single_equals(self) -> None:
        """Report `=` in a comparison, where `==` is meant, and `=<` and `=>`."""
        span = self.here()
        following = self.index + 1
        if self.raws[following] in ("<", ">") and self.adjacent(following):
            meant = f"{self.raws[following]}="
            span = Span(span.start, span.end + 1)
            message = f"this comparison is written `{meant}`"
        else:
            meant, message = "==", "values are compared with `==`"
        self.complain(span, message, write_fix(meant, span, safe=True))

    def ends_condition(self) -> bool:
        """Whether the next word ends the current operand, so that a lone `node` is an ordinary name."""
        return self.raws[self.index + 1] in _ENDS_OPERAND

    def at_keyword(self) -> bool:
        """Whether the current word begins a clause or joins conditions; without what must follow it, it is a name."""
        if self.raw not in _ENDS_OPERAND:
            return False
        following = self.index + 1
        if self.raw in _FOLLOWED_BY:
            return self.is_word(following, _FOLLOWED_BY[self.raw])
        return self.kinds[following] in (NAME, STRING, NUMBER, QUANTITY) and not self.ends_condition()

    def expr(self) -> Condition | None:
        """Expr = Term { ( "+" | "-" ) Term }"""
        return self.joined(self.term, "+", "-")

    def term(self) -> Condition | None:
        """Term = Factor { ( "*" | "/" ) Factor }"""
        return self.joined(self.factor, "*", "/")

    def factor(self) -> Condition | None:
        """[ "-" ] ( QUANTITY | NUMBER ) | NAME | STRING | Func "(" NAME ")" | "(" Expr ")\""""
        start = self.start()
        if self.at("-"):
            self.advance()
            if self.kind == QUANTITY or self.kind == NUMBER:
                word = self.take()
                return Negative(start, word.end, Operand(word))
            self.expected("a number or a quantity after `-`")
            return None
        if self.kind == QUANTITY or self.kind == NUMBER or self.kind == STRING:
            return Operand(self.take())
        if self.kind == NAME:
            if self.raw in FUNCTIONS and self.kinds[self.index + 1] == OPEN:
                function = self.take()
                self.advance()
                self.group += 1
                signal = self.plain_name("a signal")
                self.close_group("`)`")
                return Call(start, self.last_end(), function, signal)
            if not self.at_keyword():
                if self.kinds[self.index + 1] == OPEN and self.adjacent(self.index + 1):
                    functions = ", ".join(sorted(FUNCTIONS))
                    meant = _OTHER_FUNCTIONS.get(self.raw)
                    fixes = self.replaced_by(FUNCTIONS)
                    if meant is not None:
                        fixes = (replace_fix(f"Replace `{self.raw}` with `{meant}`", self.here(), meant),)
                    self.expected(f"a function ({functions})", (), fixes)
                    return None
                return Operand(self.take())
        if self.kind == OPEN:
            self.advance()
            self.group += 1
            inner = self.cond()
            self.close_group("`)`")
            return inner
        self.expected("a condition: a signal, a context, a value, …")
        return None

    # ---- what clauses share ----

    def path(self, what: str) -> Path | None:
        """Path = Name { "/" Name }"""
        first = self.name(what)
        if first is None:
            return None
        names = [first]
        while self.accept("/") or (self.kind != NAME and self.other_separator()):
            name = self.name(what)
            if name is None:
                break
            names.append(name)
        return Path(tuple(names))

    def other_separator(self) -> bool:
        """Report `Guide.Home`, `Guide::Home` and `Guide->Home`, and read the sign as `/`."""
        following = self.index + 1
        if self.raw not in _SEPARATORS or self.kinds[following] not in (NAME, STRING):
            return False
        if not (self.adjacent(self.index) and self.adjacent(following)):
            return False
        self.complain(self.here(), "the names of a path are separated by `/`", write_fix("/", self.here()))
        self.advance()
        return True

    def close_group(self, what: str) -> None:
        """Close a group, whatever precedes its `)`."""
        while self.kind != CLOSE and self.kind != NEWLINE:
            self.expected(what)
            if self.kind != CLOSE:
                self.advance()
        self.group -= 1
        self.advance()


_SEPARATORS: Final = frozenset((".", "::", "->", ":", "\\"))
_INSTEAD: Final = {"or": "||", "and": "&&"}  # as other languages write them
_ENDS_OPERAND: Final = HEADS | {"and", "or", "if", "else"}
_FOLLOWED_BY: Final = {
    "in": "at",
    "with": "probability",
    "over": "last",
    "on": "violation",
    "verified": "by",
    "sum": "of",
}
# How a bound begins, and what else people write for that.
BOUNDS: Final[dict[tuple[str, ...], tuple[str, str]]] = {
    **{words: words for words in RELATIONS},
    **{
        (word, *than, "or", "equal", *to): (("at", "most") if word in ("less", "smaller", "lower") else ("at", "least"))
        for word in ("less", "smaller", "lower", "more", "greater", "larger")
        for than in ((), ("than",))
        for to in ((), ("to",))
    },
    **dict.fromkeys(
        (("no", "more", "than"), ("not", "more", "than"), ("no", "longer", "than"), ("up", "to"), ("=", "<")),
        ("at", "most"),
    ),
    **dict.fromkeys((("<=",), ("within",), ("max",), ("maximum",), ("maximal",), ("maximally",)), ("at", "most")),
    **dict.fromkeys(
        (("no", "less", "than"), ("not", "less", "than"), ("no", "fewer", "than"), ("=", ">")), ("at", "least")
    ),
    **dict.fromkeys(((">=",), ("min",), ("minimum",), ("minimal",), ("minimally",)), ("at", "least")),
    **dict.fromkeys((("longer", "than"), ("greater", "than"), ("larger", "than")), ("more", "than")),
    **dict.fromkeys(((">",), ("above",), ("over",)), ("more", "than")),
    **dict.fromkeys((("shorter", "than"), ("smaller", "than"), ("fewer", "than")), ("less", "than")),
    **dict.fromkeys((("<",), ("under",), ("below",)), ("less", "than")),
}
