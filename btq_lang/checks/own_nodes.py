"""Nodes with the name of one of Nav2 that may be a team's own.

One invariant: a node may be a team's own only if the project names Nav2's nodes and no others, though its trees have
others.  A node with exactly the ports of Nav2's is Nav2's.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nav2 import FILES
from btq_lang.catalog.nodes import KNOWN_WORDS, lookup
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

OWN: Final = "; this may be a node of your own"
WHY: Final = (
    "`nodes` names only Nav2's, and other nodes of this file are unknown, too",
    "name the C++ of your nodes, or a model of this one, which counts before Nav2's",
)


def may_be_own(view: View, resolved: ResolvedNode, ports: Collection[str], is_near: bool = False) -> bool:
    """Whether a node with the name of one of Nav2's may be another one.

    Args:
        ports: of Nav2's node.
        is_near: whether the wrong name is similar to that of a port.
    """
    if resolved.kind is not None or resolved.id is None or not resolved.is_defined:
        return False
    keys = {*filter(is_port_name, (pair.key.text for pair in resolved.node.attributes))}
    strange = keys.difference(ports)
    if keys != strange and (is_near or not strange):
        return False
    model = view.ask(lookups.declaration, Kind.MODEL, resolved.id.text)
    return model is not None and model.is_of_nav2 and view.ask(_has_other_nodes)


def _has_other_nodes(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether a file has unknown nodes although its project names only Nav2's."""
    view = View(store, viewpoint)
    if any(path not in FILES.values() for path in view.ask(lookups.node_paths)):
        return False
    names = view.ask(lookups.used, Kind.MODEL).difference(KNOWN_WORDS, view.ask(inputs.names, Kind.MODEL))
    return any(lookup(name) is None and not view.is_pooled(Kind.MODEL, name) for name in names)
