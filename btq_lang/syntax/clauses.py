"""The clauses of requirements, their subjects and their conditions.

One invariant: as in `tree`, to which these classes belong, offsets count from the start of the item.
"""

from __future__ import annotations

from typing import Final, TypeAlias

from btq_lang.syntax.tokens import QUANTITY
from btq_lang.syntax.words import Pair, Word
from btq_lang.util.record import Part, Record
from btq_lang.util.text import Span

# ---- Arguments and parameters ---------------------------------------------------------------------------------------


class Argument(Record):
    """`limit = 0.1 m/s` after a parameterised requirement."""

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
    """A value of a bound: a quantity, a number, a parameter or a signal; `negative`: with a separate sign."""

    word: Word
    negative: bool = False


class Case(Record):
    """`20 s if not humans_near` of a value table."""

    value: Amount
    condition: Condition | None


class Table(Record):
    """A value for each context. otherwise: the value after `else`."""

    cases: tuple[Case, ...]
    otherwise: Amount | None = None


Bounded: TypeAlias = Amount | Table


class Bound(Part):
    """`at most 30 s`.  relation: `<=`, `>=`, `<`, `>`, or `between` with both values."""

    relation: str
    value: Bounded | None
    upper: Amount | None = None


class Event(Part):
    """`Pick starts`, `mission finishes` or `when battery < 3 %`; no path: the mission, or a condition."""

    path: Path | None
    happening: str
    condition: Condition | None = None

    @property
    def atoms(self) -> tuple[Event | None, ...]:
        """This one, as of several events."""
        return (self,)


class AnyEvent(Part):
    """`Pick fails or Place fails`: any of several events, of which only the last may be a condition."""

    atoms: tuple[Event | None, ...]


class Mission(Part):
    """The subject `mission`: the whole run."""


class Every(Part):
    """The subject `every MoveBase`: each source node of that ID or kind."""

    name: Word


class Between(Part):
    """The subject `from Pick starts to Place succeeds`."""

    first: Event | AnyEvent | None
    last: Event | AnyEvent | None


class Sum(Part):
    """The subject `sum of X, Y`."""

    paths: tuple[Path, ...]


class EachEvent(Part):
    """The subject `each Pick fails`: each occurrence of an event."""

    event: Event | AnyEvent | None


Subject: TypeAlias = Path | Mission | Every | Between | Sum | EachEvent


class NodeRef(Part):
    """`MoveTo (station = "A")`: a node, and values that its ports have when it starts."""

    path: Path
    pairs: tuple[Pair, ...] = ()

    @property
    def span(self) -> Span:
        return Span(self.start, self.end)


class Claim(Part):
    """A demand of a requirement: a subject (None: the node it is attached to), a verb and its operands.

    Attributes:
        verb: takes, succeeds, needs, keeps, never, leaves, uses, tries, runs, starts, ends, follows or followed.
        bound: of takes, uses, tries, runs; for `within d`, `runs every d` and `never φ for more than d`, `<= d`.
        condition: of needs, keeps, never, leaves, ends with, and of followed if it is followed by one.
        resource: of uses: the signal.
        per: of tries and counts: the path, or the word `run`; of runs: the quantity.
        event: of starts, ends, follows, followed.
        every: `runs every d`.
        visits: of visits.
        order: of `visits A, B in order`.
        form: `per` of `succeeds at least 12 per run`, which counts; else empty.
        of: of `fails at most 1 per 200 h of Dock`: the path.
    """

    subject: Subject | None
    verb: Word
    bound: Bound | None = None
    condition: Condition | None = None
    resource: Word | None = None
    per: Path | Word | None = None
    event: Event | AnyEvent | None = None
    every: bool = False
    visits: tuple[NodeRef, ...] = ()
    order: Word | None = None
    form: str = ""
    of: Path | None = None

    @property
    def row(self) -> str:
        """The verb's row in `catalog.verbs`: of `ends with battery_low` the one of `ends with`."""
        if self.form:
            is_rate = isinstance(self.per, Word) and self.per.kind == QUANTITY
            return f"{self.verb.raw} per time" if is_rate else f"{self.verb.raw} {self.form}"
        if self.condition is None:
            return self.verb.raw
        if self.verb.raw == "never" and self.bound is not None:
            return "never for"
        return "ends with" if self.verb.raw == "ends" else self.verb.raw


class ScopeClause(Part):
    """`while φ` or `when φ`."""

    word: Word
    condition: Condition | None


class Assuming(Part):
    """`assuming φ`: runs, or activations, without φ all along are not applicable."""

    condition: Condition | None


class FromUntil(Part):
    """`from Pick starts until Place succeeds`: when something is kept."""

    first: Event | AnyEvent | None
    last: Event | AnyEvent | None


class Average(Part):
    """`on average`: of takes and uses, the mean of all activations is demanded."""


class Odds(Part):
    """`in at least 98 % of runs`, `with probability >= 98 %`. experiments: None if omitted."""

    relation: str
    value: Word | None
    experiments: Word | None

    @property
    def is_of_time(self) -> bool:
        """`in at least 98 % of time`: a part of the demand rather than its odds."""
        return self.experiments is not None and self.experiments.raw == "time"


class Confidence(Part):
    """`confidence 95 %`."""

    value: Word | None


class Window(Part):
    """`over last 200 activations`, `over last 7 d`."""

    size: Word | None
    experiments: Word | None


class OnViolation(Part):
    """`on violation fail`.  action: fail, halt, warn or log."""

    action: Word | None


class Goal(Part):
    """`goal 15 Wh`: a value better than the bound."""

    value: Bounded | None


class Because(Part):
    """`because "movement next to people"`."""

    text: Word | None


class Way(Part):
    """`test "TC-12"` of `verified by`.  method: monitor, analysis, test or review; id: of the test case, the report."""

    method: Word
    id: Word | None = None


class How(Part):
    """`verified by test "TC-12", review`."""

    ways: tuple[Way, ...]


class Source(Part):
    """`source "ISO 13482, 5.10.2"`: where a requirement or a hazard is from."""

    text: Word | None


class Refines(Part):
    """`refines safe_speed, REQ-7`: the requirements of which this one is a part."""

    names: tuple[Word, ...]


class Mitigates(Part):
    """`mitigates H1, H2`: hazards."""

    names: tuple[Word, ...]


class Priority(Part):
    """`priority high`: a free tag."""

    tag: Word | None


class Approval(Part):
    """`approved by "Kim" on "2026-11-29" of "1:0123456789ab"`; `of`: the fingerprint of what was approved."""

    by: Word | None
    on: Word | None
    of: Word | None = None


class HazardSeverity(Part):
    """`severity high` of a hazard: a free tag."""

    tag: Word | None


Clause: TypeAlias = (
    Claim
    | ScopeClause
    | FromUntil
    | Assuming
    | Average
    | Odds
    | Confidence
    | Window
    | OnViolation
    | Goal
    | Because
    | How
    | Source
    | Refines
    | Mitigates
    | Priority
    | Approval
)
HazardClause: TypeAlias = Source | Because | HazardSeverity
# The clauses that demand nothing.
METADATA: Final = frozenset((Source, Refines, Mitigates, Priority, Approval))


# ---- Conditions -----------------------------------------------------------------------------------------------------


class Operand(Record):
    """A quantity, number, name or string in an expression; in a scenario an entry too, in braces."""

    word: Word

    @property
    def start(self) -> int:
        return self.word.start

    @property
    def end(self) -> int:
        return self.word.end


class Call(Part):
    """`max(speed)`: an aggregate of a signal."""

    function: Word
    signal: Word | None


class Choice(Part):
    """`(0.5 m/s if near else 1 m/s)`: a value for each context."""

    table: Table


class NodeRuns(Part):
    """`node BatteryCheck/MoveBase`: true while that node runs."""

    path: Path


class Negative(Part):
    """`-x`."""

    operand: Condition


class Not(Part):
    """`not φ`."""

    operand: Condition


class Binary(Part):
    """`a + b`, `φ and ψ`.  operator: + - * / and or."""

    operator: str
    left: Condition
    right: Condition


class Comparison(Part):
    """`a < b`, `a < b < c`: one more operand than operators."""

    operators: tuple[str, ...]
    operands: tuple[Condition, ...]


Condition: TypeAlias = Operand | Call | Choice | NodeRuns | Negative | Not | Binary | Comparison
