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
    for resolved in view.seen.of_flow("parallel", "parallel-all", "together"):
        first: dict[str, ResolvedNode] = {}
        for child in resolved.children:
            callers = {server: node for node in _below(child) for server, _ in _calls(view, node)}
            for server, node in callers.items():
                if server in first:
                    yield _twice(view, resolved, server, first[server], node)
            first = {**callers, **first}


def _twice(view: View, resolved: ResolvedNode, server: str, first: ResolvedNode, node: ResolvedNode) -> Diagnostic:
    caller = dict(_calls(view, node))[server]
    where = f" in the tree `{node.node.id.text}`" if node.is_subtree and node.node.id is not None else ""
    message = f"`{caller}`{where} calls the server `{server}`, as another child of {resolved.shown_kind} does"
    notes = (
        "a server has one goal at a time: the later one ends the earlier one",
        "put both into one child, or give one of them another server with `server_name`",
    )
    related = (Related(Place(first.node.head.span), "calls it too"),)
    return Diagnostic("shared-server", node.node.head.span, message, related, notes)


def _below(resolved: ResolvedNode) -> Iterator[ResolvedNode]:
    """A node and all below it in its tree."""
    yield from reached([resolved], lambda node: node.children)


def _calls(view: View, resolved: ResolvedNode) -> tuple[tuple[str, str], ...]:
    """The servers that a node calls, each with the ID of the node that does: those of a SubTree are those of its
    tree's nodes."""
    if resolved.is_subtree:
        return view.ask(_calls_of_tree, resolved.node.id.text) if resolved.node.id is not None else ()
    from btq_lang.catalog.nav2.creation import SERVERS  # only for Nav2

    distribution = view.ask(lookups.distribution)
    name = of_distribution(view, resolved, distribution) if distribution is not None else None
    server_name = resolved.node.attribute("server_name")
    if name is None or name not in SERVERS or (server_name is not None and is_pointer(server_name.text)):
        return ()
    return (((server_name.text.lstrip("/") if server_name is not None else "") or SERVERS[name], name),)


@on_circle(())
def _calls_of_tree(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[tuple[str, str], ...]:
    """The servers that the nodes of a tree and of those that it runs call."""
    calls, trees = store.ask(_in_tree, viewpoint, tree)
    below = (call for called in trees for call in store.ask(_calls_of_tree, viewpoint, called))
    return tuple(dict.fromkeys((*calls, *below)))


@hub
def _in_tree(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[tuple[tuple[str, str], ...], tuple[str, ...]]:
    """The servers that the nodes of a tree itself call, and the trees that it runs."""
    view = View(store, viewpoint)
    definition = view.ask(inputs.definition, Kind.TREE, tree)
    nodes = view.seen_in(*definition) if definition is not None else NO_NODES
    calls = dict.fromkeys(call for resolved in nodes.all if not resolved.is_subtree for call in _calls(view, resolved))
    trees = dict.fromkeys(resolved.node.id.text for resolved in nodes.subtrees if resolved.node.id is not None)
    return tuple(calls), tuple(trees)
