"""The clauses of requirements, their subjects and their conditions.

One invariant: as in `tree`, to which these classes belong, offsets count from the start of the item.
"""

from __future__ import annotations

from typing import TypeAlias

from btq_lang.syntax.words import Word
from btq_lang.util.record import Record
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
    """What a requirement demands: a subject (None: the node it is attached to), a verb and its operands.

    Attributes:
        verb: takes, succeeds, needs, keeps, never, leaves, uses, tries, runs, starts, ends or follows.
        bound: of takes, uses, tries, runs; for `within d` and `runs every d`, `<= d`.
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
    """`in at least 98 % of runs`, `with probability >= 98 %`. experiments: None if omitted."""

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
    """`goal 15 Wh`: a value better than the bound."""

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
