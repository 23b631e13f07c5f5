"""When nodes began, as far as the rows of a log say.

One invariant: a begin counts as known only if nothing but the node's own `tick()` separates it from the node's first
row.

The engine does not log when it ticks a node. A node that completes at once leaves one row, its result; an asynchronous
leaf writes RUNNING after its first tick; and some nodes write RUNNING after their children's rows. When such a node
began is known if the tick that wrote the row before went on to the node: that row is the RUNNING of a node above, or
the result of an elder sibling, and all nodes between tick their children at once (`NodeKind.one_tick`). Otherwise the
node began at some time after that row.

A row to IDLE, or the result of a leaf that was running, may come from another thread (of a ThreadedAction, or a
Timeout's timer) and does not show where the tree is; yet a node began after its own last row, and after an elder
sibling that it waits for had completed.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias

from btq_lang.catalog.nav2.nodes import NODES
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.evidence.model import RUNNING, LoggedTree

if TYPE_CHECKING:
    from btq_lang.evidence.model import Moment

    # If the row before may show when a node began: the node, or the one above it, that then began too, and the
    # Parallels between them, each with its child.
    Shown: TypeAlias = tuple[int, list[tuple[int, int]]]


class Begins:
    """Follows the rows of a session.

    Attributes:
        others: the rows since the last one of the thread that ticks the tree: uid, time, and whether it is a result.
    """

    def __init__(self, tree: LoggedTree) -> None:
        self._tree: Final = tree
        one_tick = {uid: _one_tick(tree, uid) for uid in tree.nodes}
        self._at_once: Final = {uid for uid, how in one_tick.items() if how}
        self._into: Final = {uid for uid, how in one_tick.items() if how in ("first", "both", "unskipped")}
        self._onward: Final = {uid for uid, how in one_tick.items() if how in ("next", "both", "unskipped")}
        self._in_order: Final = {uid for uid, how in one_tick.items() if how in ("first", "both")}
        nav2 = {uid for uid, node in tree.nodes.items() if node.kind in NODES and one_tick[uid] != "next"}
        built_in = {uid for uid, node in tree.nodes.items() if node.kind in BUILTINS}
        after_begin = (self._into | nav2 | built_in) - tree.leaves
        self._writes_first: Final = {*tree.nodes} if tree.shows_begins else after_begin
        all_parallel = {uid for uid, how in one_tick.items() if how == "unskipped"}
        self._parallel: Final = all_parallel if not tree.shows_begins else set[int]()  # what they ticked shows nothing
        # By Parallel: the row that showed its activation, and the last child that has written a row since.
        self._ticked: Final[dict[int, tuple[Moment, int]]] = {}
        self._before: tuple[Moment, int, bool] | None = None  # its node, and whether it is RUNNING
        self.others: Final[list[tuple[int, int, bool]]] = []
        self._shown: Final[dict[tuple[int, int, bool], Shown | None]] = {}

    def follow(self, now: Moment, uid: int, is_running: bool, begun: Mapping[int, Begin]) -> None:
        """Note a row of the thread that ticks the tree; `begun`: the nodes that are active."""
        self._before = now, uid, is_running
        if self.others:
            self.others.clear()
        if self._parallel:
            self._follow_parallels(uid, begun)

    def lose(self) -> None:
        """Forget the rows so far: others were lost, or the clock was set back."""
        self._before = None
        self.others.clear()

    def begin_of(self, uid: int, now: Moment, status: int, writes: int, begun: Mapping[int, Begin]) -> Begin:
        """When a node began, by its first row, which the node itself or one below it writes.

        Args:
            writes: the node that writes it.
            begun: the nodes above it that are active, and others.
        """
        if uid == writes and status == RUNNING and uid in self._writes_first:
            return Begin(now, now, now)
        before = self._before
        # After it, and after the moment just after it, at which what it ended is over.
        after = (before[0][0], before[0][1] + 2) if before is not None else (0, 0)
        if before is not None and self._shows(uid, before, now, begun):
            return Begin(after, after, now)
        time, earliest = now[0], after[0]
        for other, other_time, is_result in self.others:
            if other == uid or (is_result and self._waits_for(uid, other)):
                earliest = max(earliest, other_time)
        child = uid
        for above in self._tree.above(uid) if self._tree.delays else ():
            if begun[above].shown != now and (child == uid or begun[child].shown == now):  # what it waited for
                waited = begun[above].earliest[0] + self._tree.delays.get(above, 0)
                # Else it did not wait: 4.8.3 and 4.8.4 do not.
                earliest = max(earliest, waited) if waited <= time + _CLOCKS else earliest
            child = above
        return Begin((earliest, after[1]) if earliest < time else now, now, now)

    def _shows(self, uid: int, before: tuple[Moment, int, bool], now: Moment, begun: Mapping[int, Begin]) -> bool:
        key = uid, before[1], before[2]
        if key not in self._shown:
            self._shown[key] = self._shown_by(*key)
        shown = self._shown[key]
        if shown is None:
            return False
        if before[2] and begun[before[1]].shown != before[0]:  # its children wrote rows before it did
            return False
        first, parallels = shown
        if first != uid and begun[first].shown != now:  # which may have ticked another node meanwhile
            return False
        return all(self._last_ticked(parallel, begun[parallel].shown) <= child for parallel, child in parallels)

    def _shown_by(self, uid: int, before: int, is_running: bool) -> Shown | None:
        tree = self._tree
        child = uid
        parallels: list[tuple[int, int]] = []
        for above in tree.above(uid):
            is_last = above == before if is_running else above == tree.parent[before] and before < child
            goes_on = self._at_once if not is_last else self._into if is_running else self._onward
            if above not in goes_on:
                return None
            if above in self._parallel:
                parallels.append((above, child))
            if is_last:
                return child, parallels
            child = above
        return None

    def _waits_for(self, uid: int, other: int) -> bool:
        """Whether a node begins only after another one has completed: an elder sibling of it, or of a node above."""
        child = uid
        for above in self._tree.above(uid):
            if above == self._tree.parent[other]:
                return above in self._in_order and other < child
            child = above
        return False

    def _follow_parallels(self, uid: int, begun: Mapping[int, Begin]) -> None:
        child = uid
        for above in self._tree.above(uid):
            if above in self._parallel and above in begun:
                shown = begun[above].shown
                self._ticked[above] = shown, max(child, self._last_ticked(above, shown))
            child = above

    def _last_ticked(self, parallel: int, shown: Moment) -> int:
        """The last child that has written a row since the Parallel began, which this row shows; 0: none."""
        activation_shown, child = self._ticked.get(parallel, (shown, 0))
        return child if activation_shown == shown else 0


class Begin(NamedTuple):
    """When an activation began, at the earliest and at the latest, and the row that shows it."""

    earliest: Moment
    latest: Moment
    shown: Moment


def _one_tick(tree: LoggedTree, uid: int) -> str:
    kind = "SubTree" if tree.has_tree(uid) else tree.nodes[uid].kind
    node_kind = BUILTINS.get(kind) or NODES.get(kind)
    return node_kind.one_tick if node_kind is not None else ""


_CLOCKS: Final = 1000  # µs by which a timer and the times of rows may differ
