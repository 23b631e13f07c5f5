"""Manual edits of the nodes that a build put into XML to enforce requirements.

No import keeps such an edit, for those nodes are generated from requirements.  One invariant: generated nodes that are
unchanged are never reported, wherever they were moved and however the mission's own nodes were edited.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final, TypeAlias

from btq_lang.btcpp.document import Element
from btq_lang.btcpp.marks import MARK
from btq_lang.btcpp.wrappers import MOVED
from btq_lang.util.record import Record
from btq_lang.util.text import Span

ADVICE: Final = "the next build restores it; change the requirement that it enforces instead"


# The guards that a build put around and beside each of the mission's nodes, as checksums by name.  A node's key is its
# tree, kind and name, and its number among the nodes of the tree that share those: `Main/Pick/Again/1`.
Guards: TypeAlias = Mapping[str, Mapping[str, str]]


class ManualEdit(Record):
    """A guard that was edited after the build.

    Attributes:
        sum: its checksum now; empty if it was deleted.
        span: of the guard in the XML or, if it was deleted, of its node.
    """

    guard: str
    sum: str
    span: Span

    @property
    def happened(self) -> str:
        return "changed" if self.sum else "removed"


def node_guards(root: Element) -> Guards:
    """The guards of a file, in its order."""
    return {key: guards for key, _, guards in _nodes(root) if guards}


def manual_edits(root: Element, built: Guards) -> tuple[ManualEdit, ...]:
    """The manual edits since a build, in the order of the file."""
    built_guards = {guard for guards in built.values() for guard in guards.items()}
    marked = {_name(each): each for each in root.walk() if each.get(MARK) is not None and _name(each)}
    nodes = {key: (node, guards) for key, node, guards in _nodes(root)}
    edits = [
        ManualEdit(name, sum_, marked[name].tag_span)
        for _, guards in nodes.values()
        for name, sum_ in guards.items()
        if (name, sum_) not in built_guards
    ]
    for key, before in built.items():
        node, guards = nodes.get(key, (None, {}))
        was_another = bool(guards) and guards.keys().isdisjoint(before)  # of its kind, before it was deleted
        if node is not None and not was_another:
            edits += [ManualEdit(name, "", node.tag_span) for name in before if name not in marked]
    return tuple(sorted(edits, key=lambda each: each.span))


def _nodes(root: Element) -> Iterator[tuple[str, Element, dict[str, str]]]:
    """The mission's own nodes, in the order of the file, each with the checksums of its guards, by name."""
    for tree in root.elements:
        if tree.tag != "BehaviorTree":
            continue
        counts: dict[str, int] = {}
        stack = [*tree.elements][::-1]
        while stack:
            guards, own = _split(stack.pop())
            stack += [child for node in own for child in node.elements][::-1]
            for node in own:
                called = f"{tree.get('ID')}/{node.get('ID') or node.tag}/{_name(node)}"
                number = counts[called] = counts.get(called, 0) + 1
                # No import takes out what is around several nodes.
                yield f"{called}/{number}", node, guards if len(own) == 1 else {}


def _split(outermost: Element) -> tuple[dict[str, str], list[Element]]:
    """The guards that an element begins, by name, and the mission's own nodes in them."""
    contents: dict[str, list[str]] = {}
    own = []
    stack = [(outermost, "")]
    while stack:
        element, named = stack.pop()
        if element.get(MARK) is None:
            own.append(element)
            continue
        named = _name(element) or named  # an element without a name is a part of the guard around it
        contents.setdefault(named, []).append(_normal_form(element))
        stack += [(child, named) for child in element.elements][::-1]
    return {name: _sum(parts) for name, parts in contents.items()}, own


def _normal_form(element: Element) -> str:
    """The tag and the attributes in a normal form, without those that belong to the node itself."""
    moved = {MOVED, *(each.partition(":")[0] for each in (element.get(MOVED) or "").split())}
    return repr((element.tag, sorted((each.name, each.value) for each in element.attributes if each.name not in moved)))


def _sum(parts: list[str]) -> str:
    import hashlib

    return hashlib.sha256("\n".join(parts).encode("utf-8", "replace")).hexdigest()[:_DIGITS]


def _name(element: Element) -> str:
    return element.get("name") or ""


_DIGITS: Final = 16  # enough to detect an edit; it need not resist forgery
