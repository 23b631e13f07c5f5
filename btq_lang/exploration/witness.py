"""A run that shows an answer, tick by tick: the choices of a search, made again by the model of the engine.

One invariant: nothing is remembered here; a witness is what the model does when leaves do what was chosen.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Final, TypeAlias

from btq_lang.exploration.choices import Choices
from btq_lang.exploration.opened import Opened, Watch
from btq_lang.exploration.outcomes import Happened
from btq_lang.exploration.search import fire_timers
from btq_lang.exploration.values import Domain, FreeValue, domain_of, sample
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.leaves import tick_script_condition
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.simulator.ticking import execute_tick
from btq_lang.util.record import Record, replace


class Written(Record):
    """A value that the program or a leaf writes.

    Attributes:
        name: of the entry, or of the port that names it.
        value: one of those that it may be.
        is_needed: the run has compared it with something.
    """

    name: str
    value: float | int | str
    is_needed: bool


class Deed(Record):
    """Something that happens in a tick.

    Attributes:
        uid: the number of the node.
        path: its path.
        what: succeeds, fails, runs, is halted or goes off.
        writes: of a leaf that ends, by port.
    """

    uid: int
    path: str
    what: str
    writes: tuple[Written, ...] = ()


class Tick(Record):
    """A tick.

    Attributes:
        deeds: of leaves and timers, in order.
        entries: those of the root blackboard that have other values than before: the key and what is known of it.
        result: of the root: runs, succeeds, fails, is skipped, throws or is not known; empty: the tick is not finished,
            for what was asked has happened.
        message: of what was thrown, or why it is not known.
        at: when the program ticks, in milliseconds, if nothing but its driver delays that.
        given: the entries that the program sets before, in the first tick.
        changes: the leaves that have other statuses, by number, and their statuses; without those that are reset.
        refusals: the numbers of the ScriptConditions that fail.
    """

    deeds: tuple[Deed, ...]
    entries: tuple[tuple[str, str], ...]
    result: str
    message: str = ""
    at: int = 0
    given: tuple[Written, ...] = ()
    changes: tuple[tuple[int, int], ...] = ()
    refusals: tuple[int, ...] = ()


class NotReplayed(Exception):
    """The choices do not lead where they should."""


def replay(
    opened: Opened, watch: Watch | None, may_run: Collection[int], ways: Sequence[Sequence[int]]
) -> tuple[Tick, ...]:
    """What the model does with given choices.

    Args:
        may_run: as in the search.
        ways: the choices of each tick.

    Raises:
        NotReplayed: it would choose something else.
    """
    recorder = _Recorder(opened, watch)
    opened.begin(recorder, may_run)
    opened.leaves.done = recorder.done
    try:
        return recorder.with_values([recorder.tick(way) for way in ways])
    finally:
        opened.leaves.done = None
        opened.machine.now = 0


class _Recorder:
    """Writes down what happens, and tells it to another watch."""

    def __init__(self, opened: Opened, watch: Watch | None) -> None:
        self._opened: Final = opened
        self._watch: Final = watch
        self._custom: Final = {node.uid for node in opened.custom}
        self._deeds: list[Deed] = []
        self._entries: dict[str, str] = {}
        self._changes: list[tuple[int, int]] = []
        self._refusals: list[int] = []
        self._types: Final[dict[int, str]] = {}  # of values, by number
        self._next = 0  # when the next tick is, if no timer goes off before
        self._given: Final[list[_Value]] = []
        self._written: Final[dict[int, list[_Value]]] = {}  # by the identity of the deed

    def begin(self) -> object:
        for key, entry in sorted(self._opened.machine.root.board.root.entries.items()):
            if isinstance(entry.value, FreeValue):
                self._given.append((key, entry.value.number, entry.type))
        return self._watch.begin() if self._watch is not None else None

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if node.uid in self._custom and (after != IDLE or before == RUNNING):
            self._changes.append((node.uid, after))
            if after == IDLE:
                self._deeds.append(Deed(node.uid, node.path, "is halted"))
        if after == FAILURE and node.rules.flow is tick_script_condition:
            self._refusals.append(node.uid)
        if self._watch is not None:
            self._watch.changed(node, before, after)

    def unset_read(self, node: SimulatedNode, key: str) -> None:
        if self._watch is not None:
            self._watch.unset_read(node, key)

    def done(self, node: SimulatedNode, result: int, written: Sequence[str]) -> None:
        """A leaf has come to something."""
        deed = Deed(node.uid, node.path, _WORDS[result])
        self._deeds.append(deed)
        ports = {key_of(text, port): port for port, text in node.ports.items()}
        types = dict(self._opened.leaves.kind(node).writes)
        for key in written:
            entry = node.board.entry(key)
            if entry is not None and isinstance(entry.value, FreeValue):
                type_ = self._types[entry.value.number] = entry.type or types.get(ports[key], "")
                self._written.setdefault(id(deed), []).append((ports[key], entry.value.number, type_))

    def tick(self, way: Sequence[int]) -> Tick:
        """One tick with these choices."""
        opened, snapshots = self._opened, self._opened.snapshots
        self._deeds = []
        snapshots.choices = choices = Choices(way)
        result, message = "", ""
        self._changes, self._refusals = [], []
        now = self._next
        dues = {node.uid: node.due for node in opened.machine.timed}
        try:
            fired = fire_timers(snapshots)
            self._deeds += [Deed(node.uid, node.path, "goes off") for node in fired]
            now = opened.machine.now = self._tick_at([dues[node.uid] for node in fired])
            result = _WORDS[execute_tick(opened.machine, opened.machine.root)]
        except Happened:
            pass
        except EngineError as error:
            result, message = "throws", str(error)
        except NotModelled as error:
            result, message = "is not known", str(error)
        if choices.log != list(way):
            raise NotReplayed
        is_again = opened.machine.is_woken and opened.driver.function != "tick_exactly_once"
        self._next = now if is_again else now + opened.driver.period
        deeds, changes, refusals = tuple(self._deeds), tuple(self._changes), tuple(self._refusals)
        return Tick(deeds, self._changed_entries(), result, message, now, changes=changes, refusals=refusals)

    def _tick_at(self, dues: Sequence[int]) -> int:
        """When the next tick is if timers have gone off at some times before it."""
        driver, last = self._opened.driver, max(dues, default=self._next)
        return last if driver.is_woken else max(self._next, driver.tick_after(self._next, last))

    def with_values(self, ticks: Sequence[Tick]) -> tuple[Tick, ...]:
        """The ticks with values of entries that are as the run has compared them."""
        domains = self._opened.snapshots.domains

        def written(values: Sequence[_Value]) -> tuple[Written, ...]:
            return tuple(
                [
                    Written(name, sample(domains[number], type_), domains[number] != domain_of(type_))
                    for name, number, type_ in values
                ]
            )

        def with_values(tick: Tick) -> Tick:
            deeds = [replace(deed, writes=written(self._written.get(id(deed), ()))) for deed in tick.deeds]
            return replace(tick, deeds=tuple(deeds))

        first, *others = map(with_values, ticks)
        return replace(first, given=written(self._given)), *others

    def _changed_entries(self) -> tuple[tuple[str, str], ...]:
        before = self._entries
        self._entries = dict(_entries(self._opened, self._types))
        return tuple([(key, text) for key, text in self._entries.items() if before.get(key) != text])


def _entries(opened: Opened, types: Mapping[int, str]) -> Sequence[tuple[str, str]]:
    """The entries of the root blackboard that have values, and what is known of these; `types`: of values that leaves
    have written, by number.
    """
    snapshots = opened.snapshots
    board = opened.machine.root.board.root
    texts: list[tuple[str, str]] = []
    for key, entry in sorted(board.entries.items()):
        value = entry.value
        if isinstance(value, FreeValue):
            texts.append((key, _described(snapshots.domains[value.number], types.get(value.number, entry.type))))
        elif value is not None:
            texts.append((key, f"= {value!r}"))
    return texts


def _described(domain: Domain, type_: str) -> str:
    """What is known of a value, to follow the name of its entry; `type_`: of that."""
    if domain == domain_of(type_):
        return "has a value"
    if domain.fixed is not None:
        return f"= {domain.fixed!r}"
    parts: list[str] = []
    if domain.low > -_LIMIT:
        parts.append(f"{'>' if domain.is_low_open else '>='} {domain.low:g}")
    if domain.high < _LIMIT:
        parts.append(f"{'<' if domain.is_high_open else '<='} {domain.high:g}")
    parts += [f"!= {value!r}" for value in sorted(domain.excluded, key=str)]
    return " and ".join(parts) if parts else "has a value"


_Value: TypeAlias = tuple[str, int, str]  # the entry or port, the number of the value, and the type of the entry
_LIMIT: Final = 2.0**31 - 1  # beyond it, a limit is that of a type
_WORDS: Final = {
    SUCCESS: "succeeds",
    FAILURE: "fails",
    RUNNING: "runs",
    SKIPPED: "is skipped",
}
