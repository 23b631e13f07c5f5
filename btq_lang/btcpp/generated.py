"""Taking out of XML what a build has put into it: the marks of `marks`, for the .btq file says all that itself.

One invariant: XML that no build has made is left as it is, and what is removed is told, in one line.
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


def without_generated(document: Document, changes: list[Change]) -> int:
    """Take the marks out, in place; in how many elements a build had something to say."""
    marks: list[Span] = []
    for content in list(document.contents):
        if isinstance(content, Comment) and is_generated_mark(content.text):
            marks.append(Span(content.start, content.start + len(content.text) + len("<!---->")))
            document.contents.remove(content)
    enforcing: list[Span] = []
    described: list[Span] = []
    stack = [document.root]
    while stack:
        element = stack.pop()
        _take_out(element, enforcing)
        stack += element.elements
        for index, attribute in enumerate(element.attributes):
            if attribute.name == "_description" and DESCRIPTION_MARK in attribute.raw:
                described += _cut(element, index)
                break
    if marks or enforcing or described:
        parts = [
            *(("its mark",) if marks else ()),
            *((_counted(len(enforcing), "node that enforces", "nodes that enforce"),) if enforcing else ()),
            *((_counted(len(described), "description", "descriptions"),) if described else ()),
        ]
        first = min((*marks, *enforcing, *described))
        changes.append(Change(first, f"what a build put there is left out: {', '.join(parts)}"))
    return len(described)


def _counted(number: int, one: str, many: str) -> str:
    return f"{number} {one if number == 1 else many}"


def _take_out(parent: Element, found: list[Span]) -> None:
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
        found.append(Span(child.start + 1, child.start + 1 + len(child.tag)))
        parent.children[index : index + 1] = inside


def _cut(element: Element, index: int) -> tuple[Span, ...]:
    """Leave the user's part of a `_description`; where there was more."""
    attribute = element.attributes[index]
    own = own_description(attribute.raw)
    if own == attribute.raw:
        return ()
    if own is None:
        del element.attributes[index]
    else:
        element.attributes[index] = Attribute(attribute.name, own, attribute.place)
    return (Span(attribute.start, attribute.value_start + len(attribute.raw) + 1),)
