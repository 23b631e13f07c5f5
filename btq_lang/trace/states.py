"""The state of a requirement in one word: its verdict, unless it is not violated and its approval is outdated.

One invariant: every state has a sign of its own, so that colour is never the only difference.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.verdicts import NEVER, OPEN, SATISFIED, UNDECIDED, UNKNOWN, VIOLATED, WORST_FIRST

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import Verdict
    from btq_lang.graph.figure import Note
    from btq_lang.trace.overview import RequirementRow

SUSPECT: Final = "suspect"
NOT_JUDGED: Final = "not judged"
# The worst first.
SIGNS: Final = {
    VIOLATED: "\N{HEAVY MULTIPLICATION X}",
    SUSPECT: "!",
    UNKNOWN: "?",
    UNDECIDED: "~",
    NOT_JUDGED: "\N{WHITE SQUARE}",
    NEVER: "\N{EMPTY SET}",
    OPEN: "\N{WHITE CIRCLE}",
    SATISFIED: "\N{HEAVY CHECK MARK}",
}
IN_SENTENCES: Final = (SATISFIED, VIOLATED, UNKNOWN, UNDECIDED, NEVER, OPEN, SUSPECT, NOT_JUDGED)


def state_of_row(row: RequirementRow, verdict: Verdict | None = None) -> str:
    """The state of a requirement; verdict: at one of its nodes, else the worst of all."""
    verdict = verdict or row.verdict
    if row.state == SUSPECT and verdict != VIOLATED:
        return SUSPECT
    return verdict or NOT_JUDGED


def state_at(row: RequirementRow, note: Note, is_measured: bool) -> str:
    """The state of a requirement at a node.

    Args:
        note: of the requirement there.
        is_measured: logs show it at some node, so that it is not judged where its note has nothing of that.
    """
    classes = {measured.verdict for measured in note.measured}
    verdict = next((verdict for verdict in WORST_FIRST if class_of(verdict) in classes), None)
    is_link = not note.text  # the requirement names its nodes itself
    state = state_of_row(row, verdict)
    return state if verdict is not None or is_link or not is_measured or state == SUSPECT else NOT_JUDGED


def worst_state(states: Iterable[str]) -> str:
    """The worst of several; empty if there are none."""
    return min(states, key=list(SIGNS).index, default="")


def counted_states(states: Iterable[str]) -> list[tuple[str, int]]:
    """How often each state occurs, without those that do not."""
    numbers = Counter(states)
    return [(state, numbers[state]) for state in IN_SENTENCES if numbers[state]]


def class_of(state: str) -> str:
    """The class that a state has on a page."""
    return state.replace(" ", "-")


def box_class(state: str) -> str:
    """The class that a box or a note in a drawing has: `unknown` alone is that of a node without a model."""
    return f"is-{class_of(state)}"
