"""The tree of one file: frozen classes named after the productions of the grammar.

One invariant: an offset counts from the start of its item (`Entry.start`), so that an unchanged item is the same object
wherever edits elsewhere have moved it.  The tree has words, not meanings: `Retry` and a misspelt `Rety` look alike.  `X
| None` means "may be missing, in broken code too".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import chain
from typing import TypeAlias

from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax.clauses import METADATA as METADATA
from btq_lang.syntax.clauses import Amount as Amount
from btq_lang.syntax.clauses import AnyEvent as AnyEvent
from btq_lang.syntax.clauses import Approval as Approval
from btq_lang.syntax.clauses import Argument as Argument
from btq_lang.syntax.clauses import Assuming as Assuming
from btq_lang.syntax.clauses import Average as Average
from btq_lang.syntax.clauses import Because as Because
from btq_lang.syntax.clauses import Between as Between
from btq_lang.syntax.clauses import Binary as Binary
from btq_lang.syntax.clauses import Bound as Bound
from btq_lang.syntax.clauses import Bounded as Bounded
from btq_lang.syntax.clauses import Call as Call
from btq_lang.syntax.clauses import Case as Case
from btq_lang.syntax.clauses import Choice as Choice
from btq_lang.syntax.clauses import Claim as Claim
from btq_lang.syntax.clauses import Clause as Clause
from btq_lang.syntax.clauses import Comparison as Comparison
from btq_lang.syntax.clauses import Condition as Condition
from btq_lang.syntax.clauses import Confidence as Confidence
from btq_lang.syntax.clauses import EachEvent as EachEvent
from btq_lang.syntax.clauses import Event as Event
from btq_lang.syntax.clauses import Every as Every
from btq_lang.syntax.clauses import FromUntil as FromUntil
from btq_lang.syntax.clauses import Goal as Goal
from btq_lang.syntax.clauses import HazardClause as HazardClause
from btq_lang.syntax.clauses import HazardSeverity as HazardSeverity
from btq_lang.syntax.clauses import How as How
from btq_lang.syntax.clauses import Mission as Mission
from btq_lang.syntax.clauses import Mitigates as Mitigates
from btq_lang.syntax.clauses import Negative as Negative
from btq_lang.syntax.clauses import NodeRef as NodeRef
from btq_lang.syntax.clauses import NodeRuns as NodeRuns
from btq_lang.syntax.clauses import Not as Not
from btq_lang.syntax.clauses import Odds as Odds
from btq_lang.syntax.clauses import OnViolation as OnViolation
from btq_lang.syntax.clauses import Operand as Operand
from btq_lang.syntax.clauses import Parameter as Parameter
from btq_lang.syntax.clauses import Path as Path
from btq_lang.syntax.clauses import Priority as Priority
from btq_lang.syntax.clauses import Refines as Refines
from btq_lang.syntax.clauses import ScopeClause as ScopeClause
from btq_lang.syntax.clauses import Source as Source
from btq_lang.syntax.clauses import Subject as Subject
from btq_lang.syntax.clauses import Sum as Sum
from btq_lang.syntax.clauses import Table as Table
from btq_lang.syntax.clauses import Way as Way
from btq_lang.syntax.clauses import Window as Window
from btq_lang.syntax.node_clauses import NodeClause as NodeClause
from btq_lang.syntax.node_clauses import QualityPath as QualityPath
from btq_lang.syntax.node_clauses import ReqRef as ReqRef
from btq_lang.syntax.node_clauses import Requirement as Requirement
from btq_lang.syntax.node_clauses import SatisficedQuality as SatisficedQuality
from btq_lang.syntax.node_clauses import Satisfices as Satisfices
from btq_lang.syntax.node_clauses import Satisfies as Satisfies
from btq_lang.syntax.node_clauses import Tags as Tags
from btq_lang.syntax.nodes import Node as Node
from btq_lang.syntax.nodes import Verbatim as Verbatim
from btq_lang.syntax.scan import is_name as is_name
from btq_lang.syntax.scenarios import Given as Given
from btq_lang.syntax.scenarios import Scenario as Scenario
from btq_lang.syntax.tokens import QUANTITY, STRING
from btq_lang.syntax.words import Pair as Pair
from btq_lang.syntax.words import TypeWord as TypeWord
from btq_lang.syntax.words import Word as Word
from btq_lang.syntax.words import unquote as unquote
from btq_lang.util.record import Part, Record, fields_of
from btq_lang.util.text import Span

# ---- Items ----------------------------------------------------------------------------------------------------------


class Include(Part):
    """`include "stations.btq"`."""

    path: Word | None
    attributes: tuple[Pair, ...] = ()


class Qualities(Part):
    """`qualities iso25010-2023`: the edition in which names are looked up."""

    edition: Word | None


class QualityDecl(Part):
    """`quality gentleness : safety "…"`: a user-defined quality."""

    name: Word | None
    parent: QualityPath | None
    text: Word | None


class Port(Part):
    """`input station : string = "charger" "where to go"`; type: as one word."""

    direction: Word
    name: Word | None
    type: Word | None
    default: Word | None
    attributes: tuple[Pair, ...]
    text: Word | None

    @property
    def id(self) -> Word | None:
        """Its name, wherever it is written: XML may have it after other attributes."""
        return self.name or self._said("name")

    @property
    def initial(self) -> Word | None:
        """Its default, likewise."""
        return self.default or self._said("default")

    def _said(self, key: str) -> Word | None:
        return next((pair.value for pair in self.attributes if pair.key.text == key), None)


class Meta(Part):
    """`metadata (color = "red")` of a model."""

    attributes: tuple[Pair, ...]


class Model(Part):
    """`Action MoveBase "…"` at file level: a node's interface."""

    category: Word
    name: Word | None
    attributes: tuple[Pair, ...]
    text: Word | None
    body: tuple[Port | Meta | Verbatim, ...]

    @property
    def ports(self) -> tuple[Port, ...]:
        return tuple([part for part in self.body if isinstance(part, Port)]) if self.body else ()


class Models(Part):
    """`TreeNodesModel`: models, as in the XML element."""

    models: tuple[Model | Verbatim, ...]


class Signal(Part):
    """`signal battery : % from {battery_level} level fresh within 5 s initially 100 %`."""

    name: Word | None
    unit: Word | None
    source: Word | None = None
    behaviour: Word | None = None
    fresh: Word | None = None
    initially: Amount | None = None


class Context(Part):
    """`context humans_near : humans > 0`."""

    name: Word | None
    condition: Condition | None


class Hazard(Part):
    """`hazard H1 "Collision with a person"`; text: its title."""

    name: Word | None
    text: Word | None
    clauses: tuple[HazardClause, ...]


class Selector(Part):
    """`every MoveBase under PickPlace`, `every node tagged heavy`, or a path.

    Attributes:
        every: the ID or kind after `every`; None with a path or a tag.
    """

    every: Word | None = None
    tag: Word | None = None
    path: Path | None = None


class Apply(Part):
    """`apply slow(limit = 0.1 m/s) to every MoveBase except BatteryCheck/MoveBase`."""

    uses: tuple[ReqRef, ...]
    targets: tuple[Selector, ...]
    exceptions: tuple[Selector, ...] = ()


class Root(Part):
    """`Root mainTree`: the main tree's name; `bracketed`: its attributes are written to XML exactly as given, even if
    there are none.
    """

    name: Word | None
    attributes: tuple[Pair, ...]
    bracketed: bool


class Tree(Part):
    """`BehaviorTree PickPlace`: body as for a node; more or fewer than one node is a diagnostic."""

    name: Word | None
    attributes: tuple[Pair, ...]
    ports: tuple[Port, ...]
    clauses: tuple[NodeClause, ...]
    children: tuple[Node | Verbatim, ...]

    @property
    def span(self) -> Span:
        return Span(self.start, self.end)

    @property
    def block_end(self) -> int:
        """The end of the last line of its block."""
        return max([self.end, *(child.block_end for child in self.children if isinstance(child, Node))])

    def walk(self) -> Iterator[Node]:
        """All its nodes, depth first, in document order."""
        return chain.from_iterable([child.walk() for child in self.children if isinstance(child, Node)])


class SkippedLines(Part):
    """Lines that do not form an item; a diagnostic says what is wrong with them."""


Item: TypeAlias = (
    Include
    | Qualities
    | QualityDecl
    | Models
    | Model
    | Signal
    | Context
    | Requirement
    | Apply
    | Hazard
    | Given
    | Scenario
    | Root
    | Tree
    | Verbatim
    | SkippedLines
)


class Entry(Record):
    """An item and its place.

    Attributes:
        start: the offset in the file from which the item's offsets count: the start of its first line.
        in_root: it is in the block of a `Root`.
        diagnostics: of its syntax; spans count from `start`.
    """

    start: int
    item: Item
    in_root: bool
    diagnostics: tuple[Diagnostic, ...] = ()


def moved_by(entry: Entry, by: int) -> Entry:
    """The same item elsewhere in its file."""
    return Entry(entry.start + by, entry.item, entry.in_root, entry.diagnostics)


def models_in(item: Item) -> list[Model]:
    """The models that an item declares."""
    parts = item.models if isinstance(item, Models) else (item,)
    return [part for part in parts if isinstance(part, Model)]


def port_named(ports: Iterable[Port], name: str) -> Port | None:
    """The declared port of a name."""
    return next((port for port in ports if port.id is not None and port.id.text == name), None)


def quote(text: str) -> str:
    """A STRING whose value is `text`."""
    for character, escape in (("\\", "\\\\"), ('"', '\\"'), ("\t", "\\t")):
        text = text.replace(character, escape)
    return f'"{text}"'


def written(name: str) -> str:
    """A name as it is written in a file: in quotes if needed."""
    return name if is_name(name) else quote(name)


def shape(part: object, of_quantity: Callable[[Word], object] | None = None) -> object:
    """A part of the tree without its offsets: parts with equal shapes have the same meaning.

    Args:
        of_quantity: maps equal quantities to one value; without it, quantities compare by their text, without blanks.
    """
    if isinstance(part, Node):  # in document order, each with its number of children: no recursion, trees are deep
        return "Node", *(_shape_of_one(node) for node in _in_order(part))
    if isinstance(part, Word):
        if part.kind == QUANTITY and of_quantity is not None:
            return False, of_quantity(part)
        text = "".join(part.raw.split()) if part.kind == QUANTITY else part.text  # `30s` is `30 s`
        return part.kind == STRING, text
    if isinstance(part, tuple):
        return tuple(shape(element, of_quantity) for element in part)
    if isinstance(part, str | int | None):
        return part
    return type(part).__name__, *(
        shape(getattr(part, field), of_quantity) for field in fields_of(part) if field not in _OFFSETS
    )


_OFFSETS = ("start", "end")


def walk(part: object) -> list[object]:
    """A part of the tree and all its parts, in document order."""
    parts: list[object] = []
    stack = [part]
    while stack:
        part = stack.pop()
        if isinstance(part, Word):
            parts.append(part)
        elif isinstance(part, tuple):
            stack += reversed(part)
        elif part is not None and not isinstance(part, (int, str)):
            parts.append(part)
            stack += [value for field in reversed(fields_of(part)) if (value := getattr(part, field))]
    return parts


def _in_order(top: Node) -> Iterator[Node | Verbatim]:
    stack: list[Node | Verbatim] = [top]
    while stack:
        part = stack.pop()
        yield part
        if isinstance(part, Node):
            stack += reversed(part.children)


def _shape_of_one(part: Node | Verbatim) -> object:
    if isinstance(part, Verbatim):
        return shape(part)
    words = (part.category, part.kind, part.label)
    return shape((*words, part.attributes, part.clauses)), len(part.children)
