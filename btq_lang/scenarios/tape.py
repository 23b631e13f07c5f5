"""What happened in a run of the model, as a program repeats it in an engine: what its leaves returned and wrote, how
entries of the root blackboard changed, and what came of it.

One invariant: a program that repeats this does in an engine what it did in the model, as long as the tree does so.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final, TypeAlias

from btq_lang.scenarios.plan import Set
from btq_lang.simulator.blackboard import Unknown
from btq_lang.simulator.nodes import Machine
from btq_lang.simulator.skills import Write
from btq_lang.util.record import Record

# The number of a node and its new status, or the values of its ports when it begins; or an entry and its new value.
Event: TypeAlias = tuple[int, int | dict[str, str | Unknown | None]] | tuple[str, float | str | bool | None]
PERIOD: Final = 10  # milliseconds between two ticks


class LeafTick(Record):
    """A tick of a leaf; now: in milliseconds; sets: what changed when it began; writes: of the leaf itself."""

    now: int
    result: int
    sets: tuple[Set, ...]
    writes: tuple[Write, ...]


class Moment(Record):
    """What happens at a time, or in the same way in successive ticks.

    Attributes:
        first, last: the times of the first and the last of these ticks, in milliseconds.
        is_tick: it is in a tick, and not between two.
    """

    first: int
    last: int
    is_tick: bool
    events: tuple[Event, ...]


class Tape:
    """What happened in a run.

    Attributes:
        machine: the tree; None if it is refused.
        leaves: ticks by the number of the leaf, without those that repeat what is before and after them.
        at_changes: entries that changed in a change of a status, which is the how manieth at its time.
        between: entries that changed between two ticks: when, and after how many changes of a status at that time.
        until: when the program halted the tree, and after how many changes of a status at that time; None: the run
            ended.
    """

    def __init__(self) -> None:
        self.machine: Machine | None = None
        self.leaves: Final[dict[int, list[LeafTick]]] = {}
        self.at_changes: Final[list[tuple[int, int, tuple[Set, ...]]]] = []
        self.between: Final[list[tuple[int, int, tuple[Set, ...]]]] = []
        self.until: tuple[int, int] | None = None
        self._sets: list[Set] = []
        self._is_tick = False
        self._times: Final[list[tuple[int, bool, list[Event]]]] = []
        self._changes = 0  # at the time of the last event

    # ---- what the program does ----

    def set(self, value: Set) -> None:
        """An entry of the root blackboard changes."""
        self._sets.append(value)

    def taken(self) -> tuple[Set, ...]:
        """The entries that have changed since this was asked last."""
        sets, self._sets = tuple(self._sets), []
        return sets

    def leaf(self, uid: int, tick: LeafTick) -> None:
        """A leaf has been ticked."""
        ticks = self.leaves.setdefault(uid, [])
        if len(ticks) > 1 and ticks[-1].now < tick.now and _is_repeated(*ticks[-2:]):
            del ticks[-1]  # a leaf returns the same until its next tick
        ticks.append(tick)

    def change(self, now: int, uid: int, status: int) -> None:
        """The status of a node changes, and then what the scenario changes because of that."""
        self.event(now, (uid, status))
        self._changes += 1

    def changed(self) -> None:
        """All that the scenario changes because of a change of a status has changed."""
        if sets := self.taken():
            self.at_changes.append((self._times[-1][0], self._changes, sets))

    def pause(self, now: int) -> None:
        """The world has changed between two ticks."""
        self._at(now)
        if sets := self.taken():
            self.between.append((now, self._changes, sets))

    def halt(self, now: int) -> None:
        """The program halts the tree."""
        self._at(now)
        self.until = now, self._changes

    # ---- what comes of it ----

    def event(self, now: int, event: Event) -> None:
        """Something happens."""
        self._at(now)
        self._times[-1][2].append(event)

    def look(self, now: int) -> bool:
        """The program looks at the world, before or after a tick; whether that is after one."""
        is_after, self._is_tick = self._is_tick, False
        self._at(now)
        return is_after

    def tick(self, now: int) -> None:
        """A tick begins."""
        self._is_tick = True
        self._at(now)

    def _at(self, now: int) -> None:
        if self._times and self._times[-1][0] != now:
            self._changes = 0
        if not self._times or self._times[-1][:2] != (now, self._is_tick):
            self._times.append((now, self._is_tick, []))

    def moments(self) -> Iterator[Moment]:
        """What happened, also in the ticks that the model has passed over because they change nothing."""
        return merged(self._every_moment())

    def _every_moment(self) -> Iterator[Moment]:
        ends = [time for time, is_tick, _ in self._times if is_tick][1:] + ([self.until[0]] if self.until else [])
        next_tick = iter(ends)
        for time, is_tick, events in self._times:
            passed = (next(next_tick, time) - 1 - time) // PERIOD if is_tick else 0
            yield Moment(time, time + max(passed, 0) * PERIOD, is_tick, tuple(events))


def merged(moments: Iterable[Moment]) -> Iterator[Moment]:
    """Moments without those in which nothing happens, and with equal successive ticks as one."""
    last: Moment | None = None
    for moment in moments:
        if not moment.events:
            continue
        if last is not None:
            is_same = last.is_tick and moment.is_tick and last.events == moment.events
            if is_same and last.last + PERIOD == moment.first:
                last = Moment(last.first, moment.last, True, last.events)
                continue
            yield last
        last = moment
    if last is not None:
        yield last


def _is_repeated(before: LeafTick, tick: LeafTick) -> bool:
    return tick.result == before.result and not tick.sets and not tick.writes
