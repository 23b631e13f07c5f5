"""The written nodes that a path, a kind or a tag means, in a file and what it includes.

One invariant: a node is found by what is written, never by its instances in a run; the target of a path that leads
through SubTree nodes names them.  Callers report paths with no node or several.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from btq_lang.requirements.model import Target
from btq_lang.syntax.tree import Node, Tree
from btq_lang.util.reach import reached
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode, ResolvedTree, tree_named, tree_nodes
from btq_lang.workspace.workspace import Workspace

# ---- queries, one each, so that an equal result ends the recomputation after an edit ----


def nodes(store: Store[Workspace], viewpoint: str) -> Nodes:
    """All written nodes in scope."""
    return Nodes([store.ask(tree_nodes, viewpoint, path, facts) for path, facts in inputs.trees(store, viewpoint)])


def find(store: Store[Workspace], viewpoint: str, names: tuple[str, ...]) -> tuple[Target, ...]:
    """The nodes that a path means, as for `Nodes.find`."""
    return store.ask(nodes, viewpoint).find(names)


def every(store: Store[Workspace], viewpoint: str, name: str) -> tuple[ResolvedNode, ...]:
    """The nodes of an ID or kind, as for `Nodes.every`."""
    return store.ask(nodes, viewpoint).every(name)


def has_any(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    """Whether there are any of these."""
    return bool(store.ask(every, viewpoint, name))


def tagged(store: Store[Workspace], viewpoint: str, tag: str) -> tuple[ResolvedNode, ...]:
    """The nodes with a tag."""
    return store.ask(nodes, viewpoint).tagged(tag)


def every_under(store: Store[Workspace], viewpoint: str, name: str, top: Target) -> tuple[ResolvedNode, ...]:
    """The nodes of an ID or kind below a node, or in a tree that runs below it."""
    return store.ask(nodes, viewpoint).under(store.ask(every, viewpoint, name), top)


def callers(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[ResolvedNode, ...]:
    """The SubTree nodes that run a tree."""
    return store.ask(_callers_by_tree, viewpoint).get(tree, ())


def has_name(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    """Whether a name can occur in a path."""
    return store.ask(nodes, viewpoint).has_name(name)


def node_names(store: Store[Workspace], viewpoint: str) -> tuple[str, ...]:
    """Every name that can occur in a path."""
    return store.ask(nodes, viewpoint).names


def kinds(store: Store[Workspace], viewpoint: str) -> frozenset[str]:
    """Every ID and kind that a node has."""
    return store.ask(nodes, viewpoint).kinds


def tags(store: Store[Workspace], viewpoint: str) -> frozenset[str]:
    """Every tag that a node has."""
    return store.ask(nodes, viewpoint).tags


def knows_all_nodes(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether a node that is not in scope does not exist: those of a library may be in the files that include it, and
    those of a robot in XML that was not read."""
    return (
        store.ask(has_nodes, viewpoint)
        and inputs.is_complete(store, viewpoint)
        and not inputs.is_included(store, viewpoint)
        and inputs.is_well_formed(store, viewpoint)
    )


def mission(store: Store[Workspace], viewpoint: str) -> ResolvedNode | None:
    """The root of the main tree; None if it is unknown which tree runs."""
    main = inputs.main_tree(store, viewpoint)
    return store.ask(tree_nodes, viewpoint, *main).root if main is not None else None


def root(store: Store[Workspace], viewpoint: str, tree: str) -> ResolvedNode | None:
    """The root of the tree with a name."""
    found = store.ask(tree_named, viewpoint, tree)
    return found.root if found is not None else None


def has_nodes(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether there are any nodes in scope."""
    return store.ask(nodes, viewpoint).are_known


def _callers_by_tree(store: Store[Workspace], viewpoint: str) -> dict[str, tuple[ResolvedNode, ...]]:
    return store.ask(nodes, viewpoint).callers_by_tree


# ---- the index ----


class Nodes:
    """The written nodes of some trees.

    Attributes:
        trees: in the order of the files and of their text.
    """

    def __init__(self, trees: Sequence[ResolvedTree]) -> None:
        self.trees = tuple(trees)
        self._counting: dict[str, ResolvedTree] = {}  # by name, the first tree of each
        for tree in trees:
            if tree.name is not None:
                self._counting.setdefault(tree.name, tree)
        self._roots = {name: tree.root for name, tree in self._counting.items() if tree.root is not None}

    @cached_property
    def all(self) -> tuple[ResolvedNode, ...]:
        """In the order of the files and of their text."""
        return tuple([node for tree in self.trees for node in tree.all])

    @cached_property
    def are_known(self) -> bool:
        """Whether there are any."""
        return any(tree.all for tree in self.trees)

    def within(self, item: Tree) -> ResolvedTree:
        """The nodes of one of the trees.

        Raises:
            KeyError: it is not one of them.
        """
        return self._of_item[id(item)]

    @cached_property
    def _of_item(self) -> dict[int, ResolvedTree]:
        return {id(tree.item): tree for tree in self.trees}

    def of(self, node: Node) -> ResolvedNode | None:
        """The resolved node of a syntax node."""
        return self._of_node.get(id(node))

    def callers(self, tree: str | None) -> tuple[ResolvedNode, ...]:
        """The SubTree nodes that run a tree."""
        return self.callers_by_tree.get(tree, ()) if tree is not None else ()

    @cached_property
    def callers_by_tree(self) -> dict[str, tuple[ResolvedNode, ...]]:
        """The same for all trees that are run."""
        found: dict[str, list[ResolvedNode]] = {}
        for tree in self.trees:
            for name, node in tree.calls:
                found.setdefault(name, []).append(node)
        return {name: tuple(nodes) for name, nodes in found.items()}

    def run_by(self, node: ResolvedNode) -> ResolvedNode | None:
        """The root of the tree that a SubTree node runs."""
        name = node.node.id
        return self._roots.get(name.text) if node.category == "SubTree" and name is not None else None

    def find(self, names: tuple[str, ...]) -> tuple[Target, ...]:
        """The nodes that a path names: the last name's, below nodes or trees of the other names in their order, with
        any others between them.  A SubTree node and the root of its tree are one: the root if the path matches every
        instance of the tree, else the SubTree node."""
        last, above = names[-1], names[:-1]
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

    def every(self, name: str) -> tuple[ResolvedNode, ...]:
        """The nodes of an ID or kind; a tree's name, if no SubTree runs it, means its root."""
        found = [node for node in self._by_name.get(name, ()) if name in node.kinds]
        if not found and (root := self._roots.get(name)) is not None:
            return (root,)
        return tuple(found)

    def tagged(self, tag: str) -> tuple[ResolvedNode, ...]:
        """The nodes with a tag; a tag of a tree is one of its root."""
        found: list[ResolvedNode] = []
        for tree in self.trees:
            if tag in tree.by_tag:
                tagged = set(map(id, tree.by_tag[tag]))
                found += [node for node in tree.all if id(node) in tagged]
        return tuple(found)

    @cached_property
    def tags(self) -> frozenset[str]:
        """Every tag that a node has."""
        return frozenset().union(*(tree.by_tag for tree in self.trees))

    @cached_property
    def kinds(self) -> frozenset[str]:
        """Every ID and kind that a node has."""
        return frozenset().union(*(node.kinds for node in self.all))

    def under(self, nodes: Sequence[ResolvedNode], top: Target) -> tuple[ResolvedNode, ...]:
        """Those of the nodes that are below a node, or in a tree that runs below it."""
        below = self._below(top.node)
        return tuple(node for node in nodes if id(node) in below)

    def has_name(self, name: str) -> bool:
        """Whether a name can occur in a path."""
        return name in self._by_name or name in self._roots

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Every name that can occur in a path."""
        return (*self._by_name, *self._roots)

    @cached_property
    def _by_name(self) -> dict[str, list[ResolvedNode]]:
        found: dict[str, list[ResolvedNode]] = {}
        for tree in self.trees:
            for name, nodes in tree.by_name.items():
                found.setdefault(name, []).extend(nodes)
        return found

    @cached_property
    def _of_node(self) -> dict[int, ResolvedNode]:
        return {id(node.node): node for node in self.all}

    def _target(self, node: ResolvedNode, above: tuple[str, ...], is_tree: bool) -> Target | None:
        """The node as target of a path, if the path's other names are found above it.

        Args:
            is_tree: whether the path's last name was the tree's, so that the tree is not a step above the node.
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
        """Whether the remaining names are found above a tree on some way, and whether they are missing on some. Each
        step is a SubTree node with what is above it; the name of its tree does not count here."""
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
                at: ResolvedNode | None = caller
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

    def _below(self, top: ResolvedNode) -> set[int]:
        def following(node: ResolvedNode) -> list[ResolvedNode]:
            root = self.run_by(node)
            return node.children if root is None else [*node.children, root]

        return {id(node) for node in reached(following(top), following)}


def _runs(node: ResolvedNode, tree: str) -> bool:
    """Whether it is a SubTree node of that tree, whatever its label."""
    return node.category == "SubTree" and node.node.id is not None and node.node.id.text == tree
