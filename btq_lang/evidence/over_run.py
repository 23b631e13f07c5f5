"""What a clause judged over a run reads: what its nodes did in the run, and when events happened."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Sequence
from itertools import accumulate
from operator import attrgetter
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.evidence.conditions import truth
from btq_lang.evidence.model import ROOT, UNKNOWN_END, Activation, Moment
from btq_lang.evidence.scopes import in_scope
from btq_lang.evidence.signals import UnknownValue
from btq_lang.requirements.model import (
    All,
    Condition,
    MissionRun,
    NodeTarget,
    ResolvedAnyEvent,
    ResolvedEvent,
    ResolvedScope,
    ResolvedSpan,
)
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.guards import RefusedStart
    from btq_lang.evidence.observed import Observed

# Of an event: the next one of some others that has happened, and those that only may have happened before that.
NextOf: TypeAlias = "Callable[[Happening], tuple[Happening | None, Sequence[Happening]]]"


class Happening(Record):
    """An occurrence of an event.

    Attributes:
        until: equal to `at`; later if the log shows only that it happened between them.
        why: why the moment cannot be judged; empty if what follows from both ends may be.
        is_certain: it did happen, rather than may have.
        order: the moment that orders it among other events; None: its own.
        judged: when scopes and bounds are read; None: at `at`.
        uid: of the node that it happened to; 0: it is a condition.
    """

    at: Moment
    until: Moment
    why: str = ""
    is_certain: bool = True
    order: Moment | None = None
    judged: Moment | None = None
    uid: int = 0

    @property
    def first(self) -> Moment:
        """The earliest moment at which it may have happened, in the order of events."""
        return self.order or self.at

    @property
    def read(self) -> Moment:
        """When scopes and bounds are read."""
        return self.judged or self.at

    @property
    def last(self) -> Moment:
        """The latest moment at which it may have happened, in the order of events."""
        return self.order or self.until


class Stretch(Record):
    """A part of a run throughout which a condition holds.

    Attributes:
        why: why it is unknown whether the condition held; empty if it did.
    """

    begin: Moment
    end: Moment
    why: str = ""


class OverRun(Record):
    """A run that has ended.

    Attributes:
        verb, scopes: of the clause.
        root: the activation of its root, which spans the run.
        uids: the clause's nodes; the root for a span that begins with a condition.
        own: the activations of these, in the order of their starts.
        observed: of the whole run.
        refused: starts of the clause's nodes that its own guard refused.
        stopped: activations that its own guard stopped: of the nodes around a time between events, or of its nodes
            where its requirement has a span.
        missed: events that a judge found to concern no activation are appended.
        span: of the requirement.
        unsettled: moments are appended of judgements that, with another bound, do not follow from their measure.
    """

    verb: str
    scopes: Sequence[ResolvedScope]
    root: Activation
    uids: Sequence[int]
    own: Sequence[Activation]
    observed: Observed
    refused: Sequence[RefusedStart]
    stopped: Sequence[Activation]
    missed: list[Moment]
    span: ResolvedSpan | None
    unsettled: list[Moment]

    @property
    def is_cut_off(self) -> bool:
        """Whether the log ends before the run does."""
        return self.root.outcome == "O"

    def counts(self, begin: Moment, end: Moment) -> bool | UnknownValue:
        """Whether the scopes include a period."""
        return not self.scopes or in_scope(self.scopes, self.verb, self.observed.between(begin, end))

    def counts_one(self, activation: Activation) -> bool | UnknownValue:
        """Whether the scopes include an activation."""
        if not self.scopes:
            return True
        return in_scope(self.scopes, self.verb, self.during(activation))

    def during(self, activation: Activation) -> Observed:
        """What was observed during an activation; of one of several nodes of the clause, as seen from it."""
        observed = self.observed.during(activation)
        is_one_of_several = len(self.uids) > 1 and activation.uid in self.uids
        return observed.beside(activation.uid) if is_one_of_several else observed

    def begins(self, event: ResolvedEvent | ResolvedAnyEvent) -> list[Moment]:
        """When the clause's nodes began, to be compared with an event: a moment, or the row of another node."""
        is_by_row = event.condition is None
        return [activation.shown if is_by_row else activation.begun(self.observed.is_early) for activation in self.own]

    def starts(self) -> list[tuple[Activation, bool | UnknownValue]]:
        """The activations of the clause's nodes that count or may count."""
        starts = ((start, self.counts_one(start)) for start in self.own)
        return [(start, counts) for start, counts in starts if counts is not False]

    def stretches(self) -> list[Stretch]:
        """The parts of the run whose time counts or may count."""
        conditions = [scope.condition for scope in self.scopes if scope.word == "while"]
        if not conditions:
            return [Stretch(self.observed.begin, self.observed.end)]
        return self.with_all_along(All(tuple(conditions)))

    def with_all_along(self, condition: Condition, observed: Observed | None = None) -> list[Stretch]:
        """The maximal parts of the run in which a condition holds or is unknown.

        Args:
            observed: of the run; None: with the values `initially` of signals.
        """
        observed = observed or self.observed.in_scope
        stretches: list[Stretch] = []
        begin = observed.begin
        before: bool | UnknownValue = False
        for moment in (*observed.moments(condition), None):
            now = truth(condition, observed, moment) if moment is not None else False
            is_like = now is before or (isinstance(now, UnknownValue) and isinstance(before, UnknownValue))
            if moment is not None and is_like:
                continue
            end = moment if moment is not None else observed.end
            if before is not False:
                stretches.append(Stretch(begin, end, before.why if isinstance(before, UnknownValue) else ""))
            begin, before = end, now
        return stretches

    def happenings(
        self, event: ResolvedEvent | ResolvedAnyEvent, is_own: bool = False, is_by_row: bool = True
    ) -> list[Happening]:
        """The certain and possible occurrences of an event, in order.

        Args:
            is_own: only those of the clause's nodes, not of all that the event names.
            is_by_row: begins are in the order of their rows, not of their times.
        """
        if not isinstance(event, ResolvedAnyEvent):
            return self._happenings(event, self.own if is_own else None, is_by_row)
        is_by_row = is_by_row and event.condition is None
        occurrences: dict[Happening, None] = {}  # each once: what succeeds finishes, too
        for atom in event.atoms:
            own: Sequence[Activation] | None = None
            if is_own and atom.condition is None:
                own = self.observed.nodes.of(target_of(atom), self.own)
            elif is_own and ROOT not in self.uids:
                continue
            occurrences.update(dict.fromkeys(self._happenings(atom, own, is_by_row)))
        return sorted(occurrences, key=lambda happening: happening.first)

    def _happenings(
        self, event: ResolvedEvent, activations: Sequence[Activation] | None, is_by_row: bool
    ) -> list[Happening]:
        occurrences: list[Happening] = []
        if event.condition is not None:
            ended: Moment | None = None  # of the last part in which it is unknown
            for part in self.with_all_along(event.condition):
                if part.why or part.begin != ended:
                    occurrences.append(
                        Happening(part.begin, part.end if part.why else part.begin, part.why, not part.why)
                    )
                ended = part.end if part.why else None
            return occurrences
        outcomes = _OUTCOMES.get(event.happening)
        for activation in activations if activations is not None else self.observed.nodes.activations(target_of(event)):
            uid = activation.uid
            if outcomes is None:
                begun = activation.begun(self.observed.is_early)
                order = activation.shown if is_by_row else begun
                moments = activation.begun(True), activation.started
                occurrences.append(Happening(*moments, order=order, judged=begun, uid=uid))
            elif activation.outcome in outcomes and activation.timing == "latest":
                moments = activation.shown, activation.ended
                occurrences.append(Happening(*moments, UNKNOWN_END, judged=activation.ended, uid=uid))
            elif activation.outcome in outcomes:
                occurrences.append(Happening(activation.ended, activation.ended, uid=uid))
        return sorted(occurrences, key=lambda happening: happening.first)


def next_finder(events: Sequence[Happening], run: OverRun, *, is_later: bool) -> NextOf:
    """Finds what happens next; `is_later`: not at the same moment."""
    certain = sorted([event for event in events if event.is_certain], key=attrgetter("first", "last"))
    unclear = [event for event in events if event.why]
    moments = [event.first for event in certain]
    # The first one that has happened, of those from each index on.
    nexts = [*accumulate(reversed(certain), _earlier)][::-1]

    def next_of(event: Happening) -> tuple[Happening | None, Sequence[Happening]]:
        index = bisect_left(moments, event.first)
        while is_later and index < len(certain) and certain[index].last == event.first:
            index += 1
        last = nexts[index] if index < len(nexts) else None
        until = last.last if last is not None else run.root.ended
        return last, [other for other in unclear if other.until >= event.first and other.at <= until]

    return next_of


def _earlier(next_event: Happening, event: Happening) -> Happening:
    """Which one has happened first; of those that happen at once, that which began first."""
    return min(event, next_event, key=attrgetter("last"))


def is_never_at_once(first: ResolvedEvent | ResolvedAnyEvent, last: ResolvedEvent | ResolvedAnyEvent) -> bool:
    """Whether two events never follow each other at one moment: an event does not follow itself, and a row of a node is
    one change."""
    return first == last or (first.atoms[0].condition is None and last.atoms[0].condition is None)


def target_of(event: ResolvedEvent) -> NodeTarget:
    """The node of an event."""
    subject = event.subject
    if isinstance(subject, MissionRun):
        assert subject.node is not None, "an event of an unknown mission is not judged"
        return NodeTarget(subject.node)
    assert subject is not None, "only `when` has no subject"
    return subject


_OUTCOMES: Final = {"succeeds": "S", "fails": "F", "finishes": "SF", "halts": "H"}
