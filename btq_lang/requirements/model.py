"""What a requirement means, with its words resolved: small frozen records, values in SI beside the text as typed.

One invariant: nothing in here has to be looked up again, so export, monitor and report read the same records. How
something was written is not known here: places lead back to that.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from operator import itemgetter
from typing import Final, Literal, TypeAlias

from btq_lang.catalog.units import Dimension, Unit
from btq_lang.diagnostics.model import Place
from btq_lang.util.record import Record, as_dict
from btq_lang.workspace.resolved import ResolvedNode

Relation: TypeAlias = Literal["<=", ">=", "<", ">", "between"]
Happening: TypeAlias = Literal["starts", "succeeds", "fails", "finishes", "halts", "when"]
Action: TypeAlias = Literal["fail", "halt", "warn", "log"]
Method: TypeAlias = Literal["monitor", "analysis", "test", "review"]
Experiments: TypeAlias = Literal["activations", "runs", "occurrences"]
Behaviour: TypeAlias = Literal["level", "counter", "gauge"]
Sort: TypeAlias = Literal["number", "bool", "text"]


# ---- Nodes ----------------------------------------------------------------------------------------------------------


class NodeTarget(Record):
    """A node that a path names.

    Attributes:
        through: the leading names of the path that must be found above the node's own tree, on the way through SubTree
            nodes; empty: every instance of the node.
    """

    node: ResolvedNode
    through: tuple[str, ...] = ()


class MissionRun(Record):
    """The whole run: the main tree's written root, None if it is unknown which tree runs."""

    node: ResolvedNode | None


# ---- Values ---------------------------------------------------------------------------------------------------------


class Quantity(Record):
    """A quantity or a bare number.

    Attributes:
        text: as typed, with its sign.
        si: in SI base units, rad, bit, fractions of one for percent (`units.to_si`).
        unit: what it was typed in; `1` for a bare number.
    """

    text: str
    si: float
    unit: Unit


class Flag(Record):
    """`true` or `false`."""

    value: bool

    @property
    def text(self) -> str:
        return "true" if self.value else "false"


class TextValue(Record):
    """A string that a text signal is compared with."""

    value: str

    @property
    def text(self) -> str:
        return f'"{self.value}"'


class ResolvedSignal(Record):
    """What can be measured.

    Attributes:
        sort: number, bool or text.
        unit: of a number; None if unknown.
        key: the blackboard entry, as written between the braces; None if none is named.
        fresh: after how many seconds a sample is too old.
        initially: before the first sample.
    """

    name: str
    sort: Sort
    unit: Unit | None
    key: str | None
    behaviour: Behaviour
    fresh: float | None
    initially: Quantity | Flag | TextValue | None
    place: Place

    @property
    def entry(self) -> str:
        """The blackboard entry without the `@` of the root's; empty if none is named."""
        return (self.key or "").removeprefix("@")


class SignalRead(Record):
    """The last sample of a signal; of a bool signal, a condition as well."""

    signal: ResolvedSignal

    @property
    def text(self) -> str:
        return self.signal.name


class ResolvedParameter(Record):
    """A parameter in the definition of a requirement; what is applied has an argument in its place."""

    name: str
    sort: Sort
    unit: Unit | None
    default: Bounded | None

    @property
    def text(self) -> str:
        return self.name


class Aggregate(Record):
    """`p95(track_error)`: over the samples of an activation."""

    function: str
    signal: ResolvedSignal


class Age(Record):
    """`age(position)`: the time since the last sample of a signal; before the first one, since the activation began."""

    signal: ResolvedSignal


class Minus(Record):
    """`-x`."""

    operand: Number


class Arithmetic(Record):
    """`a + b`; operator: `+`, `-`, `*`, `/`."""

    operator: str
    left: Number
    right: Number


class ResolvedCase(Record):
    """A value and when it holds; no condition: otherwise."""

    value: Simple
    condition: Condition | None


class ResolvedTable(Record):
    """A value for each situation: of the first case whose condition holds."""

    cases: tuple[ResolvedCase, ...]

    @property
    def text(self) -> str:
        values = [case.value.text for case in self.cases]
        return f"{', '.join(values[:-1])} or {values[-1]}" if len(values) > 1 else "".join(values)


Simple: TypeAlias = Quantity | Flag | TextValue | SignalRead | ResolvedParameter
Bounded: TypeAlias = Simple | ResolvedTable
Number: TypeAlias = Bounded | Aggregate | Age | Minus | Arithmetic


# ---- Conditions -----------------------------------------------------------------------------------------------------


class Compare(Record):
    """`a < b`, `a < b < c`: one more operand than operators; all in SI."""

    operators: tuple[str, ...]
    operands: tuple[Number, ...]


class All(Record):
    """`φ and ψ`."""

    conditions: tuple[Condition, ...]


class Any(Record):
    """`φ or ψ`."""

    conditions: tuple[Condition, ...]


class Negation(Record):
    """`not φ`."""

    condition: Condition


class InContext(Record):
    """A context by its name, and its condition: all that name a context share one condition."""

    name: str
    condition: Condition

    def __hash__(self) -> int:
        """By the name: hashing the whole condition would take long."""
        return hash((InContext, self.name))


class Running(Record):
    """`node Path`: while that node runs."""

    target: NodeTarget


class ClassicScript(Record):
    """A script of the engine after SuccessIf or FailureIf in a classic description."""

    code: str


# A ResolvedScope is part of another condition only where evidence judges what is demanded in that scope.
Condition: TypeAlias = (
    "Compare | All | Any | Negation | InContext | Running | "
    "ClassicScript | SignalRead | Flag | ResolvedParameter | ResolvedScope"
)


# ---- Claims ---------------------------------------------------------------------------------------------------------


class Limit(Record):
    """A bound in SI: `value`, or from `value` to `upper` where the relation is `between`."""

    relation: Relation
    value: Bounded
    upper: Bounded | None = None


class ResolvedEvent(Record):
    """Something that happens to a node, or to the mission; `when`: a condition becomes true."""

    happening: Happening
    subject: NodeTarget | MissionRun | None
    condition: Condition | None = None

    @property
    def atoms(self) -> tuple[ResolvedEvent, ...]:
        """This one, as of several events."""
        return (self,)


class ResolvedAnyEvent(Record):
    """Any of several events, of which only the last may be a condition."""

    atoms: tuple[ResolvedEvent, ...]

    @property
    def condition(self) -> Condition | None:
        """The condition that is one of them."""
        return self.atoms[-1].condition


class Interval(Record):
    """The time from each `first` to the next `last`."""

    first: ResolvedEvent | ResolvedAnyEvent
    last: ResolvedEvent | ResolvedAnyEvent


class ResolvedEachEvent(Record):
    """Each occurrence of an event."""

    event: ResolvedEvent | ResolvedAnyEvent


class DurationSum(Record):
    """The sum of the durations of several nodes in one run."""

    targets: tuple[NodeTarget, ...]


class EveryNode(Record):
    """Each node of an ID or kind by itself."""

    name: str


Subject: TypeAlias = NodeTarget | MissionRun | EveryNode | Interval | DurationSum | ResolvedEachEvent


class VisitedNode(Record):
    """A node that counts as visited when it succeeds; values: what the entries that its ports read hold then."""

    target: NodeTarget
    values: tuple[tuple[ResolvedSignal, str], ...] = ()


class Visit(Record):
    """What has to be visited: any of these nodes; text: as typed."""

    text: str
    nodes: tuple[VisitedNode, ...]


class ResolvedClaim(Record):
    """What is demanded.

    Attributes:
        subject: the claim's own; None: what the requirement is attached to.
        verb: the word of its row in `catalog.verbs`.
        limit: of takes, uses, tries, runs; of `within d`, `runs every d` and `never φ for more than d` as `<= d`; of
            keeps and never the share of time.
        condition: of needs, keeps, never, leaves, ends with, never for, and of followed if it is followed by one.
        signal: of uses.
        per: of tries and counts a node (None: the run), of runs a duration.
        event: of starts, ends, follows, followed.
        every: `runs every d`.
        visits, in_order: of visits.
        of: of a failure rate, the node whose time is its exposure; None: the time of the runs.
        text: the clause as typed, blanks folded; with its share of time, or `on average`.
    """

    verb: str
    text: str
    place: Place
    subject: Subject | None = None
    limit: Limit | None = None
    condition: Condition | None = None
    signal: ResolvedSignal | None = None
    per: NodeTarget | Quantity | None = None
    event: ResolvedEvent | ResolvedAnyEvent | None = None
    every: bool = False
    visits: tuple[Visit, ...] = ()
    in_order: bool = False
    of: NodeTarget | None = None

    @property
    def head(self) -> str:
        """The first word of its verb, which is in its text."""
        return self.verb.partition(" ")[0]

    @property
    def subject_text(self) -> str:
        """What is before its verb, as typed."""
        verb = "is followed" if isinstance(self.subject, ResolvedEachEvent) else self.head
        return self.text.partition(f" {verb} ")[0]

    @property
    def highest(self) -> tuple[float, str] | None:
        """The most that its bound allows in any situation, in SI and as typed; None if it has no upper limit, or
        perhaps none."""
        if self.limit is None or self.limit.relation in (">=", ">"):
            return None
        return max(_values(self.limit.upper or self.limit.value), key=itemgetter(0), default=None)

    @property
    def lowest(self) -> tuple[float, str] | None:
        """The least that its bound demands in any situation, as `highest`."""
        if self.limit is None or self.limit.relation in ("<=", "<"):
            return None
        return min(_values(self.limit.value), key=itemgetter(0), default=None)


def time_for_one(number: float, seconds: float) -> float:
    """The time in seconds in which a rate of so many in a time allows one; at least that time."""
    return seconds / number if 0 < number < 1 else seconds


def _values(bounded: Bounded) -> list[tuple[float, str]]:
    """The values of a bound, in SI and as typed; empty if one of them is a signal's."""
    simple = [case.value for case in bounded.cases] if isinstance(bounded, ResolvedTable) else [bounded]
    values = [(value.si, value.text) for value in simple if isinstance(value, Quantity)]
    return values if len(values) == len(simple) else []


class ResolvedScope(Record):
    """`while φ`: only time (or activations) with φ; `when φ`: only activations with φ at their start; `assuming φ`:
    others than runs, or activations, with φ all along are not applicable."""

    word: Literal["while", "when", "assuming"]
    condition: Condition
    text: str


class ResolvedSpan(Record):
    """`from e until f`: only the time from each `first` until the next `last`, or the end of the run."""

    first: ResolvedEvent | ResolvedAnyEvent
    last: ResolvedEvent | ResolvedAnyEvent
    text: str


class ResolvedOdds(Record):
    """`in at least 98 % of activations`.  relation: `>=` or `>`; probability: a fraction of one."""

    relation: str
    probability: float
    experiments: Experiments
    text: str
    place: Place


class ResolvedWindow(Record):
    """What counts: the last `count` experiments, or the last `seconds`."""

    count: int | None
    experiments: Experiments
    seconds: float | None
    text: str
    place: Place


class ResolvedWay(Record):
    """A way to verify a requirement: `test "TC-12"`.  id: of the test case or the report; None if none is named."""

    method: Method
    id: str | None

    @property
    def text(self) -> str:
        return self.method if self.id is None else f'{self.method} "{self.id}"'


def by_people(ways: Iterable[tuple[str, str | None]]) -> str:
    """Ways to verify a requirement in words, without `monitor`: `by test TC-12 and review`; by review if none is named.

    Args:
        ways: methods, each with the ID of the test case or the report.
    """
    words = [f"{method} {id_ or ''}".rstrip() for method, id_ in ways if method != "monitor"]
    return f"by {' and '.join(words) or 'review'}"


class ResolvedApproval(Record):
    """An approval.

    Attributes:
        on: the date, as written.
        fingerprint: of the meaning that was approved; None if none is given.
    """

    by: str
    on: str
    fingerprint: str | None
    place: Place


class ResolvedRequirement(Record):
    """A requirement with its clauses resolved; scopes, span, odds, confidence, window, action, goal are of all claims.

    Attributes:
        place: its name, where it is defined.
        quality: as written, names joined by points; the enclosing one for a classic requirement.
        further_qualities: those after the first one.
        title: its title, or the classic description.
        classic: whether its claims were read from SuccessIf and FailureIf in its description.
        action: None: not given, so it is monitored.
        ways: to verify it; none: by monitor.
        unread: the claims, as typed, of which a part was not understood.
        sources: where it is from.
        refines: the requirements of which it is a part.
        mitigates: hazards.
    """

    name: str
    place: Place
    quality: str | None
    title: str | None
    classic: bool
    parameters: tuple[ResolvedParameter, ...]
    claims: tuple[ResolvedClaim, ...]
    scopes: tuple[ResolvedScope, ...] = ()
    span: ResolvedSpan | None = None
    odds: ResolvedOdds | None = None
    confidence: float | None = None
    window: ResolvedWindow | None = None
    action: Action | None = None
    goal: Bounded | None = None
    reasons: tuple[str, ...] = ()
    ways: tuple[ResolvedWay, ...] = ()
    unread: tuple[str, ...] = ()
    further_qualities: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()
    refines: tuple[str, ...] = ()
    mitigates: tuple[str, ...] = ()
    priority: str | None = None
    approvals: tuple[ResolvedApproval, ...] = ()

    @property
    def qualities(self) -> tuple[str, ...]:
        """All its qualities, as written."""
        return () if self.quality is None else (self.quality, *self.further_qualities)

    @property
    def method(self) -> Method | None:
        """The way that counts: `monitor` if it is one of several; None if none is given."""
        methods = [way.method for way in self.ways]
        return "monitor" if "monitor" in methods else next(iter(methods), None)

    @property
    def by_people(self) -> str:
        """How people verify it, in words: `by test TC-12 and review`."""
        return by_people((way.method, way.id) for way in self.ways)

    @property
    def verification(self) -> str:
        """The clause about the ways to verify it; empty without any."""
        return f"verified by {', '.join(way.text for way in self.ways)}" if self.ways else ""

    assumptions: tuple[ResolvedScope, ...] = ()

    @property
    def demands_enforcement(self) -> bool:
        """Whether `on violation` demands that the engine enforces the claims."""
        return self.action in ("fail", "halt")

    @property
    def is_verified_by_people(self) -> bool:
        """Whether people verify the claims, so that no tool enforces or monitors them."""
        return self.method in ("review", "test", "analysis")

    @property
    def is_enforceable(self) -> bool:
        """Whether the engine is to enforce the claims, as far as the requirement itself decides that; a claim or its
        node may still prevent it."""
        is_single = self.odds is None and self.window is None  # else many experiments decide, which the engine forgets
        is_single = is_single and not self.assumptions  # whether they hold is known only at the end
        return self.demands_enforcement and is_single and not self.is_verified_by_people


def events_of(subject: Subject | None) -> tuple[ResolvedEvent | ResolvedAnyEvent, ...]:
    """The events that a subject names."""
    if isinstance(subject, Interval):
        return subject.first, subject.last
    return (subject.event,) if isinstance(subject, ResolvedEachEvent) else ()


NO_DIMENSION: Final[Dimension] = (0, 0, 0, 0, 0, 0, 0, 0, 0)


def signals_in(part: object) -> Iterator[ResolvedSignal]:
    """The signals in a condition, a bound or any other part of the model, or in a tuple of such."""
    return (each for each in parts_in(part) if isinstance(each, ResolvedSignal))


def parts_in(part: object) -> Iterator[object]:
    """A part of the model, or a tuple of such, and all that it has, in order, but for what a signal has; each context
    once.
    """
    waiting = [part]
    contexts: set[str] = set()
    while waiting:
        part = waiting.pop()
        if isinstance(part, tuple):
            waiting += reversed(part)
        elif type(part) in _CLASSES:
            if isinstance(part, InContext):
                if part.name in contexts:
                    continue
                contexts.add(part.name)
            yield part
            if not isinstance(part, ResolvedSignal):
                waiting += reversed(as_dict(part).values())


_CLASSES: Final = frozenset([each for each in globals().values() if getattr(each, "__module__", "") == __name__])
