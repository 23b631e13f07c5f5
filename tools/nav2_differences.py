"""Where Nav2's own list of its nodes, which people write by hand, differs from the C++ code, each with the reason."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final, Literal, NamedTuple

from lxml import etree
from nav2_words import OF_MESSAGES

from btq_lang.cpp.model import CppNode, CppPort

Kind = Literal["not listed", "only listed", "category", "direction", "no default", "default", "type"]


class Difference(NamedTuple):
    """A node, or a port as `NODE.PORT`, and what the list and the code say of it."""

    kind: Kind
    name: str
    why: str


def differences(nodes: Sequence[CppNode], palette: str) -> Iterator[Difference]:
    """The differences of a branch.

    Args:
        palette: the text of nav2_tree_nodes.xml.
    """
    in_code = {node.name: node for node in nodes}
    models = etree.fromstring(palette.encode(), _SAFE).find("TreeNodesModel")
    listed = {model.get("ID"): model for model in models.iterchildren(tag=etree.Element)}
    for name in sorted(in_code.keys() - listed.keys()):
        yield Difference("not listed", name, f"{in_code[name].place} registers it")
    for name in sorted(listed.keys() - in_code.keys()):
        yield Difference("only listed", name, "no file registers it")
    for name in sorted(in_code.keys() & listed.keys()):
        if listed[name].tag != in_code[name].category:
            why = f"a {listed[name].tag} in the list; its base class makes it a {in_code[name].category}"
            yield Difference("category", name, why)
        yield from _of_ports(in_code[name], listed[name])


def _of_ports(node: CppNode, model: Any) -> Iterator[Difference]:
    listed = {port.get("name"): port for port in model.iterchildren(tag=etree.Element)}
    for port in node.ports:
        if port.name not in listed:
            yield Difference("not listed", f"{node.name}.{port.name}", f"{port.place} provides it")
    for name in sorted(listed.keys() - {port.name for port in node.ports}):
        yield Difference("only listed", f"{node.name}.{name}", f"{node.class_place} provides no such port")
    for port in node.ports:
        if port.name in listed:
            for kind, why in _of_port(port, listed[port.name]):
                yield Difference(kind, f"{node.name}.{port.name}", f"{why} ({port.place})")


def _of_port(port: CppPort, listed: Any) -> Iterator[tuple[Kind, str]]:
    default = listed.get("default")
    if listed.tag != f"{port.direction}_port":
        yield "direction", f"the list has <{listed.tag}>, the code says {port.direction}"
    if default is None and port.default is not None:
        yield "no default", f"the list has no default, the code `{port.default}`"
    elif default is not None and port.default is None and default != port.written.removeprefix("std::"):
        yield "default", f"the list's default `{default}` is the description in the code, the second of two arguments"
    elif not _is_default(port, default):
        yield "default", f"the default is `{default}` in the list, `{port.default}` in the code"
    if listed.get("type") is not None and _short(OF_MESSAGES.get(port.type, port.type)) != _short(listed.get("type")):
        yield "type", f"the type is `{listed.get('type')}` in the list, `{port.type}` in the code"


def _is_default(port: CppPort, listed: str | None) -> bool:
    """Whether a default of the list, which has the quotes of the code and no `std::`, is that of a port."""
    if listed is None or listed == port.written.removeprefix("std::"):
        return True
    if port.default is None:
        return False
    try:
        return float(listed) == float(port.default)
    except ValueError:
        return listed.strip('"') == port.default


def _short(type_: str) -> str:
    return type_.replace("std::", "").replace("_t", "").replace(" ", "")


_SAFE: Final = etree.XMLParser(resolve_entities=False, no_network=True)
