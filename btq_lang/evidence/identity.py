"""Which node of a log is which written node.

One invariant: a node of a log is joined with a written one only if both have the same number and path in one build of
the mission, or the same unique path; what is not joined is not judged.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Final

from btq_lang.btcpp.export import is_mission
from btq_lang.btcpp.instances import Instance
from btq_lang.btcpp.marks import MARK
from btq_lang.btcpp.outputs import as_xml
from btq_lang.btcpp.side_file import Built, RunningTree
from btq_lang.catalog.versions import VERSIONS
from btq_lang.evidence.model import LoggedTree
from btq_lang.evidence.readers.tree import kind_of
from btq_lang.requirements.model import Target
from btq_lang.requirements.resolve import Requirements, requirements
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

    def __init__(self, workspace: Workspace, path: str, name: str, side: list[tuple[int, str]] | None) -> None:
        self.workspace: Final = workspace
        self.path: Final = path
        self.name: Final = name
        self.side: Final = side
        self.requirements: Final[Requirements] = requirements(workspace, path)
        self._builds: Final[list[Build]] = []
        self._unmade: Final = _builds(self)

    def __reduce__(self) -> tuple[object, ...]:
        """What makes it again in a process that does not share the memory of this one."""
        return Candidate, (self.workspace, self.path, self.name, self.side)

    @cached_property
    def indices(self) -> dict[int, int]:
        """The index of each written node among those of the mission, by its `id`."""
        return {id(node): index for index, node in enumerate(self.requirements.nodes.all)}

    def builds(self) -> Iterator[Build]:
        """What `btq build` makes of it, without options first."""
        yield from self._builds
        for build in self._unmade:
            self._builds.append(build)
            yield build


class Joined(Record):
    """The nodes of a mission in a log.

    Attributes:
        tree: of the log.
        how: how they were found, in words.
        uids: the uids of the nodes that were found, by their number in the build.
        number: how many of the log's nodes were found.
        lacking: why the others were not.
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

    def instances(self, target: Target) -> list[tuple[str, int | None]]:
        """The paths of the instances of a written node, each with its uid in the log; None if it is not there."""
        uids = [(each, self.uids.get(_number(each))) for each in self.build.running.instances(target)]
        return [(self.tree.nodes[uid].path if uid is not None else each.path, uid) for each, uid in uids]

    def written(self) -> dict[int, int]:
        """By uid, the index of the written node of each of the log's nodes among those of the mission."""
        indices = self.mission.indices
        nodes = ((self.uids.get(_number(instance)), node) for instance, node in self.build.running.all)
        return {uid: indices[id(node)] for uid, node in nodes if uid is not None and node is not None}

    def enforcing(self) -> dict[int, str]:
        """The guards among the log's nodes, each with its requirement."""
        marks = ((self.uids.get(_number(each)), each.element.get(MARK)) for each, _ in self.build.running.all)
        return {uid: mark for uid, mark in marks if uid is not None and mark is not None}


class Build(Record):
    """What a build makes of a mission; `how` names its options."""

    how: str
    running: RunningTree

    def tree(self) -> LoggedTree:
        """The tree as a log would hold it, as far as its nodes have numbers."""
        return LoggedTree(
            [
                (each.uid, kind_of(each.element), each.path, each.parent or 0)
                for each, _ in self.running.all
                if each.uid is not None
            ]
        )


def join(missions: Sequence[Candidate], tree: LoggedTree) -> Joined | None:
    """The mission that a log's tree belongs to, with its nodes joined.

    None: no mission has half of its nodes, or, with those that are alike, two thirds.
    """
    nodes = [(node.uid, node.path) for node in tree.nodes.values()]
    for mission in sorted(missions, key=lambda each: each.side != nodes):  # building a mission takes time
        for build in mission.builds():
            if (same := join_build(mission, build, tree)) is not None:
                return same if mission.side == nodes else replace(same, others=_others(same, missions))
    best = _nearest(missions, tree)
    if best is None:
        return None
    is_same = best.number * 2 >= len(nodes) or _alike(best.build, tree) * 3 >= len(nodes) * 2
    return best if is_same else None


def _others(joined: Joined, missions: Sequence[Candidate]) -> tuple[str, ...]:
    """The paths of other missions that the log belongs to as well, by the same build of theirs."""
    others = {each.path: each for each in missions if each.path != joined.mission.path}
    builds = {
        path: next((b for b in each.builds() if b.how == joined.build.how), None) for path, each in others.items()
    }
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
    found = (_by_path(mission, build, tree) for mission in missions for build in mission.builds())
    return max(found, key=lambda each: (each.number, _alike(each.build, tree)), default=None)


def join_build(mission: Candidate, build: Build, tree: LoggedTree) -> Joined | None:
    """All nodes, if the trees of a log and of a build are equal; else None."""
    wanted = [(node.uid, node.kind, node.path) for node in tree.nodes.values()]
    made = [(_number(each), kind_of(each.element), each.path) for each, _ in build.running.all]
    if made != wanted:
        return None
    is_side = mission.side == [(uid, path) for uid, _, path in wanted]
    how = mission.origin if is_side else build.how
    return Joined(mission, tree, how, {uid: uid for uid, *_ in wanted}, len(wanted), build)


def _by_path(mission: Candidate, build: Build, tree: LoggedTree) -> Joined:
    """The nodes whose paths are equal and unique on both sides."""
    logged, made = _unique(_logged_paths(tree)), _unique(_made_paths(build))
    uids = {number: logged[key] for key, number in made.items() if key in logged}
    return Joined(mission, tree, "built from another version", uids, len(uids), build)


def _alike(build: Build, tree: LoggedTree) -> int:
    """How many nodes have the same paths in both trees, also where several are alike."""
    logged, made = (Counter(path for path, _ in pairs) for pairs in (_logged_paths(tree), _made_paths(build)))
    return (logged & made).total()


def _logged_paths(tree: LoggedTree) -> list[tuple[tuple[str, str], int]]:
    """The kind and the path of each node of a log, and its uid."""
    return [((node.kind, without_number(node.path)), node.uid) for node in tree.nodes.values()]


def _made_paths(build: Build) -> list[tuple[tuple[str, str], int]]:
    """The same of a build, with the numbers there."""
    return [((kind_of(each.element), without_number(each.path)), _number(each)) for each, _ in build.running.all]


def _builds(mission: Candidate) -> Iterator[Build]:
    """The trees of builds with different options, without those that fail."""
    workspace = mission.workspace
    targets = [workspace.project.target, *(each for each in VERSIONS if each != workspace.project.target)]
    for target in targets:
        project = replace(workspace.project, engines=(target,))
        for is_enforced in (True, False):
            running = _running(mission, workspace.with_project(project), is_enforced)
            if running is not None:
                how = "as built now" if target == targets[0] else f"as built for {target}"
                yield Build(how if is_enforced else f"{how} with --no-enforce", running)


def _running(mission: Candidate, workspace: Workspace, is_enforced: bool) -> RunningTree | None:
    """The tree that `btq build` writes; None if the mission cannot be built."""
    path = mission.path
    exports = [
        as_xml(workspace, each, enforce=is_enforced and is_mission(workspace, each)).export
        for each in workspace.registered_with(path)
    ]
    if any(each.problems for each in exports):
        return None
    elements = {key: element for each in exports for key, element in each.elements.items()}
    documents = tuple(each.document for each in exports)
    main = documents[-1].root.get("main_tree_to_execute")
    if main is None:
        return None
    return RunningTree(Built(path, path, "", documents, elements), mission.requirements.nodes, main)


def _number(instance: Instance) -> int:
    """Its number in the build; 0 after a subtree whose tree is unknown."""
    return instance.uid or 0


def without_number(path: str) -> str:
    """A path without the numbers of unnamed nodes, which change when a node before them is added or removed."""
    parts = [(name, *name.rpartition("::")) for name in path.split("/")]
    return "/".join(own if own and number.isdecimal() else name for name, own, _, number in parts)


def _unique(pairs: list[tuple[tuple[str, str], int]]) -> dict[tuple[str, str], int]:
    return {key: numbers[0] for key, numbers in grouped(pairs).items() if len(numbers) == 1}
