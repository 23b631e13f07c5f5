"""The three classes of which a tree has thousands: words, pairs and nodes.

One invariant: they are plain classes without decorators, so that they may be compiled (hatch_build.py); the others of
the tree are in `syntax`, which has these too, so that nobody else need know of this module.  `__match_args__` names
their fields, as it does those of a record: a compiled class has no `__slots__`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar, Final

from btq_lang.syntax.tokens import STRING
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from mypy_extensions import i64

    from btq_lang.syntax.tree import NodeClause, Verbatim


class Word:
    """A word of the source: a name, a string, a symbol or a value.

    Attributes:
        kind: its token kind: NAME, STRING, NUMBER, QUANTITY, BRACED or SYMBOL.
        start: where it begins.
        raw: as it stands in the source, quotes included.
    """

    __slots__ = ("kind", "raw", "start")
    __match_args__: ClassVar = ("kind", "start", "raw")

    def __init__(self, kind: i64, start: i64, raw: str) -> None:
        self.kind: Final = kind
        self.start: Final = start
        self.raw: Final = raw

    @property
    def end(self) -> i64:
        return self.start + len(self.raw)

    @property
    def span(self) -> Span:
        return Span(self.start, self.start + len(self.raw))

    @property
    def quoted(self) -> bool:
        return self.kind == STRING

    @property
    def text(self) -> str:
        """What it says: a string without its quotes and escapes, anything else as it stands."""
        return self.raw if self.kind != STRING else unquote(self.raw)

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Word) and self.raw == other.raw and self.start == other.start and self.kind == other.kind
        )

    def __hash__(self) -> int:
        return hash((self.raw, self.start))

    def __repr__(self) -> str:
        return f"{self.raw}@{self.start}"


class TypeWord(Word):
    """The type of a port, `std::string`: several words of the source, with or without blanks between them."""

    __slots__ = ()

    @property
    def text(self) -> str:
        """What it says: without blanks and comments."""
        return _GAPS.sub("", self.raw)


class Pair:
    """`key = value`: a port, a subtree argument, or `_skipIf`, `_while`, …; no value: it is missing."""

    __slots__ = ("key", "value")
    __match_args__: ClassVar = ("key", "value")

    def __init__(self, key: Word, value: Word | None) -> None:
        self.key: Final = key
        self.value: Final = value

    @property
    def span(self) -> Span:
        return Span(self.key.start, (self.value or self.key).end)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Pair) and self.key == other.key and self.value == other.value

    def __hash__(self) -> int:
        return hash(self.key)

    def __repr__(self) -> str:
        return f"{self.key!r} = {self.value!r}"


class Node:
    """A node of a tree.

    Attributes:
        start, end: its own line (or lines, when brackets run over several), without children.
        category: `Action`, `Condition`, `Control`, `Decorator`, `SubTree` where written in front of the kind.
        kind: a symbol or the node's ID; None in `SubTree (ID = PickPlace)`, where the ID is an attribute.
        label: the instance name where written behind the kind; `name` says it wherever it stands.
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
        self.clauses = clauses  # this and the next: set once more, by the parser, when the node's block ends
        self.children = children

    @property
    def span(self) -> Span:
        """The node's own line, without children."""
        return Span(self.start, self.end)

    @property
    def block_end(self) -> i64:
        """Where the last line of its block ends."""
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
        """The word to point at: the kind, the ID in brackets, or else the category."""
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
        """Equal in everything, compared without recursion: trees are deep."""
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


def unquote(raw: str) -> str:
    """What a STRING says (docs/language.md): quotes off, `\\" \\' \\\\ \\n \\t` decoded, line ends as `\\n`."""
    text = raw[1:-1] if len(raw) > 1 and raw[-1] == raw[0] and _closes(raw) else raw[1:]
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    if "\\" in text:
        text = _ESCAPE.sub(lambda match: _ESCAPED.get(match[1], match[1]), text)
    return text


def _closes(raw: str) -> bool:
    """Whether the last character of a string is its closing quote, not an escaped one."""
    if raw[-2] != "\\":
        return True
    backslashes = len(raw) - 1 - len(raw[:-1].rstrip("\\"))
    return backslashes % 2 == 0


_ESCAPE: Final = re.compile(r"\\([\"'\\nt])")
_GAPS: Final = re.compile(r"(?s)\s+|/\*.*?\*/")
_ESCAPED: Final = {"n": "\n", "t": "\t"}
