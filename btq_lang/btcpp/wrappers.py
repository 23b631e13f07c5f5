"""The elements that enforce requirements: made, put around the element of a node, and removed.

One invariant: `unwrapped` is the inverse of `wrapped`, and knows what it needs from the elements alone: every added
element has the attribute `_btq`, with the requirement that it enforces, and the outermost one records which attributes
it took from the node and their positions.  It does not know why an element is added.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from typing import Final, Literal, TypeAlias

from btq_lang.btcpp.document import Attribute, Content, Element, XmlComment, escape
from btq_lang.btcpp.marks import MARK
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.util.record import Record

MOVED: Final = "_btq_moved"

WrapperTag: TypeAlias = Literal["Sequence", "ReactiveSequence", "Timeout"]
LeafTag: TypeAlias = Literal["Script", "ScriptCondition"]

# The kinds that enforce a clause: a log shows by them what stopped a node.
LIMITING: Final = "Timeout"  # halts the node after a time
WATCHING: Final = "ReactiveSequence"  # halts the node when a condition beside it changes
EVALUATING: Final = "ScriptCondition"  # that condition, or the one that refuses a start

# From the outside in: the wrappers that several requirements put around one node are sorted by this rank.
START: Final = 0  # the beginning of the mission
VALUES: Final = 1  # values that are read when the node starts
CONDITION: Final = 2  # condition that must hold when the node starts
CHECK: Final = 3  # condition that must hold when the node has succeeded
GUARD: Final = 4  # condition that must hold while the node runs
LIMIT: Final = 5
INSIDE: Final = 6  # scripts that record the start and end of the node itself


def marked(tag: str, requirement: str, attributes: Mapping[str, str], children: Iterable[Content] = ()) -> Element:
    """An element that enforces a requirement; the values of its attributes are unescaped."""
    spelt = [Attribute(name, escape(value)) for name, value in attributes.items()]
    return Element(tag, [*spelt, Attribute(MARK, escape(requirement))], children)


def leaf(tag: LeafTag, requirement: str, name: str, code: str, failed: str | None = None) -> Element:
    """A Script or a ScriptCondition beside a node; `failed`: script that runs when it fails.

    It is skipped and does not succeed: a Sequence is skipped only if all its children are, and a node that skips itself
    must not turn into one that has succeeded. So the code of a Script runs in its `_skipIf`.
    """
    skipped = code if tag == EVALUATING else f"{code}; true"
    failing = {"_onFailure": failed} if failed is not None else {}
    return marked(tag, requirement, {"name": name, "code": code, "_skipIf": skipped, **failing})


def first_values(requirement: str, values: Mapping[str, str]) -> Element:
    """Gives values to entries that are still unwritten when the tree runs for the first time.

    A script cannot test whether an entry exists, so a node does: `WasEntryUpdated` fails if its entry was never
    written. It also fails if the entry was not written since the last test, hence the `RunOnce`.  The entry has no
    braces because a port creates an entry of its own type, in which no script can store a text.

    Args:
        values: by entry, as scripts name it (`@speed`); each a script.
    """
    writes = [
        marked("WasEntryUpdated", requirement, {"entry": entry, "_onFailure": f"{entry} := {value}"})
        for entry, value in values.items()
    ]
    # All of them are evaluated, whichever fails.
    inside = marked("ForceSuccess", requirement, {}, [marked("ParallelAll", requirement, {}, writes)])
    return marked("RunOnce", requirement, {"name": "btq_first"}, [inside])


class Wrapper(Record):
    """An element around a node.

    Attributes:
        rank: one of the constants above.
        requirement: that it enforces.
        attributes: except its name; values are unescaped.
        before, after: its other children, before and after the node.
    """

    rank: int
    requirement: str
    tag: WrapperTag
    name: str
    attributes: tuple[tuple[str, str], ...] = ()
    before: tuple[Element, ...] = ()
    after: tuple[Element, ...] = ()


def may_be_skipped(names: Sequence[str]) -> bool:
    """Whether attributes of these names can make the engine skip their node."""
    return "_skipIf" in names or "_while" in names


def wrapped(element: Element, wrappers: Sequence[Wrapper]) -> Element:
    """The outermost of the elements around a node's, which takes over the conditions by which the node may be skipped;
    at least one wrapper, in the order of the definitions of the requirements."""
    ordered = sorted(wrappers, key=lambda wrapper: wrapper.rank)
    moved = _moved(element)
    outermost = element
    for wrapper in reversed(ordered):
        outermost = _around(outermost, wrapper)
    if moved:
        positions = " ".join(f"{attribute.name}:{index}" for index, attribute in moved)
        conditions = [attribute for _, attribute in moved]
        outermost.attributes = (*outermost.attributes, *conditions, Attribute(MOVED, positions))
    return outermost


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
    holding: set[Element] = set()
    for element in reversed(outside_in):
        if element.get(MARK) is None or not holding.isdisjoint(element.elements):
            holding.add(element)
    return holding


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
    children = (*wrapper.before, inside, *wrapper.after)
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
    for entry in moved.split():
        name, _, index = entry.partition(":")
        if name in own and index.isdecimal() and node.get(name) is None:
            place = outermost.place(own[name])
            position = int(index)
            given_back = Attribute(name, own[name].raw, place)
            node.attributes = (*node.attributes[:position], given_back, *node.attributes[position:])


_PRECONDITIONS: Final = ("_failureIf", "_successIf", "_skipIf", "_while")
