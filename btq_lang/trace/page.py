"""The overview as one self-contained HTML page: without network, fonts or other files.

One invariant: without its script the page has the same contents; the script only filters, sorts and highlights.  Each
mission's trees are beside the table, or below it if one is too broad for that, with qualities and requirements at their
nodes; all marks of the same thing have the same `data-note` and are highlighted together.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from typing import Final

from btq_lang.evidence.verdicts import MissionVerdicts
from btq_lang.graph.placing import Drawing, place
from btq_lang.graph.svg import STYLE, colours, part
from btq_lang.render.page_style import PAGE_STYLE
from btq_lang.trace.overview import WAYS, At, Overview, RequirementRow, TreeRow
from btq_lang.trace.page_parts import SCRIPT, TRACE_STYLE, coded
from btq_lang.trace.verdicts import VERDICT_STYLE, verdicts
from btq_lang.trace.wording import GAPS, evidence_lines, incomplete, remarks, shown_quality, summary
from btq_lang.util.text import counted


def render(overview: Overview, missions: Sequence[MissionVerdicts] = ()) -> str:
    """The whole page, with the verdicts on missions if there are any."""
    return "\n".join(_lines(overview, missions)) + "\n"


def _lines(overview: Overview, missions: Sequence[MissionVerdicts]) -> Iterator[str]:
    has_verdicts = bool(missions) or overview.has_evidence
    title = f"{'Verdicts' if missions else 'Requirements and qualities'}: {_title(overview)}"
    yield "<!DOCTYPE html>"
    yield '<html lang="en">'
    yield '<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{escape(title)}</title>"
    style = f"{PAGE_STYLE}{TRACE_STYLE}{VERDICT_STYLE if has_verdicts else ''}"
    yield f"<style>\n{STYLE}{colours(False)}{style}</style>"
    yield f'<style media="screen and (prefers-color-scheme: dark)">\n{colours(True)}</style></head>'
    yield "<body>"
    yield '<a class="skip" href="#requirements">To the requirements</a>'
    yield f"<header><h1>{escape(title)}</h1><p>{escape(summary(overview))}</p>"
    if why := incomplete(overview):
        yield f'<p class="incomplete" role="alert">{escape(why[0].upper() + why[1:])}.</p>'
    yield from _navigation(overview, bool(missions))
    yield "</header>"
    yield "<main>"
    if missions:
        yield from verdicts(missions, {each.name: each.key for each in overview.requirements})
    drawings = [_drawing(tree) for tree in overview.trees]
    is_broad = any(each.width > _BESIDE for each in drawings)
    yield f'<div class="{"below" if is_broad else "beside"}">'
    yield '<div class="tables">'
    yield from _requirements(overview)
    yield from _concerns(overview)
    yield from _gaps(overview)
    yield from _totals(overview)
    yield "</div>"
    yield from _trees(overview, drawings)
    yield "</div></main>"
    yield '<p class="live" role="status" aria-live="polite"></p>'
    yield f"<script>\n{SCRIPT}</script>"
    yield "</body></html>"


def _title(overview: Overview) -> str:
    files = overview.files
    return ", ".join(files) if len(files) <= _FILES else f"{files[0]} and {counted(len(files) - 1, 'other file')}"


def _navigation(overview: Overview, has_verdicts: bool) -> Iterator[str]:
    sections = [("requirements", "Requirements"), ("concerns", "Qualities"), ("gaps", "Gaps"), ("totals", "Totals")]
    sections = [("verdicts", "Verdicts"), *sections] if has_verdicts else sections
    links = "".join(f'<li><a href="#{key}">{name}</a></li>' for key, name in (*sections, ("trees", "Trees")))
    yield f'<nav aria-label="Sections"><ul>{links}</ul></nav>'
    yield '<form class="filter" hidden role="search" aria-label="Filter">'
    yield '<label>Show <input type="search" name="text" placeholder="a name, a node, a clause"></label>'
    ways = "".join(f"<option>{way}</option>" for way in (*WAYS, "not attached"))
    yield f'<label>How <select name="way"><option value="">all</option>{ways}</select></label>'
    options = "".join(
        f'<option value="{escape(each.id or "-")}">{escape(each.name)}</option>'
        for each in overview.totals
        if each.concerns or each.requirements
    )
    yield f'<label>Characteristic <select name="of"><option value="">all</option>{options}</select></label>'
    yield '<button type="reset">Show all</button></form>'


# ---- tables ----


def _requirements(overview: Overview) -> Iterator[str]:
    yield _section("requirements", "Requirements")
    if not overview.requirements:
        yield _EMPTY
        return
    yield "<table><caption>Requirements, their nodes, and how they are enforced</caption>"
    yield _head("Requirement", "Holds for", "How", *(("Evidence",) if overview.has_evidence else ()))
    characteristics = {quality.key: quality.characteristic for quality in overview.qualities}
    for each in overview.requirements:
        of = characteristics.get(each.quality_key or "") or "-"
        yield f'<tr class="row" id="{each.key}" data-note="{each.key}" data-way="{each.way}" data-of="{escape(of)}">'
        yield f'<th scope="row">{_demand(each)}</th>'
        evidence = f"<td>{_evidence(each)}</td>" if overview.has_evidence else ""
        yield f"<td>{_subjects(each)}</td><td>{_ways(each)}</td>{evidence}</tr>"
    yield "</tbody></table></section>"


def _section(key: str, title: str) -> str:
    return f'<section id="{key}" aria-labelledby="h-{key}"><h2 id="h-{key}">{title}</h2>'


def _head(*names: str) -> str:
    cells = "".join(f'<th scope="col">{name}</th>' for name in names)
    return f"<thead><tr>{cells}</tr></thead><tbody>"


def _demand(each: RequirementRow) -> str:
    clauses = "".join(f"<li><code>{escape(clause)}</code></li>" for clause in each.clauses)
    parts = [
        f'<a class="name" href="#{each.key}">{escape(each.name)}</a> {_at(each.at)}',
        f"<p>{escape(each.title)}</p>" if each.title else "",
        f'<ul class="clauses">{clauses}</ul>' if clauses else "",
        f'<a class="chip" href="#{each.quality_key}">{escape(each.quality)}</a>' if each.quality else "",
    ]
    return "".join(parts)


def _subjects(each: RequirementRow) -> str:
    if not each.uses:
        return '<span class="missing">nothing</span>'
    lines = []
    for use in each.uses:
        name = escape(use.subject)
        shown = f'<a href="#{use.nodes[0]}">{name}</a>' if use.nodes else name
        given = f' <code class="given">{escape(use.arguments)}</code>' if use.arguments else ""
        how = f" <small>{escape(text)}</small>" if (text := ", ".join(remarks(each, use))) else ""
        lines.append(f"<li>{shown}{given}{how} {_at(use.at)}</li>")
    return f"<ul>{''.join(lines)}</ul>"


def _ways(each: RequirementRow) -> str:
    if not any(use.clauses for use in each.uses):
        return f'<span class="way none">{escape(each.way)}</span>'
    lines = []
    for way, why in dict.fromkeys((clause.way, clause.why) for use in each.uses for clause in use.clauses):
        text = f" <small>{coded(why)}</small>" if why else ""
        lines.append(f'<li><span class="way {way}">{way}</span>{text}</li>')
    for clause in each.loose:
        text = f"<small><code>{escape(clause)}</code> applies to no node</small>"
        lines.append(f'<li><span class="way none">not attached</span> {text}</li>')
    return f"<ul>{''.join(lines)}</ul>"


def _evidence(each: RequirementRow) -> str:
    lines = [
        f'<li><span class="verdict {verdict.replace(" ", "-")}">{verdict}</span> <small>{coded(text)}</small></li>'
        for verdict, text in evidence_lines(each)
    ]
    return f"<ul>{''.join(lines)}</ul>" if lines else _NONE


def _concerns(overview: Overview) -> Iterator[str]:
    yield _section("concerns", "Qualities")
    if not overview.qualities:
        yield _EMPTY
        return
    yield "<table><caption>Concerns of the early design, and what makes them measurable</caption>"
    yield _head("Quality", "Concern of", "Requirements")
    nodes = {node.key: node for node in overview.nodes}
    names = {each.key: each.name for each in overview.requirements}
    for each in overview.qualities:
        text = f"<p>{escape(each.definition)}</p>" if each.definition else ""
        of = escape(each.characteristic or "-")
        yield f'<tr class="row" id="{each.key}" data-note="{each.key}" data-way="" data-of="{of}">'
        name = f'<a class="name" href="#{each.key}">{escape(shown_quality(each))}</a>'
        yield f'<th scope="row">{name} {_at(each.at)}{text}</th>'
        lines = [f"<li>{_link(key, nodes[key].name, nodes[key].at)}</li>" for key in each.concerns]
        yield f"<td><ul>{''.join(lines)}</ul></td>" if lines else "<td></td>"
        links = ", ".join(f'<a href="#{key}">{escape(names[key])}</a>' for key in each.requirements)
        yield f"<td>{links or _NONE}</td></tr>"
    yield "</tbody></table></section>"


def _gaps(overview: Overview) -> Iterator[str]:
    yield _section("gaps", "Gaps")
    found = {
        "unenforced": [_link(each.key, each.name, each.at) for each in overview.unenforced],
        "unmeasured": [_link(each.key, shown_quality(each), each.at) for each in overview.unmeasured],
        "unattached": [_link(each.key, each.name, each.at) for each in overview.unattached],
        "loose": [
            f"{_link(each.key, each.name, each.at)} <code>{escape(clause)}</code>" for each, clause in overview.loose
        ],
        "bare_trees": [_link(each.nodes[0], each.name, each.at) for each in overview.bare_trees],
        "bare_nodes": [_link(each.key, each.name, each.at) for each in overview.bare_nodes],
    }
    if not any(found.values()):
        hard = "hard requirement (on violation fail or halt)"
        yield f"<p>Every {hard} is enforced, every quality has a requirement, every custom leaf node a quality.</p>"
    for gap, lines in found.items():
        if lines:
            yield f"<h3>{GAPS[gap]} ({len(lines)})</h3>"
            yield f"<ul class='gaps'>{''.join(f'<li>{line}</li>' for line in lines)}</ul>"
    yield "</section>"


def _totals(overview: Overview) -> Iterator[str]:
    yield _section("totals", "Totals")
    yield '<div class="scroll" tabindex="0" role="region" aria-label="Totals">'
    yield f'<table class="numbers"><caption>By characteristic of ISO/IEC 25010:{overview.edition}</caption>'
    yield _head("Characteristic", "Concerns", "Requirements", "Enforced", "Monitored", "Reviewed")
    for each in overview.totals:
        cells = "".join(f"<td>{number or '–'}</td>" for number in each.numbers)
        kind = "" if any(each.numbers) else ' class="empty"'
        yield f'<tr{kind}><th scope="row">{escape(each.name)}</th>{cells}</tr>'
    yield "</tbody></table></div></section>"


# ---- trees ----


def _trees(overview: Overview, drawings: Sequence[Drawing]) -> Iterator[str]:
    yield '<section class="trees" id="trees" aria-labelledby="h-trees"><h2 id="h-trees">Trees</h2>'
    yield '<p class="legend"><span class="key enforced">enforced</span> <span class="key monitored">monitored</span>'
    yield '<span class="key reviewed">reviewed</span> <span class="key quality">concern</span></p>'
    for tree, drawing in zip(overview.trees, drawings, strict=True):
        yield from _figure(tree, drawing)
    yield "</section>"


def _drawing(tree: TreeRow) -> Drawing:
    drawing = place(tree.figure)
    if drawing.width > _BROAD:
        turned = place(tree.figure, "right")
        drawing = turned if turned.width < drawing.width else drawing
    return drawing


def _figure(tree: TreeRow, drawing: Drawing) -> Iterator[str]:
    bare = ' <span class="missing">without any quality</span>' if tree.is_bare else ""
    yield f'<figure style="--wide: {drawing.width}px">'
    yield f"<figcaption><h3>{escape(tree.name)}</h3> {_at(tree.at)}{bare}</figcaption>"
    yield f'<div class="scroll" tabindex="0" role="region" aria-label="Tree {escape(tree.name)}">'
    yield part(drawing, f"The tree {tree.name}: {counted(len(tree.nodes), 'node')}")
    yield "</div></figure>"


def _link(key: str, name: str, at: At) -> str:
    return f'<a href="#{key}">{escape(name)}</a> {_at(at)}'


def _at(at: At) -> str:
    name = at.path.rpartition("/")[2]
    return f'<small class="at" title="{escape(at.path)}:{at.line}:{at.column}">{escape(name)}:{at.line}</small>'


_NONE: Final = '<span class="missing">none</span>'
_EMPTY: Final = "<p>There are none.</p></section>"
_FILES: Final = 3  # files named in the title
_BROAD: Final = 720  # pixels: a broader tree is drawn from left to right
_BESIDE: Final = 800  # pixels, which shrink into the column beside the tables in a window of 1400
