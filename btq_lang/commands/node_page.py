"""Nodes of C++ sources as one page of HTML, each port with the place where it is provided.

One invariant: the page needs nothing but itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from typing import Final

from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.cpp.model import CppNode, CppNodes, CppPort
from btq_lang.render.page_style import PAGE_STYLE


def as_html(found: CppNodes, sources: str) -> str:
    """The page."""
    return "\n".join(_lines(found, sources)) + "\n"


def _lines(found: CppNodes, sources: str) -> Iterator[str]:
    title = f"Nodes of {sources}"
    yield "<!DOCTYPE html>"
    yield '<html lang="en">'
    yield '<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{escape(title)}</title>"
    yield f"<style>\n{PAGE_STYLE}</style></head>"
    yield f"<body><header><h1>{escape(title)}</h1></header>"
    yield "<main>"
    for category in CATEGORIES:
        if nodes := [node for node in found.nodes if node.category == category]:
            yield f"<h2>{category}</h2>"
            for node in nodes:
                yield from _node(node)
    if found.unseen:
        yield "<h2>What cannot be seen</h2>"
        yield "<ul>"
        yield from (f"<li><code>{escape(str(each.place))}</code> {escape(each.message)}</li>" for each in found.unseen)
        yield "</ul>"
    yield "</main></body></html>"


def _node(node: CppNode) -> Iterator[str]:
    yield f'<section id="{escape(node.name)}"><h3>{escape(node.name)}</h3>'
    of = f"class <code>{escape(node.class_name)}</code> at " if node.class_name else "function registered at "
    yield f"<p>{of}<code>{escape(str(node.class_place))}</code></p>"
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
        f"{port.direction} <span class='name'>{escape(port.name)}</span>",
        f"<code>{escape(port.type)}</code>",
        f"<code>{escape(port.written)}</code>",
        " ".join(map(escape, (port.text, *remarks))),
        f"<code class='at'>{escape(str(port.place))}</code>",
    )
    return f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def _remarks(node: CppNode, port: CppPort) -> list[str]:
    remarks = [_WITHOUT[what] for name, what in node.without if name == port.name and what in _WITHOUT]
    return [*remarks, *(["The code never names it."] if port in node.unread else [])]


_WITHOUT: Final = {"fails": "The node fails without it.", "goes on": "The node goes on without it."}
