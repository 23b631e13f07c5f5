"""The path of a node, as a requirement names it: `Deliver/Delivery/MoveBase`."""

from __future__ import annotations

from btq_lang.ide.block import node_at
from btq_lang.ide.meaning import entry_at
from btq_lang.syntax.tree import Node, Tree, is_name, written
from btq_lang.workspace.workspace import Workspace


def node_path(workspace: Workspace, path: str, offset: int) -> str | None:
    """The names of the tree and of all nodes down to the one at a place, instance names before kinds; unnamed control
    nodes that are symbols are left out, for no path can name them.  None if there is no node."""
    entry = entry_at(workspace, path, offset)
    standing = node_at(workspace.files[path], entry, offset) if entry is not None else None
    if standing is None or entry is None or not isinstance(entry.item, Tree):
        return None
    parents: dict[int, Node] = {id(child): node for node in entry.item.walk() for child in node.nodes}
    line: list[Node] = [standing.node]
    while (parent := parents.get(id(line[-1]))) is not None:
        line.append(parent)
    words = [entry.item.name, *(node.name or node.id for node in reversed(line))]
    names = [word.text for word in words if word is not None and (word.quoted or is_name(word.text))]
    return "/".join(map(written, names))
