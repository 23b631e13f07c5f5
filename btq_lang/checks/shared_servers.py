"""Nodes of Nav2 that call one action server while another node may be calling it.

Sources: `catalog/nav2/creation.py`; nav2_util's SimpleActionServer, which has one goal at a time.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import lookups
from btq_lang.checks.nav2_nodes import of_distribution
from btq_lang.checks.sorted_nodes import NO_NODES
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.util.reach import reached
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store, hub, on_circle
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def shared_server(view: View) -> Iterator[Diagnostic]:
    """Two nodes in different children of one node that runs its children side by side, which call the same server."""
    if view.ask(lookups.distribution) is None:
        return
    for seen in view.seen.of_flow("parallel", "parallel-all", "together"):
        first: dict[str, ResolvedNode] = {}
        for child in seen.children:
            callers = {server: node for node in _below(child) for server, _ in _calls(view, node)}
            for server, node in callers.items():
                if server in first:
                    yield _twice(view, seen, server, first[server], node)
            first = {**callers, **first}


def _twice(view: View, seen: ResolvedNode, server: str, first: ResolvedNode, node: ResolvedNode) -> Diagnostic:
    caller = dict(_calls(view, node))[server]
    where = f" in the tree `{node.node.id.text}`" if node.is_subtree and node.node.id is not None else ""
    message = f"`{caller}`{where} calls the server `{server}`, as another child of {seen.shown_kind} does"
    notes = (
        "a server has one goal at a time: the later one ends the earlier one",
        "put both into one child, or give one of them another server with `server_name`",
    )
    related = (Related(Place(first.node.head.span), "calls it too"),)
    return Diagnostic("shared-server", node.node.head.span, message, related, notes)


def _below(seen: ResolvedNode) -> Iterator[ResolvedNode]:
    """A node and all below it in its tree."""
    yield from reached([seen], lambda each: each.children)


def _calls(view: View, seen: ResolvedNode) -> tuple[tuple[str, str], ...]:
    """The servers that a node calls, each with the ID of the node that does: those of a SubTree are those of its
    tree's nodes."""
    if seen.is_subtree:
        return view.ask(_called, seen.node.id.text) if seen.node.id is not None else ()
    from btq_lang.catalog.nav2.creation import SERVERS  # only for Nav2

    distribution = view.ask(lookups.distribution)
    name = of_distribution(view, seen, distribution) if distribution is not None else None
    given = seen.node.attribute("server_name")
    if name is None or name not in SERVERS or (given is not None and is_pointer(given.text)):
        return ()
    return (((given.text.lstrip("/") if given is not None else "") or SERVERS[name], name),)


@on_circle(())
def _called(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[tuple[str, str], ...]:
    """The servers that the nodes of a tree and of those that it runs call."""
    calls, trees = store.ask(_in_tree, viewpoint, tree)
    below = (call for each in trees for call in store.ask(_called, viewpoint, each))
    return tuple(dict.fromkeys((*calls, *below)))


@hub
def _in_tree(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[tuple[tuple[str, str], ...], tuple[str, ...]]:
    """The servers that the nodes of a tree itself call, and the trees that it runs."""
    view = View(store, viewpoint)
    definition = view.ask(inputs.definition, Kind.TREE, tree)
    nodes = view.seen_in(*definition) if definition is not None else NO_NODES
    calls = dict.fromkeys(call for seen in nodes.all if not seen.is_subtree for call in _calls(view, seen))
    trees = dict.fromkeys(seen.node.id.text for seen in nodes.subtrees if seen.node.id is not None)
    return tuple(calls), tuple(trees)
