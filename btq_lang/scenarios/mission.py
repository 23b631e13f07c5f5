"""A tree as its program runs it: all that is registered with it, as `btq build` writes it, ready for many runs."""

from __future__ import annotations

import posixpath
import re
from functools import cached_property
from itertools import islice
from typing import Final

from btq_lang.btcpp.document import Document
from btq_lang.btcpp.opening import with_source
from btq_lang.btcpp.reader import read
from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks.lookups import ports_of_models
from btq_lang.evidence.identity import Build, Candidate, Joined
from btq_lang.evidence.model import LoggedTree
from btq_lang.requirements import nodes
from btq_lang.requirements.model import NodeTarget
from btq_lang.requirements.resolve import Requirements
from btq_lang.simulator.programs import program_of
from btq_lang.syntax.tree import Model, Root, Tree
from btq_lang.util.record import replace
from btq_lang.util.text import Span
from btq_lang.workspace.factories import Factory
from btq_lang.workspace.port_types import as_kind
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


class NotRunnable(Exception):
    """The tree cannot be run; the message says why."""


class ScenarioMission:
    """A tree that scenarios run.

    Attributes:
        workspace: of the program that registers the file with the scenarios and all that it includes, and creates this
            tree; see `as_program`.
        path: of that file.
        name: of the tree.
        requirements: those that the file sees.
        documents: the XML that the engine loads.
        build: its nodes, and which written nodes they are.
        tree: as a log of a run would hold it.
        program: that runs it.
        dialect: the version of the engine.
    """

    def __init__(self, workspace: Workspace, path: str, tree: str, is_enforced: bool = True) -> None:
        """Build the tree; `is_enforced`: with the guards that enforce requirements.

        Raises:
            NotRunnable: it cannot be built.
        """
        self.workspace: Final = workspace
        self.path: Final = path
        self.name: Final = tree
        self._candidate: Final = Candidate(self.workspace, path, tree, None)
        self.requirements: Final[Requirements] = self._candidate.requirements
        build = next(islice(self._candidate.builds(tree), 0 if is_enforced else 1, None), None)
        if build is None:
            raise NotRunnable(f"the tree `{tree}` cannot be built; run btq check")
        self.build: Final[Build] = replace(build, is_main=True)
        self.tree: Final[LoggedTree] = self.build.tree(shows_begins=True)
        nodes = (node for _, node in self.build.running.all if node is not None)
        self.program: Final = program_of(workspace, path, nodes)
        self.dialect: Final = self.program.dialect

    @cached_property
    def documents(self) -> list[Document]:
        """Files that are XML as they are, others as a build writes them."""
        files = [self.workspace.files[path] for path in self.workspace.registered_with(self.path)]
        return [
            (read(file.source).document if file.is_xml else None) or built
            for file, built in zip(files, self.build.documents, strict=True)
        ]

    @cached_property
    def written(self) -> dict[int, ResolvedNode]:
        """The written node of each node that runs, by its number."""
        nodes = ((instance.uid, node) for instance, node in self.build.running.all)
        return {uid: node for uid, node in nodes if uid is not None and node is not None}

    @cached_property
    def conditions(self) -> frozenset[str]:
        """The names under which the program registers conditions."""
        nodes = self.requirements.nodes.all
        return frozenset(_id(node) for node in nodes if node.kind is None and node.category == "Condition")

    @cached_property
    def actions(self) -> frozenset[str]:
        """The names under which it registers other nodes."""
        nodes = self.requirements.nodes.all
        return frozenset(_id(node) for node in nodes if node.kind is None) - self.conditions

    @cached_property
    def outputs(self) -> dict[str, tuple[str, ...]]:
        """The ports through which nodes of the program write, by the name under which it registers them, of those of
        which a model or C++ declares the ports.
        """
        outputs: dict[str, tuple[str, ...]] = {}
        for name in (*self.actions, *self.conditions):
            models = self.workspace.store.ask(ports_of_models, self.path, Kind.MODEL, name)
            ports = [port for model in models for port in map(as_kind, model) if port.direction != "input"]
            if models:
                outputs[name] = tuple(dict.fromkeys(port.name for port in ports))
        return outputs

    @cached_property
    def joined(self) -> Joined:
        """Its nodes, joined with themselves."""
        return self.judged_with(self.requirements)[1]

    def judged_with(self, requirements: Requirements) -> tuple[Candidate, Joined]:
        """The mission with other requirements, and its nodes joined with those that run."""
        candidate = Candidate(self.workspace, self.path, self.name, None, requirements)
        uids = {uid: uid for uid in self.tree.nodes}
        return candidate, Joined(candidate, self.tree, self.build.how, uids, len(uids), self.build)

    def uids(self, target: NodeTarget) -> list[int]:
        """The numbers of the nodes that run that a path leads to."""
        return [each.uid for each in self.build.running.instances(target) if each.uid is not None]

    def has_port(self, uid: int, name: str) -> bool:
        """Whether a node has a port, by its model or because it is written."""
        node = self.written.get(uid)
        definition = self.workspace.find(node.path, Kind.MODEL, _id(node)) if node is not None else None
        ports = definition.symbol.target.ports if definition and isinstance(definition.symbol.target, Model) else ()
        declared = (port.id.text for port in ports if port.id is not None)
        return node is not None and name in (*declared, *(pair.key.text for pair in node.node.attributes))

    def input_port(self, uid: int) -> str | None:
        """The one input port of a node by its model, or the one that is written; None: there are none, or several."""
        node = self.written.get(uid)
        if node is None:
            return None
        definition = self.workspace.find(node.path, Kind.MODEL, _id(node))
        if definition is not None and isinstance(definition.symbol.target, Model):
            ports = [
                port.id.text for port in definition.symbol.target.ports if port.direction.raw != "output" and port.id
            ]
        else:
            ports = [pair.key.text for pair in node.node.attributes if not pair.key.text.startswith("_")]
        ports = [port for port in ports if port not in ("ID", "name")]
        return ports[0] if len(ports) == 1 else None

    def guarded(self, uid: int) -> int:
        """The number of a written node itself; of a guard or a node below one, that of the first written node there."""
        below = (other for other in self.tree.nodes if other in self.written and uid in self.tree.above(other))
        return uid if uid in self.written else next(below, uid)

    def place(self, uid: int) -> tuple[str, int]:
        """The file and the line of a node, on the disk; the file is empty if the node is in none."""
        node = self.written.get(uid)
        if node is None:
            return "", 0
        return line_of(self.workspace, node.path, node.item, node.node.head.start)


def line_of(workspace: Workspace, path: str, item: object, offset: int) -> tuple[str, int]:
    """The file and the line on the disk of an offset in an item."""
    return position_of(workspace, path, item, offset)[:2]


def position_of(workspace: Workspace, path: str, item: object, offset: int) -> tuple[str, int, int]:
    """The file, the line and the column on the disk of an offset in an item; both from 1."""
    file = workspace.files[path]
    start = next((entry.start for entry in file.parsed.entries if entry.item is item), 0)
    at = file.on_disk(Span(start + offset, start + offset)).start
    line = file.source.count("\n", 0, at) + 1
    return workspace.project.shown(path), line, at - file.source.rfind("\n", 0, at)


def main_tree(workspace: Workspace, path: str) -> str:
    """The tree that scenarios without `of` run: the main tree of their file, or the only one of all that it includes
    which no other tree there runs, or which a `Root` names; empty if it is unknown which.
    """
    if workspace.factory is not None and workspace.factory.main:
        return workspace.factory.main[0]
    if own := _main_of(workspace, path):
        return own
    mains = {main: each for each in workspace.closure(path) if (main := _main_of(workspace, each))}
    run_by_none = [main for main in mains if len(mains) == 1 or not workspace.store.ask(nodes.callers, path, main)]
    with_root = [main for main in run_by_none if any(workspace.files[mains[main]].of_type(Root))]
    return next((names[0] for names in (run_by_none, with_root) if len(names) == 1), "")


def _main_of(workspace: Workspace, path: str) -> str:
    """The main tree of a file, also if there is no such tree; empty if it has none."""
    main = workspace.main_tree(path)
    if main is not None:
        return main.symbol.name
    for root in workspace.files[path].of_type(Root):
        values = (pair.value for pair in root.attributes if pair.key.text == "main_tree_to_execute")
        if (name := root.name or next(values, None)) is not None:
            return name.text
    return ""


def with_named_tree(workspace: Workspace, path: str) -> Workspace:
    """The workspace in which the only tree that a file sees has a name, if it has none and nothing names it."""
    trees = [(each, tree) for each in workspace.registered_with(path) for tree in workspace.files[each].of_type(Tree)]
    if len(trees) != 1 or trees[0][1].name is not None or main_tree(workspace, path):
        return workspace
    file = workspace.files[trees[0][0]]
    tag, name = (_ELEMENT, f' ID="{_UNNAMED}"') if file.is_xml else (_TREE, f" {_UNNAMED}")
    return with_source(workspace, file.path, tag.sub(lambda match: match[0] + name, file.source, count=1))


def as_program(workspace: Workspace, path: str, tree: str) -> Workspace:
    """The workspace of a program that registers all that a file sees, and creates a tree."""
    paths = workspace.registered_with(path)
    own = workspace.factory or Factory(posixpath.basename(path))
    return workspace.of_factory(replace(own, files=paths, main=(tree,)))


def _id(node: ResolvedNode) -> str:
    return node.id.text if node.id is not None else ""


_UNNAMED: Final = "BehaviorTree"
_ELEMENT: Final = re.compile(r"<BehaviorTree\b")
_TREE: Final = re.compile(r"(?m)^[ \t]*BehaviorTree\b")
