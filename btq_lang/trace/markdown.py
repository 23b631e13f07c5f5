"""Markdown, for pull requests: GitHub's tables, with `<br>` for line ends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from btq_lang.render.gfm import code, escaped, table
from btq_lang.trace.overview import ExternalRow, HazardRow, Overview, RequirementRow
from btq_lang.trace.wording import (
    GAPS,
    NO_LABEL,
    TOTALS,
    approval_lines,
    chain_rows,
    evidence_lines,
    remarks,
    shown_quality,
    shown_scenario,
    state_of,
    summary,
)


def render(overview: Overview) -> str:
    """The overview as Markdown: requirements, concerns, gaps, totals."""
    return "\n".join(_lines(overview)).rstrip("\n") + "\n"


def _lines(overview: Overview) -> Iterator[str]:
    yield "## Requirements and qualities"
    yield ""
    yield escaped(summary(overview))
    has_evidence = overview.has_evidence
    chain = [(_end(row, remarks), _mitigating(own)) for row, remarks, own in chain_rows(overview)]
    if chain:
        yield ""
        yield from table(("Hazard or requirement of others", "Mitigated or refined by"), chain)
    if overview.requirements:
        yield ""
        names = {each.key: each.name for each in overview.requirements}
        heading = ["Requirement", "Quality", "Holds for", "How", *(["Evidence"] if has_evidence else ()), "Defined"]
        yield from table(heading, (_requirement(each, has_evidence, names) for each in overview.requirements))
    builds = [
        (escaped(each.name), *(f"{verdict} (suspect)" if is_old else verdict for verdict, is_old in verdicts))
        for each, verdicts in overview.by_build
    ]
    if builds:
        yield from ("", "### By build", "")
        labels = [escaped(build.label or NO_LABEL) for build in overview.builds]
        yield from table(("Requirement", *labels), builds)
    nodes = {node.key: node for node in overview.nodes}
    concerns = [quality for quality in overview.qualities if quality.concerns]
    if concerns:
        yield from ("", "### Concerns", "")
        rows = [
            (escaped(shown_quality(each)), "<br>".join(_node(nodes[key].name, nodes[key].at) for key in each.concerns))
            for each in concerns
        ]
        yield from table(("Quality", "Nodes"), rows)
    yield from _gaps(overview)
    yield from ("", f"### Totals, ISO/IEC 25010:{overview.edition}", "")
    totals = [(escaped(each.name), *map(str, each.numbers)) for each in overview.totals]
    yield from table(("Characteristic", *TOTALS), totals, 1)


def _end(row: HazardRow | ExternalRow, remarks: Sequence[str]) -> str:
    """A hazard or a requirement of another tool, and what is known of it."""
    lines = (f"**{escaped(row.name)}** ({escaped(str(row.at))})", escaped(row.title), *map(escaped, remarks))
    return "<br>".join(filter(None, lines))


def _mitigating(requirements: Sequence[RequirementRow]) -> str:
    return "<br>".join(f"**{escaped(each.name)}** {state_of(each)}" for each in requirements) or "nothing"


def _requirement(requirement: RequirementRow, has_evidence: bool, names: Mapping[str, str]) -> tuple[str, ...]:
    cell = [f"**{escaped(requirement.name)}**", *([escaped(requirement.title)] if requirement.title else [])]
    cell += [code(clause) for clause in requirement.clauses]
    refining = ", ".join(escaped(names[key]) for key in requirement.refined_by)
    cell += [f"refined by {refining}"] if refining else []
    cell += map(escaped, approval_lines(requirement))
    subjects = [
        ", ".join((_node(use.subject + use.arguments, use.at), *remarks(requirement, use))) for use in requirement.uses
    ]
    scenarios = [escaped(f"{shown_scenario(each)} ({each.at})") for each in requirement.scenarios]
    how = "<br>".join((*map(escaped, [", ".join(requirement.ways_in_words)]), *requirement.whys, *scenarios))
    evidence = "<br>".join(f"**{verdict}** {escaped(text)}" for verdict, text in evidence_lines(requirement)) or "none"
    return (
        "<br>".join(cell),
        escaped(" and ".join((requirement.quality or "", *requirement.further_qualities))),
        "<br>".join(subjects) or "nothing",
        how,
        *((evidence,) if has_evidence else ()),
        escaped(str(requirement.at)),
    )


def _gaps(overview: Overview) -> Iterator[str]:
    gaps = {
        "unmitigated": [f"{escaped(each.name)} ({each.at})" for each in overview.unmitigated],
        "unenforced": [f"{escaped(each.name)} ({each.at})" for each in overview.unenforced],
        "unmeasured": [f"{escaped(shown_quality(each))} ({each.at})" for each in overview.unmeasured],
        "unattached": [f"{escaped(each.name)} ({each.at})" for each in overview.unattached],
        "unjudged": [f"{escaped(each.name)} ({each.at})" for each in overview.unjudged],
        "not_passed": [
            f"{escaped(each.name)} ({each.at}): {escaped(shown_scenario(scenario))}"
            for each, scenario in overview.not_passed
        ],
        "sourceless": [f"{escaped(each.name)} ({each.at})" for each in overview.sourceless],
        "loose": [f"{escaped(each.name)} ({each.at}): {code(clause)}" for each, clause in overview.loose],
        "bare_trees": [_node(each.name, each.at) for each in overview.bare_trees],
        "bare_nodes": [_node(each.name, each.at) for each in overview.bare_nodes],
    }
    if not any(gaps.values()):
        return
    yield from ("", "### Gaps", "")
    for gap, lines in gaps.items():
        if lines:
            yield f"* {GAPS[gap]}: {', '.join(lines)}"


def _node(name: str, place: object) -> str:
    return f"{code(name)} ({escaped(str(place))})"
