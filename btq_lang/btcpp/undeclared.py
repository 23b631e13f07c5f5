"""Models of nodes that are used and nowhere declared: Groot opens no tree with a node that it does not know.

One invariant: such a model says what the uses suggest and no more, so it can be told from one that somebody wrote.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from btq_lang.btcpp.document import Attribute, Document, Element, escape, write
from btq_lang.btcpp.models import model_element
from btq_lang.btcpp.source import Source
from btq_lang.btcpp.trees import CustomNode, Trees
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.symbols import Kind
from btq_lang.syntax import Model, Models, Tree
from btq_lang.workspace import Workspace

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final


def undeclared(source: Source, nodes: Mapping[str, CustomNode]) -> Iterator[Element]:
    """A model for each node that has none, as its uses suggest it.

    Args:
        nodes: the nodes that the file uses and that are none of the engine's, by ID.
    """
    missing = [(name, node) for name, node in nodes.items() if source.scope.find(Kind.MODEL, name) is None]
    for name, node in sorted(missing, key=_in_order):
        yield _suggested(name, node)


def made_models(workspace: Workspace, path: str) -> frozenset[str]:
    """The nodes of an XML file whose models are such as a build adds by itself."""
    source = Source(workspace, path, workspace.project.target, verbatim=False)
    trees = Trees(source)
    written: dict[str, str] = {}
    for entry in source.file.parsed.entries:
        item = entry.item
        if isinstance(item, Tree):
            trees.element(entry, item)
        for model in item.models if isinstance(item, Models) else (item,):
            if isinstance(model, Model):
                written[model.name.text if model.name else ""] = _text(model_element(source, entry, model))
    suggested = ((name, _text(_suggested(name, node))) for name, node in trees.custom.items())
    return frozenset(name for name, text in suggested if written.get(name) == text)


def _suggested(name: str, node: CustomNode) -> Element:
    # A literal can only go in; what an entry is for, nobody says.
    ports = [
        Element("inout_port" if is_entry else "input_port", [Attribute("name", port)])
        for port, is_entry in node.ports.items()
    ]
    return Element(node.category, [Attribute("ID", escape(name))], ports)


def _in_order(node: tuple[str, CustomNode]) -> tuple[int, str]:
    return _ORDER[node[1].category], node[0]


def _text(element: Element) -> str:
    return write(Document([element]))


_ORDER: Final[dict[str, int]] = {category: index for index, category in enumerate(CATEGORIES)}
