"""Verdicts on the page: results of clauses, distributions of their measures, and the runs with the worst violations.

One invariant: every fact in a drawing is also in a text, and colour is never the only sign.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.folding import folded_sources
from btq_lang.evidence.node_rows import node_rows
from btq_lang.evidence.sentences import headline, result
from btq_lang.evidence.verdicts import OUTCOMES, VIOLATED, WORST_FIRST
from btq_lang.evidence.wording import duration, quantity, timestamp
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import (
        ClauseVerdict,
        Histogram,
        MissionVerdicts,
        NodeSummary,
        RequirementVerdict,
        Timeline,
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
    runs = {clause.timeline.run: clause.timeline for _, clause in clauses if clause.timeline is not None}
    for timeline in runs.values():
        yield from _timeline(timeline)


def _nodes(mission: MissionVerdicts) -> Iterator[str]:
    heads, rows = node_rows(mission.nodes)
    yield f'<table class="numbers"><caption>Nodes of {escape(mission.name)}</caption><thead><tr>'
    yield "".join(f'<th scope="col">{head}</th>' for head in heads)
    yield "</tr></thead><tbody>"
    for path, *numbers in rows:
        yield f'<tr><th scope="row">{escape(path)}</th>{"".join(f"<td>{each}</td>" for each in numbers)}</tr>'
    yield "</tbody></table>"


def _row(requirement: RequirementVerdict, clause: ClauseVerdict, mission: MissionVerdicts, key: str) -> str:
    look = f"<p>{escape(headline(clause, mission.medians))}</p>" if clause.verdict == VIOLATED else ""
    name = f'<a class="name" href="#{key}">{escape(requirement.id)}</a>' if key else escape(requirement.id)
    run = f'<p><a href="#run-{clause.timeline.run}">Show the run</a></p>' if clause.timeline is not None else ""
    verdict = clause.verdict.replace(" ", "-")
    text = f"<code>{escape(clause.text)}</code>" if clause.text else ""
    return (
        f'<tr data-note="{key}">'
        f'<td><span class="verdict {verdict}">{clause.verdict}</span></td>'
        f'<th scope="row">{name}<p>{escape(requirement.title)}</p>{text}</th>'
        f"<td>{escape(result(clause))}{look}{run}</td>"
        f"<td>{_histogram(clause.histogram) if clause.histogram is not None else ''}</td></tr>"
    )


# ---- histograms ----


def _histogram(found: Histogram) -> str:
    low = min(found.low, *(mark.si for mark in found.marks.values()))
    high = max(found.low + found.step * len(found.counts), *(mark.si for mark in found.marks.values()))
    span = high - low or 1.0

    def across(value: float) -> float:
        return round(_EDGE + (value - low) / span * (_WIDE - 2 * _EDGE), 1)

    values = sum(found.counts)
    first, last = quantity(found.low, found.unit), quantity(found.low + found.step * len(found.counts), found.unit)
    label = f"{counted(values, 'value')} from {first} to {last}; "
    label += ", ".join(f"{kind} {mark.text}" for kind, mark in found.marks.items())
    parts = [f'<svg class="histogram" viewBox="0 0 {_WIDE} {_HIGH}" role="img" aria-label="{escape(label)}">']
    for at, number in enumerate(found.counts):
        if number:
            x, end = across(found.low + at * found.step), across(found.low + (at + 1) * found.step)
            height = max(round(number / max(found.counts) * (_GROUND - 2 * _TEXT), 1), 1.0)
            parts.append(
                f'<rect class="bin" x="{x}" y="{_GROUND - height:g}" width="{max(end - x, 1):.1f}" height="{height:g}">'
                f"<title>{number} from {escape(quantity(found.low + at * found.step, found.unit))}"
                f" to {escape(quantity(found.low + (at + 1) * found.step, found.unit))}</title></rect>"
            )
    parts.append(f'<path class="axis" d="M{_EDGE} {_GROUND}H{_WIDE - _EDGE}"/>')
    for line, (kind, mark) in enumerate(found.marks.items()):
        x, y = across(mark.si), _TEXT * (line + 1) - 2
        anchor = "end" if x > _WIDE / 2 else "start"
        shift = -3 if anchor == "end" else 3
        parts.append(f'<path class="{kind}" d="M{x} {_TEXT * line}V{_GROUND}"/>')
        parts.append(f'<text x="{x + shift:g}" y="{y}" style="text-anchor: {anchor}">{kind} {escape(mark.text)}</text>')
    for x, anchor, value in ((_EDGE, "start", low), (_WIDE - _EDGE, "end", high)):
        text = escape(quantity(value, found.unit))
        parts.append(f'<text x="{x}" y="{_HIGH - 3}" style="text-anchor: {anchor}">{text}</text>')
    return "".join(parts) + "</svg>"


# ---- timelines ----


def _timeline(timeline: Timeline) -> Iterator[str]:
    rows = grouped(((bar.path, bar.depth), bar) for bar in timeline.bars)
    length = max((bar.end for bar in timeline.bars), default=0) or 1e-6
    name = f"Run {timeline.run} of {timeline.source}"
    yield f'<figure class="run" id="run-{timeline.run}"><figcaption><h3>{escape(name)}</h3>'
    yield f" <small>from {timestamp(timeline.start)}, {duration(length)}</small></figcaption>"
    yield '<p class="legend"><span class="key S">succeeded</span> <span class="key F">failed</span>'
    yield '<span class="key H">halted</span> <span class="key O">interrupted</span></p>'
    if timeline.left_out:
        yield f"<p>{counted(timeline.left_out, 'activation')} more are not drawn.</p>"
    yield f'<div class="scroll" tabindex="0" role="region" aria-label="{escape(name)}">'
    yield '<table class="timeline"><tbody>'
    for (path, depth), bars in rows.items():
        inset = min(depth, _DEEPEST) * 0.8 + 0.4
        yield f'<tr><th scope="row" style="padding-left: {inset:g}rem">{escape(path)}</th><td>'
        for bar in bars:
            at = f"left: {bar.begin / length:.3%}; width: {(bar.end - bar.begin) / length:.3%}"
            after = f" after {bar.took}," if bar.took else ""
            title = f"{OUTCOMES[bar.outcome]}{after} {duration(bar.end)} after the start of the run"
            yield f'<span class="bar {bar.outcome}" style="{at}" title="{title}"></span>'
        yield "</td></tr>"
    yield '</tbody><tfoot><tr><td></td><td class="ends">'
    yield f"<span>0</span><span>{duration(length)}</span></td></tr></tfoot></table></div></figure>"


_WIDE: Final = 300  # pixels
_HIGH: Final = 110
_GROUND: Final = 92
_TEXT: Final = 13
_EDGE: Final = 6
_DEEPEST: Final = 12  # levels that are indented

VERDICT_STYLE: Final = """\
.verdicts td:first-child { white-space: nowrap; }
.verdicts td:last-child { width: 20rem; }
.histogram { width: 100%; max-width: 20rem; display: block; }
.histogram text { font-size: 11px; fill: var(--ink); }
.histogram .bin { fill: var(--monitored); stroke: var(--ground); stroke-width: .5; }
.histogram .axis { stroke: var(--soft); }
.histogram .bound { stroke: var(--missing); stroke-width: 2; }
.histogram .goal { stroke: var(--enforced); stroke-width: 2; stroke-dasharray: 4 3; }
.timeline th { width: 16rem; padding: .1rem .4rem; font: .8rem ui-monospace, Menlo, Consolas, monospace; }
.timeline td { position: relative; padding: 0; height: 1.35rem; min-width: 20rem; }
.bar { position: absolute; top: .2rem; bottom: .2rem; min-width: 2px; border-radius: 2px; background: var(--enforced); }
.bar.F { background: var(--missing); outline: 1.5px solid var(--ink); }
.bar.H { background: repeating-linear-gradient(45deg, var(--reviewed) 0 4px, var(--ground) 4px 7px); }
.bar.O { background: none; border: 1.5px dashed var(--soft); }
.timeline .ends { color: var(--soft); font-size: .8rem; }
.timeline .ends span { position: absolute; left: 0; } .timeline .ends span + span { left: auto; right: 0; }
.key.S { border: 0; background: var(--enforced); color: var(--ground); }
.key.F { border: 2px solid var(--ink); background: var(--missing); color: var(--ground); }
.key.H { border: 1.5px solid var(--reviewed); } .key.O { border: 1.5px dashed var(--soft); }
.box.good .outline { stroke: var(--enforced); stroke-width: 2.4; }
.box.mixed .outline { stroke: var(--reviewed); stroke-width: 2.4; stroke-dasharray: 9 3; }
.box.bad .outline { stroke: var(--missing); stroke-width: 3.4; }
.box.idle .outline { stroke-dasharray: 2 3; }
@media (max-width: 700px) { .verdicts, .verdicts tbody, .verdicts tr, .verdicts th, .verdicts td { display: block; }
  .verdicts thead { display: none; } .verdicts td:last-child { width: auto; }
  .verdicts td, .verdicts th { border: 0; padding: .2rem .4rem; } .verdicts tr { border-bottom: 1px solid var(--line); }
  .timeline th { width: 8rem; } }
"""
