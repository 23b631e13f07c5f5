"""A node as checks see it, and the nodes of a tree, sorted by what checks look for.

One invariant: these are plain classes, so that they may be compiled (hatch_build.py): a file has as many nodes as it
has, and nearly every check would look at each.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.workspace.placeholders import is_placeholder

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Flow, NodeKind
    from btq_lang.syntax.tree import Model, Node, Tree, Word


class SeenNode:
    """A node with what is known of it.

    Attributes:
        parent: the node whose child it is; None for a tree's own.
        index: which child of its parent it is.
        kind: the built-in it is, if it is one; for an older engine's word the one of today.
        is_defined: a model of it is in scope.
        model: that model.
        category: as written, or as the built-in or the model has it; None where nobody says.
        id, name: those of the node, which are looked for in its attributes if they are nowhere else.
        is_subtree: whether the category is SubTree.
        is_placeholder: it represents a skill, see placeholders.py.
        asked: the name that a model was looked for by; nothing where none was.
    """

    __slots__ = (
        "asked",
        "category",
        "id",
        "index",
        "is_defined",
        "is_placeholder",
        "is_subtree",
        "kind",
        "model",
        "name",
        "node",
        "parent",
        "tree",
    )

    def __init__(
        self,
        node: Node,
        tree: Tree,
        parent: SeenNode | None,
        index: int,
        kind: NodeKind | None,
        is_defined: bool,
        model: Model | None,
        category: str | None,
        asked: str,
        id: Word | None,
    ) -> None:
        self.node: Final = node
        self.tree: Final = tree
        self.parent: Final = parent
        self.index: Final = index
        self.kind: Final = kind
        self.is_defined: Final = is_defined
        self.model: Final = model
        self.category: Final = category
        self.id: Final = id
        self.name: Final = node.name
        self.is_subtree: Final = category == "SubTree"
        self.is_placeholder: Final = is_placeholder(node)
        self.asked: Final = asked

    @property
    def flow(self) -> Flow:
        """What the built-in does with its children; empty for a custom node."""
        return self.kind.flow if self.kind is not None else ""

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


class SeenNodes:
    """The nodes of a tree, each list of them depth first, in document order.

    Attributes:
        all: all of them.
        given: those with attributes.
        marked: those with attributes that are no port by their first letter, as `_while`.
        demanding: those with clauses.
        categorized: those whose category is written.
        subtrees: those that run another tree.
        named: those with an instance name.
        placeholders: those that represent a skill.
        strangers: those that are neither a built-in nor a SubTree, and have no model.
        by_tag: the built-ins, by their tag.
    """

    __slots__ = (
        "all",
        "by_tag",
        "categorized",
        "demanding",
        "given",
        "marked",
        "named",
        "placeholders",
        "strangers",
        "subtrees",
    )

    def __init__(self, nodes: tuple[SeenNode, ...]) -> None:
        self.all: Final = nodes
        self.given: Final = [seen for seen in nodes if seen.node.attributes]
        self.marked: Final = [seen for seen in self.given if _is_marked(seen.node)]
        self.demanding: Final = [seen for seen in nodes if seen.node.clauses]
        self.named: Final = [seen for seen in nodes if seen.name is not None]
        self.categorized: Final = [seen for seen in nodes if seen.node.category is not None]
        self.subtrees: Final = [seen for seen in nodes if seen.is_subtree]
        self.placeholders: Final = [seen for seen in nodes if seen.is_placeholder]
        self.strangers: Final = [
            seen for seen in nodes if seen.kind is None and not seen.is_defined and not seen.is_subtree
        ]
        self.by_tag: Final[dict[str, list[SeenNode]]] = {}
        for seen in nodes:
            if seen.kind is not None:
                self.by_tag.setdefault(seen.kind.tag, []).append(seen)

    def of_flow(self, *flows: Flow) -> list[SeenNode]:
        """The built-ins of these flows, tag by tag."""
        return [seen for same in self.by_tag.values() if same[0].flow in flows for seen in same]


def _is_marked(node: Node) -> bool:
    return any(not pair.key.raw[:1].isalpha() for pair in node.attributes)


NO_NODES: Final = SeenNodes(())
