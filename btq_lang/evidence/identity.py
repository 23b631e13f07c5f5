"""Which node of a log is which written node.

One invariant: a node of a log is joined with a written one only if both have the same number and path in one build of
the mission, or the same unique path; what is not joined is not judged.

The tree that ran is the main tree of a mission, or the one whose name the log has.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Final

from btq_lang.btcpp.document import Document
from btq_lang.btcpp.export import is_mission
from btq_lang.btcpp.instances import Instance
from btq_lang.btcpp.marks import MARK
from btq_lang.btcpp.outputs import as_xml
from btq_lang.btcpp.side_file import BuiltFile, RunningTree
from btq_lang.catalog.versions import VERSIONS
from btq_lang.evidence.meanings import fingerprints
from btq_lang.evidence.model import LoggedTree
from btq_lang.evidence.readers.tree import delay_of, kind_of
from btq_lang.requirements.model import NodeTarget
from btq_lang.requirements.resolve import Requirements, requirements
from btq_lang.requirements.verifying import RequirementKey, VerifyingScenario, verifying_scenarios
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record, replace
from btq_lang.workspace.workspace import Workspace


class Candidate:
    """A mission that logs may belong to, and the trees that `btq build` makes of it, built on demand.

    Attributes:
        origin: where the list of its nodes is from, for messages.
        name: its name, for messages.
        side: the nodes that its side file lists, uid and path of each; None where there is none.
    """

    origin = "side file matches"

    def __init__(
        self,
        workspace: Workspace,
        path: str,
        name: str,
        side: list[tuple[int, str]] | None,
        demanded: Requirements | None = None,
    ) -> None:
        """demanded: the requirements to judge; None: all that the mission has."""
        self.workspace: Final = workspace
        self.path: Final = path
        self.name: Final = name
        self.side: Final = side
        self.requirements: Final[Requirements] = demanded or requirements(workspace, path)
        self._built: Final[list[_BuiltMission]] = []
        self._unbuilt: Final = _builds_of(self)
        self._builds: Final[dict[tuple[int, str], Build]] = {}

    def __reduce__(self) -> tuple[object, ...]:
        """How a process that does not share memory with this one makes the mission again."""
        return Candidate, (self.workspace, self.path, self.name, self.side)

    @cached_property
    def indices(self) -> dict[int, int]:
        """The index of each written node among those of the mission, by its `id`."""
        return {id(node): index for index, node in enumerate(self.requirements.nodes.all)}

    def scenarios(self, name: str) -> list[str]:
        """The titles of the scenarios that verify a requirement."""
        place = self.requirements.all[name].place
        return [scenario.title for scenario in self._scenarios.get((place.path or "", name), ())]

    @cached_property
    def _scenarios(self) -> Mapping[RequirementKey, Sequence[VerifyingScenario]]:
        return verifying_scenarios(self.workspace, (self.path,))

    @cached_property
    def fingerprints(self) -> dict[str, str]:
        """As of the function."""
        return fingerprints(self.workspace, self.requirements)

    def builds(self, tree: str = "") -> Iterator[Build]:
        """The builds of the mission that a program may run, the one without options first.

        Args:
            tree: the one that the program creates; empty: the main tree.  None is made where there is no such tree.
        """
        for number, built_mission in enumerate(self._all_built()):
            name = tree or built_mission.main
            if name in built_mission.trees:
                if (number, name) not in self._builds:
                    running = RunningTree(built_mission.built, self.requirements.nodes, name)
                    how = built_mission.how if name == built_mission.main else f"tree {name}, {built_mission.how}"
                    is_main, documents = name == built_mission.main, built_mission.built.documents
                    self._builds[number, name] = Build(how, running, name, is_main, documents)
                yield self._builds[number, name]

    def trees(self) -> Sequence[str]:
        """The names of the trees that a program may create instead of the main tree."""
        first = next(self._all_built(), None)
        return [name for name in first.trees if name != first.main] if first is not None else []

    def _all_built(self) -> Iterator[_BuiltMission]:
        yield from self._built
        for built_mission in self._unbuilt:
            self._built.append(built_mission)
            yield built_mission


class Joined(Record):
    """The nodes of a mission in a log.

    Attributes:
        tree: of the log.
        how: how they were found, in words.
        uids: the uids of the nodes that were found, by their number in the build.
        number: how many of the log's nodes were found.
        lacking: why the others were not.
        has_uids: whether the log has uids, so that a node has a number in it.
        others: the paths of other missions with the same nodes.
    """

    mission: Candidate
    tree: LoggedTree
    how: str
    uids: Mapping[int, int]
    number: int
    build: Build
    lacking: str = "was not found in a log of another version of the mission"
    others: tuple[str, ...] = ()
    has_uids: bool = True

    def unjoined(self) -> frozenset[int]:
        """The uids of the log's nodes that were not found in the mission."""
        return frozenset(self.tree.nodes).difference(self.uids.values())

    def differences(self) -> Iterator[str]:
        """The nodes of the log, then those of the mission, that were not found, each in words."""
        instances = (instance for instance, _ in self.build.running.all if instance.element.get(MARK) is None)
        paths = {_number(instance): instance.path for instance in instances}
        uids = self.unjoined() if self.has_uids else frozenset()
        for uid in sorted(uids):
            written_path = paths.get(uid, "") if uid not in self.uids else ""
            yield unlike(uid, without_number(self.tree.nodes[uid].path), without_number(written_path))
        yield from (self.lost(path) for number, path in paths.items() if number not in self.uids and number not in uids)

    def lost(self, path: str) -> str:
        """Why a node of the mission was not found, given its path."""
        number = next((_number(instance) for instance, _ in self.build.running.all if instance.path == path), 0)
        if self.has_uids and number in self.unjoined():
            logged = without_number(self.tree.nodes[number].path)
            return f"`{path}` {self.lacking}: {unlike(number, logged, without_number(path))}"
        return f"`{path}` {self.lacking}"

    def instances(self, target: NodeTarget) -> list[tuple[str, int | None]]:
        """The paths of the instances of a written node, each with its uid in the log; None if it is not there."""
        uids = [(instance, self.uids.get(_number(instance))) for instance in self.build.running.instances(target)]
        return [(self.tree.nodes[uid].path if uid is not None else instance.path, uid) for instance, uid in uids]

    def written(self) -> dict[int, int]:
        """By uid, the index of the written node of each of the log's nodes among those of the mission."""
        indices = self.mission.indices
        nodes = ((self.uids.get(_number(instance)), node) for instance, node in self.build.running.all)
        return {uid: indices[id(node)] for uid, node in nodes if uid is not None and node is not None}

    def enforcing(self) -> dict[int, str]:
        """The guards among the log's nodes, each with its requirement."""
        instances = (instance for instance, _ in self.build.running.all)
        marks = ((self.uids.get(_number(instance)), instance.element.get(MARK)) for instance in instances)
        return {uid: mark for uid, mark in marks if uid is not None and mark is not None}


class _BuiltMission(Record):
    """A mission as it was built.

    Attributes:
        how: with which options.
        main: the name of the main tree; empty: there is none.
        trees: the names of all trees.
    """

    how: str
    built: BuiltFile
    main: str
    trees: tuple[str, ...]


class Build(Record):
    """A tree of a build as it runs.

    Attributes:
        how: the options of the build, and the tree unless it is the main one.
        documents: of all files that are registered, in their order.
    """

    how: str
    running: RunningTree
    name: str
    is_main: bool
    documents: tuple[Document, ...]

    def tree(self, shows_begins: bool = False) -> LoggedTree:
        """The tree as a log would hold it, as far as its nodes have numbers; `shows_begins`: as in `LoggedTree`."""
        return LoggedTree(
            [
                (instance.uid, kind_of(instance.element), instance.path, instance.parent or 0)
                for instance, _ in self.running.all
                if instance.uid is not None
            ],
            delays={
                instance.uid: delay
                for instance, _ in self.running.all
                if instance.uid is not None and (delay := delay_of(instance.element)) is not None
            },
            shows_begins=shows_begins,
        )


def join(missions: Sequence[Candidate], tree: LoggedTree) -> Joined | None:
    """The mission that a log's tree belongs to, with its nodes joined.

    None: no mission has half of its nodes, or, with those that are alike, two thirds.
    """
    nodes = [(node.uid, node.path) for node in tree.nodes.values()]
    in_order = sorted(missions, key=lambda mission: mission.side != nodes)  # building a mission takes time
    for name in dict.fromkeys(("", tree.name)):
        for mission in in_order:
            for build in mission.builds(name):
                if (same := join_build(mission, build, tree)) is not None:
                    return same if mission.side == nodes else replace(same, others=_others(same, missions))
    best = _nearest(missions, tree)
    if best is None:
        return None
    is_same = best.number * 2 >= len(nodes) or _alike(best.build, tree) * 3 >= len(nodes) * 2
    return best if is_same else None


def unlike(uid: int, logged: str, written: str) -> str:
    """How a node is named in the log and in the mission, in words; `written`: empty if the mission lacks it."""
    in_mission = f"`{written}` in the mission" if written else "not in the mission"
    return f"node {uid} is `{logged}` in the log and {in_mission}"


def _others(joined: Joined, missions: Sequence[Candidate]) -> tuple[str, ...]:
    """The paths of other missions that the log belongs to as well, by the same build of theirs."""
    others = {other.path: other for other in missions if other.path != joined.mission.path}
    build = joined.build
    name = "" if build.is_main else build.name
    builds = {path: next((b for b in other.builds(name) if b.how == build.how), None) for path, other in others.items()}
    return tuple(path for path, build in builds.items() if build and join_build(others[path], build, joined.tree))


def difference(missions: Sequence[Candidate], tree: LoggedTree) -> str:
    """What the mission nearest to a log's tree lacks; empty if no mission can be built."""
    best = _nearest(missions, tree)
    if best is None or not any(node.kind for node in tree.nodes.values()):  # the log has no tree
        return ""
    joined = frozenset(best.uids.values())
    lacking = next((node.path for node in tree.nodes.values() if node.uid not in joined), "")
    return (
        f"{best.mission.name} has {best.number} of the {len(tree.nodes)} nodes in the log; "
        f"the first that it does not have is `{lacking}`"
    )


def _nearest(missions: Sequence[Candidate], tree: LoggedTree) -> Joined | None:
    name = tree.name if any(tree.name in mission.trees() for mission in missions) else ""
    joined = (_by_path(mission, build, tree) for mission in missions for build in mission.builds(name))
    return max(joined, key=lambda match: (match.number, _alike(match.build, tree)), default=None)


def join_build(mission: Candidate, build: Build, tree: LoggedTree) -> Joined | None:
    """All nodes, if the trees of a log and of a build are equal; else None."""
    wanted = [(node.uid, node.kind, node.path) for node in tree.nodes.values()]
    nodes = [(_number(instance), kind_of(instance.element), instance.path) for instance, _ in build.running.all]
    if nodes != wanted:
        return None
    is_side = mission.side == [(uid, path) for uid, _, path in wanted]
    how = mission.origin if is_side else build.how
    return Joined(mission, tree, how, {uid: uid for uid, *_ in wanted}, len(wanted), build)


def _by_path(mission: Candidate, build: Build, tree: LoggedTree) -> Joined:
    """The nodes whose paths are equal and unique on both sides."""
    logged, written = _unique(_logged_paths(tree)), _unique(_built_paths(build))
    uids = {number: logged[key] for key, number in written.items() if key in logged}
    how = "built from another version"
    return Joined(mission, tree, how if build.is_main else f"tree {build.name}, {how}", uids, len(uids), build)


def _alike(build: Build, tree: LoggedTree) -> int:
    """How many nodes have the same paths in both trees, also where several are alike."""
    logged, written = (Counter(path for path, _ in pairs) for pairs in (_logged_paths(tree), _built_paths(build)))
    return (logged & written).total()


def _logged_paths(tree: LoggedTree) -> list[tuple[tuple[str, str], int]]:
    """The kind and the path of each node of a log, and its uid."""
    return [((node.kind, without_number(node.path)), node.uid) for node in tree.nodes.values()]


def _built_paths(build: Build) -> list[tuple[tuple[str, str], int]]:
    """The same of a build, with the numbers there."""
    instances = (instance for instance, _ in build.running.all)
    return [((kind_of(each.element), without_number(each.path)), _number(each)) for each in instances]


def _builds_of(mission: Candidate) -> Iterator[_BuiltMission]:
    """Builds with different options, without those that fail."""
    workspace = mission.workspace
    targets = [workspace.project.target, *(version for version in VERSIONS if version != workspace.project.target)]
    for target in targets:
        project = replace(workspace.project, engines=(target,))
        for is_enforced in (True, False):
            built = _built(mission, workspace.with_project(project), is_enforced)
            if built is not None:
                how = "as built now" if target == targets[0] else f"as built for {target}"
                main = built.documents[-1].root.get("main_tree_to_execute") or ""
                tops = (element for document in built.documents for element in document.root.elements)
                trees = [element.get("ID") or "" for element in tops if element.tag == "BehaviorTree"]
                yield _BuiltMission(how if is_enforced else f"{how} with --no-enforce", built, main, tuple(trees))


def _built(mission: Candidate, workspace: Workspace, is_enforced: bool) -> BuiltFile | None:
    """What `btq build` writes; None if the mission cannot be built."""
    path = mission.path
    exports = [
        as_xml(workspace, registered, enforce=is_enforced and is_mission(workspace, registered)).export
        for registered in workspace.registered_with(path)
    ]
    if any(export.problems for export in exports):
        return None
    elements = {key: element for export in exports for key, element in export.elements.items()}
    return BuiltFile(path, path, "", tuple(export.document for export in exports), elements)


def _number(instance: Instance) -> int:
    """Its number in the build; 0 after a subtree whose tree is unknown."""
    return instance.uid or 0


def without_number(path: str) -> str:
    """A path without the numbers of unnamed nodes, which change when a node before them is added or removed."""
    parts = [(name, *name.rpartition("::")) for name in path.split("/")]
    return "/".join(own if own and number.isdecimal() else name for name, own, _, number in parts)


def _unique(pairs: list[tuple[tuple[str, str], int]]) -> dict[tuple[str, str], int]:
    return {key: numbers[0] for key, numbers in grouped(pairs).items() if len(numbers) == 1}
