"""Verdicts on the page: results of clauses, distributions of their measures, and the runs with the worst violations.

One invariant: every fact in a drawing is also in a text, and colour is never the only sign.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.folding import folded_sources
from btq_lang.evidence.node_rows import node_columns
from btq_lang.evidence.sentences import headline, reason, result
from btq_lang.evidence.verdicts import VIOLATED, WORST_FIRST
from btq_lang.evidence.wording import clock_time, duration, quantity
from btq_lang.trace.run_figure import Breach, run_figure
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.node_rows import Column
    from btq_lang.evidence.verdicts import (
        ClauseVerdict,
        Histogram,
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
    unlisted = clause.violated - len(rows)
    caption = f"Runs that violate {requirement}: {clause.text}"
    more = counted(len(rows) - shown, "more violation" if shown else "violation")
    return {
        "caption": caption,
        "first": rows[:shown],
        "more": rows[shown:],
        "more_summary": f"{more} of {requirement}",
        "more_caption": f"{caption}, continued" if shown else caption,
        "not_listed": f"{counted(unlisted, 'violation')} more of {requirement} not listed." if unlisted > 0 else "",
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


# ---- the distribution of what a clause measured ----


def histogram(distribution: Histogram) -> str:
    """The steps as bars, with a line for each mark."""
    counts, marks, unit = distribution.counts, distribution.marks, distribution.unit
    edges = [distribution.low + index * distribution.step for index in range(len(counts) + 1)]
    low = min(edges[0], *(mark.si for mark in marks.values()))
    high = max(edges[-1], *(mark.si for mark in marks.values()))
    span = high - low or 1.0
    ceiling = _TEXT * len(marks)

    def across(value: float) -> float:
        return round(_EDGE + (value - low) / span * (_WIDE - 2 * _EDGE), 1)

    label = f"{counted(sum(counts), 'value')} from {quantity(edges[0], unit)} to {quantity(edges[-1], unit)}; "
    label += ", ".join(f"{kind} {mark.text}" for kind, mark in marks.items())
    parts = [f'<svg class="histogram" viewBox="0 0 {_WIDE} {_HIGH}" role="img" aria-label="{escape(label)}">']
    for number, (left, right) in zip(counts, pairwise(edges), strict=True):
        if number:
            x = across(left)
            height = max(round(number / max(counts) * (_GROUND - ceiling), 1), 1.0)
            wide = min(max(across(right) - x, 1), _WIDEST)
            parts.append(
                f'<rect class="bin" x="{x}" y="{_GROUND - height:g}" width="{wide:.1f}" height="{height:g}">'
                f"<title>{number} from {escape(quantity(left, unit))} to {escape(quantity(right, unit))}</title></rect>"
            )
    parts.append(f'<path class="axis" d="M{_EDGE} {_GROUND}H{_WIDE - _EDGE}"/>')
    for line, (kind, mark) in enumerate(marks.items()):
        x, y = across(mark.si), _TEXT * (line + 1) - 2
        anchor = "end" if x > _WIDE / 2 else "start"
        shift = -3 if anchor == "end" else 3
        parts.append(f'<path class="{kind.rpartition(" ")[2]}" d="M{x} {_TEXT * line}V{_GROUND}"/>')
        parts.append(f'<text x="{x + shift:g}" y="{y}" style="text-anchor: {anchor}">{kind} {escape(mark.text)}</text>')
    ends = [(_EDGE, "start", low), (_WIDE - _EDGE, "end", high)]
    for x, anchor, value in ends if high - low > distribution.step else ends[:1]:  # where all are alike, one number
        text = escape(quantity(value, unit))
        parts.append(f'<text x="{x}" y="{_HIGH - 3}" style="text-anchor: {anchor}">{text}</text>')
    return "".join(parts) + "</svg>"


_WIDE: Final = 300  # pixels
_HIGH: Final = 110
_GROUND: Final = 92
_TEXT: Final = 13
_EDGE: Final = 6
_WIDEST: Final = 24  # a bar, where there are few
