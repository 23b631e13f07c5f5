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

    Moment = tuple[int, float]  # time and row; -1: before all rows of that time; a half: after the row


@dataclass
class Activation:
    """A node from its start to its end.

    Attributes:
        first, last: the rows that it begins and ends with, by their index.
        shown: its first row.
        start: when it began, as it is judged: its earliest, or its latest begin.
        outcome: S, F, H, or O for one that is open when its log, or its run, is cut off.
        is_exact: the log says when it ended, and not only by when.
        run: the index of its run.
    """

    uid: int
    first: int
    last: int
    shown: Moment
    start: Moment
    stop: Moment
    outcome: str
    is_exact: bool
    run: int = -1
    earliest: Moment = (0, -1)
    latest: Moment = (0, -1)

    def placed(self, by_rows: bool) -> Moment:
        """Its begin where it is asked what came before what: rows tell that of nodes, times tell it of samples."""
        return self.shown if by_rows else self.start

    @property
    def begin(self) -> int:
        return self.start[0]

    @property
    def end(self) -> int:
        return self.stop[0]


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
                shown = (rows[opened][0], opened)
                found.append(Activation(uid, opened, last, shown, shown, (end, last), outcome, is_exact))
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
            shown = (rows[min(opened, len(rows) - 1)][0], opened)
            found.append(Activation(uid, opened, len(rows) - 1, shown, shown, (rows[-1][0], len(rows) - 1), "O", True))
            closed.append(since)
    for each, since in zip(found, closed, strict=True):
        below = range(each.uid + 1, tree.last[each.uid] + 1)
        earlier = [index for uid in below for index in starts[uid] if since < index < each.first]
        if earlier:
            each.first = min(earlier)
            each.shown = (rows[each.first][0], each.first)
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
