"""Puts elements around the element of a node, and removes them.

One invariant: `unwrapped` is the inverse of `wrapped`, and knows what it needs from the elements alone: every added
element has the attribute `_btq`, with the requirement that it enforces, and the outermost one records which attributes
it took from the node and their positions.  It does not know why an element is added.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from typing import Final

from btq_lang.btcpp.around import Wrapper, marked, may_be_skipped
from btq_lang.btcpp.document import Attribute, Content, Element, XmlComment
from btq_lang.btcpp.marks import MARK
from btq_lang.catalog.kinds import CATEGORIES

MOVED: Final = "_btq_moved"


def wrapped(element: Element, wrappers: Sequence[Wrapper]) -> Element:
    """The outermost of the elements around a node's, which takes over the conditions by which the node may be skipped;
    at least one wrapper, in the order of the definitions of the requirements."""
    ordered = sorted(wrappers, key=lambda wrapper: wrapper.rank)
    moved = _moved(element)
    made = element
    for wrapper in reversed(ordered):
        made = _around(made, wrapper)
    if moved:
        said = " ".join(f"{attribute.name}:{index}" for index, attribute in moved)
        made.attributes = (*made.attributes, *(attribute for _, attribute in moved), Attribute(MOVED, said))
    return made


def unwrapped(element: Element, holding: Container[Element]) -> list[Content] | None:
    """The contents of a wrapper: the node as it was, with the comments around it, and nothing for an added Script or
    ScriptCondition; None if a user has added another node.  `holding`: the elements of the document that hold a node.
    """
    nodes = [child for child in element.elements if child in holding]
    if len(nodes) > 1:
        return None
    if nodes:
        _give_back(element, _innermost(nodes[0], holding))
    return [child for child in element.children if child in nodes or isinstance(child, XmlComment)]


def holding_nodes(root: Element) -> set[Element]:
    """The elements that are nodes themselves, or around one."""
    outside_in = [root]
    for element in outside_in:
        outside_in += element.elements
    found: set[Element] = set()
    for element in reversed(outside_in):
        if element.get(MARK) is None or not found.isdisjoint(element.elements):
            found.add(element)
    return found


def _moved(element: Element) -> list[tuple[int, Attribute]]:
    """The conditions that a node loses, with their positions: the wrapper of a node that may be skipped must be skipped
    instead."""
    names = [attribute.name for attribute in element.attributes]
    if not may_be_skipped(names):
        return []
    moved = [(index, each) for index, each in enumerate(element.attributes) if each.name in _PRECONDITIONS]
    element.attributes = tuple(each for each in element.attributes if each.name not in _PRECONDITIONS)
    return moved


def _around(element: Element, wrapper: Wrapper) -> Element:
    inside = element
    if wrapper.tag == "ReactiveSequence" and element.tag in CATEGORIES and element.tag != "SubTree":
        # The engine refuses an explicit form directly in a ReactiveSequence.
        inside = marked("Sequence", wrapper.requirement, {"name": f"{wrapper.name}_node"}, [element])
    children = (*wrapper.before, inside, *wrapper.behind)
    return marked(wrapper.tag, wrapper.requirement, {"name": wrapper.name, **dict(wrapper.attributes)}, children)


def _innermost(element: Element, holding: Container[Element]) -> Element:
    """The node itself, in what is around it."""
    while element.get(MARK) is not None:
        inside = [child for child in element.elements if child in holding]
        if len(inside) != 1:
            break
        element = inside[0]
    return element


def _give_back(outermost: Element, node: Element) -> None:
    moved = outermost.get(MOVED) or ""
    own = {attribute.name: attribute for attribute in outermost.attributes}
    for said in moved.split():
        name, _, index = said.partition(":")
        if name in own and index.isdecimal() and node.get(name) is None:
            place = outermost.place(own[name])
            at = int(index)
            given_back = Attribute(name, own[name].raw, place)
            node.attributes = (*node.attributes[:at], given_back, *node.attributes[at:])


_PRECONDITIONS: Final = ("_failureIf", "_successIf", "_skipIf", "_while")
