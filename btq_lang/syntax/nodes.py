"""Nodes, and verbatim XML among them; a tree has thousands.

One invariant: a node is a plain class, as words are, so that it can be compiled.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar, Final

from btq_lang.syntax.node_clauses import NodeClause
from btq_lang.syntax.words import Pair, Word
from btq_lang.util.record import Part
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from mypy_extensions import i64


class Node:
    """A node of a tree.

    Attributes:
        start, end: its own line (or lines, when brackets run over several), without children.
        category: `Action`, `Condition`, `Control`, `Decorator`, `SubTree` if written before the kind.
        kind: a symbol or the node's ID; None in `SubTree (ID = PickPlace)`, where the ID is an attribute.
        label: the instance name if written after the kind; `name` has it in either form.
        attributes: the pairs in brackets, in order.
        clauses: satisfices, satisfies and tags, in brackets, on the line and in the block, in order.
        children: nodes and verbatim XML, in order.
    """

    __slots__ = ("attributes", "category", "children", "clauses", "end", "kind", "label", "start")
    __match_args__: ClassVar = ("start", "end", "category", "kind", "label", "attributes", "clauses", "children")

    def __init__(
        self,
        start: i64,
        end: i64,
        category: Word | None,
        kind: Word | None,
        label: Word | None,
        attributes: tuple[Pair, ...],
        clauses: tuple[NodeClause, ...],
        children: tuple[Node | Verbatim, ...],
    ) -> None:
        self.start: Final = start
        self.end: Final = end
        self.category: Final = category
        self.kind: Final = kind
        self.label: Final = label
        self.attributes: Final = attributes
        self.clauses = clauses  # this and the next: set again by the parser when the node's block ends
        self.children = children

    @property
    def span(self) -> Span:
        """The node's own line, without children."""
        return Span(self.start, self.end)

    @property
    def block_end(self) -> i64:
        """The end of the last line of its block."""
        end = 0
        last: Node | Verbatim | None = self
        while isinstance(last, Node):
            end = max(end, last.end, *(clause.end for clause in last.clauses))
            last = last.children[-1] if last.children else None
        return end if last is None else max(end, last.end)

    @property
    def nodes(self) -> tuple[Node, ...]:
        """The children that are nodes."""
        return tuple([child for child in self.children if isinstance(child, Node)]) if self.children else ()

    @property
    def head(self) -> Word:
        """The word for diagnostics: the kind, the ID in brackets, or else the category."""
        head = self.id or self.category
        assert head is not None, "a node has a kind or a category"
        return head

    @property
    def id(self) -> Word | None:
        """The kind, or the attribute `ID` of an explicit form."""
        if self.kind is None and self.category is not None:
            return self.attribute("ID")
        return self.kind

    @property
    def name(self) -> Word | None:
        """The instance name: the label, or the attribute `name`."""
        return self.label or self.attribute("name")

    @property
    def called(self) -> str:
        """Its kind and its instance name."""
        return self.head.text if self.name is None else f"{self.head.text} {self.name.text}"

    @property
    def shown(self) -> str:
        """The node as a message names it among others: its kind, and its instance name if that differs."""
        return f"`{self.head.text}`" if self.name is None or self.name.text == self.head.text else f"`{self.called}`"

    def attribute(self, key: str) -> Word | None:
        """The value of the first attribute with this key."""
        for pair in self.attributes:
            if pair.key.text == key:
                return pair.value
        return None

    def walk(self) -> Iterator[Node]:
        """This node and all below it, depth first, in document order."""
        stack = [self]
        while stack:
            node = stack.pop()
            yield node
            if node.children:
                stack += [child for child in reversed(node.children) if isinstance(child, Node)]

    def __eq__(self, other: object) -> bool:
        """Whether all fields are equal, compared without recursion: trees are deep."""
        pairs: list[tuple[object, object]] = [(self, other)]
        while pairs:
            mine, others = pairs.pop()
            if not isinstance(mine, Node) or not isinstance(others, Node):
                if mine != others:
                    return False
            elif mine._own() != others._own() or len(mine.children) != len(others.children):
                return False
            else:
                pairs += zip(mine.children, others.children, strict=True)
        return True

    def _own(self) -> tuple[object, ...]:
        return self.start, self.end, self.category, self.kind, self.label, self.attributes, self.clauses

    def __hash__(self) -> int:
        return hash((self.start, self.end))

    def __repr__(self) -> str:
        return f"Node({self.head!r}, {len(self.children)} children)"


class Verbatim(Part):
    """`xml "<element/>"`: one verbatim XML element."""

    text: Word | None
