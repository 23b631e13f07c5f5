"""The clauses of requirements, their subjects and their conditions.

One invariant: as in `tree`, to which these classes belong, offsets count from the start of the item.
"""

from __future__ import annotations

from typing import TypeAlias

from btq_lang.syntax.tokens import QUANTITY
from btq_lang.syntax.words import Word
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


class Mission(Part):
    """The subject `mission`: the whole run."""


class Every(Part):
    """The subject `every MoveBase`: each source node of that ID or kind."""

    name: Word


class Between(Part):
    """The subject `from Pick starts to Place succeeds`."""

    first: Event | None
    last: Event | None


class Sum(Part):
    """The subject `sum of X, Y`."""

    paths: tuple[Path, ...]


Subject: TypeAlias = Path | Mission | Every | Between | Sum


class Claim(Part):
    """A demand of a requirement: a subject (None: the node it is attached to), a verb and its operands.

    Attributes:
        verb: takes, succeeds, needs, keeps, never, leaves, uses, tries, runs, starts, ends or follows.
        bound: of takes, uses, tries, runs; for `within d` and `runs every d`, `<= d`.
        condition: of needs, keeps, never, leaves.
        resource: of uses: the signal.
        per: of tries and counts: the path, or the word `run`; of runs: the quantity.
        event: of starts, ends, follows.
        every: `runs every d`.
        form: `per` of `succeeds at least 12 per run`, which counts; else empty.
        of: of `fails at most 1 per 200 h of Dock`: the path.
    """

    subject: Subject | None
    verb: Word
    bound: Bound | None = None
    condition: Condition | None = None
    resource: Word | None = None
    per: Path | Word | None = None
    event: Event | None = None
    every: bool = False
    form: str = ""
    of: Path | None = None

    @property
    def row(self) -> str:
        """The verb's row in `catalog.verbs`: of `succeeds at least 12 per run` the one of `succeeds per`."""
        if self.form and isinstance(self.per, Word) and self.per.kind == QUANTITY:
            return f"{self.verb.raw} per time"
        return f"{self.verb.raw} {self.form}".rstrip()


class ScopeClause(Part):
    """`while φ` or `when φ`."""

    word: Word
    condition: Condition | None


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


class How(Part):
    """`verified by review`.  method: monitor, analysis, test or review."""

    method: Word | None


Clause: TypeAlias = Claim | ScopeClause | Average | Odds | Confidence | Window | OnViolation | Goal | Because | How


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


class Call(Part):
    """`max(speed)`: an aggregate of a signal."""

    function: Word
    signal: Word | None


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


Condition: TypeAlias = Operand | Call | NodeRuns | Negative | Not | Binary | Comparison
