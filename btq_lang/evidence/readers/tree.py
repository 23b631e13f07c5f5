"""The tree in a log, from the XML that the engine's loggers write.

One invariant: nodes are numbered as BehaviorTree.CPP does, 1, 2, 3 … depth first, each after its parent; a tree with
other numbers is refused.

The engine writes one `<BehaviorTree>` for each instance of a subtree, and a `SubTree` element does not name its own: it
is the one whose first node has the number after the SubTree's.
"""

from __future__ import annotations

from typing import Final

from btq_lang.btcpp.document import Element
from btq_lang.btcpp.reader import read as read_xml
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.evidence.model import ROOT, LoggedTree
from btq_lang.syntax.tokens import CATEGORIES


class NotALog(Exception):
    """A file that is not a log; the message says what was expected."""


def read_tree(xml: bytes | str) -> LoggedTree:
    """The tree of a log.

    Raises:
        NotALog: there is no tree in the XML.
    """
    text = xml.decode("utf-8", "replace") if isinstance(xml, bytes) else xml
    document = read_xml(text).document
    if document is None or document.root.tag != "root":
        raise NotALog("its tree is not BehaviorTree.CPP XML")
    tops: dict[int, tuple[Element, str]] = {}  # the top node of each tree, by uid, with the path of the tree
    name = ""
    for tree in document.root.elements:
        if tree.tag == "BehaviorTree":
            for element in tree.elements:
                tops[_uid(element)] = element, tree.get("_fullpath") or ""
                name = tree.get("ID") or name if _uid(element) == ROOT else name
    if ROOT not in tops:
        raise NotALog("its tree has no node with `_uid` 1")
    nodes, delays = _numbered(tops)
    if [uid for uid, *_ in nodes] != [*range(1, len(nodes) + 1)]:
        raise NotALog("the nodes of its tree are not numbered 1, 2, 3 … as BehaviorTree.CPP numbers them")
    return LoggedTree(nodes, name, xml=text, delays=delays)


def _numbered(tops: dict[int, tuple[Element, str]]) -> tuple[list[tuple[int, str, str, int]], dict[int, int]]:
    """uid, kind, path and parent of each node, in the order of the document with subtrees in their places; and by uid
    how long the Delays wait.
    """
    nodes: list[tuple[int, str, str, int]] = []
    delays: dict[int, int] = {}
    waiting = [(*tops.pop(ROOT), 0)]
    while waiting:
        element, prefix, parent = waiting.pop()
        uid = _uid(element)
        nodes.append((uid, kind_of(element), _path(element, uid, prefix), parent))
        if (delay := delay_of(element)) is not None:
            delays[uid] = delay
        if element.tag == "SubTree":
            if uid + 1 in tops:  # popped: no tree is below two nodes, or itself
                waiting.append((*tops.pop(uid + 1), uid))
        else:
            waiting += [(child, prefix, uid) for child in reversed([*element.elements])]
    return nodes, delays


def _uid(element: Element) -> int:
    uid = element.get("_uid") or ""
    return int(uid) if uid.isascii() and uid.isdecimal() and len(uid) <= _MOST_DIGITS else 0


def kind_of(element: Element) -> str:
    """The ID that a node is registered under."""
    return element.get("ID") or element.tag if element.tag in CATEGORIES else element.tag


def delay_of(element: Element) -> int | None:
    """How long a Delay waits before it ticks its child, in µs; None for another node, and if the XML lacks the
    value.
    """
    time = element.get(_DELAYS.get(kind_of(element), "")) or ""
    return int(time) * 1000 if time.isascii() and time.isdecimal() and len(time) <= _MOST_TIME else None


def _path(element: Element, uid: int, prefix: str) -> str:
    if element.tag == "SubTree":
        return element.get("_fullpath") or ""
    kind = kind_of(element)
    name = element.get("name") or kind
    own = name if name != kind else f"{kind}::{uid}"
    return f"{prefix}/{own}" if prefix else own


# The nodes that wait before they tick their child, each with the port that says how long, in ms.
_DELAYS: Final = {
    kind.tag: port.name for kind in BUILTINS.values() if kind.flow == "delay" and (port := kind.port_for("time"))
}
_MOST_TIME: Final = 10  # an unsigned int
_MOST_DIGITS: Final = 5  # the engine numbers nodes with 16 bits
