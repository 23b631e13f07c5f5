"""A run that shows an answer, tick by tick: the choices of a search, made again by the model of the engine.

One invariant: nothing is remembered here; a witness is what the model does when leaves do what was chosen.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Final

from btq_lang.exploration.choices import Choices
from btq_lang.exploration.opened import Opened, Watch
from btq_lang.exploration.outcomes import Happened
from btq_lang.exploration.search import fire_timers
from btq_lang.exploration.values import Domain, FreeValue
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, SimulatedNode
from btq_lang.simulator.ticking import execute_tick
from btq_lang.util.record import Record


class Deed(Record):
    """Something that happens in a tick.

    Attributes:
        uid: the number of the node.
        path: its path.
        what: succeeds, fails, runs, is halted or goes off.
    """

    uid: int
    path: str
    what: str


class Tick(Record):
    """A tick.

    Attributes:
        deeds: of leaves and timers, in order.
        entries: those of the root blackboard that have other values than before: the key and what is known of it.
        result: of the root: runs, succeeds, fails, is skipped, throws or is not known; empty: the tick is not finished,
            for what was asked has happened.
        message: of what was thrown, or why it is not known.
    """

    deeds: tuple[Deed, ...]
    entries: tuple[tuple[str, str], ...]
    result: str
    message: str = ""


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
        return tuple([recorder.tick(way) for way in ways])
    finally:
        opened.leaves.done = None


class _Recorder:
    """Writes down what happens, and tells it to another watch."""

    def __init__(self, opened: Opened, watch: Watch | None) -> None:
        self._opened: Final = opened
        self._watch: Final = watch
        self._custom: Final = {node.uid for node in opened.custom}
        self._deeds: list[Deed] = []
        self._entries: dict[str, str] = {}

    def begin(self) -> object:
        return self._watch.begin() if self._watch is not None else None

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if before == RUNNING and after == IDLE and node.uid in self._custom:
            self._deeds.append(Deed(node.uid, node.path, "is halted"))
        if self._watch is not None:
            self._watch.changed(node, before, after)

    def unset_read(self, node: SimulatedNode, key: str) -> None:
        if self._watch is not None:
            self._watch.unset_read(node, key)

    def done(self, node: SimulatedNode, result: int, written: Sequence[str]) -> None:
        """A leaf has come to something."""
        self._deeds.append(Deed(node.uid, node.path, _WORDS[result]))

    def tick(self, way: Sequence[int]) -> Tick:
        """One tick with these choices."""
        opened, snapshots = self._opened, self._opened.snapshots
        self._deeds = []
        snapshots.choices = choices = Choices(way)
        result, message = "", ""
        try:
            for node in fire_timers(snapshots):
                self._deeds.append(Deed(node.uid, node.path, "goes off"))
            result = _WORDS[execute_tick(opened.machine, opened.machine.root)]
        except Happened:
            pass
        except EngineError as error:
            result, message = "throws", str(error)
        except NotModelled as error:
            result, message = "is not known", str(error)
        if choices.log != list(way):
            raise NotReplayed
        return Tick(tuple(self._deeds), self._changed_entries(), result, message)

    def _changed_entries(self) -> tuple[tuple[str, str], ...]:
        before = self._entries
        self._entries = dict(entries(self._opened))
        return tuple([(key, text) for key, text in self._entries.items() if before.get(key) != text])


def entries(opened: Opened) -> Sequence[tuple[str, str]]:
    """The entries of the root blackboard that have values, and what is known of these."""
    snapshots = opened.snapshots
    board = opened.machine.root.board.root
    texts: list[tuple[str, str]] = []
    for key, entry in sorted(board.entries.items()):
        value = entry.value
        if isinstance(value, FreeValue):
            texts.append((key, described(snapshots.domains[value.number])))
        elif value is not None:
            texts.append((key, f"= {value!r}"))
    return texts


def described(domain: Domain) -> str:
    """What is known of a value, to follow the name of its entry."""
    if domain.fixed is not None:
        return f"= {domain.fixed!r}"
    parts: list[str] = []
    if domain.low > -_LIMIT:
        parts.append(f"{'>' if domain.is_low_open else '>='} {domain.low:g}")
    if domain.high < _LIMIT:
        parts.append(f"{'<' if domain.is_high_open else '<='} {domain.high:g}")
    parts += [f"!= {value!r}" for value in sorted(domain.excluded, key=str)]
    return " and ".join(parts) if parts else "has a value"


_LIMIT: Final = 2.0**31 - 1  # beyond it, a limit is that of a type
_WORDS: Final = {
    SUCCESS: "succeeds",
    FAILURE: "fails",
    RUNNING: "runs",
    SKIPPED: "is skipped",
}
