"""The written nodes that a path, a kind or a tag means, in a file and what it includes.

One invariant: a node is found by what is written, never by its instances in a run; the target of a path that leads
through SubTree nodes names them.  Callers report paths with no node or several.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, wraps
from typing import Concatenate, ParamSpec, TypeVar

from btq_lang.requirements.model import NodeTarget
from btq_lang.util.reach import reached
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store, hub
from btq_lang.workspace.resolved import ResolvedNode, ResolvedTree, tree_named, tree_nodes
from btq_lang.workspace.workspace import Workspace

P = ParamSpec("P")
T = TypeVar("T")

# ---- queries ----


@inputs.of_scope
def nodes(store: Store[Workspace], viewpoint: str) -> Nodes:
    """All written nodes in scope."""
    return Nodes([store.ask(tree_nodes, viewpoint, path, facts) for path, facts in store.ask(inputs.trees, viewpoint)])


def callers(store: Store[Workspace], viewpoint: str, tree: str | None) -> tuple[ResolvedNode, ...]:
    """The SubTree nodes that run a tree."""
    return store.ask(_callers_by_tree, viewpoint).get(tree, ())


@inputs.of_scope
def _callers_by_tree(store: Store[Workspace], viewpoint: str) -> dict[str | None, tuple[ResolvedNode, ...]]:
    return store.ask(nodes, viewpoint).callers_by_tree


def knows_all_nodes(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether a node that is not in scope does not exist: those of a library may be in the files that include it, and
    those of a robot in XML that was not read."""
    return (
        store.ask(has_nodes, viewpoint)
        and store.ask(inputs.is_complete, viewpoint)
        and not store.ask(inputs.is_included, viewpoint)
        and store.ask(inputs.is_well_formed, viewpoint)
    )


def mission(store: Store[Workspace], viewpoint: str) -> ResolvedNode | None:
    """The root of the main tree; None if it is unknown which tree runs."""
    main = store.ask(inputs.main_tree, viewpoint)
    return store.ask(tree_nodes, viewpoint, *main).root if main is not None else None


def root(store: Store[Workspace], viewpoint: str, tree: str) -> ResolvedNode | None:
    """The root of the tree with a name."""
    resolved = store.ask(tree_named, viewpoint, tree)
    return resolved.root if resolved is not None else None


def _of_nodes(read: Callable[Concatenate[Nodes, P], T]) -> Callable[Concatenate[Store[Workspace], str, P], T]:
    """A method of `Nodes` as a query of its own, so that an equal result ends the recomputation after an edit."""

    @wraps(read)
    def query(store: Store[Workspace], viewpoint: str, /, *key: P.args, **named: P.kwargs) -> T:
        return read(store.ask(nodes, viewpoint), *key, **named)

    return query


# ---- the index ----


class Nodes:
    """The written nodes of some trees.

    Attributes:
        trees: in the order of the files and of their text.
    """

    def __init__(self, trees: Sequence[ResolvedTree]) -> None:
        self.trees = tuple(trees)
        roots = {tree.name: tree.root for tree in reversed(trees)}  # of trees with one name the first one counts
        self._roots = {name: root for name, root in roots.items() if name is not None and root is not None}

    @cached_property
    def all(self) -> tuple[ResolvedNode, ...]:
        """In the order of the files and of their text."""
        return tuple([node for tree in self.trees for node in tree.all])

    def are_known(self) -> bool:
        """Whether there is a node."""
        return any(tree.all for tree in self.trees)

    def callers(self, tree: str | None) -> tuple[ResolvedNode, ...]:
        """The SubTree nodes that run a tree."""
        return self.callers_by_tree.get(tree, ())

    @cached_property
    def callers_by_tree(self) -> dict[str | None, tuple[ResolvedNode, ...]]:
        """The same for all trees that are run."""
        nodes_by_name: dict[str, list[ResolvedNode]] = {}
        for tree in self.trees:
            for name, node in tree.calls:
                nodes_by_name.setdefault(name, []).append(node)
        return {name: tuple(nodes) for name, nodes in nodes_by_name.items()}

    def run_by(self, node: ResolvedNode) -> ResolvedNode | None:
        """The root of the tree that a SubTree node runs."""
        name = node.node.id
        return self._roots.get(name.text) if node.category == "SubTree" and name is not None else None

    def find(self, names: tuple[str, ...]) -> tuple[NodeTarget, ...]:
        """The nodes that a path names: the last name's, below nodes or trees of the other names in their order, with
        any others between them.  A SubTree node and the root of its tree are one: the root if the path matches every
        instance of the tree, else the SubTree node."""
        last, above = names[-1], names[:-1]
        root = self._roots.get(last)
        matching = (self._target(node, above, False) for node in self._by_name.get(last, ()) if node is not root)
        targets = [target for target in matching if target is not None]
        of_tree = self._target(root, above, True) if root is not None else None
        if of_tree is None:
            return tuple(targets)
        others = [target for target in targets if not _runs(target.node, last)]
        if not of_tree.through or len(others) == len(targets):
            return (of_tree, *others)
        return tuple(targets)

    def every(self, name: str) -> tuple[ResolvedNode, ...]:
        """The nodes of an ID or kind; a tree's name, if no SubTree runs it, means its root."""
        matching = [node for node in self._by_name.get(name, ()) if name in node.kinds]
        if not matching and (root := self._roots.get(name)) is not None:
            return (root,)
        return tuple(matching)

    def has_any(self, name: str) -> bool:
        """Whether a node has this ID or kind."""
        return bool(self.every(name))

    def tagged(self, tag: str) -> tuple[ResolvedNode, ...]:
        """The nodes with a tag; a tag of a tree is one of its root."""
        matching: list[ResolvedNode] = []
        for tree in self.trees:
            if tag in tree.by_tag:
                tagged = set(map(id, tree.by_tag[tag]))
                matching += [node for node in tree.all if id(node) in tagged]
        return tuple(matching)

    def tags(self) -> frozenset[str]:
        """Every tag that a node has."""
        return frozenset().union(*(tree.by_tag for tree in self.trees))

    def kinds(self) -> frozenset[str]:
        """Every ID and kind that a node has."""
        return frozenset().union(*(node.kinds for node in self.all))

    def every_under(self, name: str, top: NodeTarget) -> tuple[ResolvedNode, ...]:
        """The nodes of an ID or kind below a node, or in a tree that runs below it."""
        below = self._below(top.node)
        return tuple(node for node in self.every(name) if id(node) in below)

    def ports_with(self, value: str) -> tuple[tuple[ResolvedNode, str], ...]:
        """The ports of nodes that have a value, each with the first node that gives it so."""
        ports: dict[tuple[str, str], ResolvedNode] = {}
        for node in self.all:
            for pair in node.node.attributes:
                if pair.value is not None and pair.value.text == value and not pair.key.text.startswith("_"):
                    ports.setdefault((node.node.id.text if node.node.id is not None else "", pair.key.text), node)
        return tuple((node, port) for (_, port), node in ports.items())

    def has_name(self, name: str) -> bool:
        """Whether a name can occur in a path."""
        return name in self._by_name or name in self._roots

    def names(self) -> tuple[str, ...]:
        """Every name that can occur in a path."""
        return (*self._by_name, *self._roots)

    @cached_property
    def _by_name(self) -> dict[str, list[ResolvedNode]]:
        by_name: dict[str, list[ResolvedNode]] = {}
        for tree in self.trees:
            for name, nodes in tree.by_name.items():
                by_name.setdefault(name, []).extend(nodes)
        return by_name

    def _target(self, node: ResolvedNode, above: tuple[str, ...], is_tree: bool) -> NodeTarget | None:
        """The node as target of a path, if the path's other names are found above it.

        Args:
            is_tree: whether the path's last name was the tree's, so that the tree is not a step above the node.
        """
        left = len(above) if is_tree else _left(node.parent, node.tree, above)

        def following(state: tuple[str | None, int]) -> list[tuple[str | None, int]]:
            called, wanted = state
            callers = self.callers(called) if wanted else ()
            return [(each.tree, _left(each, each.tree, above[:wanted], called)) for each in callers]

        # Trees on all ways up, each with the number of names that are still to be found above it.
        states = [*reached([(node.tree, left)], following)]
        if all(wanted for _, wanted in states):
            return None
        is_missed = any(wanted and not self.callers(tree) for tree, wanted in states)
        return NodeTarget(node, above[:left]) if is_missed else NodeTarget(node)

    def _below(self, top: ResolvedNode) -> set[int]:
        def following(node: ResolvedNode) -> list[ResolvedNode]:
            root = self.run_by(node)
            return node.children if root is None else [*node.children, root]

        return {id(node) for node in reached(following(top), following)}


def _left(node: ResolvedNode | None, tree: str | None, above: tuple[str, ...], called: str | None = None) -> int:
    """How many of some names are not found, the last one first, from a node on up to its tree.

    Args:
        called: the tree that the node runs, whose name does not count there.
    """
    left = len(above)
    current = node
    while left and current is not None:
        left -= above[left - 1] in current.names and not (current is node and above[left - 1] == called)
        current = current.parent
    return left - bool(left and above[left - 1] == tree)


def _runs(node: ResolvedNode, tree: str) -> bool:
    """Whether it is a SubTree node of that tree, whatever its label."""
    return node.category == "SubTree" and node.node.id is not None and node.node.id.text == tree


find = _of_nodes(Nodes.find)
every = _of_nodes(Nodes.every)
has_any = _of_nodes(Nodes.has_any)
every_under = _of_nodes(Nodes.every_under)
tagged = _of_nodes(Nodes.tagged)
ports_with = _of_nodes(Nodes.ports_with)
has_name = _of_nodes(Nodes.has_name)
node_names = _of_nodes(Nodes.names)
kinds = _of_nodes(Nodes.kinds)
tags = _of_nodes(Nodes.tags)
has_nodes = hub(_of_nodes(Nodes.are_known))
