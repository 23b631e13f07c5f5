"""What a check sees: one file in its workspace, with the look-ups that many checks need made once.

It decides nothing; a check that only one rule needs does not belong here.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

from btq_lang.catalog.nodes import NodeKind, lookup
from btq_lang.checks.calls import Calls
from btq_lang.diagnostics import Place, Related
from btq_lang.record import record
from btq_lang.symbols import Kind, Use
from btq_lang.syntax import Entry, Model, Node, Port, Tree
from btq_lang.workspace import Definition, File, Scope, Workspace


@record
class SeenNode:
    """A node with what is known of it.

    Attributes:
        parent: the node whose child it is; None for a tree's own.
        index: which child of its parent it is.
        kind: the built-in it is, if it is one.
        definition: its model, where one is in scope.
        category: as written, or as the built-in or the model has it; None where nobody says.
    """

    node: Node
    tree: Tree
    parent: SeenNode | None
    index: int
    kind: NodeKind | None
    definition: Definition | None
    category: str | None

    @property
    def model(self) -> Model | None:
        target = self.definition.symbol.target if self.definition else None
        return target if isinstance(target, Model) else None

    @property
    def shown(self) -> str:
        """The node as a message names it."""
        return f"`{self.node.head.text}`"

    @property
    def is_subtree(self) -> bool:
        return self.category == "SubTree"

    def ancestors(self) -> Iterator[SeenNode]:
        """Its parent, the parent's parent, and so on."""
        above = self.parent
        while above is not None:
            yield above
            above = above.parent


class View:
    """One file in its workspace."""

    def __init__(self, workspace: Workspace, path: str) -> None:
        self.workspace = workspace
        self.path = path
        self.file: File = workspace.files[path]
        self.scope: Scope = workspace.scope(path)
        self._nodes: dict[int, tuple[SeenNode, ...]] = {}

    def nodes(self, entry: Entry) -> tuple[SeenNode, ...]:
        """The nodes of a tree, depth first, in document order; none for any other item."""
        if not isinstance(entry.item, Tree):
            return ()
        known = self._nodes.get(id(entry))
        if known is None:
            known = self._nodes[id(entry)] = tuple(self._seen(entry.item))
        return known

    def uses(self, entry: Entry, kind: Kind) -> Iterator[Use]:
        """What an entry refers to, of one kind."""
        return (use for use in self.file.summary_of(entry).uses if use.kind is kind)

    @cached_property
    def calls(self) -> Calls:
        """Which tree runs which, of all trees in scope."""
        return Calls(self.workspace, self.scope)

    def _seen(self, tree: Tree) -> Iterator[SeenNode]:
        waiting: list[tuple[Node, SeenNode | None, int]] = []
        waiting += [(node, None, index) for index, node in reversed(_numbered(tree.children))]
        while waiting:
            node, parent, index = waiting.pop()
            seen = self._look_up(node, tree, parent, index)
            yield seen
            waiting += [(child, seen, number) for number, child in reversed(_numbered(node.children))]

    def _look_up(self, node: Node, tree: Tree, parent: SeenNode | None, index: int) -> SeenNode:
        category: str | None = node.category.raw if node.category else None
        name = node.id
        kind: NodeKind | None = None
        definition: Definition | None = None
        if name is not None and category != "SubTree":
            kind = lookup(name.text, name.quoted, len(node.nodes))
            if kind is None:
                definition = self.scope.find(Kind.MODEL, name.text)
        if category is None and kind is not None:
            category = kind.category
        elif category is None and definition is not None and isinstance(model := definition.symbol.target, Model):
            category = model.category.raw
        return SeenNode(node, tree, parent, index, kind, definition, category)

    def place(self, definition: Definition) -> Place:
        """Where a definition's name stands, to be shown beside a diagnostic."""
        return Place(definition.symbol.span, definition.path, definition.entry.item)

    def defined_at(self, definition: Definition, message: str) -> Related:
        return Related(self.place(definition), message)

    def is_this(self, definition: Definition, entry: Entry) -> bool:
        """Whether a definition stands in this file's `entry`."""
        return definition.path == self.path and definition.entry is entry


def subtree_ports(view: View, seen: SeenNode) -> tuple[Port, ...]:
    """The ports that the tree behind a SubTree declares, in its block or in a model of its own."""
    name = seen.node.id
    if name is None:
        return ()
    for kind in (Kind.TREE, Kind.MODEL):
        definition = view.scope.find(kind, name.text)
        if definition is not None and isinstance(target := definition.symbol.target, Tree | Model) and target.ports:
            return target.ports
    return ()


def _numbered(children: tuple[object, ...]) -> list[tuple[int, Node]]:
    return [(index, child) for index, child in enumerate(children) if isinstance(child, Node)]
