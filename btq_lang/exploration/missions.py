"""A mission of a workspace as a tree that can be explored: what runs is what is built.

One invariant: the nodes of the tree have the numbers of the engine, and those that are written know their place.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Final

from btq_lang.btcpp.document import Document
from btq_lang.btcpp.reader import read
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2.creation import SERVERS
from btq_lang.checks import cpp_lookups, lookups
from btq_lang.checks.calls import callers, is_main
from btq_lang.checks.kinds import newer_engine_node
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Place
from btq_lang.diagnostics.rules import Severity
from btq_lang.evidence.identity import Build, Candidate
from btq_lang.exploration.leaves import LeafKind
from btq_lang.exploration.opened import Opened
from btq_lang.exploration.watching import Unasked
from btq_lang.exploration.witness import Tick
from btq_lang.requirements.model import MissionRun, NodeTarget
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nav2_models import ports_in
from btq_lang.simulator.nodes import SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.simulator.programs import program_of
from btq_lang.syntax.tree import Path
from btq_lang.util.record import replace
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.workspace.loader import shown
from btq_lang.workspace.port_types import as_kind
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


class NotExplored(Exception):
    """A mission cannot be explored; the message says why."""


class ExploredMission:
    """A mission and its tree.

    Attributes:
        tree: the name of the tree that runs.
        program: that runs it.
        dialect: the engine.
        kinds: what is known of its leaves, by name.
    """

    def __init__(self, workspace: Workspace, path: str, tree: str = "") -> None:
        """Build a mission; `tree`: the one that the program creates; empty: the main tree.

        Raises:
            NotExplored: it cannot be built, or has no such tree.
        """
        self.workspace: Final = workspace
        self.path: Final = path
        file = workspace.files[path]
        mission = Candidate(workspace, path, path, None)
        name = tree or (main.symbol.name if (main := workspace.main_tree(path)) is not None else "")
        build = next(mission.builds(name), None) if name else None
        if build is None:
            raise NotExplored(f"has no tree `{tree}`" if tree else "has no main tree; choose one with --tree")
        self.tree: Final = build.name
        self.build: Final[Build] = build
        self.nodes: Final = mission.requirements.nodes
        self.applied: Final = mission.requirements.applied
        self.program: Final = program_of(workspace, path, [node for _, node in build.running.all if node is not None])
        self.dialect: Final = self.program.dialect
        if file.is_xml:
            self._refuse_newer_nodes()
            self._documents: Sequence[Document] = self._plain()
        else:
            self._documents = build.running.documents
        self._written: Final[Mapping[int, ResolvedNode]] = {
            instance.uid: node for instance, node in build.running.all if instance.uid is not None and node is not None
        }
        self.kinds: Final = self._kinds()
        self._guarded: frozenset[str] | None = None  # entries that only nodes read that enforce requirements

    def open(self, asked: Collection[str] = ()) -> Opened:
        """The tree, ready to be explored; `asked`: the entries that a question reads.

        Raises:
            NotExplored: the engine refuses it, or it has something whose effect is not known.
        """
        set_in_cpp = self.workspace.store.ask(cpp_lookups.set_in_cpp, self.path).names
        program = replace(self.program, preset=(*self.program.preset, *set_in_cpp))
        try:
            return Opened(list(self._documents), self.tree, program, self.kinds, asked)
        except EngineError as error:
            raise NotExplored(f"the engine refuses the tree: {error}") from None
        except NotModelled as error:
            raise NotExplored(f"what the tree does is not known: {error}") from None

    def uids(self, path: Path | None) -> frozenset[int]:
        """The numbers of the nodes that a path names; None: the root.

        Raises:
            Unasked: it names none.
        """
        if path is None:
            return frozenset({1})
        names = tuple([name.text for name in path.names])
        uids = frozenset[int]().union(*map(self.uids_of, self.nodes.find(names)))
        if not uids:
            shown = "/".join(names)
            likely = near(names[-1], sorted({name for node in self.nodes.all for name in node.names}))
            raise Unasked(f"no node of the tree {self.tree} is called `{shown}`{did_you_mean(likely)}")
        return uids

    def uids_of(self, target: NodeTarget | MissionRun) -> frozenset[int]:
        """The numbers of the instances of a node; of the mission, that of the root."""
        if isinstance(target, MissionRun):
            return frozenset({1})
        return frozenset([each.uid for each in self.build.running.instances(target) if each.uid is not None])

    def written(self, uid: int) -> ResolvedNode | None:
        """A node as it is written; None: it only enforces a requirement."""
        return self._written.get(uid)

    def without_part(self, ticks: Sequence[Tick]) -> frozenset[str]:
        """The entries that have no part in a run: those that only guards of requirements read, if none refuses."""
        if all(node is not None for _, node in self.build.running.all):
            return frozenset()
        if any(self.written(uid) is None for tick in ticks for uid in tick.refusals):
            return frozenset()
        if self._guarded is None:
            opened = self.open()
            nodes = opened.machine.nodes
            read = opened.read_by([node for node in nodes if self.written(node.uid) is not None])
            self._guarded = opened.read_by(nodes) - read
        return self._guarded

    def place(self, uid: int) -> tuple[str, int] | None:
        """The file and the line of a node, from 1; None: it is not written."""
        node = self._written.get(uid)
        if node is None:
            return None
        return self._line(node.path, node.place)

    def call(self) -> tuple[str, int] | None:
        """The file and the line, from 1, of the first SubTree that calls the tree; None: the program runs it, or
        nothing is seen to."""
        store = self.workspace.store
        if store.ask(is_main, self.path, self.tree) or not store.ask(callers, self.path, self.tree):
            return None
        uses = store.ask(lookups.uses_of_tree, self.path, self.tree)
        return next((self._line(use.path, use) for use in uses if use.path is not None), None)

    def _line(self, path: str, place: Place) -> tuple[str, int]:
        """A file, and the line of a place in it."""
        file = self.workspace.files[path]
        span = file.on_disk(file.span_of(place))
        return path, file.source_lines.position(span.start).line + 1

    def server(self, node: SimulatedNode) -> str:
        """The action server that a leaf calls; empty if none is known."""
        own = node.ports.get("server_name", "")
        name = SERVERS.get(node.id, "") if self.dialect.nav2 else ""
        return (own.lstrip("/") or name) if name and key_of(own, "server_name") is None else ""

    def _refuse_newer_nodes(self) -> None:
        """Refuse nodes that the engine does not have yet; no build has looked for them in XML.

        Raises:
            NotExplored: there is one.
        """
        store = self.workspace.store
        for path in self.workspace.registered_with(self.path):
            file = self.workspace.files[path]
            for tree in store.ask(lookups.trees, path) if file.is_xml else ():
                for problem in newer_engine_node(View(store, path, tree)):
                    if problem.effective_severity is Severity.ERROR:
                        span = file.on_disk(problem.span.shifted(file.start_of(tree.item)))
                        line = file.source_lines.position(span.start).line + 1
                        raise NotExplored(f"the engine refuses the tree: {shown(path)}:{line}: {problem.message}")

    def _plain(self) -> Sequence[Document]:
        """The XML files as they are."""
        documents = [
            read(self.workspace.files[path].source).document for path in self.workspace.registered_with(self.path)
        ]
        return [document for document in documents if document is not None]

    def _kinds(self) -> Mapping[str, LeafKind]:
        """What is known of the leaves of the program."""
        store = self.workspace.store
        kinds: dict[str, LeafKind] = {}
        for _, node in self.build.running.all:
            if node is None or node.children or node.kind is not None or node.id is None or node.is_subtree:
                continue
            name = node.id.text
            declared = {
                port.name: port
                for ports in store.ask(lookups.ports_of_models, self.path, Kind.MODEL, name)
                for port in map(as_kind, ports)
            }
            if self.program.is_nav2_assumed and not declared:
                declared = {port.name: port for port in ports_in(self.dialect.nav2).get(name, ())}
            kinds[name] = LeafKind(
                is_condition=node.category == "Condition",
                is_action=node.category == "Action" and (is_stated(node) or bool(declared)),
                reads=tuple([port.name for port in declared.values() if port.direction != "output"]),
                writes=tuple([(port.name, port.type) for port in declared.values() if port.direction != "input"]),
                is_declared=node.of_model is not None or bool(declared),
            )
        return kinds


def is_stated(node: ResolvedNode) -> bool:
    """Whether a model or the file itself states the category of a node."""
    return node.of_model is not None or node.node.category is not None


def explorable(workspace: Workspace, paths: Sequence[str]) -> Iterator[str]:
    """The files among some that have a main tree."""
    return (path for path in paths if workspace.main_tree(path) is not None)
