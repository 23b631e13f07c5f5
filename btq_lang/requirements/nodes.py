"""Which written nodes a path, a kind or a tag means, in a file and what it includes.

One invariant: a node is found by what is written, never by what a run makes of it; a path that leads through SubTree
nodes says so in its target.  It complains of nothing: no node, or several, is the caller's to tell.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import chain, compress
from typing import TYPE_CHECKING

from btq_lang.catalog.name_kinds import Kind
from btq_lang.requirements.model import SourceNode, Target
from btq_lang.requirements.trees import TreeNodes
from btq_lang.syntax.tree import Model, Node, Tree
from btq_lang.workspace.symbols import Symbol

if TYPE_CHECKING:
    from btq_lang.workspace.file import File
    from btq_lang.workspace.workspace import Scope, Workspace


class Nodes:
    """The written nodes of a file and what it includes.

    Attributes:
        trees: those they stand in, in the order of the files and of their text.
        items: those as they are written.
        others: the trees in whose place another one stands than before, each in front of that; None: there were more or
            fewer.
        qualities: the quality that encloses a requirement of a node, by the `id` of what is written.
        is_ordered_as_before: in the order of the trees each has the place of the one that stood where it stands.
        renamed: the names that trees had which stood where others stand now; nothing where they have the same ones.
    """

    def __init__(self, workspace: Workspace, scope: Scope, before: Nodes | None = None) -> None:
        """before: those of an earlier workspace, to take over the trees that are the same."""
        files = [workspace.files[path] for path in scope.paths]
        self._categories: dict[str, str]
        self._models = [file.names.symbols[Kind.MODEL] for file in files]
        has_same = before is not None and before._models == self._models
        self._categories = before._categories if before is not None and has_same else _categories(self._models)
        self.items = tuple([item for file in files for item in file.of_type(Tree)])
        self.trees: tuple[TreeNodes, ...]
        known = before._of_item if before is not None else {}
        others: list[tuple[TreeNodes, TreeNodes]] | None = None
        if before is not None and has_same and len(before.items) == len(self.items):
            from operator import is_not  # only an edit asks

            # After most edits one tree of all is another one.
            trees = [*before.trees]
            for at in compress(range(len(trees)), map(is_not, self.items, before.items)):
                item = self.items[at]
                trees[at] = known.get(id(item)) or TreeNodes(_path_of(files, at), item, self._categories)
            self.trees = tuple(trees)
            others = [(one, other) for one, other in zip(before.trees, trees, strict=True) if one is not other]
        else:
            self.trees = tuple(self._read(files, known, has_same))
            others = _others(before.trees, self.trees) if before is not None else None
        self.others = others
        self._of_item: dict[int, TreeNodes] = dict(zip(map(id, self.items), self.trees, strict=True))
        self._counting: dict[str, TreeNodes] = {}  # of several trees of one name the first one
        self._roots: dict[str, SourceNode] = {}
        self._name_trees(before, others)
        self.qualities: dict[int, str]
        if before is not None and others is not None and not any(tree.qualities for pair in others for tree in pair):
            self.qualities = before.qualities
        else:
            self.qualities = {id_: each for tree in self.trees for id_, each in tree.qualities.items()}
        self._callers_before: dict[str, tuple[SourceNode, ...]] = {}
        self._called_by_others: frozenset[str] | None = None  # None: anything may be
        self.is_ordered_as_before = False
        self.renamed: frozenset[str | None] = frozenset()
        if before is not None and "callers_by_tree" in before.__dict__:
            self._callers_before = before.callers_by_tree
            if others is not None:
                self._called_by_others = frozenset([name for pair in others for tree in pair for name in tree.called])
        if before is not None and others is not None:
            self.renamed = frozenset([one.name for one, other in others if one.name != other.name])
            self.is_ordered_as_before = self._keep_order(before, others)
        self._names_before: tuple[str, ...] = before.__dict__.get("names", ()) if before is not None else ()
        self._found: dict[tuple[str, ...], tuple[Target, ...]] = {}

    def _read(self, files: Sequence[File], known: dict[int, TreeNodes], has_same: bool) -> Iterator[TreeNodes]:
        """The trees; those that are known and would come out the same."""
        for file in files:
            for item in file.of_type(Tree):
                tree = known.get(id(item))
                if tree is None or not (has_same or tree.fits(self._categories)):
                    tree = TreeNodes(file.path, item, self._categories)
                yield tree

    def _name_trees(self, before: Nodes | None, others: Sequence[tuple[TreeNodes, TreeNodes]] | None) -> None:
        """Which tree a name means, and which root."""
        if before is None or others is None or not all(map(_have_one_name, others)):
            for tree in self.trees:
                if tree.name is not None:
                    self._counting.setdefault(tree.name, tree)
            self._roots.update((name, tree.root) for name, tree in self._counting.items() if tree.root is not None)
            return
        self._counting |= before._counting
        self._roots |= before._roots
        for old, tree in others:
            if tree.name is not None and self._counting[tree.name] is old:
                self._counting[tree.name] = tree
                if tree.root is not None:
                    self._roots[tree.name] = tree.root

    def let_go(self, before: Nodes) -> None:
        """Let go of those trees of an earlier workspace that are not among these."""
        replaced = before.trees if self.others is None else [one for one, _ in self.others]
        for tree in replaced:
            if self._of_item.get(id(tree.item)) is not tree:
                tree.let_go()

    @cached_property
    def all(self) -> tuple[SourceNode, ...]:
        """In the order of the files and of their text."""
        return tuple([node for tree in self.trees for node in tree.all])

    @cached_property
    def are_known(self) -> bool:
        """Whether there are any."""
        return any(tree.all for tree in self.trees)

    def root(self, tree: str) -> SourceNode | None:
        """The written root of a tree; None where the tree has none, or nobody knows it."""
        return self._roots.get(tree)

    def has(self, item: Tree) -> bool:
        """Whether a tree is one of these."""
        return id(item) in self._of_item

    def within(self, item: Tree) -> TreeNodes:
        """The nodes of one of the trees.

        Raises:
            KeyError: it is none of them.
        """
        return self._of_item[id(item)]

    def of(self, node: Node) -> SourceNode | None:
        """A node of the syntax as one of these."""
        return self._of_node.get(id(node))

    def callers(self, tree: str | None) -> tuple[SourceNode, ...]:
        """The SubTree nodes that run a tree."""
        return self.callers_by_tree.get(tree, ()) if tree is not None else ()

    @cached_property
    def callers_by_tree(self) -> dict[str, tuple[SourceNode, ...]]:
        """The same of all trees that any runs: the same objects as before where they are the same nodes."""
        before, touched = self._callers_before, self._called_by_others
        if touched is not None and not touched:
            return before
        found: dict[str, list[SourceNode]] = {}
        for tree in self.trees:
            for name, node in tree.calls:
                if touched is None or name in touched:
                    found.setdefault(name, []).append(node)
        made = {name: _same_or_new(before.get(name, ()), nodes) for name, nodes in found.items()}
        if touched is None:
            return made
        return {name: nodes for name, nodes in before.items() if name not in touched} | made

    def run_by(self, node: SourceNode) -> SourceNode | None:
        """The root of the tree that a SubTree node runs."""
        name = node.node.id
        return self._roots.get(name.text) if node.category == "SubTree" and name is not None else None

    @cached_property
    def in_order(self) -> tuple[TreeNodes, ...]:
        """The trees, each behind those that it runs, where there is no circle; that is cut at the same place, whichever
        of its trees is asked for first."""
        indices = {id(tree.item): index for index, tree in enumerate(self.trees)}
        of_name = {name: indices[id(root.item)] for name, root in self._roots.items()}
        found: dict[int, None] = {}
        begun: set[int] = set()
        for start in range(len(self.trees)):
            waiting = [start]
            while waiting:
                index = waiting[-1]
                if index in begun:
                    waiting.pop()
                    found[index] = None
                    continue
                begun.add(index)
                below = [of_name[name] for name in reversed(self.trees[index].called) if name in of_name]
                waiting += [each for each in below if each not in begun]
        return tuple([self.trees[index] for index in found])

    def position(self, item: Tree) -> int:
        """Where a tree stands in that order."""
        return self._positions[id(item)]

    def place(self, item: int) -> int | None:
        """The same, of a tree by its `id`; None: it is none of these."""
        return self._positions.get(item)

    @cached_property
    def _positions(self) -> dict[int, int]:
        return {id(tree.item): position for position, tree in enumerate(self.in_order)}

    @cached_property
    def _has_no_circle(self) -> bool:
        return all(map(self._is_behind, self.trees))

    def _is_behind(self, tree: TreeNodes) -> bool:
        """Whether a tree stands behind all that it runs."""
        at = self.position(tree.item)
        return all(self.position(self._roots[name].item) < at for name in tree.called if name in self._roots)

    def _keep_order(self, before: Nodes, others: Sequence[tuple[TreeNodes, TreeNodes]]) -> bool:
        """Take over the order of earlier trees, if it is one of these, too; where they run each other otherwise than
        those did, only if nobody runs in a circle, for then one such order is as good as another.

        Args:
            others: the trees in whose places others stand, with these.
        """
        places = {id(tree.item): before.position(old.item) for old, tree in others}
        gone = {id(old.item) for old, _ in others}
        in_order = [*before.in_order]
        for _, tree in others:
            in_order[places[id(tree.item)]] = tree
        self.in_order = tuple(in_order)
        self._positions = {item: at for item, at in before._positions.items() if item not in gone} | places
        turned = [pair for pair in others if not _have_same_shape(pair)]
        if not turned:
            if "_has_no_circle" in before.__dict__:
                self._has_no_circle = before._has_no_circle
            return True
        callers = [node.item for pair in turned for tree in pair for node in self.callers(tree.name)]
        touched = [*(tree for _, tree in turned), *map(self.within, callers)]
        if before._has_no_circle and all(map(self._is_behind, touched)):
            self._has_no_circle = True
            return True
        del self.in_order, self._positions
        return False

    def find(self, names: Sequence[str]) -> tuple[Target, ...]:
        """The nodes that a path names: the last name's, below nodes or trees of the other names in their order, with
        any others between them.  A SubTree node and the root of its tree are one: the root where the path holds for
        every instance of the tree, else the SubTree node."""
        path = tuple(names)
        if path not in self._found:
            self._found[path] = self._find(path[-1], path[:-1])
        return self._found[path]

    def every(self, name: str) -> tuple[SourceNode, ...]:
        """The nodes of an ID or kind; a tree's name, where no SubTree runs it, is its root."""
        found = [node for node in self._by_name.get(name, ()) if name in _kinds(node)]
        if not found and (root := self._roots.get(name)) is not None:
            return (root,)
        return tuple(found)

    def tagged(self, tag: str) -> tuple[SourceNode, ...]:
        """The nodes with a tag; a tag of a tree is one of its root."""
        found: list[SourceNode] = []
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
        return frozenset().union(*map(_kinds, self.all))

    def under(self, nodes: Sequence[SourceNode], top: Target) -> tuple[SourceNode, ...]:
        """Those of the nodes that stand below a node, or in a tree that runs below it."""
        below = self._below(top.node)
        return tuple(node for node in nodes if id(node) in below)

    def has_name(self, name: str) -> bool:
        """Whether a path can have a name in it."""
        return name in self._by_name or name in self._roots

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Every name that a path can have in it."""
        names = (*self._by_name, *self._roots)
        return self._names_before if names == self._names_before else names

    @cached_property
    def _by_name(self) -> dict[str, list[SourceNode]]:
        found: dict[str, list[SourceNode]] = {}
        for tree in self.trees:
            for name, nodes in tree.by_name.items():
                found.setdefault(name, []).extend(nodes)
        return found

    @cached_property
    def _of_node(self) -> dict[int, SourceNode]:
        return {id(node.node): node for node in self.all}

    def _find(self, last: str, above: tuple[str, ...]) -> tuple[Target, ...]:
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
            root = self.run_by(node)
            for child in node.children if root is None else (*node.children, root):
                if id(child) not in found:
                    found.add(id(child))
                    waiting.append(child)
        return found


def _categories(models: Iterable[Iterable[Symbol]]) -> dict[str, str]:
    """The categories of models, by their names."""
    found: dict[str, str] = {}
    for symbol in chain.from_iterable(models):
        if isinstance(model := symbol.target, Model):
            found.setdefault(symbol.name, model.category.raw)
    return found


def _others(before: Sequence[TreeNodes], now: Sequence[TreeNodes]) -> list[tuple[TreeNodes, TreeNodes]] | None:
    """The trees that stand in the place of another one, each behind that; None: there are more trees or fewer."""
    if len(before) != len(now):
        return None
    return [(one, other) for one, other in zip(before, now, strict=True) if one is not other]


def _path_of(files: Sequence[File], at: int) -> str:
    """The file in which a tree stands, counted through all of them."""
    for file in files:
        trees = file.of_type(Tree)
        if at < len(trees):
            return file.path
        at -= len(trees)
    raise IndexError("there are no more trees")


def _have_one_name(pair: tuple[TreeNodes, TreeNodes]) -> bool:
    """Whether two trees have one name, and a root if one of them has."""
    one, other = pair
    return one.name == other.name and (one.root is None) == (other.root is None)


def _have_same_shape(pair: tuple[TreeNodes, TreeNodes]) -> bool:
    """Whether two trees have one name, and run the same ones."""
    one, other = pair
    return (one.name, one.called, one.root is None) == (other.name, other.called, other.root is None)


def _same_or_new(before: tuple[SourceNode, ...], nodes: list[SourceNode]) -> tuple[SourceNode, ...]:
    return before if [*map(id, before)] == [*map(id, nodes)] else tuple(nodes)


def _runs(node: SourceNode, tree: str) -> bool:
    """Whether it is a SubTree node of that tree, whatever its label."""
    return node.category == "SubTree" and node.node.id is not None and node.node.id.text == tree


def _kinds(node: SourceNode) -> frozenset[str]:
    from btq_lang.requirements.names import kinds_of  # few requirements name nodes by their kind

    return kinds_of(node.node, node.kind, node.category)
