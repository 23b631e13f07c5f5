"""Bugs, one at a time, for the source of a module: comparisons, conditions, constants, keys, statements.

One invariant: a bug is found again by its number, in the same source.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

PAIRS = ((ast.Lt, ast.LtE), (ast.Gt, ast.GtE), (ast.Eq, ast.NotEq), (ast.Is, ast.IsNot), (ast.In, ast.NotIn))
OPPOSITE: dict[type[ast.cmpop], type[ast.cmpop]] = {one: other for pair in PAIRS for one, other in (pair, pair[::-1])}


@dataclass(frozen=True)
class Mutant:
    """A bug: where it is, its kind, the code without it and with it, and the number it has in its module."""

    path: str
    line: int
    kind: str
    before: str
    after: str
    number: int

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.kind}: {self.before} -> {self.after}"


def mutants(source: str, path: str = "") -> list[Mutant]:
    """Every bug that can be put into a module."""
    found = []
    for number, (kind, _, _, _, old, new) in enumerate(_places(ast.parse(source))):
        before, after = (" ".join(ast.unparse(node).split())[:100] for node in (old, new))
        found.append(Mutant(path, old.lineno, kind, before, after, number))
    return found


def with_bug(source: str, number: int) -> str:
    """The module with the bug of this number; without comments."""
    tree = ast.parse(source)
    _, owner, field, index, _, new = list(_places(tree))[number]
    if index is None:
        setattr(owner, field, new)
    else:
        getattr(owner, field)[index] = new
    return ast.unparse(ast.fix_missing_locations(tree))


def _places(node: ast.AST, function: bool = False) -> Iterator[tuple[str, ast.AST, str, int | None, Any, Any]]:
    """What can be changed: kind, owner, its field and the index there, the node and the one with the bug."""
    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
        function = not isinstance(node, ast.ClassDef)
    for field, value in ast.iter_fields(node):
        if field in ("annotation", "returns", "decorator_list"):
            continue
        for index, child in enumerate(value) if isinstance(value, list) else [(None, value)]:
            if isinstance(child, ast.AST) and not _is_skipped(child):
                for kind, new in _bugs(node, field, child, function):
                    yield kind, node, field, index, child, new
                yield from _places(child, function)


def _is_skipped(node: ast.AST) -> bool:
    """Whether all of it stays: docstrings, what only type checkers read, how an object shows itself, messages."""
    if isinstance(node, ast.Expr):
        return isinstance(node.value, ast.Constant)
    if isinstance(node, ast.Assign):
        return ast.unparse(node.targets[0]) in ("TYPE_CHECKING", "__slots__", "__all__")
    if isinstance(node, ast.If):
        return "TYPE_CHECKING" in ast.unparse(node.test)
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.FunctionDef) and node.name == "__repr__")


def _bugs(owner: ast.AST, field: str, node: ast.AST, function: bool) -> Iterator[tuple[str, ast.AST]]:
    """Kinds of bugs, and the node with them."""
    if isinstance(node, ast.Compare) and type(node.ops[0]) in OPPOSITE:
        yield "comparison", ast.Compare(node.left, [OPPOSITE[type(node.ops[0])](), *node.ops[1:]], node.comparators)
    elif field in ("test", "ifs") and isinstance(node, ast.expr):
        yield "condition", ast.UnaryOp(ast.Not(), node)
    if isinstance(node, ast.BoolOp):
        yield "and/or", ast.BoolOp(ast.And() if isinstance(node.op, ast.Or) else ast.Or(), node.values)
    if isinstance(node, ast.Constant) and type(node.value) is int:
        yield "constant", ast.Constant(node.value + 1)
    is_key = isinstance(owner, (ast.Compare, ast.Set, ast.Tuple)) or field in ("keys", "slice")
    if is_key and isinstance(node, ast.Constant) and isinstance(node.value, str) and " " not in node.value:
        yield "key", ast.Constant(node.value + "x")
    if function and field in ("body", "orelse", "finalbody"):
        if _can_be_dropped(node):
            yield "drop", ast.Pass()
        if isinstance(node, (ast.If, ast.For, ast.While, ast.With)) and isinstance(owner, ast.FunctionDef):
            yield "return", ast.Return()


def _can_be_dropped(node: ast.AST) -> bool:
    """Not what gives a name its value: every test finds a name that has none."""
    if isinstance(node, ast.Assign):
        return not isinstance(node.targets[0], (ast.Name, ast.Tuple))
    return isinstance(node, (ast.Expr, ast.AugAssign, ast.Continue, ast.Break, ast.Raise))
