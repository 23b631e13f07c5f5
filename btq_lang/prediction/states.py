"""The state of a simulated tree as a value: it can be kept, compared and put back.

One invariant: what is in a state goes on alike whatever the time is.  So it has no times: of a timer it says that it
runs, and when it goes off is known to the run, as are numbers of entries that belong to a run (`LiveValue`).
"""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter
from typing import Any, Final, TypeAlias

from btq_lang.exploration.snapshots import updated_key
from btq_lang.prediction.world import Asker, KeptValue, LiveValue, WorldValue
from btq_lang.simulator.blackboard import Board, BoardEntry
from btq_lang.simulator.leaves import tick_unset_blackboard
from btq_lang.simulator.nodes import Machine
from btq_lang.simulator.timers import NEVER

StateKey: TypeAlias = tuple[Any, ...]


class States:
    """The states of a machine.

    Attributes:
        timed: its nodes that may have a timer, and then those that wait for a time to pass without one.
        boards: all blackboards, that of the root first.
    """

    def __init__(self, machine: Machine, asker: Asker) -> None:
        self._machine: Final = machine
        self._asker: Final = asker
        self.timed: Final = [*machine.timed, *machine.watching]
        boards = {id(node.board): node.board for node in machine.nodes}
        root = machine.root.board.root
        self.boards: Final[Sequence[Board]] = [root, *[board for board in boards.values() if board is not root]]
        counting = [node for node in machine.nodes if node.rules.counts_writes]
        unsets = any(node.rules.flow is tick_unset_blackboard for node in machine.nodes) and bool(counting)
        homes = [node.board.home(updated_key(node)) for node in counting]
        # The entries whose writes count; None: all, for one that is removed and made again counts from 1.
        self._counted: Final = None if unsets else frozenset([(id(board), name) for board, name in homes])
        self._kept: Final[dict[tuple[int, str], KeptValue]] = {}  # by blackboard and key

    def key(self) -> StateKey:
        """The state as it is now."""
        machine = self._machine
        return (
            machine.is_woken,
            tuple([_memory(node) for node in machine.nodes]),
            tuple([node.due != NEVER for node in self.timed]),
            tuple([self._entries(board) for board in self.boards]),
        )

    def put_back(self, key: StateKey, dues: Sequence[int]) -> None:
        """Give the machine a state that it had; `dues`: when its timers go off."""
        machine = self._machine
        machine.is_woken, memories, _, boards = key
        for node, memory in zip(machine.nodes, memories, strict=True):
            (
                node.status,
                node.index,
                node.count,
                node.skipped,
                node.is_on,
                node.completed,
                node.seen,
                node.result,
                node.has_fired,
                node.queue,
                node.kept,
            ) = memory
        for node, due in zip(self.timed, dues, strict=True):
            node.due = due
        for board, rows in zip(self.boards, boards, strict=True):
            board.entries.clear()
            for name, type_, value, _, number in rows:
                board.entries[name] = BoardEntry(type_, value, number)

    def keep_values(self) -> list[tuple[KeptValue, LiveValue]]:
        """Let entries that were given a value of the world have one of their own, which changes no more: each with what
        it is to be.
        """
        kept: list[tuple[KeptValue, LiveValue]] = []
        for position, board in enumerate(self.boards):
            for name, entry in board.entries.items():
                value = entry.value
                if not isinstance(value, LiveValue) or (
                    position == 0 and isinstance(value, WorldValue) and value.name == name
                ):
                    continue
                own = self._kept.get((position, name))
                if own is None:
                    own = self._kept[position, name] = KeptValue(self._asker)
                if value is not own:
                    kept.append((own, value))
                    entry.value = own
        return kept

    def _entries(self, board: Board) -> tuple[Any, ...]:
        counted, of = self._counted, id(board)
        return tuple(
            [
                (
                    name,
                    entry.type,
                    entry.value,
                    entry.value.__class__,  # 1.0 is another value than 1
                    entry.number if counted is None or (of, name) in counted else 0,
                )
                for name, entry in board.entries.items()
            ]
        )


# As `SimulatedNode.memory` without the time of a timer.
_memory: Final = attrgetter(
    *("status", "index", "count", "skipped", "is_on", "completed", "seen", "result", "has_fired", "queue", "kept")
)
