"""What the nodes that a build puts around others write in a log: as the engine would, but when one of them stops a node
or refuses its start is drawn, whatever their conditions say.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from btq_lang.evidence.model import FAILURE, IDLE, RUNNING, SUCCESS, LoggedTree

if TYPE_CHECKING:
    from btq_lang.evidence.model import Transition


class Guarded:
    """The rows of a tree with guards, made of those of the tree as it is written."""

    def __init__(self, tree: LoggedTree, guards: Mapping[int, str], chance: random.Random) -> None:
        """
        Args:
            tree: with guards.
            guards: the nodes that a build has put there, with the requirement of each, `*` if it is of several.
        """
        self.tree = tree
        self.guards = guards
        self.chance = chance
        self.written = [uid for uid in tree.nodes if uid not in guards]  # by their number in the written tree
        self.status = dict.fromkeys(tree.nodes, IDLE)
        self.gone: set[int] = set()  # written nodes whose rows are left out until they close
        self.rows: list[Transition] = []
        self.time = 0

    def of(self, rows: Sequence[Transition]) -> list[Transition]:
        """The rows of the guarded tree."""
        for time, number, status in rows:
            self.time = time
            self.row(self.written[number - 1], status)
        return self.rows

    def row(self, uid: int, status: int) -> None:
        """A row of a written node."""
        if any(self.is_below(uid, each) for each in self.gone if each != uid):
            return
        if uid in self.gone:
            if status != RUNNING:
                self.gone.discard(uid)
            return
        self.stop_some()
        if uid in self.gone or any(self.is_below(uid, each) for each in self.gone):
            return self.row(uid, status)
        around = self.around(uid)
        if status != IDLE and self.status[uid] != RUNNING and not self.open(around, self.begin(uid)):
            if status == RUNNING:
                self.gone.add(uid)
            return None
        self.write(uid, status)
        for guard in around if status != RUNNING else ():
            if self.status[guard] == RUNNING:
                status = self.after(guard, status)
                self.close(guard, status)
        return None

    def begin(self, uid: int) -> int:
        """When a node began that writes its first row now: with its parent, if that has begun with the row before."""
        if not self.rows or self.rows[-1][1] not in self.tree.above(uid) or self.rows[-1][2] != RUNNING:
            return self.time
        return self.time if self.tree.nodes[self.rows[-1][1]].kind == "Delay" else self.rows[-1][0]

    def open(self, around: Sequence[int], time: int) -> bool:
        """Start the guards around a node, from outside in; whether none refuses it."""
        now, self.time = self.time, time
        try:
            return self.start(around)
        finally:
            self.time = now

    def start(self, around: Sequence[int]) -> bool:
        for index, guard in enumerate(reversed(around)):
            if self.status[guard] == RUNNING:
                continue
            self.write(guard, RUNNING)
            for leaf in self.leaves(guard, before=True):
                may_refuse = self.guards[guard] != "*" and self.tree.nodes[leaf].kind == "ScriptCondition"
                refuses = may_refuse and self.chance.random() < 0.15
                self.write(leaf, FAILURE if refuses else SUCCESS)
                if refuses:
                    for each in around[len(around) - 1 - index :]:
                        self.close(each, FAILURE)
                    return False
        return True

    def after(self, guard: int, status: int) -> int:
        """What a guard comes to when the node in it has: a check that follows may fail."""
        for leaf in self.leaves(guard, before=False) if status == SUCCESS else ():
            status = SUCCESS if self.chance.random() < 0.8 else FAILURE
            self.write(leaf, status)
        return status

    def stop_some(self) -> None:
        """Let a guard stop the node in it now and then."""
        for guard in self.guards:
            kind = self.tree.nodes[guard].kind
            if (
                self.status[guard] != RUNNING
                or kind not in ("Timeout", "ReactiveSequence")
                or self.chance.random() > 0.03
            ):
                continue
            inside = next(uid for uid in range(guard, self.tree.last[guard] + 1) if uid not in self.guards)
            if self.status[inside] != RUNNING:
                continue
            for leaf in self.leaves(guard, before=True):
                self.write(leaf, FAILURE)
            for uid in range(self.tree.last[guard], guard, -1):
                self.write(uid, IDLE)
            self.gone = {each for each in self.gone if not self.is_below(each, inside)} | {inside}
            around = self.around(inside)
            for each in around[around.index(guard) :]:
                self.close(each, FAILURE)

    def close(self, guard: int, status: int) -> None:
        """A guard ends, and resets what is in it."""
        for uid in range(self.tree.last[guard], guard, -1):
            if self.tree.parent[uid] == guard:
                self.write(uid, IDLE)
        self.write(guard, status)

    def write(self, uid: int, status: int) -> None:
        if status != self.status[uid]:
            self.status[uid] = status
            self.rows.append((self.time, uid, status))

    def around(self, uid: int) -> list[int]:
        """The guards around a node, from inside out."""
        found = []
        while (uid := self.tree.parent[uid]) in self.guards:
            found.append(uid)
        return found

    def leaves(self, guard: int, *, before: bool) -> list[int]:
        """The children of a guard before, or after, the one that holds a written node."""
        children = [uid for uid in range(guard + 1, self.tree.last[guard] + 1) if self.tree.parent[uid] == guard]
        held = next(each for each in children if not {*range(each, self.tree.last[each] + 1)} <= {*self.guards})
        return [each for each in children if (each < held if before else each > held)]

    def is_below(self, uid: int, other: int) -> bool:
        return other < uid <= self.tree.last[other]
