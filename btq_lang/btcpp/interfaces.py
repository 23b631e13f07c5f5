"""What XML may say of each node that a project knows: its children, its ports, and by which categories it is named.

One invariant: a node that has several models has the ports of all of them, so no file that keeps to one is refused.
Known are the engine's nodes, the models of all files, and the nodes that no model declares, as their uses show them.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator

from btq_lang.btcpp.models import undeclared
from btq_lang.catalog.kinds import CHILDREN, NodeKind, PortKind
from btq_lang.catalog.literals import values_of
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name, is_xml_name
from btq_lang.catalog.nodes import BUILTINS, available, of_version
from btq_lang.syntax.tree import Model
from btq_lang.util.record import Record
from btq_lang.workspace.port_types import as_kind
from btq_lang.workspace.workspace import Workspace


class PortInterface(Record):
    """A port.

    Attributes:
        values: all literals that it accepts; empty if they cannot be listed.
        required: whether the engine refuses the node without it.
    """

    name: str
    values: tuple[str, ...] = ()
    required: bool = False
    doc: str = ""


class Interface(Record):
    """A node.

    Attributes:
        categories: under which the explicit form may name it.
        least, most: the number of children; None: any number.
        ports: by name.
        is_open: whether it may have other ports: nothing declares them.
    """

    name: str
    categories: tuple[str, ...]
    least: int
    most: int | None
    ports: dict[str, PortInterface]
    is_open: bool = False
    doc: str = ""


def interfaces(workspaces: Iterable[Workspace], version: str, unknown: Container[str]) -> dict[str, Interface]:
    """The nodes that the files of some workspaces know, by name: the engine's in its order, then the others by name,
    without those that the checks call unknown unless a model declares them."""
    of_engine = {kind.tag: _of_engine(kind, version) for kind in BUILTINS.values() if available(kind, version)}
    declared: dict[str, Interface] = {}
    used: dict[str, Interface] = {}
    for workspace in workspaces:
        for path in sorted(workspace.files):
            for model in _models(workspace, path):
                if model.name not in BUILTINS:
                    earlier = declared.get(model.name)
                    declared[model.name] = model if earlier is None else _merged(earlier, model)
            for name, node in undeclared(workspace, path).items():
                ports = {port.name: PortInterface(port.name) for port in node.ports if is_xml_name(port.name)}
                used[name] = Interface(name, (node.category,), 0, None, ports, is_open=True)
    others = {**{name: each for name, each in used.items() if name not in unknown}, **declared}
    return {**of_engine, **{name: others[name] for name in sorted(others)}}


def tree_names(workspaces: Iterable[Workspace]) -> list[str]:
    """The names of the trees of all files, sorted."""
    files = (file for workspace in workspaces for file in workspace.files.values())
    return sorted({name for file in files for name in file.names.by_kind[Kind.TREE]})


def _of_engine(kind: NodeKind, version: str) -> Interface:
    ports = {port.name: _port_of_engine(of_version(port, version)) for port in kind.ports if is_port_name(port.name)}
    doc = f"{kind.doc} {kind.semantics}"
    return Interface(kind.tag, (kind.category,), *kind.children, ports, kind.category == "SubTree", doc)


def _port_of_engine(port: PortKind) -> PortInterface:
    default = f"; default: {port.default}" if port.default is not None else ""
    return PortInterface(port.name, _values(port), port.required, f"{port.doc}{default}")


def _values(port: PortKind) -> tuple[str, ...]:
    return values_of(port.literal or port.type) if port.direction == "input" else ()


def _models(workspace: Workspace, path: str) -> Iterator[Interface]:
    for symbol in (each.symbol for each in workspace.files[path].defined):
        model = symbol.target
        if symbol.kind is Kind.MODEL and isinstance(model, Model) and model.category.raw != "SubTree":
            # Only the robot's program knows whether it requires an input.
            declared = (PortInterface(port.name, _values(port), doc=port.doc) for port in map(as_kind, model.ports))
            ports = {each.name: each for each in declared if is_port_name(each.name) and is_xml_name(each.name)}
            doc = model.text.text if model.text is not None else ""
            category = model.category.raw
            # A model without ports is often unfinished; the checks warn of ports then, and do not refuse them.
            yield Interface(symbol.name, (category,), *CHILDREN[category], ports, not ports, doc)


def _merged(first: Interface, second: Interface) -> Interface:
    most = None if first.most is None or second.most is None else max(first.most, second.most)
    categories = tuple(dict.fromkeys((*first.categories, *second.categories)))
    ports = merged_ports((first, second))
    is_open = first.is_open or second.is_open
    return Interface(
        first.name, categories, min(first.least, second.least), most, ports, is_open, first.doc or second.doc
    )


def merged_ports(nodes: Iterable[Interface]) -> dict[str, PortInterface]:
    """The ports of a node that may be any of several: none is required."""
    ports: dict[str, PortInterface] = {}
    for node in nodes:
        for name, port in node.ports.items():
            earlier = ports.get(name, port)
            values = port.values if port.values == earlier.values else ()
            ports[name] = PortInterface(name, values, doc=earlier.doc if earlier.doc == port.doc else "")
    return ports
