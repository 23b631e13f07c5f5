"""The tree that the engine creates from documents: every node with its number and path in logs.

One invariant: numbers and paths are those of the engine: numbers depth first from 1, each subtree in place of its
SubTree node; a path is that of the SubTree node above and the name, followed by the number if the node has no name of
its own.  It knows elements, and nothing of missions.

Source: XMLParser::PImpl::recursivelyCreateSubtree and createNodeFromXML in src/xml_parsing.cpp.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.btcpp.document import Document, Element, Raw
from btq_lang.btcpp.reader import read
from btq_lang.util.record import Record


class Instance(Record):
    """A node of the tree that runs.

    Attributes:
        uid: its number; None after a SubTree whose tree is unknown, because the number of its nodes is unknown too.
        path: as the engine's `fullPath`.
        element: the element that it is created from; one element may become many nodes.
        callers: the SubTree elements around it, the outermost first.
        parent: the number of the node above it; 0 for the root, None if that is unknown.
    """

    uid: int | None
    path: str
    element: Element
    callers: tuple[Element, ...]
    parent: int | None


def instances(documents: Iterable[Document], main: str) -> Iterator[Instance]:
    """The nodes of the tree with the ID `main` and of the subtrees in it, in the order of their numbers."""
    tops = (each for document in documents for each in document.root.elements if each.tag == "BehaviorTree")
    trees = {ID: tree for tree in tops if (ID := tree.get("ID")) is not None}
    uid: int | None = 0
    top = trees.get(main)
    callers: tuple[Element, ...] = ()
    parent: int | None = 0
    waiting = [(child, "", callers, parent) for child in _children(top)] if top is not None else []
    while waiting:
        element, prefix, callers, parent = waiting.pop()
        if uid is not None:
            uid = uid + 1 if uid < _MOST else None
        path = prefix + _own_path(element, uid)
        yield Instance(uid, path, element, callers, parent)
        if element.tag != "SubTree":
            waiting += [(child, prefix, callers, uid) for child in _children(element)]
            continue
        name = element.get("ID") or ""
        tree = trees.get(name)
        if uid is None or tree is None or name == main or any(name == caller.get("ID") for caller in callers):
            uid = None
        else:
            waiting += [(child, f"{path}/", (*callers, element), uid) for child in _children(tree)]


def _own_path(element: Element, uid: int | None) -> str:
    ID = element.tag if element.tag not in _WITH_ID else element.get("ID") or ""
    name = element.get("name")
    return name if name is not None and name != ID else f"{ID}::{'?' if uid is None else uid}"


def _children(element: Element) -> list[Element]:
    """The child elements, in reverse order; an element that a mission spells out is parsed."""
    children = []
    for child in element.children:
        if isinstance(child, Element):
            children.append(child)
        elif isinstance(child, Raw) and (document := read(child.text).document) is not None:
            children.append(document.root)
    children.reverse()
    return children


_WITH_ID: Final = frozenset(("Action", "Condition", "Control", "Decorator", "SubTree"))
_MOST: Final = 65_535  # the engine numbers nodes with 16 bits
