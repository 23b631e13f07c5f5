"""Models as XML: the contents of `<TreeNodesModel>`, so that Groot shows and edits the nodes of a robot.

The engine reads only the models of SubTrees, but Groot opens no tree with a node that it does not know.  One invariant:
declared nodes come first, in their order; then those that are used and nowhere declared: such a model says what the
uses suggest and no more, so it differs from one that a user wrote; it is the same in all files of a mission.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.btcpp.attributes import attributes_of, only_first
from btq_lang.btcpp.constants import fitting
from btq_lang.btcpp.document import Attribute, Content, Element, XmlText, escape
from btq_lang.btcpp.source import ExportSource
from btq_lang.btcpp.spelling import spelt
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.syntax.tree import Entry, Meta, Model, Port, Tree, Verbatim, Word, models_in
from btq_lang.util.record import replace
from btq_lang.workspace.custom_nodes import CustomNode, custom_nodes, custom_nodes_of, is_declared
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace


def model_element(source: ExportSource, entry: Entry, model: Model) -> Element:
    """`Action MoveBase` with its ports."""
    attributes = []
    if model.name is not None:
        is_tree = model.category.raw == "SubTree"
        attributes.append(Attribute("ID", source.spelt_tree(model.name) if is_tree else spelt(model.name)))
    attributes += attributes_of(source, entry, model.attributes)
    element = Element(model.category.raw, only_first(attributes))
    own = source.around(entry, model)
    contents = element.children
    contents += source.written(own.first, beside=True)
    if model.text is not None:
        contents.append(Element("description", (), [XmlText(model.text.text)] if model.text.text else []))
    fields: Element | None = None
    for part in model.body:
        around = source.around(entry, part)
        if isinstance(part, Meta):
            metadata = Element("Metadata", attributes_of(source, entry, part.attributes))
            if fields is None:
                fields = Element("MetadataFields")
                contents += source.written(around.before)
                contents.append(fields)
                source.put(fields.children, metadata, replace(around, before=()))
            else:
                source.put(fields.children, metadata, around)
            continue
        fields = None
        part_element = (
            source.raw(entry, part)
            if isinstance(part, Verbatim)
            else port_element(source, entry, part, model.name if model.category.raw == "SubTree" else None)
        )
        source.put(contents, part_element, around)
    contents += source.written(own.last)
    return element


def port_element(source: ExportSource, entry: Entry, port: Port, tree: Word | None = None) -> Element:
    """`input station : string = "charger" "where to go"`; tree: that has the port, if it is a tree's."""
    words = (("name", port.name), ("type", port.type), ("default", port.default))
    attributes = [Attribute(name, spelt(word)) for name, word in words if word is not None]
    if tree is not None and port.name is not None and port.default is not None and not source.verbatim:
        raw = attributes[-1].raw
        fit = fitting(source.types_below(tree.text, port.name.text), raw)
        if fit != raw:
            source.respelt(entry, port.default, raw, fit)
            attributes[-1] = Attribute("default", fit)
    attributes += attributes_of(source, entry, port.attributes)
    element = Element(f"{port.direction.raw}_port", only_first(attributes))
    own = source.around(entry, port)
    element.children.extend(source.written(own.first, beside=True))
    if port.text is not None and port.text.text:
        element.children.append(XmlText(port.text.text))
    element.children.extend(source.written(own.last))
    return element


class ModelCollector:
    """The models of a file, as they are found.

    Attributes:
        palettes: the `TreeNodesModel` elements of the file.
        loose: models outside of them, with their comments.
        trees: each tree of the file and its entry.
    """

    def __init__(self) -> None:
        self.palettes: Final[list[Element]] = []
        self.loose: Final[list[Content]] = []
        self.trees: Final[list[tuple[Entry, Tree]]] = []

    def rest(self, source: ExportSource, others: Iterable[Element]) -> list[Content]:
        """The contents to write last, with models that the file does not have itself, in a TreeNodesModel of the file
        or else in a new one."""
        for entry, tree in self.trees:
            self._add_ports(source, entry, tree)
        self.loose.extend(others)
        if self.palettes:
            self.palettes[0].children.extend(self.loose)
            return []
        return [Element("TreeNodesModel", (), self.loose)] if self.loose else []

    def _add_ports(self, source: ExportSource, entry: Entry, tree: Tree) -> None:
        """Add the ports that a tree declares in its block: the engine requires them at each SubTree."""
        if not tree.ports or tree.name is None:
            return
        raw = source.spelt_tree(tree.name)
        model = next((each for each in self._elements() if _declares(each, raw)), None)
        declared = {port.get("name") for port in model.elements} if model is not None else set()
        if model is None:
            model = Element("SubTree", [Attribute("ID", raw)])
            self.loose.append(model)
        for port in tree.ports:
            if port.name is None or port.name.text not in declared:
                source.put(model.children, port_element(source, entry, port, tree.name), source.around(entry, port))

    def _elements(self) -> Iterator[Element]:
        for contents in (*(palette.children for palette in self.palettes), self.loose):
            yield from (content for content in contents if isinstance(content, Element))


def _declares(model: Element, raw: str) -> bool:
    return model.tag == "SubTree" and any(each.name == "ID" and each.raw == raw for each in model.attributes)


def undeclared(workspace: Workspace, path: str) -> dict[str, CustomNode]:
    """The nodes that a file uses and that neither it, nor what it includes, nor what includes it declares."""
    missing = [name for name in custom_nodes_of(workspace, path) if not is_declared(workspace, path, name)]
    if not missing:
        return {}
    nodes = custom_nodes(workspace, path)
    return {name: nodes[name] for name in sorted(missing, key=lambda name: (_ORDER[nodes[name].category], name))}


def suggested_model(name: str, node: CustomNode) -> Element:
    """The model of a node as its uses suggest it."""
    ports = [Element(f"{port.direction}_port", [Attribute("name", port.name)]) for port in node.ports]
    return Element(node.category, [Attribute("ID", escape(name))], [*ports])


def made_models(workspace: Workspace, path: str) -> frozenset[str]:
    """The nodes of an XML file whose models look like those that a build adds."""
    nodes = custom_nodes(workspace, path)
    return frozenset(
        name for name, model in _models(workspace.files[path]) if name in nodes and _may_be_made(model, nodes[name])
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
