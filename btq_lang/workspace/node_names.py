"""The names of written nodes, and what these mean.

One invariant: besides the node, only what its model declares counts, which the caller looks up.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import (
    BUILTINS,
    KNOWN_WORDS,
    PLACEHOLDERS,
    NodeKind,
    lookup,
    spellings,
    xml_tag,
)
from btq_lang.catalog.versions import VERSION_3
from btq_lang.syntax.tree import Node
from btq_lang.util.record import Record
from btq_lang.util.spelling import near
from btq_lang.workspace.inputs import Declared


class NodeMeaning(Record):
    """The meaning of a node.

    Attributes:
        kind: the built-in, if it is one and the program has no node of its own in its place; for an older engine's
            word, the one of today.
        behavior: the same, or the node of a library that btq knows; None if nothing is known of what it does.
        category: as written, or that of the built-in, the placeholder, the model or an older engine's word; None if
            unknown.
        of_model: the category of its model; None if no model of it is in scope.
        is_outdated: whether its category is that of an older engine's word which has no replacement today.
    """

    kind: NodeKind | None
    category: str | None
    of_model: str | None = None
    is_outdated: bool = False
    behavior: NodeKind | None = None


def meaning_of(node: Node, declared: Callable[[str], Declared]) -> NodeMeaning:
    """The meaning of a node.

    Args:
        declared: returns what a node's model in scope declares, given the node's name.
    """
    name = node.id
    category = node.category.raw if node.category is not None else None
    if name is None or category == "SubTree":
        return NodeMeaning(None, category)
    if is_placeholder(node):
        return NodeMeaning(None, PLACEHOLDERS[name.raw])
    kind = kind_of(node)
    if kind is not None and (kind.since == VERSION_3 or not declared(name.text)[2]):
        return NodeMeaning(kind, category or kind.category, behavior=kind)
    of_model, known_node, _ = declared(name.text)
    old_word = KNOWN_WORDS.get(name.text) if of_model is None and not name.quoted else None
    if old_word is None:
        return NodeMeaning(None, category or of_model, of_model, behavior=known_node)
    kind = BUILTINS.get(old_word.replacement or "")
    return NodeMeaning(
        kind, category or old_word.category, is_outdated=kind is None and category is None, behavior=kind
    )


def kind_of(node: Node) -> NodeKind | None:
    """The built-in that a node's word means; None for a custom node, and for one that runs another tree.  A placeholder
    has the word of a script node."""
    name = node.id
    if name is None or (node.category is not None and node.category.raw == "SubTree"):
        return None
    return lookup(name.text, name.quoted, len(node.nodes) if node.children else 0)


def wraps(kind: NodeKind, node: Node) -> bool | None:
    """Whether the first child of a node that takes turns follows its last, as it does without a port that says so; None
    if an entry determines it."""
    port = kind.port_for("wraps")
    value = node.attribute(port.name) if port is not None else None
    if port is None or value is None:
        return port is None
    return None if is_pointer(value.text) else value.text.lower() not in ("false", "0")


def copies(kind: NodeKind, node: Node) -> bool:
    """Whether a node that writes an entry copies another one, and so fails from 4.7 on if that has no value."""
    port = kind.port_for("copied")
    value = node.attribute(port.name) if port is not None else None
    return value is not None and is_pointer(value.text)


def tag_of(node: Node) -> str:
    """The XML tag of a node's word; a custom node's is its own name.  Verbatim XML counts among its children."""
    name = node.id
    return xml_tag(name.text, name.quoted, len(node.children)) if name is not None else ""


def names_of(node: Node, kind: NodeKind | None, category: str | None) -> frozenset[str]:
    """Every name by which a path can name a node: its ID, all spellings of its kind, its label."""
    label = node.name.text if node.name is not None else None
    names = _called(node.id.text if node.id is not None else None, label, kind.tag if kind else "", category)
    return names | {legal_name(label)} if label is not None and is_placeholder(node) else names


def kinds_of(node: Node, kind: NodeKind | None, category: str | None) -> frozenset[str]:
    """The names of a node's kind, not of the instance; a placeholder's name is both."""
    if is_placeholder(node):
        return names_of(node, kind, category)
    return _called(node.id.text if node.id is not None else None, None, kind.tag if kind else "", category)


def is_placeholder(node: Node) -> bool:
    """Whether a node is a classic placeholder (docs/language.md): a script node without code that represents a skill.

    Only the unquoted words are: the published language has no custom nodes, so its files write skills as
    `ScriptAction (name = "MoveBase")`.  A skill has no port that is a misspelt `code`.
    """
    return (
        node.kind is not None
        and node.kind.raw in PLACEHOLDERS
        and node.category is None
        and node.name is not None
        and not any(_means_code(pair.key.text) for pair in node.attributes)
    )


@lru_cache(1000)  # many nodes of a mission have equal names
def _called(name: str | None, label: str | None, tag: str, category: str | None) -> frozenset[str]:
    of_kind = spellings(BUILTINS[tag]) if tag else ()
    words = (name, label, category if category == "SubTree" else None, *of_kind)
    return frozenset([word for word in words if word is not None])


@lru_cache(1000)
def _means_code(key: str) -> bool:
    return key == "code" or bool(near(key, ("code",)))
