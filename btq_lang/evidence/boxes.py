"""What logs show of requirements, for their boxes in a drawing: the last run's value, the verdict, and the history.

The box is the run-time stage of Ghzouli, Wohlrab and Horkoff (REFSQ 2025), figure 3.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.evidence.edges import edge_of
from btq_lang.evidence.rejudging import shown_now
from btq_lang.evidence.verdicts import SATISFIED, UNKNOWN, VIOLATED, ClauseVerdict
from btq_lang.graph.figure import Measured
from btq_lang.requirements.model import Value
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.outline import Demand
    from btq_lang.evidence.rejudging import Shown
    from btq_lang.evidence.verdicts import RequirementVerdict
    from btq_lang.graph.missions import MeasuredBy
    from btq_lang.requirements.model import Applied
    from btq_lang.requirements.resolve import Requirements

    _Key: TypeAlias = tuple[str, str, int | str]


def measured_by(found: Requirements, verdicts: Iterable[RequirementVerdict]) -> MeasuredBy:
    """A function from a requirement at what it applies to, to what logs show of it there.

    Args:
        found: of the present text of the mission that the verdicts are on.
    """
    return measured_of(shown_now(found, verdicts))


def measured_of(shown: Iterable[Shown]) -> MeasuredBy:
    """The same, from clauses of the present text with their verdicts."""
    judged = ((each.demand.applied, each.demand, each.verdict) for each in shown)
    by_key = grouped(
        (_key(applied), (demand, verdict))
        for applied, demand, verdict in judged
        if applied is not None and verdict is not None
    )
    return lambda applied: tuple(_measured(by_key.get(_key(applied), ())))


def _measured(clauses: Iterable[tuple[Demand, ClauseVerdict]]) -> Iterator[Measured]:
    clauses = [*clauses]
    for demand, clause in clauses:
        lines = (*([demand.claim.text] if len(clauses) > 1 else []), *_last(clause), _standing(clause))
        values = tuple((value.si, value.verdict == VIOLATED) for value in clause.by_run)
        if all(value is None for value, _ in values):  # nothing is measured: whether it held
            states = (value.verdict for value in clause.by_run)
            values = tuple((_HELD.get(state), state == VIOLATED) for state in states)
        text = "; ".join(filter(None, (*lines, _history(clause))))
        yield Measured(lines, clause.verdict.replace(" ", "-"), values, _bounds(demand), text)


def _last(clause: ClauseVerdict) -> Iterator[str]:
    """What the last run shows, if anything."""
    last = clause.by_run[-1] if clause.by_run else None
    if last is not None and (last.text or last.verdict != UNKNOWN):
        yield f"last run: {', '.join(filter(None, (last.text, last.verdict)))}"


def _standing(clause: ClauseVerdict) -> str:
    """The verdict, with how many violations it counts."""
    if not clause.counted:
        return clause.verdict
    return f"{clause.verdict}: {clause.violated:,} of {clause.counted:,} broke it"


def _history(clause: ClauseVerdict) -> str:
    """The values of the runs in words."""
    measures = [(value.si, value.text) for value in clause.by_run if value.si is not None]
    if not measures:
        return ""
    broken = sum(value.verdict == VIOLATED for value in clause.by_run)
    (_, least), (_, most) = min(measures), max(measures)
    return f"{counted(len(clause.by_run), 'run')} from {least} to {most}, {broken} violated"


def _bounds(demand: Demand) -> tuple[float, ...]:
    """The bounds of a clause that are numbers, in SI."""
    limit = demand.claim.limit
    if limit is not None:
        return tuple(bound.si for bound in (limit.value, limit.upper) if isinstance(bound, Value))
    edge = edge_of(demand.claim, demand.applied.subject if demand.applied is not None else None, demand.requirement)
    return (edge.value.si,) if edge is not None else ()


def _key(applied: Applied) -> _Key:
    """What is the same in all missions that have the node."""
    where = id(applied.node.node) if applied.node is not None else applied.requirement.claims[0].text
    return applied.requirement.name, applied.given, where


_HELD: Final = {SATISFIED: 1.0, VIOLATED: 0.0, UNKNOWN: None}
