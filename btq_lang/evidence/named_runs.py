"""Finds the mission of each run in a log that names nodes and has no tree of its own.

One invariant: a run is judged only if every node that it names is in one tree and in no tree of another mission; a run
that fits no mission, or several, is counted and not judged.

Nav2's two navigators number the nodes of their trees from 1 each and log to one topic, and a goal may use a tree of its
own.  So the log is cut before the first change after the root has ended, and each piece is joined by itself; adjacent
pieces of one mission are merged again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import cached_property
from typing import Final

from btq_lang.evidence.identity import Build, Candidate, Joined, join, join_build, unlike
from btq_lang.evidence.model import FAILURE, IDLE, ROOT, RUNNING, SUCCESS, LoggedTree, LogSession, NamedLog, Transition
from btq_lang.evidence.runs import ONE_COMPLETION
from btq_lang.util.grouping import grouped
from btq_lang.util.record import replace

OTHER: Final = "of another mission"
SEVERAL: Final = "of one of several missions"


def joined_sessions(
    read: Iterable[LogSession | NamedLog], missions: Sequence[Candidate], source: str
) -> Iterator[tuple[str, LogSession, Joined | str]]:
    """The sessions of a log, each with its joined mission, or with a description of what it belongs to instead.

    Args:
        source: the file, as people read it; returned with each session, with the topic if there are several.
    """
    for log in read:
        if isinstance(log, LogSession):
            yield source, log, join(missions, log.tree) or OTHER
        else:
            name = f"{source} {log.topic}" if log.topic else source
            yield from ((name, session, joined) for session, joined in _sessions(log, missions))


def _sessions(log: NamedLog, missions: Sequence[Candidate]) -> Iterator[tuple[LogSession, Joined | str]]:
    trees = _Trees(log, missions)
    pieces = [(*piece, frozenset(log.changed[slice(*piece)])) for piece in _pieces(log, trees.roots)]
    joined_by = trees.joined({nodes for *_, nodes in pieces})
    index = 0
    while index < len(pieces):
        begin, end, nodes = pieces[index]
        joined = joined_by[nodes]
        index += 1
        while index < len(pieces) and joined_by[pieces[index][2]] is joined:
            end = pieces[index][1]
            index += 1
        if isinstance(joined, str):
            uids = dict.fromkeys((trees.roots & nodes) or {log.changed[begin]}, ROOT)
            tree = LoggedTree([(ROOT, "", "", 0)])
        else:
            uids = trees.uids(joined.tree)
            tree = joined.tree
        session = LogSession(tree, _transitions(log, begin, end, uids), {}, [*log.remarks], log.signals, log.robot)
        session.unlike = trees.unlike(nodes) if joined is OTHER else ()
        yield session, joined


def _pieces(log: NamedLog, roots: Set[int]) -> Iterator[tuple[int, int]]:
    """The ranges of a log that may belong to different trees: each ends before the first change to a status other than
    IDLE after a root has ended.
    """
    begin = 0
    is_open = True  # rows before the root's first row belong to its run
    idle_at: int | None = None  # when the root was halted, if the previous row did that
    for index, (time, node, status) in enumerate(zip(log.times, log.changed, log.statuses, strict=True)):
        is_root = node in roots
        completes = is_root and status in (SUCCESS, FAILURE)
        if not is_open and status != IDLE:
            if not (completes and idle_at is not None and time - idle_at <= ONE_COMPLETION):
                yield begin, index
                begin = index
            is_open = True
        if is_root and status != RUNNING:
            is_open = False
        idle_at = time if is_root and status == IDLE else None
    if begin < len(log.times):
        yield begin, len(log.times)


def _transitions(log: NamedLog, begin: int, end: int, uids: dict[int, int]) -> Iterator[Transition]:
    """The transitions of the nodes that have a uid."""
    for time, node, status in zip(log.times[begin:end], log.changed[begin:end], log.statuses[begin:end], strict=True):
        if node in uids:
            yield time, uids[node], status


class _Trees:
    """The trees that the runs of a log may belong to: those in its file, else builds of the missions."""

    def __init__(self, log: NamedLog, missions: Sequence[Candidate]) -> None:
        self._log: Final = log
        self._has_uids: Final = any(uid for uid, _ in log.nodes)
        self._missions: Final = missions
        self._logged: Final = [(_Names(tree), join(missions, tree)) for tree in reversed(log.trees)]
        self._joined_builds: Final[dict[int, tuple[_Names, Joined] | None]] = {}

    @cached_property
    def roots(self) -> Set[int]:
        """The nodes that are the root of some tree, by their index."""
        nodes = self._log.nodes
        if self._has_uids:
            return {index for index, (uid, _) in enumerate(nodes) if uid == ROOT}
        trees = [tree for tree, _ in self._logged]
        trees += [tree for mission in self._missions for tree, _ in self._builds(mission)]
        names = {tree.root for tree in trees if tree.is_unique(ROOT)}
        return {index for index, (_, name) in enumerate(nodes) if name in names}

    def joined(self, runs: Set[frozenset[int]]) -> dict[frozenset[int], Joined | str]:
        """The mission of each run, given by its nodes, or a description of what it belongs to instead."""
        named = {run: {self._log.nodes[index] for index in run} for run in runs}
        joined_by_run: dict[frozenset[int], Joined | str] = {}
        for run, nodes in named.items():
            for tree, joined in self._logged:
                if tree.has(nodes):
                    joined_by_run[run] = joined or OTHER
                    break
        unmatched = {run: nodes for run, nodes in named.items() if run not in joined_by_run}
        fitting: dict[frozenset[int], list[Joined]] = {run: [] for run in unmatched}
        for mission in self._missions if unmatched else ():
            self._fit(mission, "", unmatched, fitting)
        unmatched = {run: nodes for run, nodes in unmatched.items() if not fitting[run]}
        for mission in self._missions if unmatched and self._has_uids else ():
            for name in mission.trees():  # a node without a uid may be of the main tree
                self._fit(mission, name, unmatched, fitting)
        others = [run for run, joined_missions in fitting.items() if not joined_missions]
        for run, joined_missions in fitting.items():
            # A run whose nodes all occur in a run of another mission may belong to that mission too.
            is_sure = len(joined_missions) == 1 and not any(run <= other for other in others)
            joined_by_run[run] = joined_missions[0] if is_sure else SEVERAL if joined_missions else OTHER
        return joined_by_run

    def unlike(self, run: Set[int]) -> Sequence[str]:
        """How the names of nodes differ in a run and in the tree that has the most of them; empty without uids."""
        nodes = sorted(self._log.nodes[index] for index in run) if self._has_uids else []
        trees = [tree for mission in self._missions for tree, _ in self._builds(mission)] if nodes else []
        differences = [
            [unlike(uid, name, written) for uid, name in nodes if uid and (written := tree.name_of(uid)) != name]
            for tree in trees
        ]
        return min(differences, key=len, default=())

    def _fit(
        self,
        mission: Candidate,
        name: str,
        unmatched: Mapping[frozenset[int], Set[tuple[int, str]]],
        fitting: Mapping[frozenset[int], list[Joined]],
    ) -> None:
        """Add a tree of a mission to those that fit the runs that are left; without a name, the main tree."""
        builds: list[tuple[Set[frozenset[int]], Joined]] = []
        for tree, joined in self._builds(mission, name):
            builds.append(({run for run, nodes in unmatched.items() if tree.has(nodes)}, joined))
            if len(builds[-1][0]) == len(unmatched):
                break
        builds.sort(key=lambda fit: -len(fit[0]))  # a short run may fit builds that the others do not
        for run in unmatched:
            fitting[run] += [joined for runs, joined in builds if run in runs][:1]

    def uids(self, tree: LoggedTree) -> dict[int, int]:
        """The uids of the log's nodes in a tree, by their index."""
        names = _Names(tree)
        pairs = ((index, names.uid(*node)) for index, node in enumerate(self._log.nodes))
        return {index: uid for index, uid in pairs if uid is not None}

    def _builds(self, mission: Candidate, name: str = "") -> Iterator[tuple[_Names, Joined]]:
        for build in mission.builds(name):
            if id(build) not in self._joined_builds:
                self._joined_builds[id(build)] = self._joined_build(mission, build)
            if (joined_build := self._joined_builds[id(build)]) is not None:
                yield joined_build

    def _joined_build(self, mission: Candidate, build: Build) -> tuple[_Names, Joined] | None:
        tree = build.tree()
        joined = join_build(mission, build, tree)
        names = _Names(tree)
        if joined is None:  # some of its nodes have no number
            return None
        return names, joined if self._has_uids else _by_name(joined, names)


def _by_name(joined: Joined, names: _Names) -> Joined:
    """The join, restricted to nodes with unique names."""
    uids = {uid: uid for uid in joined.uids if names.is_unique(uid)}
    return replace(
        joined,
        how="by name, for the log has no uids",
        uids=uids,
        number=len(uids),
        lacking="has a name that another node has too, and the log has no uids",
        has_uids=False,
    )


class _Names:
    """The names of a tree's nodes, and that of its root."""

    def __init__(self, tree: LoggedTree) -> None:
        self._names: Final = {uid: node.name for uid, node in tree.nodes.items()}
        self._named: Final = grouped((name, uid) for uid, name in self._names.items())
        self.root: Final = self._names.get(ROOT, "")

    def has(self, nodes: Set[tuple[int, str]]) -> bool:
        """Whether the tree has all these nodes."""
        return all(self._names.get(uid) == name if uid else name in self._named for uid, name in nodes)

    def name_of(self, uid: int) -> str:
        """The name of a node; empty if there is no such node."""
        return self._names.get(uid, "")

    def is_unique(self, uid: int) -> bool:
        """Whether no other node has the name of this one."""
        return len(self._named.get(self._names.get(uid, ""), ())) == 1

    def uid(self, uid: int, name: str) -> int | None:
        """The uid of a node, by its name if the log gives none; None if it is unknown."""
        if uid:
            return uid if self._names.get(uid) == name else None
        named = self._named.get(name, ())
        return named[0] if len(named) == 1 else None
