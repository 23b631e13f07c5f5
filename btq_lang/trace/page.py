"""The overview as one self-contained HTML page: without network, fonts or other files.

One invariant: without its script the page has the same contents; the script only filters, sorts and highlights.  Each
mission's trees are beside the table, or below it if one is too broad for that, with qualities and requirements at their
nodes; all marks of the same thing have the same `data-note` and are highlighted together.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from btq_lang.evidence.verdicts import MissionVerdicts
from btq_lang.graph.placing import Drawing, place
from btq_lang.graph.svg import STYLE, colours, part
from btq_lang.render.pages import PageData, page
from btq_lang.trace.first_screen import first_screen
from btq_lang.trace.overview import WAYS, At, ExternalRow, HazardRow, Overview, QualityRow, RequirementRow, TreeRow
from btq_lang.trace.verdicts import verdicts
from btq_lang.trace.wording import (
    GAPS,
    NO_LABEL,
    OUTDATED,
    TOTALS,
    approval_lines,
    chain_rows,
    evidence_lines,
    incomplete,
    remarks,
    shown_quality,
    shown_scenario,
    state_of,
    summary,
)
from btq_lang.util.text import counted


def render(overview: Overview, missions: Sequence[MissionVerdicts] = ()) -> str:
    """The whole page, with the verdicts on missions if there are any."""
    drawings = [_drawing(tree) for tree in overview.trees]
    characteristics = {quality.key: quality.characteristic for quality in overview.qualities}
    rows = {"verdicts": missions, "chain": overview.hazards or overview.external, "builds": overview.builds}
    left_out = {section for section in rows if not rows[section]}
    why = incomplete(overview)
    return page(
        "trace/page.html.j2",
        title=f"{'Verdicts' if missions else 'Requirements and qualities'}: {_files(overview)}",
        light=STYLE + colours(False),
        dark=colours(True),
        screen=first_screen(overview),
        summary=summary(overview),
        incomplete=why[:1].upper() + why[1:],
        sections=[(key, title) for key, title in _SECTIONS if key not in left_out],
        ways=(*WAYS, "not attached"),
        characteristics=[(each.id or "-", each.name) for each in overview.totals if each.concerns or each.requirements],
        has_evidence=overview.has_evidence,
        verdicts=verdicts(missions, {each.name: each.key for each in overview.requirements}),
        layout="below" if any(each.width > _BESIDE for each in drawings) else "beside",
        chain=[
            _chain_row(row, remarks, requirements, characteristics)
            for row, remarks, requirements in chain_rows(overview)
        ],
        names={each.key: each.name for each in overview.requirements},
        state_of=state_of,
        shown_scenario=shown_scenario,
        requirement_heads=("Requirement", "Holds for", "How", *(("Evidence",) if overview.has_evidence else ())),
        requirements=[_requirement(row, _characteristics(row, characteristics)) for row in overview.requirements],
        build_heads=("Requirement", *(build.label or NO_LABEL for build in overview.builds)),
        by_build=list(overview.by_build),
        qualities=_qualities(overview),
        gaps=_gaps(overview),
        totals_heading=("Characteristic", *TOTALS),
        edition=overview.edition,
        totals=[
            (total.name, [number or "–" for number in total.numbers], "" if any(total.numbers) else "empty")
            for total in overview.totals
        ],
        trees=[_tree(tree, drawing) for tree, drawing in zip(overview.trees, drawings, strict=True)],
    )


def _files(overview: Overview) -> str:
    files = overview.files
    return ", ".join(files) if len(files) <= _FILES else f"{files[0]} and {counted(len(files) - 1, 'other file')}"


# ---- tables ----


def _characteristics(row: RequirementRow, of_qualities: Mapping[str, str | None]) -> list[str]:
    """The characteristics of a requirement's qualities; `-` for none."""
    keys = (row.quality_key or "", *row.further_quality_keys)
    return list(dict.fromkeys(of_qualities.get(key) or "-" for key in keys))


def _chain_row(
    row: HazardRow | ExternalRow,
    remarks: Sequence[str],
    requirements: Sequence[RequirementRow],
    of_qualities: Mapping[str, str | None],
) -> PageData:
    """A hazard or what another tool keeps, which a filter shows if it shows one of its requirements."""
    return {
        "row": row,
        "is_external": isinstance(row, ExternalRow),
        "remarks": remarks,
        "requirements": requirements,
        "ways": "; ".join(each.way for each in requirements),
        "characteristics": " ".join(key for each in requirements for key in _characteristics(each, of_qualities)),
    }


def _requirement(row: RequirementRow, characteristics: Sequence[str]) -> PageData:
    clauses = [clause for use in row.uses for clause in use.clauses]
    ways = [(each.way, row.in_words(each.way), "" if each.is_by_people else each.why) for each in clauses]
    loose = [("none", "not attached", f"`{clause}` applies to no node") for clause in row.loose]
    return {
        "row": row,
        "characteristics": " ".join(characteristics),
        "uses": [(use, next(iter(use.nodes), ""), ", ".join(remarks(row, use))) for use in row.uses],
        "how": ", ".join(row.ways_in_words),
        "ways": [*dict.fromkeys(ways), *loose] if ways else [],
        "evidence": list(evidence_lines(row)),
        "further_qualities": list(zip(row.further_quality_keys, row.further_qualities, strict=True)),
        "approvals": [(line, line == OUTDATED) for line in approval_lines(row)],
    }


def _qualities(overview: Overview) -> list[PageData]:
    nodes = {node.key: node for node in overview.nodes}
    names = {each.key: each.name for each in overview.requirements}
    return [
        {
            "row": quality,
            "name": shown_quality(quality),
            "characteristic": quality.characteristic or "-",
            "concerns": [nodes[key] for key in quality.concerns],
            "requirements": [(key, names[key]) for key in quality.requirements],
        }
        for quality in overview.qualities
    ]


def _gaps(overview: Overview) -> list[tuple[str, list[tuple[str, str, At, str]]]]:
    """The headings of all gaps with their lines: the key of a row or a node, its name, its place, and a clause."""

    def lines(rows: Sequence[RequirementRow | QualityRow | HazardRow]) -> list[tuple[str, str, At, str]]:
        return [(row.key, shown_quality(row) if isinstance(row, QualityRow) else row.name, row.at, "") for row in rows]

    gaps = {
        "unmitigated": lines(overview.unmitigated),
        "unenforced": lines(overview.unenforced),
        "unmeasured": lines(overview.unmeasured),
        "unattached": lines(overview.unattached),
        "unjudged": lines(overview.unjudged),
        "not_passed": [(row.key, row.name, row.at, shown_scenario(way)) for row, way in overview.not_passed],
        "sourceless": lines(overview.sourceless),
        "loose": [(row.key, row.name, row.at, clause) for row, clause in overview.loose],
        "bare_trees": [(tree.nodes[0], tree.name, tree.at, "") for tree in overview.bare_trees],
        "bare_nodes": [(node.key, node.name, node.at, "") for node in overview.bare_nodes],
    }
    return [(f"{GAPS[gap]} ({len(lines)})", lines) for gap, lines in gaps.items() if lines]


# ---- trees ----


def _drawing(tree: TreeRow) -> Drawing:
    drawing = place(tree.figure)
    if drawing.width > _BROAD:
        turned = place(tree.figure, "right")
        drawing = turned if turned.width < drawing.width else drawing
    return drawing


def _tree(tree: TreeRow, drawing: Drawing) -> PageData:
    name = f"The tree {tree.name}: {counted(len(tree.nodes), 'node')}"
    return {"row": tree, "width": drawing.width, "drawing": part(drawing, name)}


_SECTIONS: Final = (
    ("overview", "At a glance"),
    ("verdicts", "Verdicts"),
    ("chain", "Hazards"),
    ("requirements", "Requirements"),
    ("builds", "Builds"),
    ("concerns", "Qualities"),
    ("gaps", "Gaps"),
    ("totals", "Totals"),
    ("trees", "Trees"),
)
_FILES: Final = 3  # files named in the title
_BROAD: Final = 720  # pixels: a broader tree is drawn from left to right
_BESIDE: Final = 800  # pixels, which shrink into the column beside the tables in a window of 1400
