"""Leaves that may do anything: what they return and write, and Nav2's nodes that read the world.

One invariant: a leaf does here what it may do by its declaration, and nothing else; conditions end at once, and actions
may run on where that is allowed.  A leaf does not change an entry while it runs, nor when it is halted.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import Final

from btq_lang.exploration.snapshots import Snapshots
from btq_lang.simulator.nav2 import UPDATED
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.simulator.world import World
from btq_lang.util.record import Record


class LeafKind(Record):
    """What is known of the leaves of a program that have one name.

    Attributes:
        is_condition: it never runs on.
        is_action: it is known to be an action.
        reads: the ports that it reads.
        writes: the ports that it writes, with their types.
        server: the action server that it calls; empty: none is known.
        is_declared: all its ports are known; else it may write to any of them that has no value.
    """

    is_condition: bool = False
    is_action: bool = False
    reads: tuple[str, ...] = ()
    writes: tuple[tuple[str, str], ...] = ()
    server: str = ""
    is_declared: bool = False


class FreeLeaves:
    """A program whose leaves do anything.

    Attributes:
        snapshots: of the machine; to be set before the first tick.
        unset_read: called when a leaf begins and an entry that it reads has no value.
        done: called with what a leaf has come to.
        may_run: the numbers of the leaves that may run on.
    """

    def __init__(self, kinds: Mapping[str, LeafKind]) -> None:
        self.snapshots: Snapshots
        self.kinds: Final = kinds
        self.may_run: Collection[int] = ()
        self.unset_read: Callable[[SimulatedNode, str], None] | None = None
        self.done: Callable[[SimulatedNode, int, Sequence[str]], None] | None = None
        self.relevant: Collection[tuple[int, str]] = ()

    def kind(self, node: SimulatedNode) -> LeafKind:
        """What is known of a leaf."""
        return self.kinds.get(node.id, _UNDECLARED)

    def tick(self, node: SimulatedNode) -> int:
        """Tick a leaf; its result."""
        kind = self.kind(node)
        if node.status != RUNNING and self.unset_read is not None:
            for key in unset_keys(node, kind):
                self.unset_read(node, key)
        results = (SUCCESS, FAILURE, RUNNING) if node.uid in self.may_run else (SUCCESS, FAILURE)
        result = results[self.snapshots.choose(len(results))]
        written = self._write(node, kind, result) if result != RUNNING else ()
        if self.done is not None:
            self.done(node, result, written)
        return result

    def _write(self, node: SimulatedNode, kind: LeafKind, result: int) -> Sequence[str]:
        """Write what a leaf may write when it ends: surely after a success if it declares that; the keys."""
        written: list[str] = []
        outputs = kind.writes if kind.is_declared else tuple((port, "") for port in node.ports)
        for port, type_ in outputs:
            key = key_of(node.ports.get(port, ""), port)
            if key is None:
                continue
            board, name = node.board.home(key)
            if (id(board), name) not in self.relevant:
                continue
            is_sure = kind.is_declared and result == SUCCESS
            entry = board.entries.get(name)
            is_empty = entry is None or entry.value is None
            if not is_sure and not (is_empty and self.snapshots.choose(2)) and (is_empty or not kind.is_declared):
                continue
            entry = node.board.create(key) if entry is None else entry
            entry.value = self.snapshots.new_value(entry.type or type_)
            entry.number += 1
            written.append(key)
        return written

    def has_answer(self, node: SimulatedNode) -> bool:
        """Nodes of Nav2 that read the time or the world answer anything, too."""
        return True

    def answer(self, node: SimulatedNode) -> bool:
        """What such a node answers."""
        return self.snapshots.choose(2) == 0

    def update(self, node: SimulatedNode) -> None:
        """Write a goal that a GoalUpdater may have received."""
        for port in UPDATED:
            key = key_of(node.ports.get(port, ""), port)
            board, name = node.board.home(key) if key is not None else (node.board, "")
            if (id(board), name) in self.relevant and self.answer(node):
                board.entries[name].value = self.snapshots.new_value(board.entries[name].type)

    def halt(self, node: SimulatedNode) -> None:
        """Nothing more than the engine does."""

    def next_change(self, now: int) -> int:
        """Never: there is no time."""
        return -1

    def memory(self) -> object:
        """Leaves remember nothing."""
        return None


def unset_keys(node: SimulatedNode, kind: LeafKind) -> Iterable[str]:
    """The entries without a value that a leaf reads."""
    for port in kind.reads:
        key = key_of(node.ports.get(port, ""), port)
        if key is not None:
            entry = node.board.entry(key)
            if entry is None or entry.value is None:
                yield key


class FreeWorld(World):
    """A world in which services may be called at any time."""

    def __init__(self) -> None:
        super().__init__()
        self.snapshots: Snapshots

    def serve(self, service: str) -> bool:
        """Whether a call of the service waits."""
        return bool(self.snapshots.choose(2))


_UNDECLARED: Final = LeafKind()
