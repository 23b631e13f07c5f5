"""The tree of a script: statements of nested expressions.

One invariant: `start` and `end` of a record are its place in the script's text, without the brackets around it (a
`Group` has them).  Versions of the engine are unknown here.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.util.record import Part, Record, fields_of
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.diagnostics.model import Diagnostic


class Script(Record):
    """A parsed script.

    Attributes:
        text: the source of the script; all offsets refer to it.
        statements: the valid ones, in order.
        problems: what the newest engine refuses, or fails to run: `script-error` and `empty-script`.
        complete: False if parsing stopped at an error, so that the statements are those before it.
    """

    text: str
    statements: tuple[Expression, ...]
    problems: tuple[Diagnostic, ...] = ()
    complete: bool = True


class Number(Part):
    """`30`, `0x1F`, `2.5e-3`; `raw` is its source.  A sign is a `Unary` around it."""

    raw: str

    @property
    def value(self) -> float:
        """Its value; an integer is an int."""
        if self.raw[:2] in ("0x", "0X"):
            return int(self.raw, 16)
        # Python refuses to parse integers of thousands of digits; such a number is a problem anyway.
        return int(self.raw) if self.raw.isdecimal() and len(self.raw) < 400 else float(self.raw)


class ScriptText(Part):
    """`'charger'`; `value` is the text between the quotes: there are no escapes."""

    value: str


class Bool(Part):
    """`true` or `false`."""

    value: bool


class Name(Part):
    """`battery`, or `@battery` for an entry of the root blackboard; an enumeration's names look alike."""

    name: str


class ScriptGroup(Part):
    """`( inner )`: kept because older engines need more brackets than the newest one."""

    inner: Expression


class Unary(Part):
    """`-x`, `~x`, `!x`."""

    operator: str
    operand: Expression


class ScriptBinary(Part):
    """`a + b`, and `-`, `*`, `/`, `..`, `&`, `|`, `^`, `&&`, `||`."""

    operator: str
    left: Expression
    right: Expression


class ScriptComparison(Part):
    """`a < b <= c`: one more operand than operators, and true where every neighbouring pair is."""

    operators: tuple[str, ...]
    operands: tuple[Expression, ...]


class Ternary(Part):
    """`condition ? then : otherwise`."""

    condition: Expression
    then: Expression
    otherwise: Expression


class Assign(Part):
    """`target := value`, and `=`, `+=`, `-=`, `*=`, `/=`.  A target other than a `Name` is a problem of the script."""

    operator: str
    target: Expression
    value: Expression


Expression: TypeAlias = (
    Number | ScriptText | Bool | Name | ScriptGroup | Unary | ScriptBinary | ScriptComparison | Ternary | Assign
)

# How tightly an operator binds in the newest engine.
RANK: Final = {
    **dict.fromkeys((":=", "=", "+=", "-=", "*=", "/="), 2),
    "?": 4,
    "||": 6,
    "&&": 8,
    **dict.fromkeys(("==", "!=", "<", ">", "<=", ">="), 10),
    "|": 12,
    "^": 12,
    "&": 14,
    "+": 16,
    "-": 16,
    "..": 16,
    "*": 18,
    "/": 18,
}
ASSIGNMENT: Final = RANK[":="]
TERNARY: Final = RANK["?"]
COMPARISON: Final = RANK["=="]


class Variable(Record):
    """A name in a script, with its place and use.

    Attributes:
        name: as written, with the `@` of the root blackboard.
        reads: its value is needed; `x += 1` reads and writes.
        writes: it is given a value.
        creates: the entry need not exist: the operator is `:=`.
    """

    name: str
    span: Span
    reads: bool
    writes: bool = False
    creates: bool = False


def variables(script: Script) -> tuple[Variable, ...]:
    """All occurrences of names in a script, in the order of the text; in a broken script those before the error.

    They include the names of enumerations, which only the robot's own code can register.
    """
    occurrences: list[Variable] = []
    stack: list[Expression] = list(reversed(script.statements))
    while stack:
        node = stack.pop()
        if isinstance(node, Name):
            occurrences.append(Variable(node.name, Span(node.start, node.end), reads=True))
        elif isinstance(node, Assign) and isinstance(target := ungrouped(node.target), Name):
            reads = node.operator not in (":=", "=")
            creates = node.operator == ":="
            occurrences.append(Variable(target.name, Span(target.start, target.end), reads, True, creates))
            stack.append(node.value)
        else:
            stack.extend(reversed(children(node)))
    return tuple(occurrences)


def operands(script: Script) -> Iterator[Name]:
    """The names that are all that a statement assigns, or with which it compares something by `==` or `!=`."""
    for node in map(ungrouped, script.statements):
        if isinstance(node, Assign):
            values: tuple[Expression, ...] = (node.value,)
        else:
            is_equality = isinstance(node, ScriptComparison) and node.operators in (("==",), ("!=",))
            values = node.operands[1:] if is_equality and isinstance(node, ScriptComparison) else ()
        yield from (value for value in map(ungrouped, values) if isinstance(value, Name))


def children(node: Expression) -> tuple[Expression, ...]:
    """The expressions directly inside another, in the order of the text."""
    values = (getattr(node, field) for field in fields_of(node))
    parts = chain.from_iterable(value if isinstance(value, tuple) else (value,) for value in values)
    return tuple([part for part in parts if isinstance(part, Expression)])


def ungrouped(node: Expression) -> Expression:
    """An expression without the brackets around it."""
    while isinstance(node, ScriptGroup):
        node = node.inner
    return node
