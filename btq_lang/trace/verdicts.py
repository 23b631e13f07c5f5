"""Verdicts on the page: results of clauses, distributions of their measures, and the runs with the worst violations.

One invariant: every fact in a drawing is also in a text, and colour is never the only sign.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.folding import folded_sources
from btq_lang.evidence.node_rows import node_columns
from btq_lang.evidence.sentences import headline, reason, result
from btq_lang.evidence.verdicts import VIOLATED, WORST_FIRST
from btq_lang.evidence.wording import clock_time, duration
from btq_lang.trace.histogram import histogram
from btq_lang.trace.run_figure import Breach, run_figure
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.node_rows import Column
    from btq_lang.evidence.verdicts import (
        ClauseVerdict,
        MissionVerdicts,
        NodeSummary,
        RequirementVerdict,
        Violation,
    )
    from btq_lang.render.pages import PageData
    from btq_lang.trace.collect import BoxDetails


def verdicts(missions: Sequence[MissionVerdicts], keys: Mapping[str, str]) -> list[PageData]:
    """What the template shows of each mission; `keys`: of the requirements' rows on the page, by name."""
    return [_mission(mission, keys) for mission in missions]


def outcomes(missions: Sequence[MissionVerdicts]) -> BoxDetails:
    """A function from a node to further lines in its box, about its instances in the logs, and to the box's class."""
    nodes = (each for mission in missions for each in mission.nodes)
    by_node = grouped((id(each.written.node), each) for each in nodes if each.written is not None)
    return lambda source: _outcome(by_node.get(id(source.node), ()))


def _outcome(nodes: Sequence[NodeSummary]) -> tuple[tuple[str, ...], str]:
    """The lines of a box, and its class."""
    succeeded, failed = sum(each.succeeded for each in nodes), sum(each.failed for each in nodes)
    others = sum(each.halted + each.interrupted for each in nodes)
    if not succeeded + failed + others:
        return ("did not run",), "idle"
    lines = [f"{counted(succeeded + failed + others, 'start')}" + (f", {failed} failed" if failed else "")]
    if len(nodes) == 1 and nodes[0].p95 and nodes[0].p50 is not None:
        lines.append(f"p50 {duration(nodes[0].p50)}, p95 {duration(nodes[0].p95)}")
    return tuple(lines), "good" if not failed else "bad" if not succeeded else "mixed"


def _mission(mission: MissionVerdicts, keys: Mapping[str, str]) -> PageData:
    files = ", ".join(source.file for source in folded_sources(mission.sources))
    outcomes = ", ".join(f"{number} {outcome}" for outcome, number in mission.outcomes)
    clauses = [(requirement, clause) for requirement in mission.requirements for clause in requirement.clauses]
    clauses.sort(key=lambda each: WORST_FIRST.index(each[1].verdict))
    timelines = {clause.timeline.run: clause.timeline for _, clause in clauses if clause.timeline is not None}
    breaches = grouped(
        (violation.run, Breach(requirement.id, keys.get(requirement.id, ""), violation))
        for requirement, clause in clauses
        for violation in clause.violations
    )
    columns = node_columns(mission.nodes)
    return {
        "name": mission.name,
        "runs": f"{counted(mission.runs, 'run')} in {files}{': ' if outcomes else ''}{outcomes}",
        "clauses": [_clause(requirement, clause, mission, keys) for requirement, clause in clauses],
        "violating": [_violating(each.id, clause, mission.medians) for each, clause in clauses if clause.violations],
        "figures": [run_figure(timeline, breaches.get(run, ())) for run, timeline in timelines.items()],
        "nodes": [(node.path, _numbers(columns, place)) for place, node in enumerate(mission.nodes)],
        "node_heads": ("node", *(column.head for column in columns)),
        "node_count": counted(len(mission.nodes), "node"),
    }


def _clause(
    requirement: RequirementVerdict, clause: ClauseVerdict, mission: MissionVerdicts, keys: Mapping[str, str]
) -> PageData:
    return {
        "requirement": requirement,
        "clause": clause,
        "key": keys.get(requirement.id, ""),
        "result": result(clause),
        "headline": headline(clause, mission.medians) if clause.verdict == VIOLATED else "",
        "histogram": histogram(clause.histogram) if clause.histogram is not None else "",
    }


def _numbers(columns: Sequence[Column], place: int) -> list[tuple[str, str]]:
    """The cells of a node: each a text, and the value to sort by if the text is not just that."""
    cells = ((column.texts[place], column.values[place]) for column in columns)
    return [(text, "" if value is None or text == str(value) else f"{value:.9g}") for text, value in cells]


# ---- the runs that violate a clause ----


def _violating(requirement: str, clause: ClauseVerdict, medians: Mapping[str, float]) -> PageData:
    """A row for each violation that is kept: the first ones, and the others folded; all, if the clause's odds allow
    them.
    """
    drawn = clause.timeline.run if clause.timeline is not None else None
    rows = [_row(clause, violation, drawn, medians) for violation in clause.violations]
    shown = _SHOWN if clause.verdict == VIOLATED else 0
    rest = clause.violated - len(rows)
    caption = f"Runs that violate {requirement}: {clause.text}"
    more = counted(len(rows) - shown, "more violation" if shown else "violation")
    return {
        "caption": caption,
        "first": rows[:shown],
        "more": rows[shown:],
        "more_summary": f"{more} of {requirement}",
        "more_caption": f"{caption}, continued" if shown else caption,
        "not_listed": f"{counted(rest, 'violation')} more of {requirement} not listed." if rest > 0 else "",
    }


def _row(clause: ClauseVerdict, violation: Violation, drawn: int | None, medians: Mapping[str, float]) -> PageData:
    return {
        "run": f"{violation.run} of {violation.source}",
        "figure": f"run-{violation.run}" if violation.run == drawn else "",
        "Time": f"{duration(violation.at)} after the start at {clock_time(violation.start)}".removesuffix(" at "),
        "Measured": violation.measured or "\N{EN DASH}",
        "Why": f"{clause.of or violation.path}: {reason(violation, medians)}",
    }


_SHOWN: Final = 10
