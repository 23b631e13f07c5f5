"""The ports of a node, as its kind, its models or its tree declare them."""

from __future__ import annotations

from functools import cache
from itertools import chain

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import BUILTINS, OLD_PORTS, PortKind
from btq_lang.catalog.versions import PORTS_OF_SUBTREE, is_before_4
from btq_lang.checks import lookups
from btq_lang.checks.view import View, ports_beside
from btq_lang.util.record import replace
from btq_lang.workspace.port_types import as_kind
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def known_ports(view: View, resolved: ResolvedNode) -> KnownPorts | None:
    """The ports of a node; None if unknown."""
    if resolved.is_placeholder or (resolved.is_subtree and not PORTS_OF_SUBTREE.holds(view.target)):
        return None
    if resolved.is_subtree:
        # The engine reads `default = ""` as none, requires outputs too, and adds up the models of a tree.
        name = resolved.id
        others = view.ask(lookups.ports_of_models, Kind.MODEL, name.text) if name is not None else ()
        declared = {port.id.text: port for port in chain(ports_beside(view, resolved), *others) if port.id is not None}
        ports = [replace(port, required=not port.default) for port in map(as_kind, declared.values())]
        return KnownPorts(tuple(ports)) if ports else None
    if resolved.kind is not None:
        return _builtin_ports(resolved.kind.tag, is_before_4(view.target))
    model_ports = view.ask(_model_ports, resolved.id.text) if resolved.is_defined and resolved.id is not None else None
    if model_ports is None or not (throws := throwing(resolved)):
        return model_ports
    return KnownPorts(tuple([replace(port, required=port.required or port.name in throws) for port in model_ports.all]))


def first_port(view: View, resolved: ResolvedNode) -> PortKind | None:
    """The likely port of a value without a name: the first that needs a value, or else the first."""
    ports = known_ports(view, resolved)
    return next(iter((*ports.required, *ports.all)), None) if ports is not None else None


def is_case(resolved: ResolvedNode, key: str) -> bool:
    """Whether an attribute is a case of a Switch; which ones exist depends on the number of its children."""
    return resolved.flow == "switch" and key.startswith("case_") and key[5:].isdecimal()


def throwing(resolved: ResolvedNode) -> tuple[str, ...]:
    """The ports without which a node of Nav2 throws."""
    behavior = resolved.behavior if resolved.kind is None else None
    return tuple([port.name for port in behavior.ports if port.required]) if behavior is not None else ()


class KnownPorts:
    """The ports of a node: their names and those that need a value."""

    __slots__ = ("all", "names", "required")

    def __init__(self, ports: tuple[PortKind, ...]) -> None:
        self.all = ports
        self.names = frozenset([port.name for port in ports])
        self.required = tuple([port for port in ports if port.required])

    def named(self, name: str) -> PortKind | None:
        return next((port for port in self.all if port.name == name), None)


def _model_ports(store: Store[Workspace], viewpoint: str, name: str) -> KnownPorts | None:
    """The ports of a node with a model.  Of several models a port of any counts, and is required if all require it."""
    models = [[*map(as_kind, ports)] for ports in store.ask(lookups.ports_of_models, viewpoint, Kind.MODEL, name)]
    needed = [{port.name for port in ports if port.required} for ports in models]
    first: dict[str, PortKind] = {}
    for port in chain(*models):
        first.setdefault(port.name, port)
    ports = [replace(port, required=all(port.name in names for names in needed)) for port in first.values()]
    return KnownPorts(tuple(ports))


@cache
def _builtin_ports(tag: str, has_old_names: bool) -> KnownPorts:
    old = {today: name for (owner, name), today in OLD_PORTS.items() if owner == tag and has_old_names}
    named = [replace(port, name=old.get(port.name, port.name)) for port in BUILTINS[tag].ports]
    return KnownPorts(tuple([replace(port, doc=f"{port.doc[0].lower()}{port.doc[1:]}") for port in named]))
