"""The nodes of one tree, and what each of them is.

One invariant: it is made of the tree and of the categories that it asks for, so it holds for as long as these do.  It
does not know other trees.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, PLACEHOLDERS, NodeKind, lookup
from btq_lang.requirements.model import SourceNode
from btq_lang.syntax.tree import Node, NodeClause, Satisfices, Tags, Tree
from btq_lang.workspace.placeholders import is_placeholder

_TIMEOUT: Final = BUILTINS["Timeout"]


class TreeNodes:
    """The nodes of one tree.

    Attributes:
        path, item: where it stands.
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
        "_asked",
        "_by_name",
        "all",
        "by_tag",
        "called",
        "calls",
        "item",
        "name",
        "path",
        "qualities",
        "root",
        "timeouts",
    )

    def __init__(self, path: str, item: Tree, categories: Mapping[str, str]) -> None:
        """categories: of the models in scope, by their names."""
        self.path = path
        self.item = item
        self.name = item.name.text if item.name is not None else None
        self._asked: dict[str, str | None] = {}
        self.by_tag: dict[str, list[SourceNode]] = {}
        self.qualities: dict[int, str] = {}
        self._by_name: dict[str, list[SourceNode]] | None = None
        self.all = tuple(self._read(categories))
        subtrees = [(node.node.id, node) for node in self.all if node.category == "SubTree"]
        self.calls = tuple([(called.text, node) for called, node in subtrees if called is not None])
        self.timeouts = tuple([node for node in self.all if node.kind is _TIMEOUT])
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

    def fits(self, categories: Mapping[str, str]) -> bool:
        """Whether it would come out the same if it were made of these."""
        return all(categories.get(name) == category for name, category in self._asked.items())

    def let_go(self) -> None:
        """Nobody asks for these nodes any more.  As parents and children know each other they would stay, with the
        whole tree, until Python looks for garbage: while somebody types, for as long as a frame of the screen."""
        for node in self.all:
            node.children.clear()

    def _note(self, clauses: tuple[NodeClause, ...], nodes: list[SourceNode]) -> None:
        for clause in clauses:
            if isinstance(clause, Tags):
                for name in clause.names:
                    self.by_tag.setdefault(name.text, []).extend(nodes)
            elif isinstance(clause, Satisfices):
                for quality in clause.qualities:
                    for requirement in quality.requirements:
                        self.qualities[id(requirement)] = ".".join(name.text for name in quality.path.names)

    def _read(self, categories: Mapping[str, str]) -> list[SourceNode]:
        path, item, tree = self.path, self.item, self.name
        nodes: list[SourceNode] = []
        waiting: list[tuple[Node, SourceNode | None, int]] = []
        waiting += [(child, None, at) for at, child in enumerate(item.children) if isinstance(child, Node)]
        waiting.reverse()
        while waiting:
            node, parent, index = waiting.pop()
            kind, category = self._kind(node, categories)
            found = SourceNode(node, path, item, tree, parent, index, kind, category)
            if parent is not None:
                parent.children.append(found)
            nodes.append(found)
            if node.children:
                children = [(child, found, at) for at, child in enumerate(node.children) if isinstance(child, Node)]
                children.reverse()
                waiting += children
        return nodes

    def _kind(self, node: Node, categories: Mapping[str, str]) -> tuple[NodeKind | None, str | None]:
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
            category = self._asked[text] = categories.get(text)
            if category is None and not name.quoted and text in KNOWN_WORDS:
                category = KNOWN_WORDS[text].category
        return None, category
