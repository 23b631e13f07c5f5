"""Nodes of Nav2 that cannot be created or that disturb each other, and which nodes are Nav2's.

Sources: `catalog/nav2/creation.py`; what BehaviorTree.CPP 3.8.7 and 4.10.0 do with the blackboard of a SubTree;
nav2_util's SimpleActionServer, which has one goal at a time.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TypeAlias

from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import FILES
from btq_lang.catalog.versions import is_before_4
from btq_lang.checks import cpp_lookups, lookups
from btq_lang.checks.pointers import is_on, passed_on
from btq_lang.checks.ports import adding_fix
from btq_lang.checks.view import View, port_names
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.util.reach import reached
from btq_lang.workspace.queries import Store, hub, on_circle
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

_InTree: TypeAlias = "tuple[tuple[tuple[str, str], ...], tuple[tuple[str, tuple[tuple[str, str], ...]], ...]]"


def isolated_node(view: View) -> Iterator[Diagnostic]:
    """A SubTree that does not pass what nodes of Nav2 in its tree take from the blackboard when they are created."""
    if not view.seen.subtrees or view.ask(lookups.distribution) is None:
        return
    is_old = is_before_4(view.target)
    for resolved in view.seen.subtrees:
        tree = resolved.id
        needed = view.ask(_needed_below, tree.text) if tree is not None else ()
        lacking = {entry: node for entry, node in needed if _passed(resolved, entry, is_old) is None}
        if tree is None or not lacking:
            continue
        names = ", ".join(f"`{entry}`" for entry in lacking)
        sharing = "__shared_blackboard" if is_old else "_autoremap"
        node = next(iter(lacking.values()))
        message = f"`{node}` cannot be created in the tree `{tree.text}`: this SubTree does not pass {names}"
        notes = (f'write `{sharing}="true"`: the engine refuses the tree without these entries of bt_navigator',)
        related = view.declared_at(Kind.TREE, tree.text, "its tree")
        fixes = adding_fix(view, resolved.node, "Pass all entries", f"{sharing} = true") if not is_old else ()
        yield Diagnostic("isolated-node", resolved.node.head.span, message, related, notes, fixes)


@on_circle(())
def _needed_below(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[tuple[str, str], ...]:
    """The entries that a tree must have to be created, each with the first node that takes it."""
    own_entries, below = store.ask(_needed_in, viewpoint, tree)
    needed = dict(own_entries)
    for called, passed in below:
        names = dict(passed)
        for entry, name in store.ask(_needed_below, viewpoint, called):
            needed.setdefault(names.get(entry, entry), name)  # what it does not pass, it is to pass
    return tuple(needed.items())


@hub
def _needed_in(store: Store[Workspace], viewpoint: str, tree: str) -> _InTree:
    """What the nodes of a tree itself take, and the trees that it runs, each with the entries that it renames."""
    from btq_lang.catalog.nav2.creation import created_by, created_with  # only for Nav2

    view = View(store, viewpoint)
    distribution = view.ask(lookups.distribution)
    if distribution is None:
        return (), ()
    nodes = view.nodes_of(tree)
    needed: dict[str, str] = {}
    for resolved, name, _ in of_nav2(view, distribution, nodes.all):
        ports = port_names(view, resolved)
        for entry in created_with(distribution, name, ports):
            needed.setdefault(entry, name)
    for name in dict.fromkeys(resolved.id.text for resolved in nodes.all if resolved.is_defined and resolved.id):
        if base := view.ask(cpp_lookups.nav2_base, Kind.MODEL, name):
            for entry in created_by(distribution, base):
                needed.setdefault(entry, name)
    is_old = is_before_4(view.target)
    below = [
        (resolved.id.text, tuple(_renamed(resolved, is_old))) for resolved in nodes.subtrees if resolved.id is not None
    ]
    return tuple(needed.items()), tuple(below)


def _renamed(resolved: ResolvedNode, is_old: bool) -> Iterator[tuple[str, str]]:
    """The entries that a SubTree passes under another name."""
    for pair in resolved.node.attributes:
        if passed := _passed(resolved, pair.key.text, is_old):
            yield pair.key.text, passed


def _passed(resolved: ResolvedNode, entry: str, is_old: bool) -> str | None:
    """The entry that a SubTree passes to its tree under a name; None if it passes none.

    Version 3 takes the value of a port for the name of an entry.
    """
    if not is_old:
        return passed_on(resolved, entry)
    value = resolved.node.attribute(entry)
    if value is not None:
        return value.text.strip("{}")
    return entry if is_on(resolved, "__shared_blackboard") else None


def shared_server(view: View) -> Iterator[Diagnostic]:
    """Two nodes in different children of one node that runs its children side by side, which call the same server."""
    if view.ask(lookups.distribution) is None:
        return
    for resolved in view.seen.of_flow("parallel", "parallel-all", "together"):
        first: dict[str, ResolvedNode] = {}
        for child in resolved.children:
            callers = {server: node for node in _with_all_below(child) for server, _ in _calls(view, node)}
            for server, node in callers.items():
                if server in first:
                    yield _twice(view, resolved, server, first[server], node)
            first = {**callers, **first}


def _twice(view: View, resolved: ResolvedNode, server: str, first: ResolvedNode, node: ResolvedNode) -> Diagnostic:
    caller = dict(_calls(view, node))[server]
    where = f" in the tree `{node.id.text}`" if node.is_subtree and node.id is not None else ""
    message = f"`{caller}`{where} calls the server `{server}`, as another child of {resolved.shown_kind} does"
    notes = (
        "a server has one goal at a time: the later one ends the earlier one",
        "put both into one child, or give one of them another server with `server_name`",
    )
    related = (Related(Place(first.node.head.span), "calls it too"),)
    return Diagnostic("shared-server", node.node.head.span, message, related, notes)


def _with_all_below(resolved: ResolvedNode) -> Iterator[ResolvedNode]:
    yield from reached([resolved], lambda node: node.children)


def _calls(view: View, resolved: ResolvedNode) -> tuple[tuple[str, str], ...]:
    """The servers that a node calls, each with the ID of the node that calls it.  A SubTree calls those of its tree's
    nodes."""
    if resolved.is_subtree:
        return view.ask(_calls_of_tree, resolved.id.text) if resolved.id is not None else ()
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
    calls, trees = store.ask(_calls_in, viewpoint, tree)
    below = (call for called in trees for call in store.ask(_calls_of_tree, viewpoint, called))
    return tuple(dict.fromkeys((*calls, *below)))


@hub
def _calls_in(
    store: Store[Workspace], viewpoint: str, tree: str
) -> tuple[tuple[tuple[str, str], ...], tuple[str, ...]]:
    """The servers that the nodes of a tree itself call, and the trees that it runs."""
    view = View(store, viewpoint)
    nodes = view.nodes_of(tree)
    calls = dict.fromkeys(call for resolved in nodes.all if not resolved.is_subtree for call in _calls(view, resolved))
    trees = dict.fromkeys(resolved.id.text for resolved in nodes.subtrees if resolved.id is not None)
    return tuple(calls), tuple(trees)


def of_nav2(view: View, distribution: str, nodes: Iterable[ResolvedNode]) -> Iterator[tuple[ResolvedNode, str, str]]:
    """The nodes of Nav2 among some, each with its ID and the name of its tree."""
    for resolved in nodes:
        name = of_distribution(view, resolved, distribution)
        if name is not None and resolved.tree is not None:
            yield resolved, name, resolved.tree


def of_distribution(view: View, resolved: ResolvedNode, distribution: str) -> str | None:
    """The ID of a node of Nav2; None for another one."""
    if resolved.of_model is None or resolved.id is None:
        return None
    model = view.ask(lookups.declaration, Kind.MODEL, resolved.id.text)
    return resolved.id.text if model is not None and model.path == FILES[distribution] else None
