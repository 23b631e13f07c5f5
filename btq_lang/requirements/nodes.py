"""Which written nodes a path, a kind or a tag means, in a file and what it includes.

One invariant: a node is found by what is written, never by what a run makes of it; a path that leads through SubTree
nodes says so in its target.  It complains of nothing: no node, or several, is the caller's to tell.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.catalog.names import legal_name
from btq_lang.catalog.nodes import KNOWN_WORDS, PLACEHOLDERS, NodeKind, lookup, spellings
from btq_lang.placeholders import is_placeholder
from btq_lang.requirements.model import SourceNode, Target
from btq_lang.symbols import Kind
from btq_lang.syntax import Entry, Model, Node, Tags, Tree
from btq_lang.workspace import Scope, Workspace


class Nodes:
    """The written nodes of a file and what it includes.

    Attributes:
        all: in the order of the files and of their text.
    """

    def __init__(self, workspace: Workspace, scope: Scope) -> None:
        found: list[SourceNode] = []
        self._roots: dict[str, SourceNode] = {}
        self._of_entry: dict[int, list[SourceNode]] = {}
        self._of_node: dict[int, SourceNode] = {}
        self._by_name: dict[str, list[SourceNode]] = {}
        self._callers: dict[str, list[SourceNode]] = {}
        for path in scope.paths:
            for entry in workspace.files[path].parsed.entries:
                if isinstance(entry.item, Tree):
                    found += self._read(scope, path, entry, entry.item)
        self.all = tuple(found)
        for node in found:
            self._of_node[id(node.node)] = node
            for name in node.names:
                self._by_name.setdefault(name, []).append(node)
            if node.category == "SubTree" and node.node.id is not None:
                self._callers.setdefault(node.node.id.text, []).append(node)

    def root(self, tree: str) -> SourceNode | None:
        """The written root of a tree; None where the tree has none, or nobody knows it."""
        return self._roots.get(tree)

    def root_of(self, entry: Entry) -> SourceNode | None:
        """The written root of the tree that stands in an entry; None where it has none, or several."""
        tops = [node for node in self._of_entry.get(id(entry), ()) if node.parent is None]
        return tops[0] if len(tops) == 1 else None

    def within(self, entry: Entry) -> Sequence[SourceNode]:
        """The nodes of the tree that stands in an entry, in the order of its text."""
        return self._of_entry.get(id(entry), ())

    def of(self, node: Node) -> SourceNode | None:
        """A node of the syntax as one of these."""
        return self._of_node.get(id(node))

    def callers(self, tree: str | None) -> tuple[SourceNode, ...]:
        """The SubTree nodes that run a tree."""
        return tuple(self._callers.get(tree, ())) if tree is not None else ()

    def find(self, names: Sequence[str]) -> tuple[Target, ...]:
        """The nodes that a path names: the last name's, below nodes or trees of the other names in their order, with
        any others between them.  A SubTree node and the root of its tree are one: the root where the path holds for
        every instance of the tree, else the SubTree node."""
        last, above = names[-1], tuple(names[:-1])
        root = self._roots.get(last)
        matching = (self._target(node, above, False) for node in self._by_name.get(last, ()) if node is not root)
        found = [target for target in matching if target is not None]
        of_tree = self._target(root, above, True) if root is not None else None
        if of_tree is None:
            return tuple(found)
        others = [target for target in found if not _runs(target.node, last)]
        if not of_tree.through or len(others) == len(found):
            return (of_tree, *others)
        return tuple(found)

    def every(self, name: str) -> tuple[SourceNode, ...]:
        """The nodes of an ID or kind; a tree's name, where no SubTree runs it, is its root."""
        found = [node for node in self._by_name.get(name, ()) if name in kinds(node)]
        if not found and (root := self._roots.get(name)) is not None:
            return (root,)
        return tuple(found)

    def tagged(self, tag: str) -> tuple[SourceNode, ...]:
        """The nodes with a tag; a tag of a tree is one of its root."""
        return tuple(node for node in self.all if tag in _tags(node))

    def tags(self) -> frozenset[str]:
        """Every tag that a node has."""
        return frozenset(tag for node in self.all for tag in _tags(node))

    def under(self, nodes: Sequence[SourceNode], top: Target) -> tuple[SourceNode, ...]:
        """Those of the nodes that stand below a node, or in a tree that runs below it."""
        below = self._below(top.node)
        return tuple(node for node in nodes if id(node) in below)

    def names(self) -> tuple[str, ...]:
        """Every name that a path can have in it."""
        return (*self._by_name, *self._roots)

    def _read(self, scope: Scope, path: str, entry: Entry, tree: Tree) -> Iterator[SourceNode]:
        name = tree.name.text if tree.name is not None else None
        mine = self._of_entry.setdefault(id(entry), [])
        waiting: list[tuple[Node, SourceNode | None, int]] = []
        waiting += [(child, None, at) for at, child in enumerate(tree.children) if isinstance(child, Node)]
        waiting.reverse()
        while waiting:
            node, parent, index = waiting.pop()
            kind, category = _kind(scope, node)
            found = SourceNode(node, path, entry, name, parent, index, kind, category, _names(node, kind, category))
            if parent is not None:
                parent.children.append(found)
            mine.append(found)
            yield found
            if node.children:
                children = [(child, found, at) for at, child in enumerate(node.children) if isinstance(child, Node)]
                waiting += reversed(children)
        definition = scope.find(Kind.TREE, name) if name is not None else None
        if name is not None and definition is not None and definition.entry is entry:
            root = self.root_of(entry)
            if root is not None:
                self._roots[name] = root

    def _target(self, node: SourceNode, above: tuple[str, ...], is_tree: bool) -> Target | None:
        """The node as a target of a path with these other names, if they are found above it.

        Args:
            is_tree: the path's last name was the tree's, so the tree is no step above the node.
        """
        left = len(above)
        at = None if is_tree else node.parent
        while left and at is not None:
            left -= above[left - 1] in at.names
            at = at.parent
        if left and not is_tree and above[left - 1] == node.tree:
            left -= 1
        if not left:
            return Target(node)
        matched, missed = self._chains(node.tree, above, left)
        return (Target(node, above[:left]) if missed else Target(node)) if matched else None

    def _chains(self, tree: str | None, above: tuple[str, ...], left: int) -> tuple[bool, bool]:
        """Whether the names that are left are found above a tree on some way, and whether they are missing on some.
        Each step is a SubTree node with what is above it; its tree's own name is none of its names here."""
        matched = missed = False
        seen: set[tuple[str | None, int]] = set()
        waiting = [(tree, left)]
        while waiting:
            state = waiting.pop()
            if state in seen:
                continue
            seen.add(state)
            called, wanted = state
            callers = self.callers(called)
            missed = missed or not callers
            for caller in callers:
                open_ = wanted
                at: SourceNode | None = caller
                while open_ and at is not None:
                    if above[open_ - 1] in at.names and not (at is caller and above[open_ - 1] == called):
                        open_ -= 1
                    at = at.parent
                if open_ and above[open_ - 1] == caller.tree:
                    open_ -= 1
                if open_:
                    waiting.append((caller.tree, open_))
                else:
                    matched = True
        return matched, missed

    def _below(self, top: SourceNode) -> set[int]:
        found: set[int] = set()
        waiting = [top]
        while waiting:
            node = waiting.pop()
            for child in (*node.children, *self._inside(node)):
                if id(child) not in found:
                    found.add(id(child))
                    waiting.append(child)
        return found

    def _inside(self, node: SourceNode) -> Iterator[SourceNode]:
        """The root of the tree that a SubTree node runs."""
        name = node.node.id
        if node.category == "SubTree" and name is not None and (root := self._roots.get(name.text)) is not None:
            yield root


def _runs(node: SourceNode, tree: str) -> bool:
    """Whether it is a SubTree node of that tree, whatever its label."""
    return node.category == "SubTree" and node.node.id is not None and node.node.id.text == tree


def _kind(scope: Scope, node: Node) -> tuple[NodeKind | None, str | None]:
    """The built-in that a node is, and its category."""
    category: str | None = node.category.raw if node.category is not None else None
    name = node.id
    if name is None or category == "SubTree":
        return None, category
    if is_placeholder(node):
        return None, PLACEHOLDERS[name.raw]
    kind = lookup(name.text, name.quoted, len(node.nodes))
    if kind is not None:
        return kind, category or kind.category
    if category is None:
        definition = scope.find(Kind.MODEL, name.text)
        if definition is not None and isinstance(model := definition.symbol.target, Model):
            category = model.category.raw
        elif not name.quoted and name.text in KNOWN_WORDS:
            category = KNOWN_WORDS[name.text].category
    return None, category


def _names(node: Node, kind: NodeKind | None, category: str | None) -> frozenset[str]:
    name, label = node.id, node.name
    found = {name.text} if name is not None else set()
    if kind is not None:
        found.update(spellings(kind))
    if category == "SubTree":
        found.add("SubTree")
    if label is not None:
        found.add(label.text)
        if is_placeholder(node):
            found.add(legal_name(label.text))
    return frozenset(found)


def kinds(node: SourceNode) -> frozenset[str]:
    """The names of a node that say what it is, and not which one; a placeholder's name says both."""
    if is_placeholder(node.node):
        return node.names
    found = {node.node.id.text} if node.node.id is not None else set()
    found.update(spellings(node.kind) if node.kind is not None else ())
    return frozenset(found | {"SubTree"} if node.category == "SubTree" else found)


def _tags(node: SourceNode) -> Iterator[str]:
    tree = node.entry.item
    clauses = tree.clauses if isinstance(tree, Tree) and node.parent is None else ()
    for clause in (*node.node.clauses, *clauses):
        if isinstance(clause, Tags):
            yield from (name.text for name in clause.names)
