"""Answers to questions about what can happen in a mission.

One invariant: *no* is only said when every state was seen, with leaves that run on wherever that can matter; *yes* has
a witness, which the model has made again.  Where counting attempts takes more states than are allowed, a search without
counts may still say no: more can happen in it than in the engine.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Literal, TypeAlias

from btq_lang.exploration.missions import ExploredMission
from btq_lang.exploration.opened import Opened, Watch
from btq_lang.exploration.outcomes import UNKNOWN
from btq_lang.exploration.questions import EndlessRun, Question
from btq_lang.exploration.resuming import last_count
from btq_lang.exploration.running import may_run
from btq_lang.exploration.search import Search, SearchBudget
from btq_lang.exploration.watching import Asking
from btq_lang.exploration.witness import Tick, replay
from btq_lang.util.record import Record

Word: TypeAlias = "Literal['yes', 'no', 'not found']"


class Answer(Record):
    """What a search has shown.

    Attributes:
        word: yes; no, in all states; or not found in those that were seen.
        states: how many were seen.
        witness: for yes, the ticks of a shortest run, without those of a circle.
        circle: the ticks that a run can repeat without an end, if that was asked.
        is_assumed: the witness takes a value calculated from unknown ones to be something, which it may not be.
        unknown: what is not known of the tree, so that not all was seen.
        is_counted: attempts and cycles were counted; else the answer holds for any number of them.
    """

    word: Word
    states: int
    witness: tuple[Tick, ...] = ()
    circle: tuple[Tick, ...] = ()
    is_assumed: bool = False
    unknown: tuple[str, ...] = ()
    is_counted: bool = True


def answered(mission: ExploredMission, question: Question, budget: SearchBudget) -> Answer:
    """The answer to a question.

    Raises:
        NotExplored: the tree cannot be explored.
        Unasked: the question names what the tree does not have.
    """
    opened = mission.open(question.keys)
    asking = Asking(question, opened.snapshots, mission.uids)
    opened.snapshots.tracked = tuple(asking.tracked.values())
    return answered_by(opened, asking, asking.tracked, budget, isinstance(question.asked, EndlessRun))


def answered_by(
    opened: Opened, watch: Watch, tracked: Collection[int], budget: SearchBudget, is_circle: bool = False
) -> Answer:
    """The answer that a watch gives, first with leaves that end at once, and then with leaves that run on.

    Args:
        tracked: the numbers of the nodes whose statuses it asks for at any time.
        is_circle: what is asked is whether the mission need not end.
    """
    running = full_runs(opened, tracked)
    states = 0
    for leaves in (frozenset[int](), running):
        opened.begin(watch, leaves)
        search = Search(opened.snapshots, budget, keeps_edges=is_circle).run()
        states = search.states
        witness = search.circle(leaves) if is_circle else search.way
        if witness is not None:
            ways, circle = witness if isinstance(witness, tuple) else (witness, ())
            opened.snapshots.has_assumed = False
            ticks = replay(opened, watch, leaves, [*ways, *circle])
            return Answer("yes", states, ticks[: len(ways)], ticks[len(ways) :], opened.snapshots.has_assumed)
        if leaves == running:
            unknown = tuple([end.message for end in search.ends if end.result == UNKNOWN])
            if search.is_closed:
                return Answer("no", states)
            if not (unknown or is_circle) and (rough := without_counts(opened, watch, leaves, budget)) is not None:
                return Answer("no", rough.states, is_counted=False)
            return Answer("not found", states, unknown=unknown)
    raise AssertionError("the last pass has an answer")


def without_counts(opened: Opened, watch: Watch, leaves: frozenset[int], budget: SearchBudget) -> Search | None:
    """A search of all states in which each attempt and each cycle may be the last; None: what is asked was found in
    it, it was cut off, or the tree has no counts."""
    if not any(map(last_count, opened.machine.nodes)):
        return None
    opened.begin(watch, leaves)
    search = Search(opened.snapshots, budget, counts=False).run()
    return search if search.is_closed and search.way is None else None


def full_runs(opened: Opened, asked: Collection[int] = ()) -> frozenset[int]:
    """The leaves that may run on in a search that can say no."""
    conditions = frozenset([name for name, kind in opened.leaves.kinds.items() if kind.is_condition])
    custom = {node.uid for node in opened.custom}
    return may_run(opened.machine.root, conditions, frozenset(asked)) & custom
