"""Signature help: the ports of the node in whose brackets the cursor is."""

from __future__ import annotations

from btq_lang.ide import describe
from btq_lang.ide.place import place_at
from btq_lang.ide.ports import ports_of_kind, ports_of_tree
from btq_lang.util.record import Record
from btq_lang.workspace.workspace import Workspace


class Parameter(Record):
    """A port: its label is a part of the signature's."""

    label: str
    documentation: str


class Signature(Record):
    """The ports of the node on one line.  active: the one that is being given a value; None: a name that is not a
    port."""

    label: str
    documentation: str
    parameters: tuple[Parameter, ...]
    active: int | None


def signature_help(workspace: Workspace, path: str, offset: int) -> Signature | None:
    """The ports of the node in whose brackets an offset is."""
    place = place_at(workspace, path, offset)
    node = place.node
    if node is None or place.depth == 0:
        return None
    if node.is_subtree:
        ports = ports_of_tree(workspace, path, node.name)
    else:
        ports = ports_of_kind(workspace, path, node.name, node.quoted)
    if not ports:
        return None
    parameters = tuple(Parameter(port.signature, describe.port(port)) for port in ports)
    label = f"{node.name} ({', '.join(parameter.label for parameter in parameters)})"
    names = [port.name for port in ports]
    if place.key is not None:
        active = names.index(place.key) if place.key in names else None
    else:
        active = next((index for index, name in enumerate(names) if name not in place.given), None)
    return Signature(label, "", parameters, active)
