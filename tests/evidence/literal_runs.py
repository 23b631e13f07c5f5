"""Activations as the design of run-time evidence tells them, of a whole session at once: slow, and nothing is streamed.

What ends a node is found from the root downwards, for an end ends what is below; when a node began, which only rows
below it may tell, is found afterwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from btq_lang.evidence.model import FAILURE, IDLE, ROOT, RUNNING, SUCCESS, LoggedTree

if TYPE_CHECKING:
    from btq_lang.evidence.model import Transition

    Moment = tuple[int, int]  # time and row; -1: before all rows of that time


@dataclass
class Activation:
    """A node from its start to its end.

    Attributes:
        first, last: the rows that it begins and ends with, by their index.
        outcome: S, F, H, or O for one that is open when its log, or its run, is cut off.
        is_exact: the log says when it ended, and not only by when.
        run: the index of its run.
    """

    uid: int
    first: int
    last: int
    begin: int
    end: int
    outcome: str
    is_exact: bool
    run: int = -1

    @property
    def start(self) -> Moment:
        """Its first row; rows of one time have an order."""
        return self.begin, self.first

    @property
    def stop(self) -> Moment:
        """Its last row."""
        return self.end, self.last


def activations(tree: LoggedTree, rows: Sequence[Transition]) -> list[Activation]:
    """All of a session, in the order in which they begin; those of the root are the runs."""
    found: list[Activation] = []
    starts: dict[int, list[int]] = {}  # by node: the rows that open it
    ends: dict[int, dict[int, str]] = {0: {}}  # by node: the rows that end it, and what they make of what is below
    closed: list[int] = []  # by what is found: the last row before it that closes its node
    for uid in tree.nodes:  # parents come before their children
        above = ends[tree.parent[uid]]
        starts[uid], ends[uid] = [], dict(above)
        opened, since = None, -1
        for index, (time, of, status) in enumerate(rows):
            if of != uid and index not in above:
                continue
            if of == uid and opened is None and status in (RUNNING, SUCCESS, FAILURE):
                starts[uid].append(index)
                opened = index
                if status == RUNNING:
                    continue
            if opened is not None:
                if of == uid and _completes(rows, index):
                    continue
                outcome, is_exact, last, end = above.get(index, "H"), of == uid and status != RUNNING, index, time
                if of == uid == ROOT and status == RUNNING:
                    outcome = "O"
                elif of == uid and status in (SUCCESS, FAILURE):
                    outcome = "S" if status == SUCCESS else "F"
                if outcome == "O":
                    is_exact, last, end = True, index - 1, rows[index - 1][0]
                found.append(Activation(uid, opened, last, rows[opened][0], end, outcome, is_exact))
                closed.append(since)
                ends[uid][index] = "O" if outcome == "O" else "H"
                opened = None
            since = index
            if of == uid and status == RUNNING:
                starts[uid].append(index)
                opened = index
        if opened is None and uid == ROOT:
            opened = len(rows)  # it may have begun with a row below it
        if opened is not None and rows:
            begin = rows[min(opened, len(rows) - 1)][0]
            found.append(Activation(uid, opened, len(rows) - 1, begin, rows[-1][0], "O", True))
            closed.append(since)
    for each, since in zip(found, closed, strict=True):
        below = range(each.uid + 1, tree.last[each.uid] + 1)
        earlier = [index for uid in below for index in starts[uid] if since < index < each.first]
        if earlier:
            each.first = min(earlier)
            each.begin = rows[each.first][0]
    found = [each for each in found if each.first < len(rows)]
    runs = sorted((each for each in found if each.uid == ROOT), key=lambda each: each.first)
    for each in found:
        each.run = max(number for number, run in enumerate(runs) if run.first <= each.first)
    return sorted(found, key=lambda each: (each.first, each.uid))


def _completes(rows: Sequence[Transition], index: int) -> bool:
    """Whether a row to IDLE belongs to its node's own completion: the next row is the result, within 1 ms."""
    time, uid, status = rows[index]
    if status != IDLE or index + 1 == len(rows):
        return False
    after, of, result = rows[index + 1]
    return of == uid and result in (SUCCESS, FAILURE) and after - time <= 1000
