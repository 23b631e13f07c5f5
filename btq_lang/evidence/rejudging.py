"""Judges a clause again after its bound or its odds have been edited, by the counts that were kept."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.clause_findings import verdict_of
from btq_lang.evidence.edges import Edge, edge_of, key_of
from btq_lang.evidence.identity import without_number
from btq_lang.evidence.margins import Counts
from btq_lang.evidence.outline import Demand, demands
from btq_lang.evidence.scopes import within
from btq_lang.evidence.tally import Tally
from btq_lang.evidence.verdicts import (
    SATISFIED,
    UNKNOWN,
    VIOLATED,
    ClauseVerdict,
    Measures,
    RequirementVerdict,
    RunValue,
    Worst,
)
from btq_lang.evidence.wording import measured
from btq_lang.requirements.model import NodeTarget
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from btq_lang.requirements.model import Subject
    from btq_lang.requirements.resolve import Requirements


class Shown(Record):
    """A clause of the present text with its verdict.

    Attributes:
        verdict: None: the logs were not judged by this clause, but by an earlier one.
        least: with the bound inside of a step of the margins, how many are violated at least; else how many are.
    """

    demand: Demand
    verdict: ClauseVerdict | None
    least: int = 0


def shown_now(requirements: Requirements, judged: Iterable[RequirementVerdict]) -> Iterator[Shown]:
    """The clauses of the present text, each with its verdict.

    Args:
        judged: those on an earlier text; one without measures only counts for a clause that is the same, at a node with
            the same name.
    """
    verdicts = [(requirement.id, clause) for requirement in judged for clause in requirement.clauses]
    by_place = grouped(
        ((name, clause.measures.key, clause.measures.place), clause)
        for name, clause in verdicts
        if clause.measures is not None
    )
    by_text = grouped(((name, clause.text), clause) for name, clause in verdicts if clause.measures is None)
    for demand in demands(requirements):
        name, subject = demand.requirement.name, demand.subject
        edge = edge_of(within(demand.claim, demand.requirement.scopes), subject, demand.requirement)  # as it was judged
        # Several of a requirement with arguments may be at one node: they are in one order.
        if clauses := by_place.get((name, key_of(demand.requirement, demand.claim, edge), demand.place)):
            yield _again(demand, clauses.pop(0), edge)
            continue
        alike = by_text.get((name, demand.text), [])
        index = next((index for index, clause in enumerate(alike) if _is_named(clause, subject)), None)
        yield Shown(demand, None) if index is None else Shown(demand, alike[index], alike.pop(index).violated)


def _is_named(clause: ClauseVerdict, subject: Subject | None) -> bool:
    """Whether a clause was judged at a node with the name of the subject; true if the subject is not a single node."""
    if not isinstance(subject, NodeTarget):
        return True
    name, kind, head = subject.node.node.name, subject.node.kind, subject.node.node.head
    subject_name = name.text if name is not None else kind.tag if kind is not None else head.text
    paths = (_PLACE.sub("", path) for path in clause.path.split(", "))
    return any(without_number(path.rpartition("/")[2]) == subject_name for path in paths)


_PLACE: Final = re.compile(r" \(\d+ of \d+\)$")  # as in `rows.node_names`


def _again(demand: Demand, clause: ClauseVerdict, edge: Edge | None) -> Shown:
    measures = clause.measures
    assert measures is not None, "only clauses with measures are looked up"
    odds, confidence = demand.requirement.odds, demand.requirement.confidence
    is_same_bound = (edge.value.si if edge is not None else None) == measures.bound
    odds_now = (odds.relation, odds.probability) if odds is not None else None
    if is_same_bound and (odds_now, confidence) == (measures.odds, clause.confidence):
        return Shown(demand, clause, clause.violated)
    is_pooled = clause.pooled is not None
    if is_pooled or demand.requirement.window is not None or (not is_same_bound and measures.margins is None):
        return Shown(demand, None)
    if is_same_bound or edge is None or measures.margins is None:
        return Shown(demand, _with_counts(demand, clause, measures, None), clause.violated)
    least, most = measures.margins.counts(edge.value.si, edge)
    worst = measures.margins.worst(edge.value.si, edge)
    text = measured(worst[0], edge.value.unit, edge.value.si) if worst is not None else ""
    by_run = tuple(_moved(value, edge) for value in clause.by_run)
    clause = replace(clause, worst=Worst(worst[0], text, worst[1]) if worst is not None else None, by_run=by_run)
    verdicts = [_with_counts(demand, clause, measures, counts) for counts in (least, most)]
    if verdicts[0].verdict != verdicts[1].verdict:
        return Shown(demand, None)
    return Shown(demand, verdicts[1], least.violated)


def _moved(value: RunValue, edge: Edge) -> RunValue:
    """The value of a run with another bound."""
    if value.si is None:
        return value
    verdict = VIOLATED if edge.is_broken_by(value.si) else UNKNOWN if value.verdict == UNKNOWN else SATISFIED
    return replace(value, verdict=verdict)


def _with_counts(demand: Demand, clause: ClauseVerdict, measures: Measures, counts: Counts | None) -> ClauseVerdict:
    """The clause as its requirement demands it now, with other counts."""
    requirement = demand.requirement
    tally = Tally(requirement.odds, requirement.confidence, clause.limits)
    tally.worst, tally.why = clause.worst, clause.why
    tally.by_run.extend(clause.by_run)
    if counts is None:
        tally.violations.extend(clause.violations)
        counts = Counts(clause.counted - clause.violated, clause.violated, clause.unknown, clause.cut_off)
    kept, tally.violated, tally.unknown, tally.cut_off = counts
    tally.counted = kept + tally.violated
    verdict, why = verdict_of(tally, measures.missing, measures.has_run)
    return replace(clause, verdict=verdict, why=why, confidence=requirement.confidence, **tally.fields())
