"""Constants on the ports of subtrees, as every version of the engine takes them.

Up to 4.8 the engine keeps what a SubTree says for a port as text, and the node that reads it converts it.  From 4.9.1
on a text that is a number becomes an `int`, an `int64_t` or a `double`, and the tree is not made when a node below has
another type on that entry: `level = 30` above a `double`, `limit = 500` above the `msec` of a Timeout.  So a number is
spelt as what the node below takes: `30.0` is a `double`; one with a blank behind it stays text, and is read as the
number, for the engine ignores what stands behind the digits.  (Tried with 4.6.2, 4.8.4 and 4.10.0.)

A number on a port of text has no spelling that all versions take.

One invariant: what is no number, or meets no type that is known, is left alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from btq_lang.catalog.nodes import BUILTINS, port_type, xml_tag
from btq_lang.symbols import Kind
from btq_lang.syntax import Model, Node, Port, Tree
from btq_lang.workspace import Scope

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final


def fitting(type_: str, raw: str) -> str:
    """A constant for a port of a subtree, spelt so that nodes below take it; as it is where it needs no other spelling.

    Args:
        type_: what `type_below` says of the port.
        raw: what stands between the quotes of the attribute.
    """
    if not is_number(raw):
        return raw
    is_whole = _WHOLE.fullmatch(raw) is not None
    if type_ == "double":
        return f"{raw}.0" if is_whole else raw
    if type_ == "int":
        return raw if is_whole and -_INT <= int(raw) < _INT else f"{raw} "
    if type_ == "bool":
        return _BOOLS.get(raw, raw)
    return f"{raw} " if type_ in _OTHER_NUMBERS else raw


def is_number(raw: str) -> bool:
    """Whether a constant is one that the engine takes for a number."""
    return _NUMBER.fullmatch(raw) is not None


def type_below(scope: Scope, target: str, tree: str, port: str) -> str:
    """The type that a port of a tree first meets in the tree or in those below it, else the one that is declared.

    Args:
        target: the version of the engine whose types count.

    Returns:
        the type as the engine prints it; nothing where nobody knows.
    """
    waiting = [(tree, port)]
    seen = set(waiting)
    declared = ""
    while waiting:
        name, key = waiting.pop()
        found = scope.find(Kind.TREE, name)
        if found is None or not isinstance(found.symbol.target, Tree):
            continue
        inside = found.symbol.target
        declared = declared or _declared(inside.ports, key)
        for node, meets in _uses(inside, key):
            if node.category is not None and node.category.raw == "SubTree":
                below = (node.id.text if node.id is not None else "", meets)
                waiting += [] if below in seen else [below]
                seen.add(below)
            elif type_ := _port_type(scope, target, node, meets):
                return type_
    return declared


def _uses(tree: Tree, key: str) -> Iterator[tuple[Node, str]]:
    """The nodes that an entry of a tree's blackboard is given to, and their ports."""
    for node in tree.walk():
        for pair in node.attributes:
            text = pair.value.text if pair.value is not None else ""
            if text == f"{{{key}}}" or (text == "{=}" and pair.key.text == key):
                yield node, pair.key.text


def _port_type(scope: Scope, target: str, node: Node, key: str) -> str:
    if node.id is None:
        return ""
    builtin = BUILTINS.get(xml_tag(node.id.text, node.id.quoted, len(node.children)))
    if builtin is not None:
        port = builtin.port(key)
        return _plain(port_type(port, target)) if port is not None else ""
    model = scope.find(Kind.MODEL, node.id.text)
    if model is None or not isinstance(model.symbol.target, Model):
        return ""
    return _declared(model.symbol.target.ports, key)


def _declared(ports: tuple[Port, ...], name: str) -> str:
    port = next((each for each in ports if each.name is not None and each.name.text == name), None)
    return _plain(port.type.text) if port is not None and port.type is not None else ""


def _plain(type_: str) -> str:
    return "" if type_ in ("BT::AnyTypeAllowed", "BT::Any") else type_


_INT: Final = 2**31
_NUMBER: Final = re.compile(r"-?[0-9]+(?:\.[0-9]*)?(?:[eE][+-]?[0-9]+)?")
_WHOLE: Final = re.compile(r"-?[0-9]+")
_BOOLS: Final = {"0": "false", "1": "true"}
_OTHER_NUMBERS: Final = frozenset(
    (
        *("float", "unsigned int", "unsigned", "long", "unsigned long", "short", "unsigned short", "size_t"),
        *(f"{std}{sign}int{bits}_t" for std in ("", "std::") for sign in ("", "u") for bits in (8, 16, 32, 64)),
    )
)
