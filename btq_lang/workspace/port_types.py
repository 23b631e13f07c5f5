"""The types that what a SubTree gives to a port meets in the tree below it.

One invariant: the answer follows the engine: an entry of the tree, given to a node's port, meets the type of that port,
and a SubTree in there hands it on.  A type that nobody knows, and one that takes anything, is no type.

Source: instantiateTreeFromXML in src/xml_parsing.cpp of 4.10.0.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import BUILTINS, port_type
from btq_lang.syntax.tree import Model, Node, Pair, Port, Tree
from btq_lang.util.record import Record
from btq_lang.workspace.node_names import tag_of

if TYPE_CHECKING:
    from btq_lang.workspace.file import Definition
    from btq_lang.workspace.workspace import Scope


class Meeting(Record):
    """A node's port that an entry is given to.

    Attributes:
        tree: where the node stands.
        type: of the port, as the engine prints it or as the node's model says.
    """

    tree: Definition
    node: Node
    pair: Pair
    type: str


def meetings(scope: Scope, version: str, tree: str, port: str) -> Iterator[Meeting]:
    """The ports of a known type that a port of a tree meets, in the tree and in those below it.

    Args:
        version: of the engine whose types count.
    """
    waiting = [(tree, port)]
    seen = set(waiting)
    for name, key in waiting:
        found = scope.find(Kind.TREE, name)
        if found is None or not isinstance(found.symbol.target, Tree):
            continue
        for node in found.symbol.target.walk():
            is_subtree = node.category is not None and node.category.raw == "SubTree"
            for pair in node.attributes:
                text = pair.value.text if pair.value is not None else ""
                meets = pair.key.text
                if text != f"{{{key}}}" and not (text == "{=}" and meets == key):
                    continue
                if not is_subtree:
                    if type_ := _port_type(scope, version, node, meets):
                        yield Meeting(found, node, pair, type_)
                elif (below := (node.id.text if node.id is not None else "", meets)) not in seen:
                    waiting.append(below)
                    seen.add(below)


def declared_type(ports: tuple[Port, ...], name: str) -> str:
    """The type that a port is declared with; nothing where it has none that says something."""
    port = next((each for each in ports if each.name is not None and each.name.text == name), None)
    return _plain(port.type.text) if port is not None and port.type is not None else ""


def is_text(type_: str) -> bool:
    """Whether a type is that of texts."""
    return type_ in ("std::string", "string")


def is_number(text: str) -> bool:
    """Whether the engine (from 4.9.1 on) makes a number of what a SubTree gives to a port: all of it must be one.

    Source: std::from_chars, for an int and for a double.
    """
    return text[:1] in _BEGINS_NUMBER and _NUMBER.fullmatch(text) is not None


def _port_type(scope: Scope, version: str, node: Node, key: str) -> str:
    if node.id is None:
        return ""
    builtin = BUILTINS.get(tag_of(node))
    if builtin is not None:
        port = builtin.port(key)
        return _plain(port_type(port, version)) if port is not None else ""
    model = scope.find(Kind.MODEL, node.id.text)
    if model is None or not isinstance(model.symbol.target, Model):
        return ""
    return declared_type(model.symbol.target.ports, key)


def _plain(type_: str) -> str:
    return "" if type_ in ("BT::AnyTypeAllowed", "BT::Any") else type_


_BEGINS_NUMBER: Final = frozenset("-.0123456789iInN")  # most values do not, and the pattern takes long to compile
_NUMBER: Final = re.compile(
    r"-?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|(?i:inf(?:inity)?|nan(?:\([0-9A-Za-z_]*\))?))"
)
