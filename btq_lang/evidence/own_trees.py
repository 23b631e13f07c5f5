"""The trees in logs as missions without requirements, for logs whose mission is unknown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain, count
from typing import Final

from btq_lang.btcpp.document import write
from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.logged import as_written
from btq_lang.btcpp.side_file import BuiltFile, RunningTree
from btq_lang.evidence.identity import Build, Candidate
from btq_lang.evidence.model import LoggedTree, LogSession
from btq_lang.workspace.workspace import Workspace

NO_MISSION: Final = (
    "no mission found; name one with --mission FILE, a .btq file or XML, or make one with btq import LOG"
)


class OwnTree(Candidate):
    """The tree in a log as a mission."""

    origin = "the tree in the log"

    def __init__(self, path: str, name: str, tree: LoggedTree) -> None:
        """Make it of a tree; `path`: what it is called in messages."""
        nodes = [(node.uid, node.path) for node in tree.nodes.values()]
        self._document: Final = as_written(tree.xml)
        text = import_xml(write(self._document)).text
        super().__init__(Workspace.of({path: text}), path, name, nodes)
        self._made_of: Final = path, name, tree

    def __reduce__(self) -> tuple[object, ...]:
        return OwnTree, self._made_of

    def builds(self, tree: str = "") -> Iterator[Build]:
        """The builds of the mission, and last the tree itself, which always equals the one in the log."""
        yield from super().builds(tree)
        main = self._document.root.get("main_tree_to_execute") or ""
        if tree in ("", main):
            built = BuiltFile(self.path, self.path, "", (self._document,), {})
            yield Build(self.origin, RunningTree(built, self.requirements.nodes, main), main, True, built.documents)


class OwnTrees:
    """The missions made of trees in logs, one for all logs with the same tree.

    Attributes:
        missions: those made so far, in their order.
    """

    def __init__(self) -> None:
        self.missions: Final[list[OwnTree]] = []
        self._node_lists: Final[set[tuple[tuple[int, str, str], ...]]] = set()

    def of(self, sessions: Iterator[LogSession], address: str) -> Iterator[LogSession]:
        """The sessions of a running robot, with a mission for each when it begins."""
        for session in sessions:
            self.add([session.tree], address)
            yield session

    def add(self, trees: Iterable[LoggedTree], log: str) -> None:
        """Make missions of the trees in a log that are not known yet."""
        for tree in trees:
            nodes = tuple((node.uid, node.kind, node.path) for node in tree.nodes.values())
            if nodes in self._node_lists:
                continue
            self._node_lists.add(nodes)
            ID = as_written(tree.xml).root.get("main_tree_to_execute") or "tree"
            names = chain((ID,), (f"{ID} {number}" for number in count(2)))
            name = next(unused for unused in names if all(unused != mission.name for mission in self.missions))
            self.missions.append(OwnTree(f"{log}/{name}.btq", name, tree))
