"""Removing from XML what a build has added, for the .btq file says it itself (see `marks`).

One invariant: XML that no build has made does not change, and what is removed is reported in one line; the comment that
marks a file as generated is removed without a report.
"""

from __future__ import annotations

from btq_lang.btcpp.document import Attribute, Content, Document, Element, XmlComment
from btq_lang.btcpp.marks import DESCRIPTION_MARK, MARK, is_generated_mark, own_description
from btq_lang.btcpp.version3 import VersionNote
from btq_lang.btcpp.wrappers import MOVED, holding_nodes, unwrapped
from btq_lang.util.text import Span, counted


def may_be_generated(text: str) -> bool:
    """Whether XML can hold a mark at all: most has none, and need not be searched."""
    return "btq" in text and (DESCRIPTION_MARK in text or "by btq" in text or f"{MARK}=" in text)


def without_generated(document: Document, changes: list[VersionNote]) -> int:
    """Remove the marks, in place; return the number of elements that a build had described."""
    document.contents[:] = [
        part for part in document.contents if not (isinstance(part, XmlComment) and is_generated_mark(part.text))
    ]
    enforcing: list[Span] = []
    described: list[Span] = []
    stack = [document.root]
    holding = holding_nodes(document.root)
    while stack:
        element = stack.pop()
        _remove_guards(element, holding, enforcing)
        stack += element.elements
        for index, attribute in enumerate(element.attributes):
            if attribute.name == "_description" and DESCRIPTION_MARK in attribute.raw:
                described += _cut_description(element, index)
                break
    parts: list[str] = []
    if enforcing:
        parts.append(counted(len(enforcing), "node that enforces requirements", "nodes that enforce requirements"))
    if described:
        parts.append(counted(len(described), "description"))
    if parts:
        first = min((*enforcing, *described))
        changes.append(VersionNote(first, f"removed what `btq build` added: {', '.join(parts)}"))
    return len(described)


def _remove_guards(parent: Element, holding: set[Element], spans: list[Span]) -> None:
    """Remove the nodes that enforce requirements from an element's children; keep the mission's own nodes in them."""
    remaining: list[Content] = []
    waiting = parent.children[::-1]
    while waiting:
        child = waiting.pop()
        inside = None
        if isinstance(child, Element) and child.get(MARK) is not None:
            inside = unwrapped(child, holding)
            if inside is None:  # it was edited, so it belongs to the user now
                child.attributes = tuple(each for each in child.attributes if each.name not in (MARK, MOVED))
            else:
                spans.append(child.tag_span)
                waiting += reversed(inside)
        if inside is None:
            remaining.append(child)
    parent.children[:] = remaining


def _cut_description(element: Element, index: int) -> tuple[Span, ...]:
    """Keep the user's part of a `_description`; return where more was cut."""
    attribute, remaining = element.attributes[index], [*element.attributes]
    start, value_start = element.place(attribute)
    own = own_description(attribute.raw)
    if own == attribute.raw:
        return ()
    if own is None:
        del remaining[index]
    else:
        remaining[index] = Attribute(attribute.name, own, (start, value_start))
    element.attributes = tuple(remaining)
    return (Span(start, value_start + len(attribute.raw) + 1),)
