"""Measures how long the `tick()` of a leaf takes, which blocks the whole tree.

One invariant: only rows of one tick are compared.  When a leaf writes its first row right after its parent has begun,
or after a sibling before it has completed, nothing else ran in between.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from btq_lang.evidence.model import FAILURE, RUNNING, SUCCESS, Session

if TYPE_CHECKING:
    from btq_lang.evidence.model import Transition


def timed(session: Session, took: Callable[[int, int], None]) -> Session:
    """The session, with transitions that report ticks of leaves as they are read: the uid, and how many µs it took."""
    return Session(session.tree, _timed(session, took), session.samples, session.remarks)


def _timed(session: Session, took: Callable[[int, int], None]) -> Iterator[Transition]:
    tree = session.tree
    parent = tree.parent
    running: set[int] = set()
    before, uid_before, status_before = 0, 0, RUNNING
    for row in session.transitions:
        time, uid, status = row
        if uid in tree.leaves:
            if uid not in running and status in _ANSWERS and time >= before:
                above = parent[uid]
                is_sibling = parent.get(uid_before) == above and uid_before < uid
                if (is_sibling and status_before in _RESULTS) or (uid_before == above and status_before == RUNNING):
                    took(uid, time - before)
            if status == RUNNING:
                running.add(uid)
            else:
                running.discard(uid)
        before, uid_before, status_before = row
        yield row


_RESULTS = (SUCCESS, FAILURE)
_ANSWERS = (RUNNING, SUCCESS, FAILURE)
