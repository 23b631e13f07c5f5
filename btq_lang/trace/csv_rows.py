"""CSV, a line for each clause at each of its subjects, and one for each gap (RFC 4180, lines end with CR LF).

The columns, which later versions add to but do not change:

    kind            requirement | concern | quality without requirement | requirement without node |
                    clause without node | hard requirement not enforced | evidence | build |
                    node without quality | tree without quality |
                    hazard | hazard without requirement | external |
                    requirement without verdict | requirement without source | scenario |
                    scenario not passed
    requirement, title, quality, characteristic
    holds_for       the subject, or the node that has the concern, or the node or tree of a gap
    tree the tree of its first node
    clause, how, why    how: enforced | monitored | by people, as `by test TC-12`
    attached_by     subject | satisfies | apply | link
    source, line    of what attached it, or of the node or tree
    defined, defined_line   where the requirement or the quality is defined or first named
    verdict, result     of a clause by logs, at the node whose path in the engine is in holds_for
    suspect         of a verdict: yes if the requirement meant something else when it was judged
    build           the label of the runs by which a requirement has the verdict
    hazard, severity    the hazard that the requirement mitigates; how is then how it is covered, verdict its worst
    external        the ID in another tool of what the requirement refines or mitigates, likewise
    refines, mitigates, origin, priority, verified_by, approval     of the requirement; origin: its sources,
                    approval: open | approved | approved without fingerprint | suspect
    scenario        the title of one that verifies the requirement, or what is in external; its place is in source and
                    line, in result what came of it, in suspect yes if its text has changed since, and in verdict the
                    one that it expects instead of satisfied
    approved_by     who has approved the requirement, each with the date: `Kim 2026-11-29; Lee 2026-12-01`

A text that a spreadsheet would take for a formula (`-> Work`, `=1+1`) gets an apostrophe prefix, as OWASP advises ("CSV
Injection"); programs that need the exact texts read the JSON.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

from btq_lang.render.spreadsheet import table
from btq_lang.trace.overview import At, Clause, ExternalRow, HazardRow, Overview, RequirementRow, VerificationRow
from btq_lang.trace.wording import chain_rows


def render(overview: Overview) -> str:
    """The overview as CSV, with a heading."""
    return table(COLUMNS, _rows(overview))


def _rows(overview: Overview) -> Iterator[dict[str, str | int]]:
    trees = {node.key: node.tree for node in overview.nodes}
    nodes = {node.key: node for node in overview.nodes}
    characteristics = {quality.key: quality.characteristic or "" for quality in overview.qualities}
    for requirement in overview.requirements:
        row = _requirement(requirement, characteristics.get(requirement.quality_key or "", ""))
        if not requirement.uses:
            yield {"kind": "requirement without node", **row, "clause": "; ".join(requirement.clauses)}
        for use in requirement.uses:
            tree = trees[use.nodes[0]] if use.nodes else ""
            applied = {**row, "holds_for": use.subject + use.arguments, "tree": tree, "attached_by": use.how}
            for clause in use.clauses or (None,):
                yield {"kind": "requirement", **applied, **_clause(requirement, clause), **_source(use.at)}
        for loose in requirement.loose:
            yield {"kind": "clause without node", **row, "clause": loose}
        for evidence in requirement.evidence:
            verdict = {"clause": evidence.clause, "verdict": evidence.verdict, "result": evidence.result}
            verdict |= {"suspect": "yes"} if evidence.is_suspect else {}
            source = {"source": evidence.mission} if evidence.mission else {}
            yield {"kind": "evidence", **row, "holds_for": evidence.path, **verdict, **source}
        for scenario in requirement.scenarios:
            yield {"kind": "scenario", **row, **_scenario(scenario)}
    for requirement, verdicts in overview.by_build:
        row = _requirement(requirement, characteristics.get(requirement.quality_key or "", ""))
        for build, (of_build, is_old) in zip(overview.builds, verdicts, strict=True):
            suspect = "yes" if is_old else ""
            yield {"kind": "build", **row, "verdict": of_build, "build": build.label, "suspect": suspect}
    yield from _chain(overview, characteristics)
    for requirement in overview.unenforced:
        row = _requirement(requirement, characteristics.get(requirement.quality_key or "", ""))
        yield {"kind": "hard requirement not enforced", **row}
    for quality in overview.qualities:
        named = {"quality": quality.id or quality.name, "characteristic": quality.characteristic or ""}
        named |= {"defined": quality.at.path, "defined_line": str(quality.at.line)}
        for key in quality.concerns:
            node = nodes[key]
            yield {"kind": "concern", **named, "holds_for": node.name, "tree": node.tree, **_source(node.at)}
        if not quality.requirements:
            yield {"kind": "quality without requirement", **named}
    for node in overview.bare_nodes:
        yield {"kind": "node without quality", "holds_for": node.name, "tree": node.tree, **_source(node.at)}
    for bare in overview.bare_trees:
        yield {"kind": "tree without quality", "holds_for": bare.name, "tree": bare.name, **_source(bare.at)}


def _chain(overview: Overview, characteristics: Mapping[str, str]) -> Iterator[dict[str, str | int]]:
    for end, _, mitigating in chain_rows(overview):
        is_hazard = isinstance(end, HazardRow)
        own: dict[str, str | int] = {"hazard": end.name} if is_hazard else {"external": end.name}
        own |= {"severity": end.severity} if isinstance(end, HazardRow) else {}
        for requirement in mitigating:
            row = _requirement(requirement, characteristics.get(requirement.quality_key or "", ""))
            state = {"how": ", ".join(requirement.ways_in_words), "verdict": requirement.verdict or ""}
            yield {"kind": "hazard" if is_hazard else "external", **row, **own, **state, **_source(end.at)}
        for scenario in end.scenarios if isinstance(end, ExternalRow) else ():
            yield {"kind": "scenario", "title": end.title, **own, **_scenario(scenario)}
        if is_hazard and not mitigating:
            yield {"kind": "hazard without requirement", "title": end.title, **own, **_source(end.at)}
    gaps = {"requirement without verdict": overview.unjudged, "requirement without source": overview.sourceless}
    for lacking, scenario in overview.not_passed:
        column = "requirement" if isinstance(lacking, RequirementRow) else "external"
        named: dict[str, str | int] = {column: lacking.name, "title": lacking.title}
        yield {"kind": "scenario not passed", **named, **_scenario(scenario)}
    for kind, requirements in gaps.items():
        for requirement in requirements:
            yield {"kind": kind, **_requirement(requirement, characteristics.get(requirement.quality_key or "", ""))}


def _requirement(requirement: RequirementRow, characteristic: str) -> dict[str, str | int]:
    return {
        "requirement": requirement.name,
        "title": requirement.title,
        "quality": " and ".join((requirement.quality or "", *requirement.further_qualities)),
        "characteristic": characteristic,
        "refines": ", ".join(requirement.refines),
        "mitigates": ", ".join(requirement.mitigates),
        "origin": "; ".join(requirement.sources),
        "priority": requirement.priority,
        "verified_by": ", ".join(f"{way.method} {way.id}".rstrip() for way in requirement.verification),
        "approval": requirement.state,
        "approved_by": "; ".join(f"{each.by} {each.on}" for each in requirement.approvals),
        "defined": requirement.at.path,
        "defined_line": requirement.at.line,
    }


def _clause(requirement: RequirementRow, clause: Clause | None) -> dict[str, str | int]:
    if clause is None:
        return {}
    return {"clause": clause.text, "how": requirement.in_words(clause.way), "why": clause.why}


def _scenario(scenario: VerificationRow) -> dict[str, str | int]:
    came = {"result": scenario.outcome, "suspect": "yes" if scenario.is_stale else ""} if scenario.outcome else {}
    expects = {"verdict": scenario.expects} if scenario.expects else {}
    return {"scenario": scenario.id, **(_source(scenario.at) if scenario.at is not None else {}), **came, **expects}


def _source(place: At) -> dict[str, str | int]:
    return {"source": place.path, "line": place.line}


COLUMNS: Final = (
    *("kind", "requirement", "title", "quality", "characteristic", "holds_for", "tree", "clause", "how", "why"),
    *("attached_by", "source", "line", "defined", "defined_line", "verdict", "result", "build"),
    *("hazard", "severity", "external", "refines", "mitigates", "origin", "priority", "verified_by", "approval"),
    "suspect",
    "approved_by",
    "scenario",
)
