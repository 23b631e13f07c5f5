"""Clauses of a mission about order or occurrence, each asked whether it can be violated.

One invariant: a clause is asked only if a single run can violate it and time has no part in that: `follows`, `each … is
followed by`, `never` of nodes that run, `tries at most` and `succeeds`, without shares of runs, and without scopes
but those of `never`: while nodes run, and from one event of nodes until another.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, TypeAlias

from btq_lang.exploration.answers import Answer, answered_by
from btq_lang.exploration.askable import askable_claims, why_not_asked
from btq_lang.exploration.missions import ExploredMission
from btq_lang.exploration.outcomes import Happened
from btq_lang.exploration.search import SearchBudget
from btq_lang.exploration.snapshots import Snapshots
from btq_lang.exploration.watching import happens
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.model import (
    All,
    Any,
    Condition,
    MissionRun,
    Negation,
    NodeTarget,
    Quantity,
    ResolvedAnyEvent,
    ResolvedClaim,
    ResolvedEachEvent,
    ResolvedEvent,
    Running,
)
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, SimulatedNode
from btq_lang.util.record import Record

_Test: TypeAlias = Callable[[], bool]
_Events: TypeAlias = list[tuple[frozenset[int], str]]  # nodes and what happens to them


class ClauseAnswer(Record):
    """Whether a clause can be violated.

    Attributes:
        requirement: its name.
        text: of the clause, as typed.
    """

    requirement: str
    text: str
    answer: Answer


class UnaskedClause(Record):
    """A clause that cannot be asked; why: in words after it."""

    requirement: str
    text: str
    why: str


def unasked_clauses(mission: ExploredMission) -> tuple[UnaskedClause, ...]:
    """The clauses that cannot be asked, each once."""
    pairs = [(applied, claim) for applied in mission.applied for claim in applied.requirement.claims]
    unasked = (UnaskedClause(each.requirement.name, claim.text, why_not_asked(each, claim)) for each, claim in pairs)
    return tuple(dict.fromkeys(clause for clause in unasked if clause.why))


def clause_answers(mission: ExploredMission, budget: SearchBudget, only: str = "") -> Iterator[ClauseAnswer]:
    """The clauses that can be asked, with the answers.

    Args:
        only: the requirement that is asked about; empty: all.

    Raises:
        NotExplored: the tree cannot be explored.
    """
    for applied in mission.applied:
        name = applied.requirement.name
        for claim in askable_claims(applied) if only in ("", name) else ():
            opened = mission.open()
            watch = _watch(mission, applied, claim, opened.snapshots)
            opened.snapshots.tracked = tuple(watch.tracked.values())
            yield ClauseAnswer(name, claim.text, answered_by(opened, watch, watch.tracked, budget))


class _Violation:
    """Watches for the violation of a clause.

    Attributes:
        tracked: the nodes of whose statuses it asks at any time, by number.
    """

    def __init__(self, snapshots: Snapshots) -> None:
        self.snapshots: Final = snapshots
        self.tracked: dict[int, SimulatedNode] = {}

    def begin(self) -> object:
        return 0

    def unset_read(self, node: SimulatedNode, key: str) -> None:
        """No clause is about that."""


class _Occurs(_Violation):
    """Events that must not occur more often than so many times in a run, or in an activation of some node."""

    def __init__(self, snapshots: Snapshots, events: _Events, most: int, per: frozenset[int]) -> None:
        super().__init__(snapshots)
        self._events: Final = events
        self._most: Final = most
        self._per: Final = per

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if node.uid in self._per and happens("starts", before, after):
            self.snapshots.watched = 0
        if _is_any(self._events, node, before, after):
            if self.snapshots.watched == self._most:
                raise Happened
            self.snapshots.watched += 1


class _Holds(_Violation):
    """Nodes that must not run together while others run."""

    def __init__(self, snapshots: Snapshots, test: _Test, tracked: dict[int, SimulatedNode]) -> None:
        super().__init__(snapshots)
        self._test: Final = test
        self.tracked = tracked

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if self._test():
            raise Happened


class _HoldsWithin(_Holds):
    """Nodes that must not run from each of some events until the next of others."""

    def __init__(
        self, snapshots: Snapshots, test: _Test, tracked: dict[int, SimulatedNode], first: _Events, last: _Events
    ) -> None:
        super().__init__(snapshots, test, tracked)
        self._first: Final = first
        self._last: Final = last

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        for is_start in (True, False):  # a node that ends at once starts before
            if _is_any(_starts(self._last, is_start), node, before, after):
                self.snapshots.watched = 0
            if _is_any(_starts(self._first, is_start), node, before, after):
                self.snapshots.watched = 1
        if self.snapshots.watched:
            super().changed(node, before, after)


class _Follows(_Violation):
    """Starts that need an event since the start before."""

    def __init__(self, snapshots: Snapshots, starting: frozenset[int], events: _Events) -> None:
        super().__init__(snapshots)
        self._starting: Final = starting
        self._events: Final = events

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if _is_any(self._events, node, before, after):
            self.snapshots.watched = 1
        if node.uid in self._starting and happens("starts", before, after):
            if not self.snapshots.watched:
                raise Happened
            self.snapshots.watched = 0


class _Followed(_Violation):
    """Events after which another must occur before the mission ends."""

    def __init__(self, snapshots: Snapshots, events: _Events, others: _Events) -> None:
        super().__init__(snapshots)
        self._events: Final = events
        self._others: Final = others

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if _is_any(self._events, node, before, after):
            self.snapshots.watched = 1
        if _is_any(self._others, node, before, after):
            self.snapshots.watched = 0
        if node is self.snapshots.machine.root and after in (SUCCESS, FAILURE) and self.snapshots.watched:
            raise Happened


_Watch: TypeAlias = _Occurs | _Holds | _Follows | _Followed


def _is_any(events: _Events, node: SimulatedNode, before: int, after: int) -> bool:
    return any(node.uid in uids and happens(word, before, after) for uids, word in events)


def _starts(events: _Events, is_start: bool) -> _Events:
    return [event for event in events if (event[1] == "starts") == is_start]


def _watch(mission: ExploredMission, applied: Applied, claim: ResolvedClaim, snapshots: Snapshots) -> _Watch:
    """Who watches for the violation of a claim that can be asked."""
    subject = claim.subject or applied.subject
    if isinstance(subject, ResolvedEachEvent):
        return _Followed(snapshots, _events(mission, subject.event), _events(mission, claim.event))
    assert isinstance(subject, NodeTarget | MissionRun), "others are not asked"
    uids = mission.uids_of(subject)
    if claim.verb == "succeeds":
        return _Occurs(snapshots, [(uids, "fails")], 0, frozenset())
    if claim.verb == "follows":
        return _Follows(snapshots, uids, _events(mission, claim.event))
    if claim.verb == "tries":
        assert claim.limit is not None, "as above"
        assert isinstance(claim.limit.value, Quantity), "as above"
        per = mission.uids_of(claim.per) if isinstance(claim.per, NodeTarget) else frozenset()
        return _Occurs(snapshots, [(uids, "starts")], int(claim.limit.value.si), per)
    tracked: dict[int, SimulatedNode] = {}
    assert claim.condition is not None, "as above"
    conditions = (claim.condition, *(scope.condition for scope in applied.requirement.scopes))
    test = _test(mission, All(conditions), snapshots, tracked)
    if isinstance(subject, NodeTarget):
        while_running = _runs(uids, snapshots, tracked)
        return _Holds(snapshots, lambda: while_running() and test(), tracked)
    span = applied.requirement.span
    if span is not None:
        return _HoldsWithin(snapshots, test, tracked, _events(mission, span.first), _events(mission, span.last))
    return _Holds(snapshots, test, tracked)


def _events(mission: ExploredMission, event: ResolvedEvent | ResolvedAnyEvent | None) -> _Events:
    """Changes of statuses that an event is."""
    atoms = event.atoms if event is not None else ()
    return [(mission.uids_of(atom.subject), atom.happening) for atom in atoms if atom.subject is not None]


def _test(
    mission: ExploredMission, condition: Condition, snapshots: Snapshots, tracked: dict[int, SimulatedNode]
) -> _Test:
    """A function that says whether nodes run as a condition says."""
    if isinstance(condition, Negation):
        inner = _test(mission, condition.condition, snapshots, tracked)
        return lambda: not inner()
    if isinstance(condition, All | Any):
        tests = [_test(mission, each, snapshots, tracked) for each in condition.conditions]
        joined = all if isinstance(condition, All) else any
        return lambda: joined(test() for test in tests)
    assert isinstance(condition, Running), "others are not asked"
    return _runs(mission.uids_of(condition.target), snapshots, tracked)


def _runs(uids: frozenset[int], snapshots: Snapshots, tracked: dict[int, SimulatedNode]) -> _Test:
    nodes = [node for node in snapshots.machine.nodes if node.uid in uids]
    tracked.update({node.uid: node for node in nodes})
    return lambda: any(node.status == RUNNING for node in nodes)
