"""What logs show of requirements, for their boxes in a drawing: the last run's value, the verdict, and the history.

The box is the run-time stage of Ghzouli, Wohlrab and Horkoff (REFSQ 2025), figure 3.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.evidence.edges import edge_of
from btq_lang.evidence.rejudging import shown_now
from btq_lang.evidence.verdicts import SATISFIED, UNKNOWN, VIOLATED, ClauseVerdict
from btq_lang.evidence.wording import measured
from btq_lang.graph.figure import MeasuredClause
from btq_lang.requirements.model import Quantity
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.outline import Demand
    from btq_lang.evidence.rejudging import Shown
    from btq_lang.evidence.verdicts import RequirementVerdict
    from btq_lang.graph.missions import MeasuredBy
    from btq_lang.requirements.applied import Applied
    from btq_lang.requirements.resolve import Requirements

    _Key: TypeAlias = tuple[str, str, int | str]


def measured_by(requirements: Requirements, verdicts: Iterable[RequirementVerdict]) -> MeasuredBy:
    """A function that gives what logs show of a requirement at what it applies to.

    Args:
        requirements: of the present text of the mission that the verdicts are on.
    """
    return measured_of(shown_now(requirements, verdicts))


def measured_of(shown: Iterable[Shown]) -> MeasuredBy:
    """The same, from clauses of the present text with their verdicts."""
    by_key = grouped(
        (_key(present.demand.applied), (present.demand, present.verdict))
        for present in shown
        if present.demand.applied is not None and present.verdict is not None
    )

    def measured_at(applied: Applied) -> tuple[MeasuredClause, ...]:
        clauses = by_key.get(_key(applied), [])
        return tuple(_measured(demand, clause, is_named=len(clauses) > 1) for demand, clause in clauses)

    return measured_at


def _measured(demand: Demand, clause: ClauseVerdict, is_named: bool) -> MeasuredClause:
    """What logs show of a clause; is_named: its text is among the lines."""
    bounds, by_run = _bounds(demand), clause.by_run

    def shown(si: float | None) -> str:
        return measured(si, bounds[0].unit, bounds[0].si) if si is not None and bounds else ""

    lines = [demand.claim.text] if is_named else []
    if by_run and (by_run[-1].si is not None or by_run[-1].verdict != UNKNOWN):
        lines.append(f"last run: {', '.join(filter(None, (shown(by_run[-1].si), by_run[-1].verdict)))}")
    lines.append(_standing(clause))
    history = f"{counted(len(by_run), 'run')}, {sum(value.verdict == VIOLATED for value in by_run)} violated"
    numbers = [value.si for value in by_run if value.si is not None]
    if numbers and bounds:
        history += f", from {shown(min(numbers))} to {shown(max(numbers))}"
    return MeasuredClause(
        tuple(lines),
        clause.verdict.replace(" ", "-"),
        # Where nothing is measured, whether it held.
        tuple((value.si if numbers else _HELD.get(value.verdict), value.verdict == VIOLATED) for value in by_run),
        tuple(bound.si for bound in bounds),
        "; ".join((*lines, history)),
    )


def _standing(clause: ClauseVerdict) -> str:
    """The verdict, with how many judgements are violations, and how many are unknown."""
    unknown = [f"{clause.unknown:,} unknown"] if clause.unknown else []
    counts = [f"{clause.violated:,} of {clause.counted:,} broke it"] if clause.counted else []
    return ": ".join(filter(None, (clause.verdict, ", ".join(counts + unknown))))


def _bounds(demand: Demand) -> tuple[Quantity, ...]:
    """The bounds of a clause that are numbers."""
    limit = demand.claim.limit
    if limit is not None:
        return tuple(bound for bound in (limit.value, limit.upper) if isinstance(bound, Quantity))
    edge = edge_of(demand.claim, demand.subject, demand.requirement)
    return (edge.value,) if edge is not None else ()


def _key(applied: Applied) -> _Key:
    """The key of a requirement at a node, the same in all missions that have the node."""
    where = id(applied.node.node) if applied.node is not None else applied.requirement.claims[0].text
    return applied.requirement.name, applied.argument_list, where


_HELD: Final = {SATISFIED: 1.0, VIOLATED: 0.0}
