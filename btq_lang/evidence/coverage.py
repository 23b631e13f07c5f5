"""What the logs of a mission cover: which nodes ran, in how many runs, how long and with which results.

Also retries, where failures began, and in how many runs each context held: a requirement in a context that never
occurred was not tested.
"""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.nav2.nodes import NODES
from btq_lang.catalog.nodes import tags_of
from btq_lang.evidence.conditions import truth
from btq_lang.evidence.history import History, Nearby
from btq_lang.evidence.model import BEGUN_BEFORE, ROOT, Activation, LoggedTree, Outcome
from btq_lang.evidence.observed import Observed
from btq_lang.evidence.signals import Signals, UnknownValue
from btq_lang.evidence.verdicts import NodeSummary, Repeats
from btq_lang.evidence.wording import duration
from btq_lang.requirements.model import Condition, InContext, Running, parts_in

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Joined
    from btq_lang.workspace.resolved import ResolvedNode


class Coverage:
    """Statistics of the nodes in a mission's logs.

    Attributes:
        retries: starts of children of Retry nodes, without the first of each.
        recoveries: starts of second children of Nav2's RecoveryNodes.
    """

    def __init__(self) -> None:
        self.retries: Final = _Repeated()
        self.recoveries: Final = _Repeated()
        self._nodes: Final[dict[tuple[int, str], _Node]] = {}
        self._now: dict[int, _Node] = {}  # of the current log, by uid
        self._repeated: dict[int, list[tuple[_Repeated, int]]] = {}  # the counters that a start increments
        self._runs = 1

    def expect(self, tree: LoggedTree, written: Mapping[int, int]) -> None:
        """Begin a log with this tree; `written`: by uid, the index of each written node among those of the mission."""
        self._now = {}
        for uid, node in tree.nodes.items():
            new = _Node(node.path, node.kind, uid in tree.leaves, written.get(uid))
            self._now[uid] = self._nodes.setdefault((uid, node.path), new)
        self._repeated = {}
        for uid, node in tree.nodes.items():
            if node.kind in _RETRYING and tree.last[uid] > uid:
                self._repeated.setdefault(uid, []).append((self.retries, -1))
                self._repeated.setdefault(uid + 1, []).append((self.retries, 1))
                second = tree.last[uid + 1] + 1
                if node.kind in _RECOVERING and second <= tree.last[uid]:
                    self._repeated.setdefault(second, []).append((self.recoveries, 1))

    def count(self, activation: Activation) -> None:
        """Count an activation that has ended."""
        uid, outcome = activation.uid, activation.outcome
        node = self._now[uid]
        node.outcomes[outcome] += 1
        if activation.timing == "exact" and outcome in "SF":
            if activation.is_duration_known:
                node.times.append(activation.end - activation.begin)
            else:
                node.bounded += 1
                node.longest = max(node.longest, activation.end - activation.earliest)
                node.has_longest = node.has_longest and activation.earliest > 0
        if node.is_leaf and activation.is_begin_known and activation.timing not in BEGUN_BEFORE:
            node.ticks.append(activation.shown[0] - activation.begin)  # its first tick
        if node.run != self._runs:
            node.run = self._runs
            node.runs += 1
        for repeated, step in self._repeated.get(uid, ()):
            repeated.now += step

    def end_run(self, run: int, began: int | None) -> None:
        """Count the open run, which has ended; `began`: the node where its failure began, if it failed."""
        self._runs += 1
        if began is not None:
            self._now[began].began += 1
        for repeated in (self.retries, self.recoveries):
            repeated.end_run(run)

    def clock_remarks(self) -> Iterator[str]:
        """A remark on each node of the current log with a duration that is much longer than its others."""
        for node in self._now.values():
            longest = max(node.times, default=0)
            if longest > _HOUR and longest > _FACTOR * (median := sorted(node.times)[len(node.times) // 2]):
                took = f"{node.path} took {duration(longest / 1e6)} once"
                yield f"{took}, and half of the times at most {duration(median / 1e6)}: was the clock set forward?"

    def add_all(self, other: Coverage, runs: int) -> None:
        """Add the statistics of later logs; `runs`: how many runs were before them."""
        for key, node in other._nodes.items():
            own = self._nodes.setdefault(key, node)
            if own is not node:
                own.add_all(node)
        self.retries.add_all(other.retries, runs)
        self.recoveries.add_all(other.recoveries, runs)

    def summary(self, written: Sequence[ResolvedNode]) -> tuple[NodeSummary, ...]:
        """The statistics of all nodes, in the order of their uids; `written`: the nodes of the mission."""
        return tuple(self._nodes[key].summary(written) for key in sorted(self._nodes))


class _Node:
    """The counts of one node.

    Attributes:
        times: of activations that succeeded or failed, in µs, if known.
        bounded: how many of these have a time that is not known.
        longest: how long any of those took at most, in µs, if `has_longest`.
        run: the last one in which it was active.
    """

    def __init__(self, path: str, kind: str, is_leaf: bool, written: int | None) -> None:
        self.began = self.bounded = self.longest = 0
        self.has_longest = True
        self.ticks: Final = array("q")
        self.path: Final = path
        self._kind: Final = kind
        self.is_leaf: Final = is_leaf
        self._written: Final = written
        self.outcomes: Final[Counter[Outcome]] = Counter()
        self.times: Final = array("q")
        self.runs = self.run = 0

    def add_all(self, other: _Node) -> None:
        self.began += other.began
        self.bounded += other.bounded
        self.longest = max(self.longest, other.longest)
        self.has_longest = self.has_longest and other.has_longest
        self.runs += other.runs
        self.times.extend(other.times)
        self.ticks.extend(other.ticks)
        self.outcomes.update(other.outcomes)

    def summary(self, written: Sequence[ResolvedNode]) -> NodeSummary:
        times, ticks = sorted(self.times), sorted(self.ticks)
        return NodeSummary(
            path=self.path,
            kind=self._kind,
            is_leaf=self.is_leaf,
            runs=self.runs,
            succeeded=self.outcomes["S"],
            failed=self.outcomes["F"],
            halted=self.outcomes["H"],
            interrupted=self.outcomes["O"],
            failures_began=self.began,
            p50=_percentile(times, 50),
            p95=_percentile(times, 95),
            bounded=self.bounded,
            longest=self.longest / 1e6 if self.bounded and self.has_longest else None,
            tick_p95=_percentile(ticks, 95),
            tick_worst=_percentile(ticks, 100),
            written=written[self._written] if self._written is not None else None,
        )


class _Repeated:
    """Counts repetitions: in the open run, in total, and in the run with the most."""

    def __init__(self) -> None:
        self.now = 0
        self._total = self._most = self._run = 0

    def end_run(self, run: int) -> None:
        self._total += self.now
        if self.now > self._most:
            self._most, self._run = self.now, run
        self.now = 0

    def add_all(self, other: _Repeated, runs: int) -> None:
        self._total += other._total
        if other._most > self._most:
            self._most, self._run = other._most, other._run + runs

    def summary(self) -> Repeats:
        return Repeats(self._total, self._most, self._run or None)


def _percentile(ordered: list[int], percent: int) -> float | None:
    """The smallest of some times, in µs, that this percentage of them does not exceed, in seconds; None without any."""
    return ordered[-(-len(ordered) * percent // 100) - 1] / 1e6 if ordered else None


class Contexts:
    """Counts the runs of a mission's contexts while its logs are read.

    Attributes:
        counts: in how many runs each context held, and in how many others that is unknown.
    """

    def __init__(self, contexts: Mapping[str, Condition | None]) -> None:
        """Count nothing yet; a context that could not be resolved is None."""
        self._contexts: Final = [
            InContext(name, condition) for name, condition in contexts.items() if condition is not None
        ]
        self.counts: Final = Counter(dict.fromkeys(contexts, 0)), Counter(dict.fromkeys(contexts, 0))

    def join(self, joined: Joined, signals: Signals, history: History) -> None:
        """Begin another log."""
        self._signals, self._nodes = signals, Nearby(ROOT, joined, history)
        for context in self._contexts:
            for part in parts_in(context):
                if isinstance(part, Running):
                    self._nodes.find(part.target)

    def end_run(self, root: Activation) -> None:
        """Count the open run, which has ended; `root`: the activation of its root."""
        observed = Observed(self._signals, self._nodes, root.started, root.ended, root.timing != "latest").in_scope
        held, unknown = self.counts
        for context in self._contexts:
            is_unknown = False
            for moment in observed.moments(context):
                holds = truth(context, observed, moment)
                if holds is True:
                    held[context.name] += 1
                    break
                is_unknown = is_unknown or isinstance(holds, UnknownValue)
            else:
                unknown[context.name] += is_unknown


_HOUR: Final = 3_600_000_000  # µs
_FACTOR: Final = 1000
_RECOVERING: Final = frozenset([kind.tag for kind in NODES.values() if kind.flow == "recover"])
_RETRYING: Final = tags_of("retry") | _RECOVERING
