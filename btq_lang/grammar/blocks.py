"""The open blocks while a tree is parsed.

One invariant: a node gets its children when its block closes, all at once.
"""

from __future__ import annotations

from typing import Final

from btq_lang.syntax.tree import Node, NodeClause, Verbatim

MAX_DEPTH: Final = 256  # levels below a BehaviorTree; the engine's limit (4.9 and later)
OF_ITS_OWN: Final = "move a part of them into a BehaviorTree of its own and call it with SubTree"


class Block:
    """The open block of a node, or of the tree itself, with what has been parsed so far."""

    __slots__ = ("children", "clauses", "level", "node")

    def __init__(self, level: int, node: Node | None) -> None:
        self.level: Final = level  # of the line that opened it
        self.node: Final = node
        self.clauses: list[NodeClause] = []
        self.children: list[Node | Verbatim] = []

    def has_nodes(self) -> bool:
        return any(isinstance(child, Node) for child in self.children)

    def close(self) -> None:
        if self.node is not None:
            self.node.children = tuple(self.children)
            if self.clauses:
                self.node.clauses += tuple(self.clauses)
