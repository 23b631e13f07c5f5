"""What nodes did in the open run, kept only for the nodes that clauses name.

One invariant: in a subtree that is used several times, a clause that names another node means that node in the same use
of the subtree; outside of it, all its instances in the innermost tree around both.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from operator import attrgetter
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.model import UNKNOWN_END, Activation, LoggedTree, Moment
from btq_lang.evidence.signals import UnknownValue
from btq_lang.requirements.model import NodeTarget

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Joined


class History:
    """The ended activations of the open run, by node."""

    def __init__(self) -> None:
        self._by_node: Final[dict[int, list[Activation]]] = {}

    def watch(self, uids: Iterable[int]) -> None:
        """Keep the activations of these nodes."""
        for uid in uids:
            self._by_node.setdefault(uid, [])

    @property
    def watched(self) -> frozenset[int]:
        """The nodes whose activations are kept."""
        return frozenset(self._by_node)

    def add(self, activation: Activation) -> None:
        """Record an activation that has ended."""
        kept = self._by_node.get(activation.uid)
        if kept is not None:
            kept.append(activation)

    @contextmanager
    def including(self, activations: Iterable[Activation]) -> Iterator[None]:
        """Meanwhile, what is still active counts as if the log ended now."""
        including = [activation for activation in activations if activation.uid in self._by_node]
        for activation in including:
            self._by_node[activation.uid].append(activation)
        try:
            yield
        finally:
            for activation in including:
                self._by_node[activation.uid].pop()

    def activations_of(self, uids: Sequence[int]) -> list[Activation]:
        """The activations of nodes, in the order of their starts."""
        activations = [activation for uid in uids for activation in self._by_node[uid]]
        return sorted(activations, key=_SHOWN) if len(uids) > 1 else activations

    def runs(self, uid: int, moment: Moment, is_early: bool) -> bool | UnknownValue:
        """Whether a node is active at a moment, from its start to the row of its end.

        Args:
            is_early: it started as early as it may have, not as late.
        """
        kept = self._by_node[uid]
        index = bisect_right(kept, moment, key=lambda activation: activation.begun(is_early)) - 1
        if index < 0 or moment > kept[index].ended:
            return False
        is_known = kept[index].timing != "latest" or moment == kept[index].begun(is_early)
        return True if is_known else UnknownValue(UNKNOWN_END)

    def clear(self) -> None:
        """Forget the run, which has ended."""
        for kept in self._by_node.values():
            kept.clear()


class Nearby:
    """The nodes that a clause names, resolved relative to its own node."""

    def __init__(self, uid: int, joined: Joined, history: History) -> None:
        """Resolve nothing yet; `uid`: of the clause's node; the root's if it has none."""
        self._uid: Final = uid
        self._joined: Final = joined
        self._history: Final = history
        self._uids: Final[dict[NodeTarget, tuple[int, ...] | UnknownValue]] = {}
        self._beside: Final[dict[int, Nearby]] = {}

    def find(self, target: NodeTarget) -> tuple[int, ...] | UnknownValue:
        """The instances of a node, whose activations are kept from now on."""
        instances = self._joined.instances(target)
        lost = next((path for path, uid in instances if uid is None), None)
        uids: tuple[int, ...] | UnknownValue
        if lost is not None:
            uids = UnknownValue(self._joined.lost(lost))
        else:
            uids = near(self._uid, [uid for _, uid in instances if uid is not None], self._joined.tree)
            self._history.watch(uids)
        self._uids[target] = uids
        return uids

    def beside(self, uid: int) -> Nearby:
        """The same nodes, relative to another of the clause's own."""
        if uid == self._uid:
            return self
        if uid not in self._beside:
            self._beside[uid] = Nearby(uid, self._joined, self._history)
            for target in self._uids:
                self._beside[uid].find(target)
        return self._beside[uid]

    def activations(self, target: NodeTarget) -> list[Activation]:
        """The activations of a node in the run, in the order of their starts."""
        uids = self._uids[target]
        return [] if isinstance(uids, UnknownValue) else self._history.activations_of(uids)

    def of(self, target: NodeTarget, activations: Iterable[Activation]) -> list[Activation]:
        """Those activations that are of any instance of a node."""
        uids = {uid for _, uid in self._joined.instances(target)}
        return [activation for activation in activations if activation.uid in uids]

    def are_begins_known(self) -> bool:
        """Whether the log says when all of these nodes began in the run."""
        all_uids = (uids for uids in self._uids.values() if not isinstance(uids, UnknownValue))
        return all(activation.is_begin_known for uids in all_uids for activation in self._history.activations_of(uids))

    def runs(self, target: NodeTarget, moment: Moment, is_early: bool) -> bool | UnknownValue:
        """Whether a node runs; `is_early`: as in `History.runs`."""
        uids = self._uids[target]
        if isinstance(uids, UnknownValue):
            return uids
        running = [self._history.runs(uid, moment, is_early) for uid in uids]
        return True in running or next((state for state in running if isinstance(state, UnknownValue)), False)


def near(uid: int, others: Sequence[int], tree: LoggedTree) -> tuple[int, ...]:
    """Those of the other nodes in the innermost tree around a node that contains any of them."""
    while others:
        uid = _use_around(uid, tree)
        inside = tuple(other for other in others if not uid or uid <= other <= tree.last[uid])
        if inside:
            return inside
    return ()


def _use_around(uid: int, tree: LoggedTree) -> int:
    """The SubTree node that a node is inside of, by the prefix of its path; 0 in the main tree."""
    path = tree.nodes[uid].path
    return next((above for above in tree.above(uid) if path.startswith(f"{tree.nodes[above].path}/")), 0)


_SHOWN: Final = attrgetter("shown")
