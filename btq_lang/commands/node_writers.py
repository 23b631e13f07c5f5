"""Nodes of C++ sources as models: in btq's own language, and as XML for Groot.

One invariant: the first line says what wrote the file, so that it is not taken for a handwritten mission.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.btcpp.document import Attribute, Comment, Document, Element, Text, escape, write
from btq_lang.btcpp.importing import import_xml
from btq_lang.cpp.model import CppNode, CppPort

MADE_BY = "made by `btq nodes`"


def as_btq(nodes: Iterable[CppNode], sources: str) -> str:
    """The models in btq's language; an input that the code is seen to do without has an empty default.

    Args:
        sources: what the nodes were read from.
    """
    models = _models(nodes, optional=True)
    text = import_xml(write(Document([Element("root", (), [Element("TreeNodesModel", (), models)])]))).text
    return f"# {_headline(sources)}\n\n{text.partition(_BLANK_LINE)[2]}"


def as_xml(nodes: Iterable[CppNode], sources: str) -> str:
    """The models as XML."""
    root = Element("root", [Attribute("BTCPP_format", "4")], [Element("TreeNodesModel", (), _models(nodes))])
    return write(Document([Comment(f" {_headline(sources)} "), root]))


def _headline(sources: str) -> str:
    return f"{MADE_BY} from {sources.replace('--', '- -')}: change the C++ code and run it again"


def _models(nodes: Iterable[CppNode], optional: bool = False) -> Iterator[Comment | Element]:
    for node in nodes:
        if not node.complete:
            yield Comment(f" it cannot be seen whether {node.name} has more ports ")
        ports = [_port(port, optional and node.goes_on_without(port)) for port in node.ports]
        yield Element(node.category, [Attribute("ID", escape(node.name))], ports)


def _port(port: CppPort, is_optional: bool) -> Element:
    default = "" if is_optional else port.default
    said = (("name", port.name), ("type", port.type or None), ("default", default))
    attributes = [Attribute(key, escape(value)) for key, value in said if value is not None]
    return Element(f"{port.direction}_port", attributes, [Text(port.text)] if port.text.strip() else [])


_BLANK_LINE = "\n\n"
