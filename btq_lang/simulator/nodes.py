"""A node of a simulated tree: what it is, its status, and what it remembers between ticks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.simulator.blackboard import Board
from btq_lang.syntax.script.tree import Script

if TYPE_CHECKING:
    from btq_lang.simulator.blackboard import Value

IDLE: Final = 0
RUNNING: Final = 1
SUCCESS: Final = 2
FAILURE: Final = 3
SKIPPED: Final = 4  # a result, never a status
STATUS_NAMES: Final = ("IDLE", "RUNNING", "SUCCESS", "FAILURE", "SKIPPED")


class SimulatedNode:
    """A node.

    Attributes:
        uid: its number, in document order from 1.
        id: the name under which the program registers it.
        path: its full path, as messages of the engine have it.
        ports: as written, or by default.
        board: the blackboard that it sees.
        conditions: `_failureIf`, `_successIf`, `_skipIf`, `_while`, as far as they are written.
        scripts: `_onSuccess`, `_onFailure`, `_post`, `_onHalted`, likewise, and `code` or `if`.
        index: of the current child; of a Switch, -1 if none runs.
        count: how often a child has ended, failed or been tried.
        skipped: how many children have been skipped since it began.
        is_on: that it runs its child, is in its catch, or has ended for ever: what its function calls so.
        completed: the children that have ended.
        seen: the number of writes that it knows of an entry.
        result: that of its only run.
        queue: what is left to loop over; None before the first start.
    """

    __slots__ = (
        "board",
        "children",
        "completed",
        "conditions",
        "count",
        "id",
        "index",
        "is_on",
        "name",
        "path",
        "ports",
        "queue",
        "result",
        "scripts",
        "seen",
        "skipped",
        "status",
        "uid",
    )

    def __init__(self, uid: int, id_: str, name: str, path: str, ports: dict[str, str], board: Board) -> None:
        self.uid: Final = uid
        self.id: Final = id_
        self.name: Final = name
        self.path: Final = path
        self.ports: Final = ports
        self.board: Final = board
        self.conditions: Final[list[tuple[str, Script]]] = []
        self.scripts: Final[dict[str, Script]] = {}
        self.children: Final[list[SimulatedNode]] = []
        self.status = IDLE
        self.index = -1 if id_.startswith("Switch") else 0
        self.count = 0
        self.skipped = 0
        self.is_on = False
        self.completed: frozenset[int] = frozenset()
        self.seen = 0
        self.result = IDLE
        self.queue: tuple[Value, ...] | None = None

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
            self.queue,
        )


def in_document_order(root: SimulatedNode) -> Sequence[SimulatedNode]:
    """A node and all below it, parents first."""
    nodes: list[SimulatedNode] = []
    stack = [root]
    while stack:
        node = stack.pop()
        nodes.append(node)
        stack += reversed(node.children)
    return nodes
