"""Verdicts on the page: results of clauses, distributions of their measures, and the runs with the worst violations.

One invariant: every fact in a drawing is also in a text, and colour is never the only sign.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.folding import folded_sources
from btq_lang.evidence.node_rows import node_columns
from btq_lang.evidence.sentences import headline, result
from btq_lang.evidence.verdicts import VIOLATED, WORST_FIRST
from btq_lang.evidence.wording import duration
from btq_lang.trace.histogram import HISTOGRAM_STYLE, histogram
from btq_lang.trace.page_parts import coded
from btq_lang.trace.run_figure import RUN_STYLE, Breach, run_figure
from btq_lang.trace.violating_runs import VIOLATING_STYLE, violating_runs
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import (
        ClauseVerdict,
        MissionVerdicts,
        NodeSummary,
        RequirementVerdict,
    )
    from btq_lang.trace.collect import BoxDetails


def verdicts(missions: Sequence[MissionVerdicts], keys: Mapping[str, str]) -> Iterator[str]:
    """The page's section of verdicts; `keys`: of the requirements' rows on the page, by name."""
    yield '<section id="verdicts" aria-labelledby="h-verdicts"><h2 id="h-verdicts">Verdicts</h2>'
    for mission in missions:
        yield from _mission(mission, keys)
    yield "</section>"


def outcomes(missions: Sequence[MissionVerdicts]) -> BoxDetails:
    """A function from a node to further lines in its box, about its instances in the logs, and to the box's class."""
    nodes = (each for mission in missions for each in mission.nodes)
    found = grouped((id(each.written.node), each) for each in nodes if each.written is not None)
    return lambda source: _outcome(found.get(id(source.node), ()))


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


def _mission(mission: MissionVerdicts, keys: Mapping[str, str]) -> Iterator[str]:
    files = ", ".join(source.file for source in folded_sources(mission.sources))
    outcomes = ", ".join(f"{number} {outcome}" for outcome, number in mission.outcomes)
    yield f"<h3>{escape(mission.name)}</h3>"
    yield f"<p>{counted(mission.runs, 'run')} in {escape(files)}{': ' if outcomes else ''}{outcomes}</p>"
    clauses = [(requirement, clause) for requirement in mission.requirements for clause in requirement.clauses]
    if not clauses:
        yield "<p>No requirement to judge.</p>"
        if mission.nodes:
            yield from _nodes(mission)
        return
    clauses.sort(key=lambda each: WORST_FIRST.index(each[1].verdict))
    yield f'<table class="verdicts"><caption>Verdicts of {escape(mission.name)}</caption>'
    heads = "".join(f'<th scope="col">{head}</th>' for head in ("Verdict", "Requirement", "Result", "Measured"))
    yield f"<thead><tr>{heads}</tr></thead><tbody>"
    for requirement, clause in clauses:
        yield _row(requirement, clause, mission, keys.get(requirement.id, ""))
    yield "</tbody></table>"
    for requirement, clause in clauses:
        if clause.violations:
            yield from violating_runs(requirement.id, clause, mission.medians)
    runs = {clause.timeline.run: clause.timeline for _, clause in clauses if clause.timeline is not None}
    for run, timeline in runs.items():
        breaches = (
            Breach(requirement.id, keys.get(requirement.id, ""), violation)
            for requirement, clause in clauses
            for violation in clause.violations
            if violation.run == run
        )
        yield from run_figure(timeline, [*breaches])
    if mission.nodes:
        yield f"<details><summary>What each of {counted(len(mission.nodes), 'node')} did</summary>"
        yield from _nodes(mission)
        yield "</details>"


def _nodes(mission: MissionVerdicts) -> Iterator[str]:
    """The table of nodes, in the order of the mission; a script sorts it by the values of a column."""
    columns, name = node_columns(mission.nodes), f"Nodes of {escape(mission.name)}"
    yield f'<div class="scroll" tabindex="0" role="region" aria-label="{name}">'
    yield f'<table class="numbers sortable"><caption>{name}</caption><thead><tr>'
    yield "".join(f'<th scope="col">{head}</th>' for head in ("node", *(column.head for column in columns)))
    yield "</tr></thead><tbody>"
    for place, node in enumerate(mission.nodes):
        cells = "".join(_number(column.values[place], column.texts[place]) for column in columns)
        yield f'<tr><th scope="row">{escape(node.path)}</th>{cells}</tr>'
    yield "</tbody></table></div>"


def _number(value: float | None, text: str) -> str:
    """A cell, with its value if the text is not just that."""
    return f"<td>{text}</td>" if value is None or text == str(value) else f'<td data-value="{value:.9g}">{text}</td>'


def _row(requirement: RequirementVerdict, clause: ClauseVerdict, mission: MissionVerdicts, key: str) -> str:
    look = f"<p>{coded(headline(clause, mission.medians))}</p>" if clause.verdict == VIOLATED else ""
    name = f'<a class="name" href="#{key}">{escape(requirement.id)}</a>' if key else escape(requirement.id)
    run = f'<p><a href="#run-{clause.timeline.run}">Show the run</a></p>' if clause.timeline is not None else ""
    verdict = clause.verdict.replace(" ", "-")
    text = f"<code>{escape(clause.text)}</code>" if clause.text else ""
    return (
        f'<tr data-note="{key}">'
        f'<td><span class="verdict {verdict}">{clause.verdict}</span></td>'
        f'<th scope="row">{name}<p>{escape(requirement.title)}</p>{text}</th>'
        f"<td>{escape(result(clause))}{look}{run}</td>"
        f"<td>{histogram(clause.histogram) if clause.histogram is not None else ''}</td></tr>"
    )


VERDICT_STYLE: Final = f"""\
.verdicts td:first-child {{ white-space: nowrap; }}
.verdicts td:last-child {{ width: 20rem; }}
{HISTOGRAM_STYLE}{VIOLATING_STYLE}{RUN_STYLE}\
.box.good .outline {{ stroke: var(--enforced); stroke-width: 2.4; }}
.box.mixed .outline {{ stroke: var(--reviewed); stroke-width: 2.4; stroke-dasharray: 9 3; }}
.box.bad .outline {{ stroke: var(--missing); stroke-width: 3.4; }}
.box.idle .outline {{ stroke-dasharray: 2 3; }}
@media (max-width: 700px) {{ .verdicts, .verdicts tbody, .verdicts tr, .verdicts th, .verdicts td {{ display: block; }}
  .verdicts thead {{ display: none; }} .verdicts td:last-child {{ width: auto; }}
  .verdicts td, .verdicts th {{ border: 0; padding: .2rem .4rem; }}
  .verdicts tr {{ border-bottom: 1px solid var(--line); }} .verdicts caption {{ display: block; }} }}
"""
