"""A node as checks see it.

One invariant: it is a plain class, so that it may be compiled (hatch_build.py): a file has as many as it has nodes, and
nearly every check looks at each.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.kinds import NodeKind
from btq_lang.syntax import Model, Node, Tree

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

    from btq_lang.workspace import Definition


class SeenNode:
    """A node with what is known of it.

    Attributes:
        parent: the node whose child it is; None for a tree's own.
        index: which child of its parent it is.
        kind: the built-in it is, if it is one; for an older engine's word the one of today.
        definition: where its model stands, where one is in scope.
        model: that model.
        category: as written, or as the built-in or the model has it; None where nobody says.
        is_subtree: whether that is SubTree.
        asked: the name that a model was looked for by; nothing where none was.
    """

    __slots__ = ("asked", "category", "definition", "index", "is_subtree", "kind", "model", "node", "parent", "tree")

    def __init__(
        self,
        node: Node,
        tree: Tree,
        parent: SeenNode | None,
        index: int,
        kind: NodeKind | None,
        definition: Definition | None,
        model: Model | None,
        category: str | None,
        asked: str,
    ) -> None:
        self.node: Final = node
        self.tree: Final = tree
        self.parent: Final = parent
        self.index: Final = index
        self.kind: Final = kind
        self.definition: Final = definition
        self.model: Final = model
        self.category: Final = category
        self.is_subtree: Final = category == "SubTree"
        self.asked: Final = asked

    @property
    def shown(self) -> str:
        """The node as a message names it."""
        return f"`{self.node.head.text}`"

    def ancestors(self) -> Iterator[SeenNode]:
        """Its parent, the parent's parent, and so on."""
        above = self.parent
        while above is not None:
            yield above
            above = above.parent
