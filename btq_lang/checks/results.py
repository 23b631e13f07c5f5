"""The possible results of a file's nodes, as far as their kinds, attributes and children determine them.

One invariant: every status that a node can return is included, so a missing one is impossible; an unknown leaf can
return anything.  Only `first` and `usual` assume that some actions take longer than one tick.  This module does not
know the blackboard, and so not whether a condition is ever true.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from btq_lang.catalog.kinds import NodeKind
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import lookup
from btq_lang.checks import cpp_lookups
from btq_lang.checks.statuses import ANYTHING, FAILURE, RUNNING, SKIPPED, SUCCESS, of_kind
from btq_lang.checks.view import View
from btq_lang.syntax.tree import Node, Tree
from btq_lang.util.record import Record
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


class Results(Record):
    """The possible results of a node: sets of statuses.

    Attributes:
        first: at the tick that starts it (a SequenceWithMemory that was halted resumes instead of starting), if actions
            in a Timeout take longer than one tick.
        usual: the same, if custom actions take longer than one tick.
        ever: at any tick.
    """

    first: int
    usual: int
    ever: int


UNKNOWN: Final = Results(ANYTHING, ANYTHING, ANYTHING)


def result(view: View, node: object) -> Results:
    """The possible results of a node of a tree; for verbatim XML all."""
    return results(view).get(id(node), UNKNOWN)


def results(view: View) -> Mapping[int, Results]:
    """The possible results of the nodes of a tree, by their `id`; verbatim XML is left out."""
    return view.ask(_of_nodes, view.path, view.facts)


@on_circle(UNKNOWN)
@inputs.of_scope
def _of_tree(store: Store[Workspace], viewpoint: str, tree: str) -> Results:
    """The possible results of a tree by its name; all, if it runs itself."""
    definition = store.ask(inputs.definition, viewpoint, Kind.TREE, tree)
    item = definition[1].item if definition is not None else None
    if definition is None or not isinstance(item, Tree) or is_filled_in(View(store, viewpoint), tree, item):
        return UNKNOWN
    roots = [child for child in item.children if isinstance(child, Node)]
    return _of_nodes(store, viewpoint, *definition)[id(roots[0])] if len(roots) == 1 else UNKNOWN


def is_filled_in(view: View, name: str, tree: Tree) -> bool:
    """Whether a tree does nothing because the program replaces it: its name is like `__BringUp__`, or C++ of the
    project has that name."""
    is_stub = all(isinstance(node, Node) and (node.children or _does_nothing(node)) for node in tree.walk())
    return is_stub and (_TEMPLATE(name) is not None or view.ask(cpp_lookups.is_in_cpp, name))


def _does_nothing(node: Node) -> bool:
    kind = lookup(node.kind.text) if node.kind is not None else None
    return kind is not None and kind.flow in ("succeeds", "fails") and not kind.ports


def _of_nodes(store: Store[Workspace], viewpoint: str, path: str, facts: Facts) -> dict[int, Results]:
    """The possible results of the nodes of a tree.  `_of_tree` does not ask for it, or it would be part of each
    circle."""
    view = View(store, viewpoint)
    by_node: dict[int, Results] = {}
    for resolved in reversed(view.seen_in(path, facts).all):  # children before their parents
        by_node[id(resolved.node)] = _of_node(view, resolved, by_node)
    return by_node


def _of_node(view: View, resolved: ResolvedNode, by_node: dict[int, Results]) -> Results:
    possible = UNKNOWN
    if resolved.is_subtree:
        possible = view.ask(_of_tree, resolved.id.text) if resolved.id is not None and resolved.id.text else UNKNOWN
    elif resolved.behavior is not None:
        children = tuple([by_node.get(id(child), UNKNOWN) for child in resolved.node.children])
        possible = _of_behavior(resolved.behavior, resolved.node, children)
    elif not resolved.node.children:
        name = (
            resolved.id.text
            if resolved.id is not None and resolved.is_defined and resolved.stated_category == "Action"
            else None
        )
        at_once = name is not None and view.ask(cpp_lookups.ends_at_once, Kind.MODEL, name)
        possible = _AT_ONCE if at_once else _CUSTOM.get(resolved.stated_category or "", _UNKNOWN_LEAF)
    added = 0
    for pair in resolved.node.attributes:
        added |= _ADDED.get(pair.key.text, 0)
    return Results(possible.first | added, possible.usual | added, possible.ever | added) if added else possible


def _of_behavior(kind: NodeKind, node: Node, children: tuple[Results, ...]) -> Results:
    """The possible results by a node's row; cached, as most nodes have no attributes and few kinds of children."""
    key = id(kind), *[child.first | child.usual << 4 | child.ever << 8 for child in children]
    possible = _without_ports.get(key) if not node.attributes else None
    if possible is not None:
        return possible
    if kind.flow == "timeout" and len(children) == 1 and children[0].usual == RUNNING:
        first = RUNNING  # an action with a limited time takes time
    else:
        first = of_kind(kind, node, [child.first for child in children], starting=True)
    possible = Results(
        first,
        of_kind(kind, node, [child.usual for child in children], starting=True),
        of_kind(kind, node, [child.ever for child in children], starting=False),
    )
    if not node.attributes and len(children) < _FEW:
        _without_ports[key] = possible
    return possible


_TEMPLATE: Final = re.compile("__.+__").fullmatch
_FEW: Final = 4  # there are not many such combinations
_without_ports: Final[dict[tuple[int, ...], Results]] = {}
_ANY_LEAF: Final = SUCCESS | FAILURE | RUNNING
_UNKNOWN_LEAF: Final = Results(_ANY_LEAF, _ANY_LEAF, _ANY_LEAF)
_AT_ONCE: Final = Results(SUCCESS | FAILURE, SUCCESS | FAILURE, SUCCESS | FAILURE)
_CUSTOM: Final = {
    "Action": Results(_ANY_LEAF, RUNNING, _ANY_LEAF),
    "Condition": _AT_ONCE,
}
_ADDED: Final = {"_failureIf": FAILURE, "_successIf": SUCCESS, "_skipIf": SKIPPED, "_while": SKIPPED}
