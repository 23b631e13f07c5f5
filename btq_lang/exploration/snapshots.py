"""What a tick depends on and changes, as values: the memory of a node and all below it, and what all nodes share.

One invariant: equal snapshots go on alike.  So values of entries are numbered in the order of their entries, and what
cannot matter again is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter
from typing import Any, Final, TypeAlias

from btq_lang.exploration.choices import Choices
from btq_lang.exploration.values import Domain, FreeValue, Origin, domain_of
from btq_lang.simulator.blackboard import Board, BoardEntry, Value
from btq_lang.simulator.leaves import tick_unset_blackboard
from btq_lang.simulator.nodes import Machine, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.util.record import replace

Memories: TypeAlias = tuple[tuple[Any, ...], ...]  # of a node and all below it
Shared: TypeAlias = tuple[Any, ...]


class Snapshots:
    """The parts of a machine that change, all of which can be kept and put back.

    Attributes:
        choices: those of the run that is going on.
        domains: what is known of the values that leaves have written.
        watched: what a question remembers of what has happened.
        has_assumed: a value that was calculated from unknown ones was taken to be something.
        tracked: nodes whose statuses a question asks for wherever a tick is.
    """

    def __init__(self, machine: Machine) -> None:
        self.machine: Final = machine
        self.choices = Choices()
        self.domains: dict[int, Domain] = {}
        self.watched: Any = None
        self.has_assumed = False
        self.tracked: Sequence[SimulatedNode] = ()
        self._positions: Final = {node.uid: position for position, node in enumerate(machine.nodes)}
        self._sizes: Final = _sizes(machine.root)
        boards = {id(node.board): node.board for node in machine.nodes}
        root = machine.root.board.root
        self._boards: Final[Sequence[Board]] = [root, *[board for board in boards.values() if board is not root]]
        self._counting: Final = [node for node in machine.nodes if node.rules.counts_writes]
        unsets = any(node.rules.flow is tick_unset_blackboard for node in machine.nodes) and bool(self._counting)
        homes = [node.board.home(updated_key(node)) for node in self._counting]
        # The entries whose writes count; None: all, for one that is removed and made again counts from 1.
        self._counted: Final = None if unsets else frozenset([(id(board), name) for board, name in homes])
        self._domain_numbers: Final[dict[Domain, int]] = {}  # numbers are compared faster
        self._all_domains: list[Domain] = []
        self._interned: Final[dict[tuple[Any, ...], tuple[Any, ...]]] = {}  # most states share nearly all memories
        self._last = 0  # the number of the newest value

    def choose(self, count: int) -> int:
        """A number below `count`."""
        return self.choices.choose(count)

    def new_value(self, type_: str) -> FreeValue:
        """A value of which nothing is known but its type."""
        self._last += 1
        self.domains[self._last] = domain_of(type_)
        return FreeValue(self._last, self)

    def derived(self, origin: Origin) -> FreeValue:
        """The value that an operator makes of two."""
        for number, domain in self.domains.items():
            if domain.origin == origin:
                return FreeValue(number, self)
        self._last += 1
        self.domains[self._last] = Domain(is_derived=True, origin=origin)
        return FreeValue(self._last, self)

    def assume(self) -> None:
        """A derived value was taken to be something."""
        self.has_assumed = True

    # ---- nodes ----

    def memories(self, node: SimulatedNode) -> Memories:
        """Those of a node and all below it."""
        shared = self._interned.setdefault
        return tuple([shared(memory, memory) for memory in map(_memory, self._below(node))])

    def put_back(self, node: SimulatedNode, memories: Memories) -> None:
        """Give a node and all below it the memories that they had."""
        for each, memory in zip(self._below(node), memories, strict=True):
            (
                each.status,
                each.index,
                each.count,
                each.skipped,
                each.is_on,
                each.completed,
                each.seen,
                each.result,
                each.due,
                each.has_fired,
                each.queue,
                each.kept,
            ) = memory

    def _below(self, node: SimulatedNode) -> Sequence[SimulatedNode]:
        start = self._positions[node.uid]
        return self.machine.nodes[start : start + self._sizes[node.uid]]

    # ---- what they share ----

    def shared(self) -> Shared:
        """Entries, what is known of their values, and what is watched."""
        numbers: dict[int, int] = {}
        domains: list[Domain] = []
        boards: list[object] = []
        for board in self._boards:
            rows: list[object] = []
            for key in sorted(board.entries):
                entry = board.entries[key]
                value, kind = entry.value, _PLAIN
                if isinstance(value, FreeValue):
                    value, kind = self._known(value, entry, numbers, domains)
                elif isinstance(value, float):
                    kind = _REAL
                count = entry.number if self._counted is None or (id(board), key) in self._counted else 0
                rows.append((key, entry.type, kind, value, count))
            board_rows = tuple(rows)
            boards.append(self._interned.setdefault(board_rows, board_rows))
        if any(domain.is_derived for domain in self.domains.values()):
            self._add_derived(numbers, domains)
        domain_numbers = tuple(
            [self._domain_numbers.setdefault(domain, len(self._domain_numbers)) for domain in domains]
        )
        return self.watched, tuple([node.status for node in self.tracked]), tuple(boards), domain_numbers

    def _add_derived(self, numbers: dict[int, int], domains: list[Domain]) -> None:
        """Add what is known of values derived from others that last, and name these by their new numbers."""
        for number, domain in sorted(self.domains.items()):
            if domain.is_derived:
                operands = [part[0] for part in domain.origin if isinstance(part, tuple)]
                lasts = bool(operands) and all(operand in numbers for operand in operands)
                origin: Origin = ()
                if lasts:
                    origin = tuple([(numbers[part[0]],) if isinstance(part, tuple) else part for part in domain.origin])
                renamed = replace(domain, origin=origin)
                if number in numbers:
                    domains[numbers[number] - 1] = renamed
                elif lasts and renamed != Domain(is_derived=True, origin=origin):
                    domains.append(renamed)
                    numbers[number] = len(domains)

    @property
    def counts_writes(self) -> bool:
        """Whether writes can be counted again from the first."""
        return bool(self._counting) and self._counted is not None

    def count_anew(self) -> None:
        """Count the writes of entries again from the first: it only matters whether a node has seen the last one."""
        written: list[BoardEntry] = []
        for node in self._counting:
            entry = node.board.entry(updated_key(node))
            if entry is not None and entry.number:
                written.append(entry)
                node.seen = _SEEN if node.seen == entry.number else _UNSEEN
        for entry in written:
            entry.number = _SEEN

    def _known(
        self, value: FreeValue, entry: BoardEntry, numbers: dict[int, int], domains: list[Domain]
    ) -> tuple[Value, int]:
        """A value as what it is, or else as its new number; and its kind."""
        domain = self.domains[value.number]
        if domain.fixed is None:
            if value.number not in numbers:
                domains.append(domain)
                numbers[value.number] = len(domains)
            return numbers[value.number], _FREE
        is_real = entry.type in ("double", "float") and not isinstance(domain.fixed, str)
        fixed = float(domain.fixed) if is_real else domain.fixed
        return fixed, _REAL if isinstance(fixed, float) else _PLAIN

    def put_back_shared(self, shared: Shared) -> None:
        """Put entries back, what was known of their values, and what was watched."""
        self.watched, _, boards, domains = shared
        for board, rows in zip(self._boards, boards, strict=True):
            entries = board.entries
            entries.clear()
            for key, type_, kind, value, number in rows:
                entries[key] = BoardEntry(type_, FreeValue(value, self) if kind == _FREE else value, number)
        if len(self._all_domains) < len(self._domain_numbers):
            self._all_domains = list(self._domain_numbers)
        self.domains = {number: self._all_domains[domain] for number, domain in enumerate(domains, start=1)}
        self._last = len(domains)


def updated_key(node: SimulatedNode) -> str:
    """The entry whose writes a node counts."""
    written = node.ports.get("entry", "")
    return key_of(written, "entry") or written


def _sizes(root: SimulatedNode) -> dict[int, int]:
    """How many nodes are below each, and itself, by number."""
    sizes: dict[int, int] = {}
    order = [root]
    for node in order:
        order += node.children
    for node in reversed(order):
        sizes[node.uid] = 1 + sum(sizes[child.uid] for child in node.children)
    return sizes


# As `SimulatedNode.memory`, which takes three times as long.
_memory: Final = attrgetter(
    *(
        "status",
        "index",
        "count",
        "skipped",
        "is_on",
        "completed",
        "seen",
        "result",
        "due",
        "has_fired",
        "queue",
        "kept",
    )
)
_PLAIN: Final = 0  # kinds of values
_REAL: Final = 1  # 1.0 is another value than 1
_FREE: Final = 2
_UNSEEN: Final = 1
_SEEN: Final = 2
