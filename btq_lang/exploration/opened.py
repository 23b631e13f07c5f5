"""A tree whose leaves are free, ready to be explored.

One invariant: an entry that nothing in the tree writes, or that bt_navigator or C++ sets, is one that the program sets
before: it has a value, which is unknown.  All others begin without one.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Final, Protocol, TypeAlias

from btq_lang.btcpp.document import Document
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.exploration.choices import Choices
from btq_lang.exploration.leaves import FreeLeaves, FreeWorld, LeafKind
from btq_lang.exploration.snapshots import Memories, Shared, Snapshots
from btq_lang.simulator.errors import EngineError
from btq_lang.simulator.leaves import tick_custom
from btq_lang.simulator.loading import load
from btq_lang.simulator.nav2 import UPDATED
from btq_lang.simulator.nav2_answered import set_answered
from btq_lang.simulator.nodes import Machine, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.simulator.programs import KnownProgram
from btq_lang.syntax.script.tree import variables

_Home: TypeAlias = tuple[int, str]  # a blackboard and a name there


class Watch(Protocol):
    """Who watches what happens; it may raise `Happened`."""

    def begin(self) -> object:
        """What is remembered before the first tick."""

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        """A node has another status."""

    def unset_read(self, node: SimulatedNode, key: str) -> None:
        """A leaf begins that reads an entry without a value."""


class Opened:
    """A tree.

    Attributes:
        driver: how the program ticks it.
        start: the memories of all nodes, and what they share, before the first tick.
        watch: to be set before the first tick.
    """

    def __init__(
        self,
        documents: list[Document],
        main: str,
        program: KnownProgram,
        kinds: Mapping[str, LeafKind],
        asked: Collection[str] = (),
    ) -> None:
        """Load the tree `main`.

        Args:
            program: that runs it; the entries that it sets have a value, also if the tree writes them.
            kinds: of its leaves, by name.
            asked: the entries of the root blackboard that a question reads.

        Raises:
            EngineError: the engine refuses the tree.
            NotModelled: the tree has something whose effect is not known.
        """
        self.watch: Watch | None = None
        self.leaves: Final = FreeLeaves(kinds)
        world = FreeWorld()
        actions = [name for name, kind in kinds.items() if kind.is_action]
        self.driver: Final = program.driver
        arguments = documents, main, program.dialect, self.leaves, self._changed, None, actions, world
        self.machine: Final[Machine] = load(*arguments)
        for node in self.machine.nodes:
            _refuse(node)
        self.snapshots: Final = Snapshots(self.machine)
        self.leaves.snapshots = world.snapshots = self.snapshots
        self.leaves.unset_read = self._unset_read
        self.custom: Final = [node for node in self.machine.nodes if node.rules.flow is tick_custom]
        self._set_entries(asked, program.preset)
        for node in self.machine.nodes:
            set_answered(node, self.leaves)
        self.start: Final[tuple[Memories, Shared]] = (
            self.snapshots.memories(self.machine.root),
            self.snapshots.shared(),
        )

    def begin(self, watch: Watch | None, may_run: Collection[int]) -> None:
        """Go back to the start; `may_run`: the numbers of the leaves that may run on."""
        memories, shared = self.start
        self.snapshots.choices = Choices()
        self.snapshots.put_back(self.machine.root, memories)
        self.snapshots.put_back_shared(shared)
        self.leaves.may_run = may_run
        self.watch = watch
        self.snapshots.watched = watch.begin() if watch is not None else None
        self.machine.recall = None

    def read_by(self, nodes: Iterable[SimulatedNode]) -> frozenset[str]:
        """The entries of the root blackboard whose values matter to some nodes."""
        root = id(self.machine.root.board.root)
        return frozenset([name for node in nodes for board, name in self._read(node) if board == root])

    def _changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if self.watch is not None:
            self.watch.changed(node, before, after)

    def _unset_read(self, node: SimulatedNode, key: str) -> None:
        if self.watch is not None:
            self.watch.unset_read(node, key)

    # ---- entries ----

    def _set_entries(self, asked: Collection[str], preset: Collection[str]) -> None:
        """Give a value to the entries that only the program writes, and find out whose values matter."""
        root = self.machine.root.board.root
        read = {home for node in self.machine.nodes for home in self._read(node)}
        read |= {(id(root), name) for name in asked}
        written = {home for node in self.machine.nodes for home in self._written(node)}
        before = {(id(root), name) for name in preset}
        for board, name in sorted((read - written) | (before & (read | written)), key=lambda home: home[1]):
            if board == id(root):
                entry = root.create(name)
                if entry.value is None:
                    entry.value = self.snapshots.new_value(entry.type)
                    entry.number = 1
        self.leaves.relevant = frozenset(read)

    def _read(self, node: SimulatedNode) -> Iterator[_Home]:
        """The entries whose values matter to a node."""
        for script in (*[script for _, script in node.conditions], *node.scripts.values()):
            for variable in variables(script):
                yield _home(node, variable.name)
        is_custom = node.rules.flow is tick_custom
        for port in self.leaves.kind(node).reads if is_custom else node.ports:
            key = key_of(node.ports.get(port, ""), port)
            if key is not None and not (node.id == "SubTree" or port in _WRITTEN):
                yield _home(node, key)
            elif port == "entry":
                yield _home(node, node.ports[port])

    def _written(self, node: SimulatedNode) -> Iterator[_Home]:
        """The entries that a node may write."""
        for script in (*[script for _, script in node.conditions], *node.scripts.values()):
            for variable in variables(script):
                if variable.writes:
                    yield _home(node, variable.name)
        if node.rules.flow is tick_custom:
            kind = self.leaves.kind(node)
            ports: Sequence[str] = [port for port, _ in kind.writes] if kind.is_declared else list(node.ports)
        else:
            ports = _WRITTEN
        for port in ports:
            written = node.ports.get(port)
            if written is not None:
                key = key_of(written, port)
                if key is not None or port == "output_key":
                    yield _home(node, written if key is None else key)


def _refuse(node: SimulatedNode) -> None:
    """Refuse what the engine refuses when it creates a node, or throws as soon as it ticks one.

    Raises:
        EngineError: it does.
    """
    if node.rules.is_decorator and len(node.children) != 1:
        raise EngineError(f"{node.path} must have exactly 1 child")
    for script in (*[script for _, script in node.conditions], *node.scripts.values()):
        if not script.complete:
            raise EngineError(f"the script [{script.text}] of {node.path} cannot be read")
    kind = BUILTINS.get(node.id) if node.rules.flow is not tick_custom else None
    for port in kind.ports if kind is not None else ():
        if port.required and port.name not in node.ports and port.direction != "output":
            raise EngineError(f"{node.path} lacks the port [{port.name}]")


def _home(node: SimulatedNode, key: str) -> _Home:
    board, name = node.board.home(key)
    return id(board), name


_WRITTEN: Final = ("output_key", "current_child_idx", "value", *UPDATED)  # of nodes of the engine and of Nav2
