"""The C++ grammar of tree-sitter, and small questions to the nodes of its trees.

One invariant: no other module imports tree-sitter, and this one only when a text is parsed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from tree_sitter import Node


class GrammarMissing(Exception):
    """tree-sitter or its C++ grammar is not installed."""


def parse(text: str) -> Node:
    """The syntax tree of a C++ file; it exists for every text.

    Raises:
        GrammarMissing: the extra is not installed.
    """
    # A macro between `class` and its name, which exports it, is not C++ before the preprocessor has run.
    plain = _EXPORTED.sub(lambda match: match[1] + " " * len(match[2]), text)
    root: Node = _parser().parse(plain.encode("utf-8", "replace")).root_node
    if root.has_error and (without := _without_inner_conditions(plain)) != plain:
        other: Node = _parser().parse(without.encode("utf-8", "replace")).root_node
        root = other if len([*errors(other)]) < len([*errors(root)]) else root
    return root


def _without_inner_conditions(text: str) -> str:
    """A text without the lines `#if` … `#endif` inside of brackets, which the grammar cannot read: what is between
    them is left, as if all conditions held."""
    lines = text.splitlines(keepends=True)
    depth = 0
    for index, line in enumerate(lines):
        if _CONDITIONAL(line):
            if depth:
                lines[index] = re.sub(r"[^\r\n]", " ", line)
            continue
        code = _NO_CODE.sub("", line)
        depth = max(0, depth + code.count("(") - code.count(")"))
    return "".join(lines)


@cache
def _parser() -> Any:
    try:
        from tree_sitter import Language, Parser
        from tree_sitter_cpp import language
    except ImportError as error:
        raise GrammarMissing from error
    return Parser(Language(language()))


def text_of(node: Node | None) -> str:
    """The source of a node, blanks and comments as they are."""
    return "" if node is None or node.text is None else node.text.decode("utf-8", "replace")


def walk(node: Node, outside: frozenset[str] = frozenset()) -> Iterator[Node]:
    """A node and all below it, in order; what is inside of nodes of some types is left out."""
    stack = [node]
    while stack:
        node = stack.pop()
        yield node
        if node.type not in outside:
            stack.extend(reversed(node.named_children))


def errors(node: Node) -> Iterator[Node]:
    """The nodes that the grammar cannot read, and those that it misses."""
    waiting = [node]
    while waiting:  # expressions may be deep
        node = waiting.pop()
        if node.is_error or node.is_missing:
            yield node
        elif node.has_error:
            waiting.extend(reversed(node.children))


def field(node: Node, name: str) -> Node | None:
    """The child of a name."""
    return node.child_by_field_name(name)


def contents(node: Node | None) -> list[Node]:
    """The children that mean something."""
    return [] if node is None else [each for each in node.named_children if each.type != "comment"]


def arguments(call: Node) -> list[Node]:
    """The arguments of a call."""
    return contents(field(call, "arguments"))


def callee(call: Node) -> tuple[str, str, list[str]]:
    """The function of a call: the scope before its name, the name, and the arguments of a template."""
    return named(field(call, "function"))


def named(node: Node | None) -> tuple[str, str, list[str]]:
    """The scope, the name and the template's arguments of an expression or a type that names something."""
    scopes: list[str] = []
    templates: list[str] = []
    while node is not None:
        if node.type == "qualified_identifier":
            scopes.append(text_of(field(node, "scope")))
            node = field(node, "name")
        elif node.type == "dependent_name":
            node = contents(node)[0]
        elif node.type == "field_expression":
            node = field(node, "field")
        elif node.type in ("template_function", "template_method", "template_type"):
            templates = [text_of(each) for each in contents(field(node, "arguments"))]
            node = field(node, "name")
        else:
            return "::".join(scopes), text_of(node), templates
    return "", "", []


def literal(node: Node | None) -> str | None:
    """The string that a literal, or several in a row, are; None for anything else."""
    if node is None:
        return None
    if node.type == "concatenated_string":
        parts = [literal(part) for part in contents(node)]
        return None if None in parts else "".join(part or "" for part in parts)
    if node.type == "user_defined_literal":
        return literal(node.named_children[0])
    if node.type == "raw_string_literal":
        return "".join(text_of(part) for part in node.named_children if part.type == "raw_string_content")
    if node.type != "string_literal":
        return None
    return "".join(_ESCAPED.get(text_of(part), text_of(part)) for part in node.named_children)


def enclosing(node: Node, kinds: tuple[str, ...]) -> Node | None:
    """The innermost node of some types around another."""
    around = node.parent
    while around is not None and around.type not in kinds:
        around = around.parent
    return around


LAMBDAS: Final = frozenset(("lambda_expression",))
_EXPORTED: Final = re.compile(r"(\b(?:class|struct)\s+)([A-Z][A-Z0-9_]+)(?=\s+[A-Za-z_]\w*\s*(?:final\s*)?[:{])")
_CONDITIONAL: Final = re.compile(r"[ \t]*#[ \t]*(?:if|ifdef|ifndef|elif|else|endif)\b").match
_NO_CODE: Final = re.compile(r"//.*|\"(?:[^\"\\]|\\.)*\"|'[()]'|/\*.*?\*/")
_ESCAPED: Final = {"\\n": "\n", "\\t": "\t", '\\"': '"', "\\'": "'", "\\\\": "\\"}
