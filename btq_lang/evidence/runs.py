"""Turns status changes, as the engine and Nav2's control nodes log them, into activations and runs.

One invariant: activations are yielded when they end, children first, so the root's activation ends its run; whatever
the log holds, two activations of a node are never merged.

How real logs deviate from the plain sequence RUNNING, result, IDLE:

* A node writes IDLE and then its own result (Nav2's RecoveryNode): one row is held back to detect it.
* A node writes its first row after rows of its children (Nav2's PipelineSequence): it began with the first of those.
* A node writes its first row after its first tick: `begins.py` says when it began.
* Nothing is written when a node is halted (logs without rows to IDLE): it had ended by the time a node above it ended,
  or by its next start.
* Rows before the first one, or between two, were not seen (a running robot): the open run ends there, cut off, and
  whether a node is active is unknown until a row says so.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.begins import Begin, Begins
from btq_lang.evidence.model import (
    FAILURE,
    GAP,
    PLACES,
    ROOT,
    RUNNING,
    SKIPPED,
    SUCCESS,
    UNTIL,
    Activation,
    LiveMark,
    LoggedTree,
    LogSession,
)
from btq_lang.evidence.wording import timestamp

if TYPE_CHECKING:
    from btq_lang.evidence.model import Moment, Outcome, Timing


def activations(session: LogSession) -> Iterator[Activation]:
    """The activations of a session, each as it ends; those of the root are the runs."""
    tree = session.tree
    begins = Begins(tree)
    odd = Oddities()
    nodes = _OpenNodes(tree, begins, odd, session.keeping)
    parent = tree.parent
    leaves = tree.leaves
    by_others = begins.others
    begun, running, completed, unseen = nodes.begun, nodes.running, nodes.completed, nodes.unseen
    idle: tuple[int, Moment] | None = None  # a halt that may turn out to be part of the node's own completion
    is_reset_written = False
    row, now = 0, (0, 0)
    until = now  # nodes that are active at `now` are still active then
    for number, (time, uid, status) in enumerate(session.transitions, 1):
        row = number * PLACES
        if uid not in parent or status not in _STATUSES:
            if isinstance(uid, LiveMark):
                if idle is not None:
                    yield from nodes.end(*idle, "H")
                    idle = None
                if uid is UNTIL:
                    until = time, row
                if uid is GAP:
                    yield from nodes.lose(max(now, until))
            else:
                odd.count("rows with an unknown node or status, left out", time)
            continue
        before, now = now, (time, row)
        if time < before[0]:
            nodes.distrust(time)
        completes = status in _RESULTS
        if idle is not None:
            halted, then = idle
            idle = None
            if not (halted == uid and completes and time - then[0] <= ONE_COMPLETION):
                yield from nodes.end(halted, then, "H")
        if unseen:
            nodes.see(uid, now, status)
        # Else a thread of its own may have written it.
        is_of_tick = status == RUNNING or (completes and not (uid in running and uid in leaves))
        if status == RUNNING:
            if uid in running:
                yield from nodes.end_unwritten(uid, before[0], now)
            running.add(uid)
            if uid not in begun:
                nodes.begin(uid, now, status)
        elif completes:
            if uid not in begun:
                nodes.begin(uid, now, status)
            completed.add(uid)
            ended = nodes.end(uid, now, "S" if status == SUCCESS else "F")
            if len(ended) > 1:
                odd.count(_UNWRITTEN, time)
            yield from ended
        else:
            completed.discard(uid)
            is_reset_written = True
            if uid in running:
                idle = uid, now
            elif uid == ROOT and uid in begun:  # no row of the root: how the run ended is unknown
                yield from nodes.end(ROOT, now, "O", below="O")
            elif uid in begun:
                nodes.forget(uid)
        if is_of_tick:
            begins.follow(now, uid, status == RUNNING, begun)
        else:
            by_others.append((uid, time, completes))
    if not is_reset_written:
        session.keeping.clear()
    if idle is not None:
        yield from nodes.end(*idle, "H")
    if ROOT in begun:
        yield from nodes.end(ROOT, (max(now, until)[0], row), "O", below="O")
    session.remarks.extend(odd.remarks())


class _OpenNodes:
    """The nodes that are active.

    Attributes:
        begun: when each began at the latest.
        running: those that have written RUNNING.
        completed: those that have completed and have not been reset since.
        unseen: those that may or may not be active.
    """

    def __init__(self, tree: LoggedTree, begins: Begins, odd: Oddities, keeping: set[int]) -> None:
        """No node is active; `keeping`: nodes that start a child again without resetting it are added."""
        self.begun: Final[dict[int, Begin]] = {}
        self.running: Final[set[int]] = set()
        self.completed: Final[set[int]] = set()
        self.unseen: Final[set[int]] = set()
        self._late: Final[set[int]] = set()  # those that began before their time in `begun`
        self._tree: Final = tree
        self._begins: Final = begins
        self._odd: Final = odd
        self._keeping: Final = keeping
        self._distrusted: Final[set[int]] = set()

    def begin(self, uid: int, now: Moment, status: int) -> None:
        """Mark the node that writes a row and its ancestors as active, whether these have logged it or not."""
        begun, parent = self.begun, self._tree.parent
        beginning = [uid]
        while (above := parent[beginning[-1]]) and above not in begun:
            beginning.append(above)
        for node in reversed(beginning):
            begun[node] = self._begins.begin_of(node, now, status, uid, begun)
        if uid in self.completed:
            self._keeping.add(parent[uid])

    def see(self, uid: int, now: Moment, status: int) -> None:
        """Conclude from a row which nodes were active before it."""
        if status in _ACTIVE:
            for above in self._tree.above(uid):
                if above in self.unseen:
                    self._begin_late(above, now)
        if status in _RESULTS and uid in self.unseen:
            self._begin_late(uid, now)
        elif status == RUNNING:
            self._late.discard(uid)  # rows below it came first
        self.unseen.difference_update(range(uid, self._tree.last[uid] + 1))  # what is below is not active now

    def _begin_late(self, uid: int, now: Moment) -> None:
        self.unseen.discard(uid)
        self.begun[uid] = Begin(now, now, now)
        self._late.add(uid)

    def end(
        self, uid: int, now: Moment, outcome: Outcome, timing: Timing = "exact", below: Outcome = "H"
    ) -> list[Activation]:
        """End a node; returns the activations that end with it, innermost first, its own last."""
        ended: list[Activation] = []
        last = self._tree.last[uid]
        if last > uid and max(self.begun) > uid:  # mostly nothing below is open any more
            for node in sorted([node for node in self.begun if uid < node <= last], reverse=True):
                if node in self.running:
                    ended.append(self._activation(node, now, below, "latest" if below == "H" else "exact"))
                else:  # only its descendants have written rows
                    self.forget(node)
        ended.append(self._activation(uid, now, outcome, timing))
        return ended

    def forget(self, uid: int) -> None:
        """Mark a node as inactive."""
        del self.begun[uid]
        self.running.discard(uid)
        self._distrusted.discard(uid)
        self._late.discard(uid)

    def end_unwritten(self, uid: int, before: int, now: Moment) -> list[Activation]:
        """End a running node that starts again: its end has no row.

        Args:
            before: the time of the row before this one; a run ends there.
        """
        if uid == ROOT:
            return self.end(ROOT, (before, now[1] - 1), "O", below="O")
        self._odd.count(_UNWRITTEN, now[0])
        return self.end(uid, now, "H", "latest")

    def distrust(self, time: int) -> None:
        """Mark the durations of all active nodes as unknown: the clock was set back to this time."""
        self._odd.count("rows earlier than the row before them, so durations across them are unknown", time)
        self._distrusted.update(self.begun)
        self._begins.lose()

    def lose(self, now: Moment) -> list[Activation]:
        """End the open run, because later rows were lost; which nodes are active is unknown from now on."""
        ended = self.end(ROOT, now, "O", "lost", below="O") if ROOT in self.begun else []
        self.completed.clear()
        self.unseen.update(self._tree.parent)
        self._begins.lose()
        return ended

    def _activation(self, uid: int, now: Moment, outcome: Outcome, timing: Timing) -> Activation:
        self.running.discard(uid)
        if uid in self._distrusted:
            self._distrusted.remove(uid)
            timing = "broken"
        if uid in self._late:
            self._late.remove(uid)
            timing = "part" if timing == "lost" else "late"
        begin = self.begun.pop(uid)
        return Activation(uid, begin.latest, now, outcome, timing, begin.earliest, begin.shown)


class Oddities:
    """Counts what is unusual in a log; each kind is one remark, with the time of the first."""

    def __init__(self) -> None:
        self._kinds: Final[dict[str, tuple[int, int]]] = {}

    def count(self, what: str, time: int) -> int:
        """Count one; returns how many of its kind were before it."""
        first, number = self._kinds.get(what, (time, 0))
        self._kinds[what] = first, number + 1
        return number

    def remarks(self) -> Iterator[str]:
        """A remark for each kind."""
        for what, (first, number) in self._kinds.items():
            yield f"{what}: {number}, the first at {timestamp(first)}"


ONE_COMPLETION: Final = 1000  # µs between a node's IDLE and its own result
_UNWRITTEN: Final = "halts without a row of their own, so only the latest possible end is known"
_STATUSES: Final = frozenset(range(SKIPPED + 1))
_RESULTS: Final = (SUCCESS, FAILURE)
_ACTIVE: Final = (RUNNING, SUCCESS, FAILURE)  # what a node writes only while those above it are active
