"""Which nodes ran, and how long the leaves took."""

from __future__ import annotations

from array import array

from btq_lang.evidence.verdicts import NodeTimes

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

    from btq_lang.evidence.model import Activation, LoggedTree


class Coverage:
    """The nodes of the logs of a mission.

    Attributes:
        exercised: whether each of them ran, by uid and path.
    """

    def __init__(self) -> None:
        self.exercised: Final[dict[tuple[int, str], bool]] = {}
        self._leaves: Final[dict[str, array[float]]] = {}

    def expect(self, tree: LoggedTree) -> None:
        """The nodes of a log may run."""
        for node in tree.nodes.values():
            self.exercised.setdefault((node.uid, node.path), False)

    def count(self, tree: LoggedTree, activation: Activation) -> None:
        """One of them ran."""
        uid = activation.uid
        path = tree.nodes[uid].path
        self.exercised[uid, path] = True
        if tree.last[uid] == uid and activation.outcome in ("S", "F"):
            self._leaves.setdefault(path, array("d")).append(activation.seconds)

    def slowest(self) -> NodeTimes | None:
        """The leaf that takes longest in 95 of 100 activations; None where none takes any time."""
        times = [(path, sorted(each)) for path, each in self._leaves.items()]
        found = [NodeTimes(path, _percentile(each, 50), _percentile(each, 95)) for path, each in times]
        slowest = max(found, key=lambda each: each.p95, default=None)
        return slowest if slowest is not None and slowest.p95 > 0 else None


def _percentile(ordered: list[float], percent: int) -> float:
    """The smallest of some values that so many percent of them do not exceed."""
    return ordered[-(-len(ordered) * percent // 100) - 1]
