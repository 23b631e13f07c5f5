"""Tokens to the tree of a script, by the grammar of the newest engine.

One invariant: what this accepts without a problem the newest engine loads (BehaviorTree.CPP 4.10,
src/script_parser.cpp), with the same tree; what it reports, the engine refuses or fails at when it ticks the node.
Parsing stops at the first error without a certain correction, as it does in the engine.
"""

from __future__ import annotations

from typing import Final, NoReturn

from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.syntax.script import mistakes
from btq_lang.syntax.script.mistakes import error
from btq_lang.syntax.script.tokens import BEGINS, END, ERROR, NAME, NUMBER, OPERANDS, TEXT, tokenize
from btq_lang.syntax.script.tree import (
    ASSIGNMENT,
    COMPARISON,
    RANK,
    TERNARY,
    Assign,
    Bool,
    Expression,
    Name,
    Number,
    Script,
    ScriptBinary,
    ScriptComparison,
    ScriptGroup,
    ScriptText,
    Ternary,
    Unary,
    ungrouped,
)
from btq_lang.syntax.tree import walk
from btq_lang.util.text import Span

# Nested operators, redundant brackets included.  The engine has no limit except its stack; the engines up to 4.8 refuse
# more than 256 operators.
MAX_DEPTH: Final = 100


def parse_script(text: str) -> Script:
    """Parse a script; never raises.  Errors for the newest engine are in `problems`, in the order of the text."""
    if not text.replace(";", " ").strip():
        return Script(text, (), (mistakes.empty(text),))
    parser = _Parser(text)
    statements: list[Expression] = []
    try:
        parser.script(statements)
    except _Stop:
        return Script(text, tuple(statements), _in_order(parser.problems), complete=False)
    return Script(text, tuple(statements), _in_order(parser.problems))


class _Stop(Exception):
    """Parsing cannot continue; the reason is among the problems."""


class _Parser:
    """A place in the tokens of a script.

    Attributes:
        at: the index of the next token.
        depth: how many expressions are open.
        height: how many operators are nested in the expression read last.
    """

    def __init__(self, text: str) -> None:
        tokens = tokenize(text)
        self.text: Final = text
        self.kinds: Final = tokens.kinds
        self.starts: Final = tokens.starts
        self.ends: Final = tokens.ends
        self.meant: Final = tokens.meant
        self.problems: list[Diagnostic] = tokens.problems
        self.at = 0
        self.depth = 0
        self.height = 0

    def script(self, statements: list[Expression]) -> None:
        """`x := 1; y := 2`: statements, for which the newest engine does not require separators."""
        self.leading_semicolons()
        while self.kinds[self.at] != END:
            statement = self.expression(0)
            statements.append(statement)
            if self.kinds[self.at] == ";":
                while self.kinds[self.at] == ";":
                    self.at += 1
            elif self.kinds[self.at] != END:
                self.statement_boundary(statement)

    def leading_semicolons(self) -> None:
        while self.kinds[self.at] == ";":
            self.at += 1
        if self.at:
            span = Span(self.starts[0], self.ends[self.at - 1])
            fix = replace_fix("Remove it", span, "", safe=True)
            message = "unexpected `;` at the start of a script: it separates statements"
            self.problems.append(error(span, message, fix))

    def statement_boundary(self, statement: Expression) -> None:
        """Decide whether what follows a statement without `;` is another statement or a mistake.

        The newest engine takes it for a statement.  If the previous one has no effect (it assigns nothing), or the next
        is a mere number, text or unit, an operator is missing rather than a `;`.
        """
        kind = self.kinds[self.at]
        if kind not in BEGINS:
            self.unexpected(statement)
        does_nothing = not any(isinstance(node, Assign) for node in walk(statement))
        if does_nothing or kind in (NUMBER, TEXT) or self.is_unit() or self.is_call():
            self.two_operands()

    def expression(self, least: int) -> Expression:
        """Operators that bind at least this tightly, and their operands: precedence climbing, as in the engine."""
        self.depth += 1
        if self.depth > 2 * MAX_DEPTH + 1:
            self.stop(mistakes.too_deep(self.span(self.at), MAX_DEPTH))
        left = self.operand()
        height = self.height
        while True:
            kind = self.kinds[self.at]
            rank = RANK.get(kind, -1)
            if rank < least:
                break
            if rank == COMPARISON:
                left, height = self.comparison(left, height)
            elif rank > TERNARY:
                self.at += 1
                right = self.expression(rank + 1)
                left = ScriptBinary(left.start, right.end, kind, left, right)
                height = max(height, self.height)
            elif rank == TERNARY:
                left, height = self.ternary(left, height)
            else:
                left, height = self.assignment(left, height)
            height += 1
            if height > MAX_DEPTH:
                self.stop(mistakes.too_deep(Span(left.start, left.end), MAX_DEPTH))
            if rank <= TERNARY:
                break
        self.depth -= 1
        self.height = height
        return left

    def comparison(self, left: Expression, height: int) -> tuple[Expression, int]:
        """`a < b <= c`"""
        operators, operands = [], [left]
        while RANK.get(self.kinds[self.at]) == COMPARISON:
            operators.append(self.kinds[self.at])
            self.at += 1
            operands.append(self.expression(COMPARISON + 1))
            height = max(height, self.height)
        return ScriptComparison(left.start, operands[-1].end, tuple(operators), tuple(operands)), height

    def ternary(self, condition: Expression, height: int) -> tuple[Expression, int]:
        """`a ? b : c`"""
        question = self.at
        self.at += 1
        then = self.expression(0)
        height = max(height, self.height)
        if self.kinds[self.at] != ":":
            self.unclosed(error(self.span(question), "a `?` needs both values: `condition ? this : that`"))
        self.at += 1
        otherwise = self.expression(TERNARY)
        return Ternary(condition.start, otherwise.end, condition, then, otherwise), max(height, self.height)

    def assignment(self, target: Expression, height: int) -> tuple[Expression, int]:
        """`x := a`, and `=`, `+=`, `-=`, `*=`, `/=`"""
        operator = self.at
        kind = self.kinds[operator]
        if not isinstance(ungrouped(target), Name):
            self.problems.append(mistakes.not_assignable(self.span(operator), kind == "="))
        self.at += 1
        value = self.expression(0)
        return Assign(target.start, value.end, kind, target, value), max(height, self.height)

    def operand(self) -> Expression:
        """`x`, `30`, `'text'`, `true`, `(a + b)`, `-x`, `~x`, `!x`"""
        index = self.at
        kind = self.kinds[index]
        start, end = self.starts[index], self.ends[index]
        if kind in OPERANDS:
            self.at += 1
            self.height = 0
            meant = self.meant.get(index)
            if kind == NAME:
                return Name(start, end, self.text[start:end] if meant is None else meant)
            if kind == NUMBER:
                return Number(start, end, self.text[start:end] if meant is None else meant)
            if kind == TEXT:
                return ScriptText(start, end, self.text[start + 1 : end - 1] if meant is None else meant)
            return Bool(start, end, self.text[start:end] == "true")
        if kind == "(":
            self.at += 1
            inner = self.expression(0)
            if self.kinds[self.at] != ")":
                self.unclosed(mistakes.unclosed_bracket(self.text, Span(start, end), self.span(self.at)))
            self.at += 1
            # Brackets around an operator are not counted, or adding required ones could exceed the limit.
            self.height += not isinstance(inner, Unary | ScriptBinary | ScriptComparison | Ternary | Assign)
            if self.height > MAX_DEPTH:
                self.stop(mistakes.too_deep(Span(start, end), MAX_DEPTH))
            return ScriptGroup(start, self.ends[self.at - 1], inner)
        if kind == "-" or kind == "!" or kind == "~":
            return self.prefixed()
        if kind == "+" and (self.kinds[index + 1] in BEGINS or self.kinds[index + 1] in ("+", "-")):
            self.problems.append(mistakes.unary_plus(self.text, Span(start, end)))
            return self.prefixed()
        self.no_operand()

    def prefixed(self) -> Expression:
        """`-x`, `~x`, `!x`; a `+` was reported and is ignored."""
        index = self.at
        self.depth += 1
        if self.depth > 2 * MAX_DEPTH + 1:
            self.stop(mistakes.too_deep(self.span(index), MAX_DEPTH))
        self.at += 1
        operand = self.operand()
        self.depth -= 1
        if self.kinds[index] == "+":
            return operand
        self.height += 1
        if self.height > MAX_DEPTH:
            self.stop(mistakes.too_deep(self.span(index), MAX_DEPTH))
        return Unary(self.starts[index], operand.end, self.kinds[index], operand)

    # ---- errors ----

    def no_operand(self) -> NoReturn:
        """Report a missing operand."""
        index = self.at
        kind, before = self.kinds[index], self.kinds[index - 1] if index else ";"
        if kind == ERROR:
            self.unreadable()
        waiting = None if before == ";" or before == ")" or before in OPERANDS else self.span(index - 1)
        if waiting is None and kind == ")":
            self.stop(error(self.span(index), "unexpected `)`: no bracket is open"))
        if waiting is None and kind == ":":
            self.stop(error(self.span(index), "unexpected `:` without `?`; assign a value with `:=`"))
        self.stop(mistakes.missing_operand(self.text, waiting, self.span(index)))

    def unexpected(self, statement: Expression) -> NoReturn:
        """Report that what follows a statement neither separates nor begins one."""
        if RANK.get(self.kinds[self.at]) == ASSIGNMENT and isinstance(statement, Ternary):
            message = "an assignment in the last part of `? :` must be in brackets: `c ? a : (b := 1)`"
            self.stop(error(self.span(self.at), message))
        self.no_operand()

    def unclosed(self, problem: Diagnostic) -> NoReturn:
        """Report a `(` or a `?` that is not completed."""
        if self.kinds[self.at] in BEGINS:
            self.two_operands()
        if self.kinds[self.at] == ERROR:
            self.unreadable()
        self.stop(problem)

    def two_operands(self) -> NoReturn:
        """Report two operands without an operator between them; three words in a row are reported as prose."""
        first, last = self.at - 1, self.at
        while first and self.is_word(first) and self.is_word(first - 1):
            first -= 1
        while self.is_word(last) and self.is_word(last + 1):
            last += 1
        if last - first > 1:
            self.prose(self.starts[first])
        left, right = self.span(first), self.span(last)
        both = Span(left.start, right.end)
        if self.is_call():
            name = self.text[left.start : left.end]
            self.stop(error(both, f"unexpected call `{name}(…)`: scripts have no functions"))
        if self.is_unit():
            notes = ("write the number in the unit of the entry",)
            name = self.text[right.start : right.end]
            self.stop(error(both, f"unexpected unit `{name}`: scripts have no units", notes=notes))
        self.stop(mistakes.two_operands(self.text, left, right))

    def is_word(self, index: int) -> bool:
        """Whether a token can be part of prose, including words that were read as operators."""
        return self.kinds[index] in OPERANDS or self.text[self.starts[index] : self.ends[index]].isalpha()

    def is_call(self) -> bool:
        """Whether it is `f(` without a blank"""
        before = self.at - 1
        return self.kinds[self.at] == "(" and self.kinds[before] == NAME and self.ends[before] == self.starts[self.at]

    def is_unit(self) -> bool:
        """Whether it is `30 sec` without an operator after it"""
        kinds, index = self.kinds, self.at
        return kinds[index] == NAME and kinds[index - 1] == NUMBER and kinds[index + 1] not in RANK

    def unreadable(self) -> NoReturn:
        span = self.span(self.at)
        if self.text[span.start] in "'’" and self.text[span.start - 1 : span.start].isalpha():  # an apostrophe
            self.prose(0)
        self.stop(mistakes.no_such(self.text, span))

    def prose(self, start: int) -> NoReturn:
        self.problems.clear()
        self.stop(mistakes.prose(self.text, start))

    def stop(self, problem: Diagnostic) -> NoReturn:
        self.problems.append(problem)
        raise _Stop

    def span(self, index: int) -> Span:
        return Span(self.starts[index], self.ends[index])


def _in_order(problems: list[Diagnostic]) -> tuple[Diagnostic, ...]:
    return tuple(sorted(problems, key=lambda problem: problem.span)) if problems else ()
