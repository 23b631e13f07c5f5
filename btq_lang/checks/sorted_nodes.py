"""The nodes of a tree, sorted by what checks look for, so that not every check has to look at every node of a file.

One invariant: it only sorts; all properties are the nodes' own (workspace/resolved.py).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.kinds import Flow
from btq_lang.syntax.tree import Pair, Word
from btq_lang.workspace.inputs import of_scope
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode, tree_nodes
from btq_lang.workspace.workspace import Workspace


@of_scope
def sorted_nodes(store: Store[Workspace], viewpoint: str, path: str, tree: Facts) -> SortedNodes:
    """The nodes of a tree, sorted."""
    return SortedNodes(store.ask(tree_nodes, viewpoint, path, tree).all)


class SortedNodes:
    """The nodes of a tree, each list depth first, in document order.

    Attributes:
        all: all of them.
        given: those with attributes.
        marked: those with attributes that begin with `_`, so that they are not ports, as `_while`.
        demanding: those with clauses.
        categorized: those whose category is written.
        subtrees: those that run another tree.
        named: those with an instance name.
        placeholders: those that represent a skill.
        strangers: those that are neither a built-in, a placeholder nor a SubTree, and have no model.
        by_tag: the built-ins, by their tag.
        by_flow: the nodes with a known flow, by that.
    """

    def __init__(self, nodes: tuple[ResolvedNode, ...]) -> None:
        self.all: Final = nodes
        self.given: Final = [resolved for resolved in nodes if resolved.node.attributes]
        self.marked: Final = [
            resolved
            for resolved in self.given
            if any(not pair.key.raw[:1].isalpha() for pair in resolved.node.attributes)
        ]
        self.demanding: Final = [resolved for resolved in nodes if resolved.node.clauses]
        self.named: Final = [resolved for resolved in nodes if resolved.name is not None]
        self.categorized: Final = [resolved for resolved in nodes if resolved.node.category is not None]
        self.subtrees: Final = [resolved for resolved in nodes if resolved.is_subtree]
        self.placeholders: Final = [resolved for resolved in nodes if resolved.is_placeholder]
        self.strangers: Final = [
            resolved
            for resolved in nodes
            if resolved.kind is None
            and resolved.of_model is None
            and not (resolved.is_placeholder or resolved.is_subtree)
        ]
        self.by_tag: Final[dict[str, list[ResolvedNode]]] = {}
        self.by_flow: Final[dict[Flow, list[ResolvedNode]]] = {}
        for resolved in nodes:
            if resolved.kind is not None:
                self.by_tag.setdefault(resolved.kind.tag, []).append(resolved)
            if resolved.flow:
                self.by_flow.setdefault(resolved.flow, []).append(resolved)

    def values(self) -> Iterator[tuple[ResolvedNode, Pair, Word]]:
        """The attributes that have a value."""
        for resolved in self.given:
            yield from ((resolved, pair, pair.value) for pair in resolved.node.attributes if pair.value is not None)

    def of_flow(self, *flows: Flow) -> list[ResolvedNode]:
        """The nodes of these flows, flow by flow."""
        return [resolved for flow in flows for resolved in self.by_flow.get(flow, ())]


NO_NODES: Final = SortedNodes(())
