"""When activations began, word for word as the design of run-time evidence tells it: between an earliest and a latest
moment.

A node that ticks its children within its own tick is not told from the rows alone, so there is a table of the kinds.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from btq_lang.evidence.model import FAILURE, IDLE, RUNNING, SUCCESS

if TYPE_CHECKING:
    from literal_runs import Activation, Moment

    from btq_lang.evidence.model import LoggedTree, Transition

# Kinds that go on to a child within the tick in which they start, or in which the child before ended; the same in 4.6,
# 4.8 and 4.10, but that TryCatch exists since 4.9.  Before a cycle of Repeat, Retry or Loop there is a row of the cycle
# before, of the same child, which is no sign of anything: so they are as the others.  All other kinds never do: Delay,
# KeepRunningUntilFailure, Precondition, SkipUnlessUpdated, WaitValueUpdate, and whatever a user has written.
IN_TURN = ("Sequence", "Fallback", "ReactiveSequence", "ReactiveFallback", "IfThenElse", "WhileDoElse", "TryCatch")
NAV2_IN_TURN = ("RecoveryNode", "RoundRobin")
AROUND_ONE = ("Inverter", "ForceSuccess", "ForceFailure", "RunOnce", "Timeout", "Repeat", "RetryUntilSuccessful")
LOOPS = ("LoopInt", "LoopDouble", "LoopBool", "LoopString")
# These pause between children, so that only their first one is ticked within the tick.
PAUSING = ("AsyncSequence", "AsyncFallback", "SequenceWithMemory")
# A child of these starts in their first tick, or else was skipped then.
PARALLEL = ("Parallel", "ParallelAll")
# These are RUNNING only after a child is, so that their row is no sign.
SILENT = ("Switch2", "Switch3", "Switch4", "Switch5", "Switch6", "PipelineSequence")
GOES_ON = (*IN_TURN, *NAV2_IN_TURN, *AROUND_ONE, *LOOPS, *PAUSING, *PARALLEL, *SILENT, "SubTree")


class Begins:
    """Sets `earliest` and `latest` of all activations of a session.

    * A control node or decorator whose first row is its own RUNNING began with it, whatever its kind.
    * What has only a result, a leaf whose first row is RUNNING, and a node that began with a row below it, began
      between the row before its first row and that row; if it is known when, just after the row before.
    * It began after its own last row, and after the end of an elder sibling, of it or of a node above, for which their
      parent waits: also where another thread may have written these.
    * Without any row before, nothing is known of the earliest begin: it is the epoch.

    Args:
        delays: how long each Delay waits, in µs.
    """

    def __init__(
        self,
        tree: LoggedTree,
        subtrees: Collection[int],
        delays: Mapping[int, int],
        rows: Sequence[Transition],
        found: Sequence[Activation],
    ) -> None:
        self.tree = tree
        self.subtrees = subtrees
        self.delays = delays
        self.rows = rows
        self.found = found
        self.is_leaf = {uid: last == uid for uid, last in tree.last.items()}
        # Results of leaves that were RUNNING: another thread may have written them.
        self.late_results = {
            each.last
            for each in found
            if self.is_leaf[each.uid] and each.first != each.last and each.outcome in ("S", "F")
        }

    def set(self) -> None:
        for a in self.found:
            a.earliest, a.latest = self.interval(a)

    def interval(self, a: Activation) -> tuple[Moment, Moment]:
        own: Moment = (self.rows[a.first][0], a.first)
        _, uid, status = self.rows[a.first]
        if uid == a.uid and status == RUNNING and not self.is_leaf[uid]:
            return own, own
        before = self.row_before(a.first)
        if before is None:
            return (0, -1), own
        after: Moment = (self.rows[before][0], before + 0.5)
        if self.is_known(a, before):
            return after, after
        waited = [self.waited(each, a) for each in self.tree.above(a.uid) if each in self.delays]
        waited += [self.rows[index][0] for index in range(before + 1, a.first) if self.is_awaited(index, a)]
        earliest = max([after[0], *waited])
        return ((earliest, after[1]) if earliest < own[0] else own), own

    def is_awaited(self, index: int, a: Activation) -> bool:
        """Whether an activation began after a row of another thread."""
        _, of, status = self.rows[index]
        if of == a.uid:
            return True
        child = a.uid
        while parent := self.tree.parent[child]:
            if self.tree.parent[of] == parent:
                in_order = self.tree.nodes[parent].kind in (*IN_TURN, *NAV2_IN_TURN, *PAUSING)
                return status in (SUCCESS, FAILURE) and of < child and in_order
            child = parent
        return False

    def row_before(self, index: int) -> int | None:
        """The last row before one that only the thread that ticks can have written."""
        for before in range(index - 1, -1, -1):
            if self.rows[before][2] in (RUNNING, SUCCESS, FAILURE) and before not in self.late_results:
                return before
        return None

    def waited(self, delay: int, a: Activation) -> int:
        """Until when a Delay above an activation waited, before which it ticks nothing; 0 if that is later than the
        row by more than clocks differ: then it did not wait; or if its begin left no row, or others below it have.
        """
        around = [each for each in self.found if each.uid == delay and each.first < a.first <= each.last]
        until = around[-1].earliest[0] + self.delays[delay] if around and not self.ran(delay + 1, a) else 0
        return until if until <= self.rows[a.first][0] + 1000 else 0

    def is_known(self, a: Activation, before: int) -> bool:
        """Whether the row before is RUNNING of an ancestor, or the end of an elder sibling of the node or of an
        ancestor, and all parents between go on within a tick."""
        _, of, status = self.rows[before]
        child = a.uid
        while parent := self.tree.parent[child]:
            kind = "SubTree" if parent in self.subtrees else self.tree.nodes[parent].kind
            if kind not in GOES_ON or (kind in PARALLEL and not self.starts_with(parent, child, a)):
                return False
            if parent in (of, self.tree.parent[of]) and self.ran(child, a):
                return False
            if of == parent:
                began = any(
                    each.uid == of and each.first == before for each in self.found
                )  # else rows below came first
                return status == RUNNING and kind not in SILENT and began
            if self.tree.parent[of] == parent and of < child:
                return status != RUNNING and kind not in PAUSING
            child = parent
        return False

    def ran(self, uid: int, a: Activation) -> bool:
        """Whether a node above an activation, or its own, had begun before: it may have ticked another child first."""
        return any(self.has_begun(each, a.first) for each in self.tree.above(a.uid) if each >= uid)

    def has_begun(self, uid: int, before: int) -> bool:
        """Whether a row of a node, or below it, shows before another one that it had begun, and none that it ended."""
        return self.has_row(range(uid, self.tree.last[uid] + 1), uid, before)

    def has_row(self, uids: Collection[int], since_end_of: int, before: int) -> bool:
        """Whether there is a row, but to IDLE, of one of some nodes since a node ended last."""
        around = (since_end_of, *self.tree.above(since_end_of))
        rows = [*enumerate(self.rows[:before])]
        ends = [each.last for each in self.found if each.uid in around and each.last < before]
        ends += [index for index, (_, of, status) in rows if of == since_end_of and status == IDLE]
        return any(
            of in uids and status in (RUNNING, SUCCESS, FAILURE)
            for _, (_, of, status) in rows[max(ends, default=-1) + 1 :]
        )

    def starts_with(self, parallel: int, child: int, a: Activation) -> bool:
        """Whether a child of a Parallel starts with the first row of an activation, and was not skipped since the
        Parallel began: no younger sibling wrote anything."""
        if self.ran(child, a):
            return False
        younger = range(self.tree.last[child] + 1, self.tree.last[parallel] + 1)
        return not self.has_row(younger, parallel, a.first)
