"""The types with which a tree reads the values that a SubTree passes to its ports.

One invariant: the result follows the engine: an entry of the tree is read as the type of each port to which it is
assigned, and a SubTree passes it on.  Unknown types, and those that accept anything, are left out.

Source: instantiateTreeFromXML in src/xml_parsing.cpp of 4.10.0.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.kinds import PortKind
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import BUILTINS, of_version
from btq_lang.syntax.tree import Model, Node, Pair, Port, Tree, port_named
from btq_lang.util.record import Record
from btq_lang.workspace.file import Definition
from btq_lang.workspace.node_names import tag_of
from btq_lang.workspace.workspace import Scope


class Meeting(Record):
    """A node's port to which an entry is assigned.

    Attributes:
        tree: of the node.
        type: of the port, as the engine prints it or as the node's model declares it.
        direction: of the port.
    """

    tree: Definition
    node: Node
    pair: Pair
    type: str
    direction: str


def meetings(scope: Scope, version: str, tree: str, port: str) -> Iterator[Meeting]:
    """The ports of a known type to which a port of a tree is assigned, in the tree and in those below it."""
    waiting = [(tree, port)]
    seen = set(waiting)
    for name, key in waiting:
        definition = scope.find(Kind.TREE, name)
        if definition is None or not isinstance(definition.symbol.target, Tree):
            continue
        for node in definition.symbol.target.walk():
            is_subtree = node.category is not None and node.category.raw == "SubTree"
            for pair in node.attributes:
                text = pair.value.text if pair.value is not None else ""
                meets = pair.key.text
                if text != f"{{{key}}}" and not (text == "{=}" and meets == key):
                    continue
                if not is_subtree:
                    type_, direction = _type_and_direction(scope, version, node, meets)
                    if type_:
                        yield Meeting(definition, node, pair, type_, direction)
                elif (below := (node.id.text if node.id is not None else "", meets)) not in seen:
                    waiting.append(below)
                    seen.add(below)


def as_kind(port: Port) -> PortKind:
    """A port that a tree or a model declares, as one of a built-in; required if it is an input without a default."""
    name, default = port.id, port.initial.text if port.initial is not None else None
    return PortKind(
        name.text if name is not None else "",
        port.direction.raw,  # type: ignore[arg-type]  # one of the parser's three
        port.type.text if port.type is not None else "",
        port.text.text if port.text is not None else "",
        default,
        name is not None and port.direction.raw == "input" and default is None,
    )


def declared_type(ports: tuple[Port, ...], name: str) -> str:
    """The declared type of a port; empty if it has none that restricts values."""
    port = port_named(ports, name)
    return _plain(port.type.text) if port is not None and port.type is not None else ""


def is_text(type_: str) -> bool:
    """Whether a type is one of texts."""
    return type_ in ("std::string", "string")


def is_number(text: str) -> bool:
    """Whether the engine (from 4.9.1 on) turns a SubTree's port value into a number: all of it must be one.

    Source: std::from_chars, for an int and for a double.
    """
    return text[:1] in _BEGINS_NUMBER and _NUMBER.fullmatch(text) is not None


def _type_and_direction(scope: Scope, version: str, node: Node, key: str) -> tuple[str, str]:
    if node.id is None:
        return "", ""
    builtin = BUILTINS.get(tag_of(node))
    if builtin is not None:
        port = builtin.port(key)
        return (_plain(of_version(port, version).type), port.direction) if port is not None else ("", "")
    model = scope.target(Kind.MODEL, node.id.text)
    declared = port_named(model.ports, key) if isinstance(model, Model) else None
    return (_plain(declared.type.text), declared.direction.raw) if declared and declared.type else ("", "")


def _plain(type_: str) -> str:
    return "" if type_ in ("BT::AnyTypeAllowed", "BT::Any") else type_


_BEGINS_NUMBER: Final = frozenset("-.0123456789iInN")  # most values do not, and the pattern takes long to compile
_NUMBER: Final = re.compile(
    r"-?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|(?i:inf(?:inity)?|nan(?:\([0-9A-Za-z_]*\))?))"
)
