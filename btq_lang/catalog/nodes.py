"""Looking up node kinds: what a word in a file stands for in the engine.

One invariant: a quoted kind is the XML tag verbatim, never a symbol or an alias.  It does not know a file's own models
nor its placeholders: whether a name that is found nowhere is a custom node is decided by those who have read the file.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from btq_lang.catalog.engine_nodes import ENGINE_NODES
from btq_lang.catalog.kinds import Category, Direction, Execution, NodeKind, PortKind
from btq_lang.catalog.versions import at_least
from btq_lang.catalog.words import KNOWN_WORDS, OLD_PORTS, PLACEHOLDERS, KnownWord

__all__ = [
    "BUILTINS",
    "KNOWN_WORDS",
    "OLD_PORTS",
    "PLACEHOLDERS",
    "Category",
    "Direction",
    "Execution",
    "KnownWord",
    "NodeKind",
    "PortKind",
    "available",
    "lookup",
    "port_type",
    "spellings",
    "xml_tag",
]


def lookup(word: str, quoted: bool = False, child_count: int | None = None) -> NodeKind | None:
    """The built-in that a node's kind stands for, or None: then it is a custom node.

    Args:
        quoted: the kind stood in quotes.
        child_count: how many children the node has; it chooses among Switch2 to Switch6, the nearest where none fits.
    """
    if quoted:
        return BUILTINS.get(word)
    if word == "Switch":
        cases = min(max((child_count or 0) - 1, 2), 6)
        return BUILTINS[f"Switch{cases}"]
    return _BY_SPELLING.get(word)


def xml_tag(word: str, quoted: bool = False, child_count: int | None = None) -> str:
    """The XML tag that is written for a node's kind; a custom node's is its own name."""
    kind = lookup(word, quoted, child_count)
    if kind is not None:
        return kind.tag
    known = None if quoted else KNOWN_WORDS.get(word)
    return word if known is None else known.tag


def spellings(kind: NodeKind) -> tuple[str, ...]:
    """Every way to write a kind, the tag first."""
    return (kind.tag, *kind.symbols, *kind.aliases)


def available(kind: NodeKind, version: str) -> bool:
    """Does that version of the engine have the node?"""
    return at_least(version, kind.since) and (kind.until is None or at_least(kind.until, version))


def port_type(port: PortKind, version: str) -> str:
    """The type that a version of the engine gives a port."""
    if port.type_before is not None and not at_least(version, port.type_before[0]):
        return port.type_before[1]
    return port.type


# By XML tag.
BUILTINS: Final[Mapping[str, NodeKind]] = {kind.tag: kind for kind in ENGINE_NODES}

_BY_SPELLING: Final = {spelling: kind for kind in ENGINE_NODES for spelling in spellings(kind)}
