"""The changes in the verdicts on requirements between two sides of a store.

One invariant: a clause whose bound was edited says nothing about the robot, so no verdict on it counts as a change.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Final, TypeAlias

from btq_lang.evidence.store.queries import Ask, only
from btq_lang.evidence.store.summary import summary
from btq_lang.evidence.store.tables import quoted
from btq_lang.evidence.verdicts import OPEN, VIOLATED, ClauseVerdict, RequirementVerdict, worst_of
from btq_lang.util.record import Record

Verdicts: TypeAlias = Mapping[str, RequirementVerdict]  # of a mission, by requirement


class Newly(Record):
    """A requirement that only one side violates.

    Attributes:
        before, after: the verdict of each side.
        violated, counted: how many judgements of each side are violations, and how many count.
        p: how likely it is by chance that so many more runs of a side are violations, after Holm; None where only one
            side has judgements to compare.
        may_be_chance: whether chance may explain it.
        pooled: what all runs of each side come to, if a failure rate or a mean is what is violated; else None.
        clause, node: that demand it; else empty.
    """

    id: str
    title: str
    before: str
    after: str
    violated: tuple[int, int]
    counted: tuple[int, int]
    p: float | None
    may_be_chance: bool
    pooled: tuple[str, str] | None = None
    clause: str = ""
    node: str = ""


class Edited(Record):
    """A clause that has another bound, or other odds, on each side.

    Attributes:
        before, after: the clause of each side.
        violated, counted: as in `Newly`, each side by its own clause.
    """

    requirement: str
    node: str
    before: str
    after: str
    violated: tuple[int, int]
    counted: tuple[int, int]


def verdicts(ask: Ask, by: str, side: str) -> Mapping[str, Verdicts]:
    """The verdicts of a side that come from its runs, by mission."""
    missions = summary(only(ask, f"{by} = {quoted(side)}"), "").missions
    return {
        mission.name: {
            requirement.id: requirement for requirement in mission.requirements if requirement.verdict != OPEN
        }
        for mission in missions
    }


def edited(before: Verdicts, after: Verdicts) -> tuple[Edited, ...]:
    """The clauses of a mission that differ in their numbers only, at the same nodes."""
    edits = []
    for name in before.keys() & after.keys():
        texts = [{(clause.path, clause.text) for clause in side[name].clauses} for side in (before, after)]
        old = {
            (clause.path, _without_numbers(clause)): clause
            for clause in before[name].clauses
            if (clause.path, clause.text) not in texts[1]
        }
        for clause in after[name].clauses:
            key = clause.path, _without_numbers(clause)
            if (clause.path, clause.text) not in texts[0] and key in old:
                was = old.pop(key)
                counts = (was.violated, clause.violated), (was.counted, clause.counted)
                edits.append(Edited(name, clause.path, was.text, clause.text, *counts))
    return tuple(sorted(edits, key=lambda edit: (edit.requirement, edit.node)))


def turned(before: Verdicts, after: Verdicts, edits: Sequence[Edited]) -> list[Newly]:
    """The requirements of a mission that only one side violates, by clauses that were not edited."""
    old = {(edit.requirement, edit.node, edit.before) for edit in edits}
    new = {(edit.requirement, edit.node, edit.after) for edit in edits}
    requirements = []
    for name in {**after, **before}:
        pair = [
            [clause for clause in side[name].clauses if (name, clause.path, clause.text) not in edited_clauses]
            if name in side
            else None
            for side, edited_clauses in ((before, old), (after, new))
        ]
        first, second = (worst_of(clause.verdict for clause in clauses) if clauses else _NOT_JUDGED for clauses in pair)
        if (first == VIOLATED) != (second == VIOLATED):
            title = (after.get(name) or before[name]).title
            violated, counts = (
                [sum(getattr(clause, what) for clause in clauses or ()) for clauses in pair]
                for what in ("violated", "counted")
            )
            numbers = (violated[0], violated[1]), (counts[0], counts[1])
            pooled = _pooled(pair[0] or (), pair[1] or ()) if not any(violated) else ()
            requirements.append(Newly(name, title, first, second, *numbers, None, False, *pooled))
    return requirements


def _pooled(
    before: Sequence[ClauseVerdict], after: Sequence[ClauseVerdict]
) -> tuple[()] | tuple[tuple[str, str], str, str]:
    """What both sides come to in the first clause about all runs together that only one violates; and the clause."""
    of_after = {(clause.path, clause.text): clause for clause in after}
    for was in before:
        now = of_after.get((was.path, was.text))
        if now is None or was.pooled is None or now.pooled is None:
            continue
        if (was.verdict == VIOLATED) != (now.verdict == VIOLATED):
            # Whether more time decides it says nothing beside the other side.
            texts = (clause.text.partition(", ")[0] for clause in (was.pooled, now.pooled))
            return (next(texts), next(texts)), was.text, was.path
    return ()


def _without_numbers(clause: ClauseVerdict) -> str:
    return _QUANTITY.sub("…", clause.text)


_QUANTITY: Final = re.compile(r"\d[\d.]* ?(?:%|[^\W\d][\w/]*)?")  # a number with its unit, or the next word
_NOT_JUDGED: Final = "not judged"
