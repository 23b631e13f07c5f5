"""The written nodes of a tree, and what each means from a viewpoint.

One invariant: the result depends on the tree and on what the models in scope declare, so an edit elsewhere leaves it
the same object unless such a category changes.  Neither other trees nor a model's ports are known here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Final

from btq_lang.catalog.kinds import Flow
from btq_lang.catalog.name_kinds import Kind
from btq_lang.diagnostics.model import Place
from btq_lang.syntax.tree import Node, NodeClause, Satisfices, Tags, Tree, Word
from btq_lang.workspace import inputs
from btq_lang.workspace.inputs import Declared
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.node_names import is_placeholder, kinds_of, meaning_of, names_of
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace


@inputs.of_scope
def tree_nodes(store: Store[Workspace], viewpoint: str, path: str, facts: Facts) -> ResolvedTree:
    """The nodes of a tree."""
    return ResolvedTree(path, facts, cache(lambda name: store.ask(inputs.declared, viewpoint, name)))


@inputs.of_scope
def tree_named(store: Store[Workspace], viewpoint: str, name: str) -> ResolvedTree | None:
    """The nodes of the tree with a name."""
    tree = store.ask(inputs.definition, viewpoint, Kind.TREE, name)
    return store.ask(tree_nodes, viewpoint, *tree) if tree is not None else None


@inputs.of_scope
def trees_called(store: Store[Workspace], viewpoint: str, name: str) -> tuple[str, ...]:
    """The trees that the tree with a name runs."""
    tree = store.ask(tree_named, viewpoint, name)
    return tree.called if tree is not None else ()


class ResolvedNode:
    """A written node, with its place in the tree and its meaning.  Equal only to itself: its place is its identity.


    Attributes:
        within: its tree.
        parent: None for a node at the top of its tree.
        index: among the children of its parent, counting verbatim XML.
        children: the nodes below it.
        id, name: of the node, from its attributes if they are not written before.
        is_placeholder: whether it represents a skill (placeholders.py).
        kind, behavior, of_model, category, is_outdated: its meaning (node_names.py).
        is_subtree: whether it runs another tree, under the name that the engine of today has for that.
    """

    __slots__ = (
        "_names",
        "behavior",
        "category",
        "children",
        "id",
        "index",
        "is_outdated",
        "is_placeholder",
        "is_subtree",
        "kind",
        "name",
        "node",
        "of_model",
        "parent",
        "within",
    )

    def __init__(
        self,
        node: Node,
        within: ResolvedTree,
        parent: ResolvedNode | None,
        index: int,
        declared: Callable[[str], Declared],
    ) -> None:
        self.node: Final = node
        self.within: Final = within
        self.parent: Final = parent
        self.index: Final = index
        self.children: list[ResolvedNode] = []  # filled while the tree is read
        self.id: Final = node.id
        self.name: Final[Word | None] = node.name
        self.is_placeholder: Final = is_placeholder(node)
        meaning = meaning_of(node, declared)
        self.kind: Final = meaning.kind
        self.behavior: Final = meaning.behavior
        self.of_model: Final = meaning.of_model
        self.category: Final = meaning.category
        self.is_outdated: Final = meaning.is_outdated
        self._names: frozenset[str] | None = None
        self.is_subtree: Final = self.category == "SubTree" and not self.is_outdated

    # ---- its place ----

    @property
    def path(self) -> str:
        """The file in which it is written."""
        return self.within.path

    @property
    def facts(self) -> Facts:
        """The facts of its item, by which queries identify it."""
        return self.within.facts

    @property
    def item(self) -> Tree:
        """The item from which its offsets count."""
        return self.within.item

    @property
    def tree(self) -> str | None:
        """The name of its tree; None if that is missing."""
        return self.within.name

    @property
    def place(self) -> Place:
        """The place of its head."""
        return Place(self.node.head.span, self.path, self.item)

    def ancestors(self) -> Iterator[ResolvedNode]:
        """Its parent, the parent's parent, and so on."""
        above = self.parent
        while above is not None:
            yield above
            above = above.parent

    # ---- its names ----

    @property
    def names(self) -> frozenset[str]:
        """Every name by which a path can name it: its ID, all spellings of its kind, its label."""
        if self._names is None:
            self._names = names_of(self.node, self.kind, self.category)
        return self._names

    @property
    def kinds(self) -> frozenset[str]:
        """The names of its kind, not of the instance."""
        return kinds_of(self.node, self.kind, self.category)

    @property
    def shown_kind(self) -> str:
        """The node as a message names it: its kind, or the word in its place."""
        return f"`{self.node.head.text}`"

    @property
    def shown(self) -> str:
        """The node as a message names it among others: its kind, and its instance name if it has one."""
        return self.node.shown

    # ---- what it means ----

    @property
    def flow(self) -> Flow:
        """The flow of its children; empty if it is unknown."""
        return self.behavior.flow if self.behavior is not None else ""

    @property
    def tag(self) -> str:
        """The built-in's tag; empty for a custom node."""
        return self.kind.tag if self.kind is not None else ""

    @property
    def is_defined(self) -> bool:
        """Whether a model of it is in scope."""
        return self.of_model is not None

    @property
    def stated_category(self) -> str | None:
        """Its category, unless only an older engine's word determines it."""
        return None if self.is_outdated else self.category

    def __repr__(self) -> str:
        return f"<{self.shown} in {self.tree}>"


class ResolvedTree:
    """The nodes of one tree.

    Attributes:
        path, facts, item: where it is written.
        name: None if that is missing.
        all: in the order of the text.
        root: the node at the top; None if there are none or several.
        calls: the SubTree nodes, each with the name of the tree that it runs.
        called: those names.
        by_tag: the nodes by their `tags`; a tag of the tree is one of its root.
        qualities: the quality that encloses a requirement in `Quality = performance (QualityReq …)`, by its `id`.
    """

    __slots__ = ("_by_name", "all", "by_tag", "called", "calls", "facts", "item", "name", "path", "qualities", "root")

    def __init__(self, path: str, facts: Facts, declared: Callable[[str], Declared]) -> None:
        """declared: returns what a node's model in scope declares, given the node's name."""
        item = facts.item
        assert isinstance(item, Tree), "only trees have nodes"
        self.path: Final = path
        self.facts: Final = facts
        self.item: Final = item
        self.name: Final = item.name.text if item.name is not None else None
        self.by_tag: Final[dict[str, list[ResolvedNode]]] = {}
        self.qualities: Final[dict[int, str]] = {}
        self._by_name: dict[str, list[ResolvedNode]] | None = None
        self.all: Final = tuple(self._read(declared))
        subtrees = [(node.id, node) for node in self.all if node.category == "SubTree"]
        self.calls: Final = tuple([(called.text, node) for called, node in subtrees if called is not None])
        self.called: Final = tuple([name for name, _ in self.calls])
        for node in self.all:
            if node.node.clauses:
                self._note(node.node.clauses, [node])
        tops = [node for node in self.all if node.parent is None]
        self.root: Final = tops[0] if len(tops) == 1 else None
        self._note(item.clauses, tops)

    @property
    def by_name(self) -> dict[str, list[ResolvedNode]]:
        """The nodes by every name that they have."""
        if self._by_name is None:
            self._by_name = {}
            for node in self.all:
                for name in node.names:
                    self._by_name.setdefault(name, []).append(node)
        return self._by_name

    def _note(self, clauses: tuple[NodeClause, ...], nodes: list[ResolvedNode]) -> None:
        for clause in clauses:
            if isinstance(clause, Tags):
                for name in clause.names:
                    self.by_tag.setdefault(name.text, []).extend(nodes)
            elif isinstance(clause, Satisfices):
                for quality in clause.qualities:
                    for requirement in quality.requirements:
                        self.qualities[id(requirement)] = quality.path.text

    def _read(self, declared: Callable[[str], Declared]) -> Iterator[ResolvedNode]:
        waiting: list[tuple[Node, ResolvedNode | None, int]] = []
        tops = [(child, None, place) for place, child in enumerate(self.item.children) if isinstance(child, Node)]
        waiting += reversed(tops)
        while waiting:
            node, parent, index = waiting.pop()
            resolved = ResolvedNode(node, self, parent, index, declared)
            if parent is not None:
                parent.children.append(resolved)
            yield resolved
            if node.children:
                children = [
                    (child, resolved, place) for place, child in enumerate(node.children) if isinstance(child, Node)
                ]
                waiting += reversed(children)
