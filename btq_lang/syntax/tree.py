"""The tree of one file: frozen classes named after the productions of the grammar.

One invariant: an offset counts from the start of the item it stands in (`Entry.start` says where that is), so that an
item that did not change is the same object wherever edits elsewhere have moved it.  The tree knows words, not
meanings: `Retry` and a misspelt `Rety` look alike.  `X | None` means "may be missing, in broken code too".
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, TypeAlias

from btq_lang.syntax.node_clauses import Quality as Quality
from btq_lang.syntax.node_clauses import QualityPath as QualityPath
from btq_lang.syntax.node_clauses import ReqRef as ReqRef
from btq_lang.syntax.node_clauses import Requirement as Requirement
from btq_lang.syntax.node_clauses import Satisfices as Satisfices
from btq_lang.syntax.node_clauses import Satisfies as Satisfies
from btq_lang.syntax.node_clauses import Tags as Tags
from btq_lang.syntax.scan import is_name as is_name
from btq_lang.syntax.tokens import QUANTITY, STRING
from btq_lang.syntax.words import Node as Node
from btq_lang.syntax.words import Pair as Pair
from btq_lang.syntax.words import TypeWord as TypeWord
from btq_lang.syntax.words import Word as Word
from btq_lang.syntax.words import unquote as unquote
from btq_lang.util.record import Record, fields_of
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.diagnostics.model import Diagnostic

# ---- Qualities and requirements on nodes ----------------------------------------------------------------------------

NodeClause: TypeAlias = Satisfices | Satisfies | Tags


class Argument(Record):
    """`limit = 0.1 m/s` behind a parameterised requirement."""

    name: Word
    value: Bounded | None


class Parameter(Record):
    """`limit : m/s = 0.25 m/s` of a parameterised requirement."""

    name: Word
    unit: Word | None
    default: Bounded | None = None


# ---- Clauses of a requirement ---------------------------------------------------------------------------------------


class Path(Record):
    """`BatteryCheck/MoveBase`: matched from the right over the names of trees, nodes and labels."""

    names: tuple[Word, ...]

    @property
    def span(self) -> Span:
        return Span(self.names[0].start, self.names[-1].end)


class Amount(Record):
    """A value of a bound: a quantity, a number, a parameter or a signal; `negative` where a sign stands apart."""

    word: Word
    negative: bool = False


class Case(Record):
    """`20 s if not humans_near` of a value table."""

    value: Amount
    condition: Condition | None


class Table(Record):
    """A value for each context.  otherwise: the value behind `else`."""

    cases: tuple[Case, ...]
    otherwise: Amount | None = None


Bounded: TypeAlias = Amount | Table


class Bound(Record):
    """`at most 30 s`.  relation: `<=`, `>=`, `<`, `>`, or `between` with both values."""

    start: int
    end: int
    relation: str
    value: Bounded | None
    upper: Amount | None = None


class Event(Record):
    """`Pick starts`, `mission finishes` or `when battery < 3 %`; no path: the mission, or a condition."""

    start: int
    end: int
    path: Path | None
    happening: str
    condition: Condition | None = None


class Mission(Record):
    """The subject `mission`: the whole run."""

    start: int
    end: int


class Every(Record):
    """The subject `every MoveBase`: each source node of that ID or kind."""

    start: int
    end: int
    name: Word


class Between(Record):
    """The subject `from Pick starts to Place succeeds`."""

    start: int
    end: int
    first: Event | None
    last: Event | None


class Sum(Record):
    """The subject `sum of X, Y`."""

    start: int
    end: int
    paths: tuple[Path, ...]


Subject: TypeAlias = Path | Mission | Every | Between | Sum


class Claim(Record):
    """What a requirement demands: a subject (None: the node it is attached to), a verb and what belongs to the verb.

    Attributes:
        verb: takes, succeeds, needs, keeps, never, leaves, uses, tries, runs, starts, ends or follows.
        bound: of takes, uses, tries, runs; of `within d` and `runs every d` as `<= d`.
        condition: of needs, keeps, never, leaves.
        resource: of uses: the signal.
        per: of tries: the path; of runs: the quantity.
        event: of starts, ends, follows.
        every: `runs every d`.
    """

    start: int
    end: int
    subject: Subject | None
    verb: Word
    bound: Bound | None = None
    condition: Condition | None = None
    resource: Word | None = None
    per: Path | Word | None = None
    event: Event | None = None
    every: bool = False


class Scope(Record):
    """`while φ` or `when φ`."""

    start: int
    end: int
    word: Word
    condition: Condition | None


class Odds(Record):
    """`in at least 98 % of runs`, `with probability >= 98 %`.  experiments: None where not said."""

    start: int
    end: int
    relation: str
    value: Word | None
    experiments: Word | None


class Confidence(Record):
    """`confidence 95 %`."""

    start: int
    end: int
    value: Word | None


class Window(Record):
    """`over last 200 activations`, `over last 7 d`."""

    start: int
    end: int
    size: Word | None
    experiments: Word | None


class OnViolation(Record):
    """`on violation fail`.  action: fail, halt, warn or log."""

    start: int
    end: int
    action: Word | None


class Goal(Record):
    """`goal 15 Wh`: what would be better than the bound."""

    start: int
    end: int
    value: Bounded | None


class Because(Record):
    """`because "movement next to people"`."""

    start: int
    end: int
    text: Word | None


class How(Record):
    """`verified by review`.  method: monitor, analysis, test or review."""

    start: int
    end: int
    method: Word | None


Clause: TypeAlias = Claim | Scope | Odds | Confidence | Window | OnViolation | Goal | Because | How


# ---- Conditions -----------------------------------------------------------------------------------------------------


class Operand(Record):
    """A quantity, number, name or string in an expression."""

    word: Word

    @property
    def start(self) -> int:
        return self.word.start

    @property
    def end(self) -> int:
        return self.word.end


class Call(Record):
    """`max(speed)`: an aggregate of a signal."""

    start: int
    end: int
    function: Word
    signal: Word | None


class NodeRuns(Record):
    """`node BatteryCheck/MoveBase`: true while that node runs."""

    start: int
    end: int
    path: Path


class Negative(Record):
    """`-x`."""

    start: int
    end: int
    operand: Condition


class Not(Record):
    """`not φ`."""

    start: int
    end: int
    operand: Condition


class Binary(Record):
    """`a + b`, `φ and ψ`.  operator: + - * / and or."""

    start: int
    end: int
    operator: str
    left: Condition
    right: Condition


class Comparison(Record):
    """`a < b`, `a < b < c`: one more operand than operators."""

    start: int
    end: int
    operators: tuple[str, ...]
    operands: tuple[Condition, ...]


Condition: TypeAlias = Operand | Call | NodeRuns | Negative | Not | Binary | Comparison


# ---- Items ----------------------------------------------------------------------------------------------------------


class Verbatim(Record):
    """`xml "<element/>"`: one XML element as it is."""

    start: int
    end: int
    text: Word | None


class Include(Record):
    """`include "stations.btq"`."""

    start: int
    end: int
    path: Word | None
    attributes: tuple[Pair, ...] = ()


class Qualities(Record):
    """`qualities iso25010-2023`: the edition that names are looked up in."""

    start: int
    end: int
    edition: Word | None


class QualityDecl(Record):
    """`quality gentleness : safety "…"`: a quality of one's own."""

    start: int
    end: int
    name: Word | None
    parent: QualityPath | None
    text: Word | None


class Port(Record):
    """`input station : string = "charger" "where to go"`; type: its words as one."""

    start: int
    end: int
    direction: Word
    name: Word | None
    type: Word | None
    default: Word | None
    attributes: tuple[Pair, ...]
    text: Word | None


class Meta(Record):
    """`metadata (color = "red")` of a model."""

    start: int
    end: int
    attributes: tuple[Pair, ...]


class Model(Record):
    """`Action MoveBase "…"` at file level: a node's interface."""

    start: int
    end: int
    category: Word
    name: Word | None
    attributes: tuple[Pair, ...]
    text: Word | None
    body: tuple[Port | Meta | Verbatim, ...]

    @property
    def ports(self) -> tuple[Port, ...]:
        return tuple([part for part in self.body if isinstance(part, Port)]) if self.body else ()


class Models(Record):
    """`TreeNodesModel`: models in the place where the XML element stands."""

    start: int
    end: int
    models: tuple[Model | Verbatim, ...]


class Signal(Record):
    """`signal battery : % from {battery_level} level fresh within 5 s initially 100 %`."""

    start: int
    end: int
    name: Word | None
    unit: Word | None
    source: Word | None = None
    behaviour: Word | None = None
    fresh: Word | None = None
    initially: Amount | None = None


class Context(Record):
    """`context humans_near : humans > 0`."""

    start: int
    end: int
    name: Word | None
    condition: Condition | None


class Selector(Record):
    """`every MoveBase under PickPlace`, `every node tagged heavy`, or a path.

    Attributes:
        every: the ID or kind after `every`; None where a path or a tag says it.
    """

    start: int
    end: int
    every: Word | None = None
    tag: Word | None = None
    path: Path | None = None


class Apply(Record):
    """`apply slow(limit = 0.1 m/s) to every MoveBase except BatteryCheck/MoveBase`."""

    start: int
    end: int
    uses: tuple[ReqRef, ...]
    targets: tuple[Selector, ...]
    exceptions: tuple[Selector, ...] = ()


class Root(Record):
    """`Root mainTree`: the main tree's name; `bracketed`: its attributes are written exactly as given, even none."""

    start: int
    end: int
    name: Word | None
    attributes: tuple[Pair, ...]
    bracketed: bool


class Tree(Record):
    """`BehaviorTree PickPlace`: body as a node's; more or fewer than one node is a diagnostic."""

    start: int
    end: int
    name: Word | None
    attributes: tuple[Pair, ...]
    ports: tuple[Port, ...]
    clauses: tuple[NodeClause, ...]
    children: tuple[Node | Verbatim, ...]

    @property
    def span(self) -> Span:
        return Span(self.start, self.end)

    def walk(self) -> Iterator[Node]:
        """All its nodes, depth first, in document order."""
        stack = [child for child in reversed(self.children) if isinstance(child, Node)]
        while stack:
            node = stack.pop()
            yield node
            if node.children:
                stack += [child for child in reversed(node.children) if isinstance(child, Node)]


class Skipped(Record):
    """Lines that are no item; a diagnostic says what is wrong with them."""

    start: int
    end: int


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
    | Root
    | Tree
    | Verbatim
    | Skipped
)


class Entry(Record):
    """An item and where it stands.

    Attributes:
        start: the offset in the file that the item's offsets count from: the start of its first line.
        in_root: it stands in the block of a `Root`.
        diagnostics: what is wrong with its syntax; spans count from `start`.
    """

    start: int
    item: Item
    in_root: bool
    diagnostics: tuple[Diagnostic, ...] = ()


def moved_by(entry: Entry, by: int) -> Entry:
    """The same item elsewhere in its file."""
    return Entry(entry.start + by, entry.item, entry.in_root, entry.diagnostics)


def quote(text: str) -> str:
    """A STRING that says `text`."""
    for character, escape in (("\\", "\\\\"), ('"', '\\"'), ("\t", "\\t")):
        text = text.replace(character, escape)
    return f'"{text}"'


def shape(part: object, of_quantity: Callable[[Word], object] | None = None) -> object:
    """A part of the tree without its offsets: two parts with one shape say the same.

    Args:
        of_quantity: what two quantities that are the same have in common; else how they are written, without blanks.
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
    """A part of the tree and all that is in it, in document order."""
    found: list[object] = []
    stack = [part]
    while stack:
        part = stack.pop()
        if isinstance(part, Word):
            found.append(part)
        elif isinstance(part, tuple):
            stack += reversed(part)
        elif part is not None and not isinstance(part, (int, str)):
            found.append(part)
            stack += [getattr(part, field) for field in reversed(fields_of(part))]
    return found


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
