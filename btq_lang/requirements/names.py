"""By which names a written node is found.

One invariant: a name is what is written, or a spelling of the built-in that is written.
"""

from __future__ import annotations

from functools import lru_cache

from btq_lang.catalog.kinds import NodeKind
from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import BUILTINS, spellings
from btq_lang.syntax.tree import Node
from btq_lang.workspace.placeholders import is_placeholder


def names_of(node: Node, kind: NodeKind | None, category: str | None) -> frozenset[str]:
    """Every name that a path can call a node by: its ID, all spellings of its kind, its label."""
    label = node.name.text if node.name is not None else None
    found = _called(node.id.text if node.id is not None else None, label, kind.tag if kind else "", category)
    return found | {legal_name(label)} if label is not None and is_placeholder(node) else found


def kinds_of(node: Node, kind: NodeKind | None, category: str | None) -> frozenset[str]:
    """The names of a node that say what it is, and not which one; a placeholder's name says both."""
    if is_placeholder(node):
        return names_of(node, kind, category)
    return _called(node.id.text if node.id is not None else None, None, kind.tag if kind else "", category)


@lru_cache(1000)  # most nodes of a mission are called as others of it are
def _called(name: str | None, label: str | None, tag: str, category: str | None) -> frozenset[str]:
    of_kind = spellings(BUILTINS[tag]) if tag else ()
    words = (name, label, category if category == "SubTree" else None, *of_kind)
    return frozenset([word for word in words if word is not None])
