"""Models of nodes that are used and nowhere declared: Groot opens no tree with a node that it does not know.

One invariant: such a model says what the uses suggest and no more, so it differs from one that a user wrote; it is the
same in all files of a mission, and omitted if a file that includes this one declares the node.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.btcpp.document import Attribute, Element, escape
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.name_kinds import Kind
from btq_lang.syntax.tree import Model, models_in
from btq_lang.workspace.custom_nodes import CustomNode, custom_nodes, custom_nodes_of
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace


def undeclared(workspace: Workspace, path: str) -> dict[str, CustomNode]:
    """The nodes that a file uses and that neither it, nor what it includes, nor what includes it declares."""
    scope = workspace.scope(path)
    used = custom_nodes_of(workspace.files[path])
    missing = [name for name in used if scope.find(Kind.MODEL, name) is None]
    if missing and path in workspace.included_files:
        above = [workspace.scope(other) for other in workspace.files if path in workspace.closure(other)]
        missing = [name for name in missing if not any(scope.find(Kind.MODEL, name) for scope in above)]
    if not missing:
        return {}
    known = custom_nodes(workspace, path)
    return {name: known[name] for name in sorted(missing, key=lambda name: (_ORDER[known[name].category], name))}


def suggested_model(name: str, node: CustomNode) -> Element:
    """The model of a node as its uses suggest it."""
    ports = [Element(f"{port.direction}_port", [Attribute("name", port.name)]) for port in node.ports]
    return Element(node.category, [Attribute("ID", escape(name))], [*ports])


def made_models(workspace: Workspace, path: str) -> frozenset[str]:
    """The nodes of an XML file whose models look like those that a build adds."""
    known = custom_nodes(workspace, path)
    return frozenset(
        name for name, model in _models(workspace.files[path]) if name in known and _may_be_made(model, known[name])
    )


def _models(file: File) -> Iterator[tuple[str, Model]]:
    for entry in file.parsed.entries:
        for model in models_in(entry.item):
            if model.name is not None:
                yield model.name.text, model


def _may_be_made(model: Model, node: CustomNode) -> bool:
    """Whether a model says no more than a node's uses suggest; unseen files may use more of its ports."""
    names = {port.name.text for port in model.ports if port.name is not None}
    used = {port.name for port in node.ports}
    says_more = any(port.type or port.default or port.attributes or port.text for port in model.ports)
    is_plain = len(names) == len(model.body) and not model.attributes and model.text is None
    return is_plain and not says_more and model.category.raw == node.category and names >= used


_ORDER: Final[dict[str, int]] = {category: index for index, category in enumerate(CATEGORIES)}
