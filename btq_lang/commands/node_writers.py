"""Nodes of C++ sources as models: in btq's own language, and as XML for Groot; and as a page for people.

One invariant: the first line says what wrote the file, so that it is not taken for a handwritten mission.
"""

from __future__ import annotations

import html
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final

from btq_lang.btcpp.document import Attribute, Comment, Document, Element, Text, escape, write
from btq_lang.btcpp.importing import import_xml
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.cpp.model import CppNode, CppNodes, CppPort
from btq_lang.render.page_style import PAGE_STYLE
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
    return write(Document([Comment(f" {_headline(sources)} "), root]))


def _headline(sources: str) -> str:
    return f"{MADE_BY} from {sources.replace('--', '- -')}: change the C++ code and run it again"


def _with_optional_inputs(node: CppNode) -> CppNode:
    ports = tuple(replace(port, default="") if node.goes_on_without(port) else port for port in node.ports)
    return replace(node, ports=ports)


def _models(nodes: Iterable[CppNode], texts: Mapping[str, str]) -> Iterator[Comment | Element]:
    for node in nodes:
        if not node.complete:
            yield Comment(f" it cannot be seen whether {node.name} has more ports ")
        text = [Element("description", (), [Text(texts[node.name])])] if node.name in texts else []
        yield Element(node.category, [Attribute("ID", escape(node.name))], [*text, *map(_port, node.ports)])


def _port(port: CppPort) -> Element:
    said = (("name", port.name), ("type", port.type or None), ("default", port.default))
    attributes = [Attribute(key, escape(value)) for key, value in said if value is not None]
    return Element(f"{port.direction}_port", attributes, [Text(port.text)] if port.text.strip() else [])


def as_html(found: CppNodes, sources: str) -> str:
    """The nodes as one page that needs nothing but itself, each port with the place where it is provided."""
    return "\n".join(_lines(found, sources)) + "\n"


def _lines(found: CppNodes, sources: str) -> Iterator[str]:
    title = f"Nodes of {sources}"
    yield "<!DOCTYPE html>"
    yield '<html lang="en">'
    yield '<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{html.escape(title)}</title>"
    yield f"<style>\n{PAGE_STYLE}</style></head>"
    yield f"<body><header><h1>{html.escape(title)}</h1></header>"
    yield "<main>"
    for category in CATEGORIES:
        if nodes := [node for node in found.nodes if node.category == category]:
            yield f"<h2>{category}</h2>"
            for node in nodes:
                yield from _node(node)
    if found.unseen:
        yield "<h2>What cannot be seen</h2>"
        yield "<ul>"
        yield from (
            f"<li><code>{html.escape(str(each.place))}</code> {html.escape(each.message)}</li>" for each in found.unseen
        )
        yield "</ul>"
    yield "</main></body></html>"


def _node(node: CppNode) -> Iterator[str]:
    yield f'<section id="{html.escape(node.name)}"><h3>{html.escape(node.name)}</h3>'
    of = f"class <code>{html.escape(node.class_name)}</code> at " if node.class_name else "function registered at "
    yield f"<p>{of}<code>{html.escape(str(node.class_place))}</code></p>"
    if not node.complete:
        yield '<p class="missing">It may have more ports.</p>'
    if node.ports:
        yield "<table><thead><tr><th>Port</th><th>Type</th><th>Default</th><th>Meaning</th><th>Place</th></tr></thead>"
        yield "<tbody>"
        yield from (_row(port, _remarks(node, port)) for port in node.ports)
        yield "</tbody></table>"
    else:
        yield '<p class="empty">No ports.</p>'
    yield "</section>"


def _row(port: CppPort, remarks: Sequence[str]) -> str:
    cells = (
        f"{port.direction} <span class='name'>{html.escape(port.name)}</span>",
        f"<code>{html.escape(port.type)}</code>",
        f"<code>{html.escape(port.written)}</code>",
        " ".join(map(html.escape, (port.text, *remarks))),
        f"<code class='at'>{html.escape(str(port.place))}</code>",
    )
    return f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def _remarks(node: CppNode, port: CppPort) -> list[str]:
    remarks = [_WITHOUT[what] for name, what in node.without if name == port.name and what in _WITHOUT]
    return [*remarks, *(["The code never names it."] if port in node.unread else [])]


_BLANK_LINE = "\n\n"
_WITHOUT: Final = {"fails": "The node fails without it.", "goes on": "The node goes on without it."}
