"""Taking out of XML what a build has put into it: the marks of `marks`, for the .btq file says all that itself.

One invariant: XML that no build has made is left as it is, and every removal is told.
"""

from __future__ import annotations

from btq_lang.btcpp.document import Attribute, Comment, Document, Element
from btq_lang.btcpp.marks import DESCRIPTION_MARK, is_generated_mark, own_description
from btq_lang.btcpp.version3 import Change
from btq_lang.btcpp.wrappers import MARK, MOVED, unwrapped
from btq_lang.text import Span


def may_be_generated(text: str) -> bool:
    """Whether XML can hold a mark at all: most does not, and need not be looked through."""
    return DESCRIPTION_MARK in text or "by btq" in text or f"{MARK}=" in text


def without_generated(document: Document, changes: list[Change]) -> None:
    """Take the marks out, in place."""
    for content in list(document.contents):
        if isinstance(content, Comment) and is_generated_mark(content.text):
            end = content.start + len(content.text) + len("<!---->")
            changes.append(Change(Span(content.start, end), "the mark of a generated file is left out"))
            document.contents.remove(content)
    stack = [document.root]
    while stack:
        element = stack.pop()
        _take_out(element, changes)
        stack += element.elements
        for index, attribute in enumerate(element.attributes):
            if attribute.name == "_description" and DESCRIPTION_MARK in attribute.raw:
                _cut(element, index, changes)
                break


def _take_out(parent: Element, changes: list[Change]) -> None:
    """What enforces a requirement, among the children of an element; what is in it comes up."""
    index = 0
    while index < len(parent.children):
        child = parent.children[index]
        if not isinstance(child, Element) or child.get(MARK) is None:
            index += 1
            continue
        inside = unwrapped(child)
        if inside is None:  # now it is somebody's
            child.attributes[:] = [each for each in child.attributes if each.name not in (MARK, MOVED)]
            continue
        what = f"<{child.tag}> `{child.get('name')}`, which a build put there, is left out"
        changes.append(Change(Span(child.start + 1, child.start + 1 + len(child.tag)), what))
        parent.children[index : index + 1] = inside


def _cut(element: Element, index: int, changes: list[Change]) -> None:
    """The user's part of a `_description`."""
    attribute = element.attributes[index]
    own = own_description(attribute.raw)
    if own == attribute.raw:
        return
    end = attribute.value_start + len(attribute.raw) + 1
    changes.append(Change(Span(attribute.start, end), "what a build wrote into this _description is left out"))
    if own is None:
        del element.attributes[index]
    else:
        element.attributes[index] = Attribute(attribute.name, own, attribute.place)
