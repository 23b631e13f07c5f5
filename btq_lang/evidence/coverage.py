"""Which nodes ran, in how many runs, how long they took and what they came to; retries, and where failures began."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.nodes import tags_of
from btq_lang.evidence.verdicts import NodeSummary, Repeats

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation, LoggedTree, Outcome
    from btq_lang.requirements.model import SourceNode


class Coverage:
    """The nodes of the logs of a mission.

    Attributes:
        retries: starts of what Retry nodes repeat, without the first of each.
        recoveries: starts of the second children of Nav2's RecoveryNodes.
    """

    def __init__(self) -> None:
        self.retries: Final = _Repeated()
        self.recoveries: Final = _Repeated()
        self._nodes: Final[dict[tuple[int, str], _Node]] = {}
        self._now: dict[int, _Node] = {}  # those of the tree whose log is read, by uid
        self._repeated: dict[int, list[tuple[_Repeated, int]]] = {}  # what a start of them counts for
        self._runs = 1

    def expect(self, tree: LoggedTree, written: Mapping[int, SourceNode]) -> None:
        """The nodes of a log may run.

        Args:
            written: as what they are written, by uid.
        """
        self._now = {}
        for uid, node in tree.nodes.items():
            new = _Node(node.path, node.kind, tree.last[uid] == uid, written.get(uid))
            self._now[uid] = self._nodes.setdefault((uid, node.path), new)
        self._repeated = {}
        for uid, node in tree.nodes.items():
            if node.kind in _RETRYING and tree.last[uid] > uid:
                self._repeated.setdefault(uid, []).append((self.retries, -1))
                self._repeated.setdefault(uid + 1, []).append((self.retries, 1))
                second = tree.last[uid + 1] + 1
                if node.kind == _RECOVERY and second <= tree.last[uid]:
                    self._repeated.setdefault(second, []).append((self.recoveries, 1))

    def count(self, activation: Activation) -> None:
        """One of them has ended."""
        uid = activation.uid
        self._now[uid].count(activation, self._runs)
        for repeated, step in self._repeated.get(uid, ()):
            repeated.now += step

    def end_run(self, run: int, began: int | None) -> None:
        """The run that was open has ended.

        Args:
            began: the node where its failure began, if it failed.
        """
        self._runs += 1
        if began is not None:
            self._now[began].began += 1
        for repeated in (self.retries, self.recoveries):
            repeated.end_run(run)

    def took(self, uid: int, time: int) -> None:
        """A tick of a leaf has taken so many µs."""
        self._now[uid].ticks.append(time)

    def summary(self) -> tuple[NodeSummary, ...]:
        """The nodes in the order of their numbers."""
        return tuple(node.summary() for _, node in sorted(self._nodes.items(), key=lambda each: each[0]))


class _Node:
    """What was counted of a node."""

    def __init__(self, path: str, kind: str, is_leaf: bool, written: SourceNode | None) -> None:
        self.began = 0
        self.ticks: Final = array("q")
        self._path: Final = path
        self._kind: Final = kind
        self._is_leaf: Final = is_leaf
        self._written: Final = written
        self._outcomes: Final[dict[Outcome, int]] = {"S": 0, "F": 0, "H": 0, "O": 0}
        self._times: Final = array("q")  # of those that succeeded or failed, in µs
        self._runs = self._run = 0

    def count(self, activation: Activation, run: int) -> None:
        self._outcomes[activation.outcome] += 1
        if activation.outcome in ("S", "F") and activation.timing == "exact":
            self._times.append(activation.end - activation.begin)
        if self._run != run:
            self._run = run
            self._runs += 1

    def summary(self) -> NodeSummary:
        times, ticks = sorted(self._times), sorted(self.ticks)
        return NodeSummary(
            path=self._path,
            kind=self._kind,
            is_leaf=self._is_leaf,
            runs=self._runs,
            succeeded=self._outcomes["S"],
            failed=self._outcomes["F"],
            halted=self._outcomes["H"],
            interrupted=self._outcomes["O"],
            failures_began=self.began,
            p50=_percentile(times, 50),
            p95=_percentile(times, 95),
            tick_p95=_percentile(ticks, 95),
            tick_worst=_percentile(ticks, 100),
            written=self._written,
        )


class _Repeated:
    """How often something was done again: in the run that is open, in all, and in which run most often."""

    def __init__(self) -> None:
        self.now = 0
        self._total = self._most = self._run = 0

    def end_run(self, run: int) -> None:
        self._total += self.now
        if self.now > self._most:
            self._most, self._run = self.now, run
        self.now = 0

    def summary(self) -> Repeats:
        return Repeats(self._total, self._most, self._run or None)


def _percentile(ordered: list[int], percent: int) -> float | None:
    """The smallest of some times that so many percent of them do not exceed, in seconds; None without any."""
    return ordered[-(-len(ordered) * percent // 100) - 1] / 1e6 if ordered else None


_RECOVERY: Final = "RecoveryNode"
_RETRYING: Final = frozenset((*tags_of("retry"), _RECOVERY))
