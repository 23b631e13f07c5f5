"""The part of the parser that reads conditions, in contexts and clauses.

Each `parse_…` is a production of docs/grammar.md and named after it; its docstring shows the production.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from btq_lang.diagnostics.model import replace_fix, write_fix
from btq_lang.grammar.cursor import Cursor
from btq_lang.syntax.tokens import BRACED, CLOSE, ERROR, NAME, NEWLINE, NUMBER, OPEN, OPERATOR, QUANTITY, STRING, SYMBOL
from btq_lang.syntax.tree import (
    Amount,
    Binary,
    Call,
    Case,
    Choice,
    Comparison,
    Condition,
    Negative,
    NodeRuns,
    Not,
    Operand,
    Path,
    Table,
)
from btq_lang.util.text import Span

# Words that begin a clause and so end the condition before them.
SUBJECT_HEADS: Final = frozenset(("mission", "every", "from", "sum"))
HEADS: Final = SUBJECT_HEADS.union(
    ("while", "when", "in", "with", "confidence", "over", "on", "goal", "because", "verified")
)
# Words that begin a clause only where its continuation follows; else they are names.
METADATA_HEADS: Final = frozenset(("source", "refines", "mitigates", "priority", "approved"))
FUNCTIONS: Final = frozenset(("max", "min", "mean", "p95", "stddev", "change", "count", "age"))
_OTHER_FUNCTIONS: Final = {
    **dict.fromkeys(("avg", "average"), "mean"),
    **{"maximum": "max", "minimum": "min", "std": "stddev", "delta": "change", "diff": "change"},
}
COMPARISONS: Final = frozenset(("<=", ">=", "<", ">", "==", "!="))
RELATIONS: Final = {("at", "most"): "<=", ("at", "least"): ">=", ("less", "than"): "<", ("more", "than"): ">"}

NO_RATE: Final = "a condition has no rate: a node's claim has, as in `Dock fails at most 1 per 1e6 h`"
MAX_NESTING: Final = 50  # of brackets in one condition
MAX_OPERATORS: Final = 100  # in one condition
MAX_CASES: Final = 100  # in one value: each case of a table may be another table


def parse_cond(cursor: Cursor) -> Condition | None:
    """Cond = Conj { "or" Conj }"""
    if cursor.nesting == 0:
        cursor.operators = 0
    if cursor.nesting > MAX_NESTING:
        too_deep(cursor, f"more than {MAX_NESTING} nested brackets")
        return None
    cursor.nesting += 1
    condition = joined(cursor, parse_conj, "or")
    cursor.nesting -= 1
    return condition


def parse_conj(cursor: Cursor) -> Condition | None:
    """Conj = Neg { "and" Neg }"""
    return joined(cursor, parse_neg, "and")


def parse_neg(cursor: Cursor) -> Condition | None:
    """Neg = [ "not" ] Atom"""
    start = cursor.start()
    if cursor.accept_word("not") or accept_instead(cursor, "!", "not"):
        operand = parse_atom(cursor)
        return Not(start, operand.end, operand) if operand else None
    return parse_atom(cursor)


def parse_atom(cursor: Cursor) -> Condition | None:
    """Atom = Expr [ Cmp Expr [ Cmp Expr ] ] | "node" Path | "(" Cond ")\""""
    if cursor.at_word("node") and cursor.kinds[cursor.index + 1] in (NAME, STRING) and not ends_condition(cursor):
        start = cursor.start()
        cursor.advance()
        path = parse_path(cursor, "a node")
        return NodeRuns(start, cursor.last_end(), path) if path else None
    first = parse_expr(cursor)
    if first is None:
        return None
    operators: list[str] = []
    operands = [first]
    if isinstance(first, Operand) and (meant := in_words(cursor)):
        operators.append(meant)
        operand = parse_expr(cursor)
        if operand is None:
            return first
        operands.append(operand)
    while cursor.kind == OPERATOR and (cursor.raw in COMPARISONS or cursor.raw == "="):
        if cursor.raw == "=":
            if cursor.group and cursor.nesting < 2:  # of the next attribute
                break
            single_equals(cursor)
        if len(operators) == 2:
            cursor.expected("at most two comparisons in a row")
            break
        operators.append("==" if cursor.raw == "=" else cursor.raw)
        cursor.advance()
        if operators[-1] == "==" and (cursor.at("<") or cursor.at(">")) and cursor.adjacent(cursor.index):
            cursor.advance()  # `=<` is reported as a whole
        operand = parse_expr(cursor)
        if operand is None:
            return first
        operands.append(operand)
    if not operators:
        return first
    return Comparison(first.start, operands[-1].end, tuple(operators), tuple(operands))


def parse_expr(cursor: Cursor) -> Condition | None:
    """Expr = Term { ( "+" | "-" ) Term }"""
    return joined(cursor, parse_term, "+", "-")


def parse_term(cursor: Cursor) -> Condition | None:
    """Term = Factor { ( "*" | "/" ) Factor }"""
    return joined(cursor, parse_factor, "*", "/")


def parse_factor(cursor: Cursor) -> Condition | None:
    """[ "-" ] ( QUANTITY | NUMBER ) | NAME | STRING | Func "(" NAME ")" | "(" ( Expr | Bounded ) ")" | Entry"""
    start = cursor.start()
    if cursor.at("-"):
        cursor.advance()
        if cursor.kind == QUANTITY or cursor.kind == NUMBER:
            if cursor.raws[cursor.index - 2] == "+":
                tolerance(cursor)
            word = cursor.take()
            return Negative(start, word.end, Operand(word))
        cursor.expected("a number or a quantity after `-`")
        return None
    if cursor.kind == QUANTITY or cursor.kind == NUMBER or cursor.kind == STRING:
        return Operand(cursor.take())
    if cursor.kind == NAME:
        if cursor.raw in FUNCTIONS and cursor.kinds[cursor.index + 1] == OPEN:
            function = cursor.take()
            cursor.advance()
            cursor.group += 1
            signal = cursor.plain_name("a signal")
            close_group(cursor, "`)`")
            return Call(start, cursor.last_end(), function, signal)
        if not at_keyword(cursor):
            if cursor.kinds[cursor.index + 1] == OPEN and cursor.adjacent(cursor.index + 1):
                functions = ", ".join(sorted(FUNCTIONS))
                meant = _OTHER_FUNCTIONS.get(cursor.raw)
                fixes = cursor.replaced_by(FUNCTIONS)
                if meant is not None:
                    fixes = (replace_fix(f"Replace `{cursor.raw}` with `{meant}`", cursor.here(), meant),)
                cursor.expected(f"a function ({functions})", (), fixes)
                return None
            return Operand(cursor.take())
    if cursor.kind == OPEN:
        cursor.advance()
        cursor.group += 1
        inner = parse_cond(cursor)
        if inner is not None and cursor.at_word("if"):
            inner = choice(cursor, inner)
        close_group(cursor, "`)`")
        return inner
    if cursor.kind == BRACED and cursor.in_scenario:
        return parse_entry(cursor)
    cursor.expected("a condition: a signal, a context, a value, …")
    return None


def parse_entry(cursor: Cursor) -> Operand:
    """Entry = BRACED, in scenarios"""
    return Operand(cursor.take())


def parse_cases(cursor: Cursor, value: Amount) -> Table:
    """ "if" Cond { "," Simple "if" Cond } "else" Simple; the first value is already read"""
    cases: list[Case] = []
    while cursor.accept_word("if"):
        cases.append(Case(value, parse_cond(cursor)))
        if not cursor.accept(","):
            break
        if len(cases) == MAX_CASES:
            note = "compute the value in a node, and declare a signal for its output"
            cursor.complain(
                cursor.here(), f"more than {MAX_CASES} cases in one value", notes=(note,), rule="nested-too-deep"
            )
            cursor.recover()
            return Table(tuple(cases))
        following = parse_simple(cursor)
        if following is None:
            return Table(tuple(cases))
        value = following
        if not cursor.at_word("if"):
            cursor.expected("`if` and a condition, or `else` instead of the comma")
            return Table(tuple(cases))
    otherwise = parse_simple(cursor) if cursor.expect_word("else") else None
    return Table(tuple(cases), otherwise)


def parse_simple(cursor: Cursor, strings: bool = False) -> Amount | None:
    """Simple = [ "-" ] ( QUANTITY | NUMBER ) | NAME;  with `strings` a STRING too"""
    cursor.skip_sign(":")
    negative = cursor.accept("-")
    if cursor.kind == QUANTITY or cursor.kind == NUMBER:
        return Amount(cursor.take(), negative)
    if not negative and (cursor.kind == NAME or (strings and cursor.kind == STRING)):
        return Amount(cursor.take())
    cursor.expected("a value with its unit: 30 s")
    return None


def parse_path(cursor: Cursor, what: str) -> Path | None:
    """Path = Name { "/" Name }"""
    first = cursor.name(what)
    if first is None:
        return None
    names = [first]
    while cursor.accept("/") or (cursor.kind != NAME and other_separator(cursor)):
        name = cursor.name(what)
        if name is None:
            break
        names.append(name)
    return Path(tuple(names))


# ---- what productions ask and report ----


def choice(cursor: Cursor, first: Condition) -> Condition:
    """Read the rest of a value table in brackets, whose first value is read."""
    value = first.operand if isinstance(first, Negative) else first
    if not isinstance(value, Operand) or value.word.kind == STRING:
        cursor.expected("`)`", ("the values of a choice are single ones: `(0.5 m/s if humans_near else 1 m/s)`",))
        cursor.recover()
        return first
    table = parse_cases(cursor, Amount(value.word, negative=isinstance(first, Negative)))
    return Choice(first.start, cursor.last_end(), table)


def joined(cursor: Cursor, operand: Callable[[Cursor], Condition | None], *operators: str) -> Condition | None:
    """Operand { Operator Operand }"""
    left = operand(cursor)
    while left is not None and (operator := accept_one(cursor, operators)):
        right = operand(cursor)
        if right is None:
            break
        left = binary(cursor, operator, left, right)
    return left


def accept_one(cursor: Cursor, operators: tuple[str, ...]) -> str:
    """The operator that is here, if it is one of these; else empty"""
    operator = cursor.raw
    if operator in operators and (cursor.kind == OPERATOR or cursor.kind == NAME):
        cursor.advance()
        return operator
    for word in operators if cursor.kind == SYMBOL or cursor.kind == ERROR else ():
        if accept_instead(cursor, _INSTEAD.get(word, ""), word):
            return word
    return ""


def accept_instead(cursor: Cursor, sign: str, word: str) -> bool:
    """Report an operator of another language, and read it as the word that is meant"""
    if cursor.kind not in (SYMBOL, ERROR) or cursor.raw != sign:
        return False
    written = word if word != "not" else "not "
    fix = replace_fix(f"Write `{word}`", cursor.here(), written, safe=True)
    cursor.complain(cursor.here(), f"in conditions `{sign}` is written `{word}`", fix)
    cursor.advance()
    return True


def binary(cursor: Cursor, operator: str, left: Condition, right: Condition) -> Condition:
    """Join two operands; report too many in one condition, because a chain is a deep tree."""
    cursor.operators += 1
    if cursor.operators > MAX_OPERATORS:
        too_deep(cursor, f"more than {MAX_OPERATORS} operators in one condition")
        return left
    return Binary(left.start, right.end, operator, left, right)


def too_deep(cursor: Cursor, message: str) -> None:
    note = "write a part of it as a context of its own: `context part : …`"
    cursor.complain(cursor.here(), message, notes=(note,), rule="nested-too-deep")
    cursor.recover()


def in_words(cursor: Cursor) -> str:
    """Report `wind below 10 m/s`, and go to the value; the comparison that is meant, or empty."""
    bound = bound_ahead(cursor) if cursor.kind == NAME and cursor.raw not in _ENDS_OPERAND else None
    if cursor.raw == "within" and "followed" in cursor.raws[: cursor.index]:
        return ""  # the deadline of what follows an event
    if bound is None or cursor.kinds[cursor.index + bound[0]] not in (NUMBER, QUANTITY):
        return ""
    length, meant = bound
    if cursor.is_word(cursor.index + length + 1, "per"):
        cursor.complain(cursor.here(), NO_RATE)
        cursor.recover()
        return ""
    written_otherwise(cursor, "this comparison", length, RELATIONS[meant])
    cursor.go_to(cursor.index + length)
    return RELATIONS[meant]


def bound_ahead(cursor: Cursor) -> tuple[int, tuple[str, str]] | None:
    """The number of words here that begin a bound, and the words of this language for them."""
    for length in (5, 4, 3, 2, 1):
        if (meant := BOUNDS.get(tuple(cursor.raws[cursor.index : cursor.index + length]))) is not None:
            return length, meant
    return None


def written_otherwise(cursor: Cursor, what: str, length: int, written: str) -> None:
    """Report that the next words, so many, are written otherwise."""
    last = cursor.index + length - 1
    span = Span(cursor.here().start, cursor.starts[last] + len(cursor.raws[last]))
    cursor.complain(span, f"{what} is written `{written}`", write_fix(written, span, safe=True))


def tolerance(cursor: Cursor) -> None:
    """Report `x +- 10 mm`, at its value."""
    sign, value, raws = cursor.index - 2, cursor.raw, cursor.raws
    is_of_two = sign > 3 and raws[sign - 2] == "==" and cursor.kinds[sign - 3] == NAME
    if is_of_two and cursor.kinds[sign - 1] in (QUANTITY, NUMBER) and cursor.report_slip(cursor):
        return
    if not cursor.adjacent(sign + 1) or sign < 1 or not (is_of_two or cursor.kinds[sign - 1] == NAME):
        return
    span = Span(cursor.starts[sign - 3 if is_of_two else sign - 1], cursor.here().end)
    amount = f"{raws[sign - 3]} - {raws[sign - 1]}" if is_of_two else raws[sign - 1]
    meant = f"-{value} <= {amount} <= {value}"
    cursor.complain(span, f"a tolerance is written `{meant}`", write_fix(meant, span))


def single_equals(cursor: Cursor) -> None:
    """Report `=` in a comparison, where `==` is meant, and `=<` and `=>`."""
    span = cursor.here()
    following = cursor.index + 1
    rest = cursor.text[span.end : cursor.starts[-1]]
    if ("+" in rest or "±" in rest) and cursor.report_slip(cursor):
        return
    if cursor.raws[following] in ("<", ">") and cursor.adjacent(following):
        meant = f"{cursor.raws[following]}="
        span = Span(span.start, span.end + 1)
        message = f"this comparison is written `{meant}`"
    else:
        meant, message = "==", "values are compared with `==`"
    cursor.complain(span, message, write_fix(meant, span, safe=True))


def ends_condition(cursor: Cursor) -> bool:
    """Whether the next word ends the current operand, so that a lone `node` is an ordinary name."""
    return cursor.raws[cursor.index + 1] in _ENDS_OPERAND


def at_keyword(cursor: Cursor) -> bool:
    """Whether the current word begins a clause or joins conditions; without what must follow it, it is a name."""
    if cursor.raw not in _ENDS_OPERAND:
        return False
    following = cursor.index + 1
    if cursor.raw in _FOLLOWED_BY:
        return cursor.is_word(following, _FOLLOWED_BY[cursor.raw])
    return cursor.kinds[following] in (NAME, STRING, NUMBER, QUANTITY) and not ends_condition(cursor)


def other_separator(cursor: Cursor) -> bool:
    """Report `Guide.Home`, `Guide::Home` and `Guide->Home`, and read the sign as `/`."""
    following = cursor.index + 1
    if cursor.raw not in _SEPARATORS or cursor.kinds[following] not in (NAME, STRING):
        return False
    if not (cursor.adjacent(cursor.index) and cursor.adjacent(following)):
        return False
    cursor.complain(cursor.here(), "the names of a path are separated by `/`", write_fix("/", cursor.here()))
    cursor.advance()
    return True


def close_group(cursor: Cursor, what: str) -> None:
    """Close a group, whatever precedes its `)`."""
    while cursor.kind != CLOSE and cursor.kind != NEWLINE:
        cursor.expected(what)
        if cursor.kind != CLOSE:
            cursor.advance()
    cursor.group -= 1
    cursor.advance()


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
