"""Strings, default values and types as C++ writes them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from btq_lang.cpp.grammar import arguments, callee, contents, field, literal, named, text_of
from btq_lang.cpp.source import substituted
from btq_lang.cpp.sources import BoundClass, CppSources

if TYPE_CHECKING:
    from tree_sitter import Node


class Frame:
    """The surroundings of an expression: its class, scope and file, and the meanings of names there.

    Attributes:
        bound: the class, if it is in one.
        strings: variables that are strings.
        depth: the number of functions around that called each other.
    """

    def __init__(self, bound: BoundClass | None, scope: tuple[str, ...], path: str, depth: int = 0) -> None:
        self.bound: Final = bound
        self.scope: Final = scope
        self.path: Final = path
        self.depth: Final = depth
        self.strings: Final[dict[str, str]] = {}

    @property
    def meanings(self) -> dict[str, str]:
        """The meanings of the parameters of templates."""
        return self.bound.meanings if self.bound is not None else {}


def string(sources: CppSources, node: Node | None, frame: Frame) -> str | None:
    """The string that an expression is: a literal, a constant, or either in `std::string(…)`."""
    if node is None:
        return None
    if (text := literal(node)) is not None:
        return text
    if node.type in ("identifier", "qualified_identifier"):
        name = text_of(node)
        if name in frame.strings:
            return frame.strings[name]
        return sources.string(substituted(name, frame.meanings), frame.bound, frame.scope, frame.path)
    if node.type == "call_expression":
        _, name, _ = callee(node)
        passed = arguments(node)
    elif node.type == "compound_literal_expression":
        _, name, _ = named(field(node, "type"))
        passed = contents(field(node, "value"))
    else:
        return None
    if name in _STRINGS:
        return string(sources, passed[0], frame) if passed else ""
    return None


def default(sources: CppSources, node: Node, frame: Frame) -> str | None:
    """The text of a default value; None if it is an expression."""
    if (text := string(sources, node, frame)) is not None:
        return text
    written = text_of(node)
    if node.type in ("true", "false"):
        return written
    if (number := _NUMBER.fullmatch(written)) is not None:
        return number[1].replace("'", "")
    if (status := _STATUS.fullmatch(written)) is not None:
        return status[1]
    return "inf" if _INFINITY.fullmatch(written) else None


def type_of(sources: CppSources, written: str, frame: Frame) -> str:
    """The type of a port: what an alias or a template's parameter means, else as it is written."""
    type_ = substituted(written, frame.meanings)
    ancestry = sources.ancestry(frame.bound) if frame.bound is not None else ()
    for scope in (frame.scope, *(each.scope for each in ancestry)):
        if (meant := sources.alias(type_, scope, frame.path)) is not None:
            return meant
    return type_


_STRINGS: Final = ("string", "string_view", "StringView")
_NUMBER: Final = re.compile(r"([+-]?(?:\d[\d']*\.?[\d']*|\.\d+)(?:[eE][+-]?\d+)?)(?:[fFlLuU]+|ms)?")
_STATUS: Final = re.compile(r"(?:BT::)?NodeStatus::([A-Z]+)")
_INFINITY: Final = re.compile(r"std::numeric_limits<\s*(?:double|float)\s*>::infinity\(\)")
