"""Scripts as text: a tree is compared and drawn in the form that all versions of the engine read alike."""

from __future__ import annotations

from typing import Final

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
    ScriptText,
    Ternary,
    Unary,
    ungrouped,
)

UNARY: Final = 20  # a prefix binds like this
ATOM: Final = 22  # and nothing tighter than this


def unparse(tree: Script | Expression, *, fully_parenthesised: bool = True) -> str:
    """A script or an expression as text: `; ` between statements, text in single quotes.

    Args:
        fully_parenthesised: brackets around every operator and its operands, the form that all versions of the engine
            read alike; otherwise as few as the newest version needs.  Brackets of the source are not kept.
    """
    statements = tree.statements if isinstance(tree, Script) else (tree,)
    full = fully_parenthesised
    return "; ".join(
        _write(statement, ATOM if full and not isinstance(ungrouped(statement), Assign) else 0, full)
        for statement in statements
    )


def _write(node: Expression, least: int, full: bool) -> str:
    """`node`, in brackets if it binds less tightly than `least`."""

    def inside(child: Expression, rank: int) -> str:
        return _write(child, ATOM if full else rank, full)

    node = ungrouped(node)
    if isinstance(node, Number):
        return node.raw
    if isinstance(node, Name):
        return node.name
    if isinstance(node, Bool):
        return "true" if node.value else "false"
    if isinstance(node, ScriptText):
        # There are no escapes: the newest engine cannot express text with a single quote, but older ones read this.
        return f"'{node.value}'" if "'" not in node.value else f'"{node.value}"'

    if isinstance(node, Unary):
        rank, text = UNARY, f"{node.operator}{inside(node.operand, UNARY)}"
    elif isinstance(node, ScriptBinary):
        rank = RANK[node.operator]
        text = f"{inside(node.left, rank)} {node.operator} {inside(node.right, rank + 1)}"
    elif isinstance(node, ScriptComparison):
        rank = COMPARISON
        text = inside(node.operands[0], rank + 1)
        for operator, operand in zip(node.operators, node.operands[1:], strict=True):
            text += f" {operator} {inside(operand, rank + 1)}"
    elif isinstance(node, Ternary):
        rank = TERNARY
        text = f"{inside(node.condition, rank + 1)} ? {inside(node.then, 0)} : {inside(node.otherwise, rank)}"
    elif isinstance(node, Assign):
        rank, text = ASSIGNMENT, f"{inside(node.target, ATOM)} {node.operator} {inside(node.value, 0)}"
    return f"({text})" if rank < least else text
