"""Nodes of C++ sources as models: in btq's own language, and as XML for Groot; and as a page for people.

One invariant: the first line names the writer, so that the file is not taken for a handwritten mission.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from btq_lang.btcpp.document import Attribute, Document, Element, XmlComment, XmlText, escape, write
from btq_lang.btcpp.importing import import_xml
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.cpp.model import CppNode, CppNodes, CppPort
from btq_lang.util.record import replace

MADE_BY = "made by `btq nodes`"


def as_btq(nodes: Iterable[CppNode], sources: str) -> str:
    """The models in btq's language; an input that the code is seen to do without has an empty default."""
    return models_in_btq(map(_with_optional_inputs, nodes), _headline(sources))


def models_in_btq(nodes: Iterable[CppNode], headline: str, texts: Mapping[str, str] | None = None) -> str:
    """The models in btq's language, below a comment; texts: descriptions of nodes, by name."""
    models = _models(nodes, texts or {})
    text = import_xml(write(Document([Element("root", (), [Element("TreeNodesModel", (), models)])]))).text
    return f"# {headline}\n\n{text.partition(_BLANK_LINE)[2]}"


def as_xml(nodes: Iterable[CppNode], sources: str) -> str:
    """The models as XML."""
    root = Element("root", [Attribute("BTCPP_format", "4")], [Element("TreeNodesModel", (), _models(nodes, {}))])
    return write(Document([XmlComment(f" {_headline(sources)} "), root]))


def _headline(sources: str) -> str:
    return f"{MADE_BY} from {sources.replace('--', '- -')}: change the C++ code and run it again"


def _with_optional_inputs(node: CppNode) -> CppNode:
    ports = tuple(replace(port, default="") if node.goes_on_without(port) else port for port in node.ports)
    return replace(node, ports=ports)


def _models(nodes: Iterable[CppNode], texts: Mapping[str, str]) -> Iterator[XmlComment | Element]:
    for node in nodes:
        if not node.complete:
            yield XmlComment(f" it cannot be seen whether {node.name} has more ports ")
        text = [Element("description", (), [XmlText(texts[node.name])])] if node.name in texts else []
        yield Element(node.category, [Attribute("ID", escape(node.name))], [*text, *map(_port, node.ports)])


def _port(port: CppPort) -> Element:
    values = (("name", port.name), ("type", port.type or None), ("default", port.default))
    attributes = [Attribute(key, escape(value)) for key, value in values if value is not None]
    return Element(f"{port.direction}_port", attributes, [XmlText(port.text)] if port.text.strip() else [])


def as_html(cpp_nodes: CppNodes, sources: str) -> str:
    """The nodes as one page that needs nothing but itself, each port with the place where it is provided."""
    from btq_lang.render.pages import page

    categories = [
        (category, [node for node in cpp_nodes.nodes if node.category == category]) for category in CATEGORIES
    ]
    return page(
        "projects/nodes.html.j2",
        title=f"Nodes of {sources}",
        categories=[
            (category, [(node, [(port, _meaning(node, port)) for port in node.ports]) for node in nodes])
            for category, nodes in categories
            if nodes
        ],
        unseen=cpp_nodes.unseen,
    )


def _meaning(node: CppNode, port: CppPort) -> str:
    of_port = [what for name, what in node.without if name == port.name and port.default is None]
    remarks = [_WITHOUT[what] for what in of_port if what in _WITHOUT]
    return " ".join([port.text, *remarks, *(["The code never names it."] if port in node.unread else [])])


_BLANK_LINE = "\n\n"
_WITHOUT: Final = {"fails": "The node fails without it.", "goes on": "The node goes on without it."}
