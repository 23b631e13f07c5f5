"""A simulated tree: its nodes, with what they are, their status and what they remember between ticks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, Protocol, TypeAlias

from btq_lang.simulator.blackboard import Board, Value
from btq_lang.simulator.versions import Dialect
from btq_lang.simulator.world import World
from btq_lang.syntax.script.tree import Script
from btq_lang.util.record import Record

IDLE: Final = 0
RUNNING: Final = 1
SUCCESS: Final = 2
FAILURE: Final = 3
SKIPPED: Final = 4  # a result, never a status
STATUS_NAMES: Final = ("IDLE", "RUNNING", "SUCCESS", "FAILURE", "SKIPPED")


class TickRules(Record):
    """What all nodes of a kind have in common.

    Attributes:
        flow: what a tick of a node does.
        halt: what a halt does.
        is_decorator: it has one child.
        is_stateful: it is an action of the program that begins, goes on and ends.
        is_timed: it may have a timer.
        watches_time: it may wait for a time to pass, without a timer.
        counts_writes: what it does depends on how often an entry was written.
        yields: it asks to be ticked again after a child that ended at once.
    """

    flow: Flow
    halt: Halt
    is_decorator: bool = False
    is_stateful: bool = False
    yields: bool = False
    is_timed: bool = False
    watches_time: bool = False
    counts_writes: bool = False


class SimulatedNode:
    """A node.

    Attributes:
        uid: its number, in document order from 1.
        id: the name under which the program registers it.
        path: its full path, as messages of the engine have it.
        ports: as written, or by default.
        board: the blackboard that it sees.
        rules: what it does, by its kind.
        conditions: `_failureIf`, `_successIf`, `_skipIf`, `_while`, as far as they are written.
        scripts: `_onSuccess`, `_onFailure`, `_post`, `_onHalted`, likewise, and `code` or `if`.
        index: of the current child; of a node that chooses one at every tick, counted from 1, and 0 if none runs.
        count: how often a child has ended, failed or been tried.
        skipped: how many children have been skipped since it began.
        is_on: a flag of its function: it runs its child, is in its catch, or has ended for ever.
        completed: the children that have ended.
        seen: the number of writes that it knows of an entry.
        result: that of its only run.
        due: when its timer goes off, or the time has passed for which it waits, in milliseconds; negative if never.
        has_fired: its timer has gone off since it began.
        queue: what is left to loop over; None before the first start.
        kept: what it keeps to compare with later: a period, a position, goals, a path.
    """

    __slots__ = (
        *("board", "children", "completed", "conditions", "count", "due", "has_fired", "id", "index", "is_on", "kept"),
        *("name", "path", "ports", "queue", "result", "rules", "scripts", "seen", "skipped", "status", "uid"),
    )

    def __init__(
        self, uid: int, id_: str, name: str, path: str, ports: dict[str, str], board: Board, rules: TickRules
    ) -> None:
        """A node that has not been ticked."""
        self.uid: Final = uid
        self.id: Final = id_
        self.name: Final = name
        self.path: Final = path
        self.ports: Final = ports
        self.board: Final = board
        self.rules = rules
        self.conditions: Final[list[tuple[str, Script]]] = []
        self.scripts: Final[dict[str, Script]] = {}
        self.children: Final[list[SimulatedNode]] = []
        self.status = IDLE
        self.index = 0
        self.count = 0
        self.skipped = 0
        self.is_on = False
        self.completed: frozenset[int] = frozenset()
        self.seen = 0
        self.result = IDLE
        self.due = -1
        self.has_fired = False
        self.queue: tuple[Value, ...] | None = None
        self.kept: tuple[Any, ...] = ()

    @property
    def child(self) -> SimulatedNode:
        """Its only child."""
        return self.children[0]

    def memory(self) -> tuple[object, ...]:
        """All of it that changes, as a value."""
        return (
            self.status,
            self.index,
            self.count,
            self.skipped,
            self.is_on,
            self.completed,
            self.seen,
            self.result,
            self.due,
            self.has_fired,
            self.queue,
            self.kept,
        )


def _in_document_order(root: SimulatedNode) -> Sequence[SimulatedNode]:
    """A node and all below it, parents first."""
    nodes: list[SimulatedNode] = []
    stack = [root]
    while stack:
        node = stack.pop()
        nodes.append(node)
        stack += reversed(node.children)
    return nodes


class Program(Protocol):
    """The program that has registered the custom leaves."""

    def tick(self, node: SimulatedNode) -> int:
        """Tick a leaf of the program; its result."""

    def halt(self, node: SimulatedNode) -> None:
        """Halt a leaf that runs."""

    def next_change(self, now: int) -> int:
        """When a leaf ends or the world changes, in milliseconds, later than `now`; negative: never."""

    def memory(self) -> object:
        """All of the program that changes, as a value."""


class Machine:
    """A tree that can be ticked.

    Attributes:
        nodes: all of them, parents first.
        timed: those that may have a timer.
        watching: those that may wait for a time to pass, without a timer.
        now: the time, in milliseconds since the start of the program.
        changes: called with each change of a status, and the status before.
        world: what nodes read beside entries and the time.
        is_woken: a node has asked to be ticked again at once.
        waker: the last decorator that has; else the last node that has, or the root.
        recall: what ticks a node instead, where what it may do is remembered.
        passed: says instead whether the time has passed for which a node waits, where times are not kept in nodes.
        skipped: the numbers of the nodes that were skipped at some time.
    """

    def __init__(
        self,
        root: SimulatedNode,
        dialect: Dialect,
        program: Program,
        changes: Callable[[SimulatedNode, int, int], None],
        world: World,
    ) -> None:
        self.root: Final = root
        self.nodes: Final = _in_document_order(root)
        self.timed: Final = [node for node in self.nodes if node.rules.is_timed]
        self.watching: Final = [node for node in self.nodes if node.rules.watches_time]
        self.now = 0
        self.dialect: Final = dialect
        self.program: Final = program
        self.changes: Final = changes
        self.world: Final = world
        self.is_woken = False
        self.waker = root
        self.recall: Callable[[SimulatedNode], int] | None = None
        self.passed: Callable[[SimulatedNode], bool] | None = None
        self.skipped: Final[set[int]] = set()
        self._counts_writes: Final = any(node.rules.counts_writes for node in self.nodes)

    def wake(self, node: SimulatedNode) -> None:
        """Ask for another tick at once; a node that goes on without an end is a decorator, or has one above it."""
        self.is_woken = True
        if node.rules.is_decorator or not self.waker.rules.is_decorator:
            self.waker = node

    def state(self) -> tuple[object, ...]:
        """Everything on which the next tick depends but the time, as a value."""
        boards = {id(node.board): node.board for node in self.nodes}
        counts = self._counts_writes
        return (
            self.is_woken,
            tuple([node.memory() for node in self.nodes]),
            tuple([board.memory(counts) for board in (self.root.board.root, *boards.values())]),
            self.world.memory(),
            self.program.memory(),
        )


Flow: TypeAlias = Callable[[Machine, SimulatedNode], int]
Halt: TypeAlias = Callable[[Machine, SimulatedNode], None]
