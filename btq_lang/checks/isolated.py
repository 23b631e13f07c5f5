"""Nodes of Nav2 that cannot be created, because a SubTree above them does not pass the entries of bt_navigator.

Sources: `catalog/nav2/creation.py`; what BehaviorTree.CPP 3.8.7 and 4.10.0 do with the blackboard of a SubTree.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.versions import is_before_4
from btq_lang.checks import lookups
from btq_lang.checks.nav2_nodes import of_nav2
from btq_lang.checks.pointers import passed_on
from btq_lang.checks.ports import adding_fix
from btq_lang.checks.view import View, ports_beside
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.workspace import inputs
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
        tree = resolved.node.id
        needed = view.ask(_needed, tree.text) if tree is not None else ()
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
def _needed(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[tuple[str, str], ...]:
    """The entries that a tree must have to be created, each with the first node that takes it."""
    own_entries, below = store.ask(_in_tree, viewpoint, tree)
    needed = dict(own_entries)
    for called, passed in below:
        names = dict(passed)
        for entry, name in store.ask(_needed, viewpoint, called):
            needed.setdefault(names.get(entry, entry), name)  # what it does not pass, it is to pass
    return tuple(needed.items())


@hub
def _in_tree(store: Store[Workspace], viewpoint: str, tree: str) -> _InTree:
    """What the nodes of a tree itself take, and the trees that it runs, each with the entries that it renames."""
    from btq_lang.catalog.nav2.creation import created_with  # only for Nav2

    view = View(store, viewpoint)
    distribution = view.ask(lookups.distribution)
    definition = view.ask(inputs.definition, Kind.TREE, tree)
    if distribution is None or definition is None:
        return (), ()
    nodes = view.seen_in(*definition)
    needed: dict[str, str] = {}
    for resolved, name, _ in of_nav2(view, distribution, nodes.all):
        ports = {port.id.text for port in ports_beside(view, resolved) if port.id is not None}
        for entry in created_with(distribution, name, ports):
            needed.setdefault(entry, name)
    is_old = is_before_4(view.target)
    below = [
        (resolved.node.id.text, tuple(_renamed(resolved, is_old)))
        for resolved in nodes.subtrees
        if resolved.node.id is not None
    ]
    return tuple(needed.items()), tuple(below)


def _renamed(resolved: ResolvedNode, is_old: bool) -> Iterator[tuple[str, str]]:
    """The entries that a SubTree passes under another name."""
    for pair in resolved.node.attributes:
        if passed := _passed(resolved, pair.key.text, is_old):
            yield pair.key.text, passed


def _passed(resolved: ResolvedNode, entry: str, is_old: bool) -> str | None:
    """The entry that a SubTree passes to its tree under a name; None: it passes none.

    Version 3 takes the value of a port for the name of an entry.
    """
    if not is_old:
        return passed_on(resolved, entry)
    shared, value = (resolved.node.attribute(key) for key in ("__shared_blackboard", entry))
    if value is not None:
        return value.text.strip("{}")
    return entry if shared is not None and shared.text in ("true", "True", "TRUE", "1") else None
