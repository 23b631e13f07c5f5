"""JSON, for programs.

The document, format 1; a later btq adds keys but changes none without a new number:

    {"format": 1, "tool": "btq", "version": VERSION, "quality_model": "iso25010-2023", "files": [PATH],
     "requirements": [{"key": KEY, "id": NAME, "title": TEXT, "quality": NAME | null, "quality_key": KEY | null,
                       "further_qualities": [{"name": NAME, "key": KEY}],
                       "how": TEXT, "clauses": [TEXT], "at": PLACE,
                       "sources": [TEXT], "refines": [NAME], "refined_by": [KEY], "mitigates": [NAME],
                       "priority": NAME | null,
                       "verified_by": [{"method": "monitor" | "analysis" | "test" | "review", "id": TEXT | null,
                                        "at": PLACE | null} | SCENARIO],
                       "approvals": [{"by": TEXT, "on": TEXT, "of": FINGERPRINT | null}],
                       "state": "open" | "approved" | "approved without fingerprint" | "suspect",
                       "fingerprint": FINGERPRINT,
                       "clauses_without_nodes": [TEXT],
                       "evidence": [{"mission": PATH, "clause": TEXT, "path": PATH IN THE ENGINE,
                                     "verdict": "violated" | "unknown" | "undecided" | "satisfied" | "never exercised"
                                                | "open",
                                     "result": TEXT, "suspect": BOOL}] | null,
                       "holds_for": [{"subject": TEXT, "nodes": [KEY], "arguments": TEXT, "at": PLACE,
                                      "attached_by": "subject" | "satisfies" | "apply" | "link",
                                      "clauses": [{"text": TEXT, "why": TEXT,
                                                   "how": "enforced" | "monitored" | "reviewed"}]}]}],
     "hazards": [{"key": KEY, "id": NAME, "title": TEXT, "severity": NAME | null, "sources": [TEXT], "reasons": [TEXT],
                  "at": PLACE, "requirements": [KEY]}],
     "external": [{"key": KEY, "id": NAME, "title": TEXT, "status": TEXT, "url": TEXT, "at": PLACE,
                   "requirements": [KEY], "scenarios": [SCENARIO]}],
     "qualities": [{"key": KEY, "name": NAME, "id": NAME | null, "characteristic": NAME | null, "definition": TEXT,
                    "at": PLACE, "concerns": [KEY], "requirements": [KEY]}],
     "nodes": [{"key": KEY, "name": TEXT, "tree": NAME, "category": NAME | null, "skill": BOOL,
                "carries": "own" | "above" | "none", "at": PLACE}],
     "trees": [{"name": NAME, "at": PLACE, "nodes": [KEY], "without_quality": BOOL}],
     "totals": [{"characteristic": NAME | null, "name": TEXT, "concerns": N, "requirements": N,
                 "enforced": N, "monitored": N, "reviewed": N}],
     "gaps": {"hard_requirements_not_enforced": [KEY], "qualities_without_requirements": [KEY],
              "requirements_without_nodes": [KEY], "clauses_without_nodes": [{"requirement": KEY, "clause": TEXT}],
              "nodes_without_qualities": [KEY], "trees_without_qualities": [NAME],
              "hazards_without_requirements": [KEY], "requirements_without_verdicts": [KEY],
              "requirements_without_sources": [KEY],
              "scenarios_not_passed": [{"requirement": KEY, "scenario": TEXT, "outcome": OUTCOME}]},
     "skills": {"own": N, "above": N, "none": N},
     "builds": [{"label": TEXT, "verdicts": [{"requirement": KEY, "verdict": VERDICT, "suspect": BOOL}]}]}

    PLACE = {"path": PATH, "line": N, "column": N}, counted from 1, columns in Unicode code points
    SCENARIO = {"id": TEXT, "at": PLACE, "expects": TEXT | null, "outcome": OUTCOME | null, "changed": BOOL}
    OUTCOME = "passed" | "failed" | "unknown" | "error" | "not run"

A `skill` is an action or a condition that is not built in; it `carries` a quality or a requirement itself, through a
node above it, or not at all.  Keys are valid in this document only.  A test in `verified_by` that has a place is a
scenario, and its id the title; `btq test` runs it, `btq trace` does not.  `outcome` is what came of it by the results
that were given, `changed`, whether its text differs from that which ran, `expects`, which verdict on the requirement it
expects instead of satisfied.  `mission` is empty in the overview of
one mission; `evidence` is null where neither logs nor verdicts are given.  A verdict is `suspect` if the requirement
meant something else when it was judged; `state` is that of its approval.  A build is the runs in a store that have its
label.  The text is ASCII.
"""

from __future__ import annotations

import json
from typing import TypeAlias

from btq_lang.trace.overview import (
    CharacteristicTotals,
    ClauseEvidence,
    ExternalRow,
    HazardRow,
    Overview,
    RequirementRow,
    VerificationRow,
)
from btq_lang.util.record import as_dict
from btq_lang.util.version import __version__

Json: TypeAlias = "bool | int | str | list[Json] | dict[str, Json] | None"


def render(overview: Overview) -> str:
    """The document, indented."""
    document: dict[str, Json] = {
        "format": 1,
        "tool": "btq",
        "version": __version__,
        "quality_model": f"iso25010-{overview.edition}",
        "files": list(overview.files),
        "requirements": [_requirement(each, overview.has_evidence) for each in overview.requirements],
        "hazards": [_hazard(each) for each in overview.hazards],
        "external": [_external(each) for each in overview.external],
        "qualities": [{**as_dict(each), "at": as_dict(each.at)} for each in overview.qualities],
        "nodes": [
            {
                "key": each.key,
                "name": each.name,
                "tree": each.tree,
                "category": each.category,
                "skill": each.is_skill,
                "carries": each.carries,
                "at": as_dict(each.at),
            }
            for each in overview.nodes
        ],
        "trees": [
            {"name": each.name, "at": as_dict(each.at), "nodes": list(each.nodes), "without_quality": each.is_bare}
            for each in overview.trees
        ],
        "totals": [_total(each) for each in overview.totals],
        "gaps": {
            "hard_requirements_not_enforced": [each.key for each in overview.unenforced],
            "qualities_without_requirements": [each.key for each in overview.unmeasured],
            "requirements_without_nodes": [each.key for each in overview.unattached],
            "clauses_without_nodes": [{"requirement": each.key, "clause": clause} for each, clause in overview.loose],
            "nodes_without_qualities": [each.key for each in overview.bare_nodes],
            "trees_without_qualities": [each.name for each in overview.bare_trees],
            "hazards_without_requirements": [each.key for each in overview.unmitigated],
            "requirements_without_verdicts": [each.key for each in overview.unjudged],
            "requirements_without_sources": [each.key for each in overview.sourceless],
            "scenarios_not_passed": [
                {"requirement": each.key, "scenario": way.id, "outcome": way.outcome}
                for each, way in overview.not_passed
            ],
        },
        "skills": dict(overview.coverage()),
        "builds": [
            {
                "label": build.label,
                "verdicts": [
                    {"requirement": key, "verdict": verdict, "suspect": key in build.suspect}
                    for key, verdict in build.verdicts
                ],
            }
            for build in overview.builds
        ],
    }
    return json.dumps(document, indent=1) + "\n"


def _requirement(requirement: RequirementRow, has_evidence: bool) -> Json:
    return {
        "key": requirement.key,
        "id": requirement.name,
        "title": requirement.title,
        "quality": requirement.quality,
        "quality_key": requirement.quality_key,
        "further_qualities": [
            {"name": name, "key": key}
            for name, key in zip(requirement.further_qualities, requirement.further_quality_keys, strict=True)
        ],
        "how": requirement.way,
        "clauses": list(requirement.clauses),
        "at": as_dict(requirement.at),
        "sources": list(requirement.sources),
        "refines": list(requirement.refines),
        "refined_by": list(requirement.refined_by),
        "mitigates": list(requirement.mitigates),
        "priority": requirement.priority or None,
        "verified_by": [
            {
                "method": way.method,
                "id": way.id or None,
                "at": as_dict(way.at) if way.at is not None else None,
                **(_results(way) if way.at is not None else {}),
            }
            for way in requirement.verification
        ],
        "approvals": [{"by": each.by, "on": each.on, "of": each.of or None} for each in requirement.approvals],
        "state": requirement.state,
        "fingerprint": requirement.fingerprint,
        "clauses_without_nodes": list(requirement.loose),
        "evidence": [*map(_evidence, requirement.evidence)] if has_evidence else None,
        "holds_for": [
            {
                "subject": use.subject,
                "nodes": list(use.nodes),
                "arguments": use.arguments,
                "at": as_dict(use.at),
                "attached_by": use.how,
                "clauses": [{"text": clause.text, "how": clause.way, "why": clause.why} for clause in use.clauses],
            }
            for use in requirement.uses
        ],
    }


def _results(way: VerificationRow) -> dict[str, Json]:
    return {"expects": way.expects or None, "outcome": way.outcome or None, "changed": way.is_stale}


def _hazard(hazard: HazardRow) -> Json:
    return {
        "key": hazard.key,
        "id": hazard.name,
        "title": hazard.title,
        "severity": hazard.severity or None,
        "sources": list(hazard.sources),
        "reasons": list(hazard.reasons),
        "at": as_dict(hazard.at),
        "requirements": list(hazard.requirements),
    }


def _external(external: ExternalRow) -> Json:
    fields = as_dict(external)
    return {
        **{"key": fields.pop("key"), "id": fields.pop("name")},
        **fields,
        "at": as_dict(external.at),
        "requirements": list(external.requirements),
        "scenarios": [{"id": way.id, "at": as_dict(way.at), **_results(way)} for way in external.scenarios],
    }


def _total(totals: CharacteristicTotals) -> Json:
    fields = as_dict(totals)
    return {"characteristic": fields.pop("id") or None, **fields}


def _evidence(clause: ClauseEvidence) -> Json:
    fields = as_dict(clause)
    return {**{name: value for name, value in fields.items() if name != "is_suspect"}, "suspect": clause.is_suspect}
