"""The nodes of one tree, and what each of them is.

One invariant: it is made of the tree and of the categories that it asks for.  It does not know other trees.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import KNOWN_WORDS, PLACEHOLDERS, NodeKind, lookup
from btq_lang.requirements.model import SourceNode
from btq_lang.syntax.tree import Node, NodeClause, Satisfices, Tags, Tree
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.placeholders import is_placeholder
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace


def tree_nodes(store: Store[Workspace], viewpoint: str, path: str, facts: Facts) -> TreeNodes:
    """The nodes of a tree.

    Args:
        path, facts: where it is written.
    """
    return TreeNodes(path, facts, cache(partial(inputs.category, store, viewpoint)))


def tree_named(store: Store[Workspace], viewpoint: str, name: str) -> TreeNodes | None:
    """The nodes of the tree that a name means."""
    found = inputs.definition(store, viewpoint, Kind.TREE, name)
    return store.ask(tree_nodes, viewpoint, *found) if found is not None else None


def trees_called(store: Store[Workspace], viewpoint: str, name: str) -> tuple[str, ...]:
    """The trees that the tree runs that a name means."""
    tree = store.ask(tree_named, viewpoint, name)
    return tree.called if tree is not None else ()


class TreeNodes:
    """The nodes of one tree.

    Attributes:
        path, facts, item: where it is written.
        name: None where that is missing.
        all: in the order of the text.
        root: the node at the top; None where there is none, or several.
        timeouts: the Timeout nodes.
        calls: the SubTree nodes, each with the name of the tree that it runs.
        called: those names.
        by_tag: the nodes by their tags; a tag of the tree is one of its root.
        qualities: the quality that encloses a requirement in `Quality = performance (QualityReq …)`, by its `id`.
    """

    __slots__ = (
        "_by_name",
        "all",
        "by_tag",
        "called",
        "calls",
        "facts",
        "item",
        "name",
        "path",
        "qualities",
        "root",
        "timeouts",
    )

    def __init__(self, path: str, facts: Facts, category: Callable[[str], str | None]) -> None:
        """category: that of a model in scope."""
        item = facts.item
        assert isinstance(item, Tree), "only trees have nodes"
        self.path = path
        self.facts = facts
        self.item = item
        self.name = item.name.text if item.name is not None else None
        self.by_tag: dict[str, list[SourceNode]] = {}
        self.qualities: dict[int, str] = {}
        self._by_name: dict[str, list[SourceNode]] | None = None
        self.all = tuple(self._read(category))
        subtrees = [(node.node.id, node) for node in self.all if node.category == "SubTree"]
        self.calls = tuple([(called.text, node) for called, node in subtrees if called is not None])
        self.timeouts = tuple([node for node in self.all if node.flow == "timeout"])
        self.called = tuple([name for name, _ in self.calls])
        for node in self.all:
            if node.node.clauses:
                self._note(node.node.clauses, [node])
        tops = [node for node in self.all if node.parent is None]
        self.root = tops[0] if len(tops) == 1 else None
        self._note(item.clauses, tops)

    @property
    def by_name(self) -> dict[str, list[SourceNode]]:
        """The nodes by every name that they have."""
        if self._by_name is None:
            self._by_name = {}
            for node in self.all:
                for name in node.names:
                    self._by_name.setdefault(name, []).append(node)
        return self._by_name

    def _note(self, clauses: tuple[NodeClause, ...], nodes: list[SourceNode]) -> None:
        for clause in clauses:
            if isinstance(clause, Tags):
                for name in clause.names:
                    self.by_tag.setdefault(name.text, []).extend(nodes)
            elif isinstance(clause, Satisfices):
                for quality in clause.qualities:
                    for requirement in quality.requirements:
                        self.qualities[id(requirement)] = ".".join(name.text for name in quality.path.names)

    def _read(self, category_of: Callable[[str], str | None]) -> list[SourceNode]:
        path, facts, item, tree = self.path, self.facts, self.item, self.name
        nodes: list[SourceNode] = []
        waiting: list[tuple[Node, SourceNode | None, int]] = []
        waiting += [(child, None, at) for at, child in enumerate(item.children) if isinstance(child, Node)]
        waiting.reverse()
        while waiting:
            node, parent, index = waiting.pop()
            kind, category = _kind(node, category_of)
            found = SourceNode(node, path, facts, item, tree, parent, index, kind, category)
            if parent is not None:
                parent.children.append(found)
            nodes.append(found)
            if node.children:
                children = [(child, found, at) for at, child in enumerate(node.children) if isinstance(child, Node)]
                children.reverse()
                waiting += children
        return nodes


def _kind(node: Node, category_of: Callable[[str], str | None]) -> tuple[NodeKind | None, str | None]:
    """The built-in that a node is, and its category."""
    category: str | None = node.category.raw if node.category is not None else None
    name = node.id
    if name is None or category == "SubTree":
        return None, category
    if is_placeholder(node):
        return None, PLACEHOLDERS[name.raw]
    text = name.text
    kind = lookup(text, name.quoted, len(node.nodes) if node.children else 0)
    if kind is not None:
        return kind, category or kind.category
    if category is None:
        category = category_of(text)
        if category is None and not name.quoted and text in KNOWN_WORDS:
            category = KNOWN_WORDS[text].category
    return None, category
