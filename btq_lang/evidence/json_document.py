"""Verdicts for programs: a document that `verdicts.schema.json` describes."""

from __future__ import annotations

import json
from collections.abc import Container
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.evidence.wording import timestamp
from btq_lang.util.record import as_dict
from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import (
        ClauseVerdict,
        EvidenceFile,
        Foreign,
        Measures,
        MissionVerdicts,
        RequirementVerdict,
        RunValue,
        VerdictReport,
    )

    Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"

FORMAT: Final = "btq-verdicts"
VERSION: Final = 2


def render(report: VerdictReport) -> str:
    """Write the report as JSON."""
    sources = [_source(source, mission) for mission in report.missions for source in mission.sources]
    sources += [
        {"file": each.file, "mission": None, "runs": each.runs, **_unjoined(each), "remarks": []}
        for each in report.foreign
    ]
    document: Json = {
        "format": FORMAT,
        "version": VERSION,
        "runs": sum(mission.runs for mission in report.missions),
        "sources": sources,
        "remarks": list(report.remarks),
        "missions": [_mission(mission) for mission in report.missions],
        "requirements": [
            _requirement(requirement, mission) for mission in report.missions for requirement in mission.requirements
        ],
    }
    return json.dumps(document, indent=1, allow_nan=False) + "\n"


def _source(source: EvidenceFile, mission: MissionVerdicts) -> Json:
    return {
        "file": source.file,
        "mission": mission.name,
        "runs": source.runs,
        "first_run": source.first_run,
        "start": timestamp(source.begin) if source.begin is not None else None,
        "end": timestamp(source.end) if source.end is not None else None,
        "identity": source.identity,
        "joined": source.joined,
        "nodes": source.nodes,
        **({"left_out": list(source.left_out)} if source.left_out else {}),
        **_unjoined(source),
        "remarks": list(source.remarks),
    }


def _unjoined(source: EvidenceFile | Foreign) -> dict[str, Json]:
    return {"unjoined": list(source.unjoined)} if source.unjoined else {}


def _mission(mission: MissionVerdicts) -> Json:
    return {
        "name": mission.name,
        "file": shown(mission.file),
        "runs": mission.runs,
        **({"outline": mission.outline} if mission.outline else {}),
        "outcomes": dict(mission.outcomes),
        "ended_by": dict(mission.ended_by),
        "retries": _fields(mission.retries),
        "recoveries": _fields(mission.recoveries),
        "contexts": [_fields(each) for each in mission.contexts],
        "nodes": [_fields(node, but=("is_leaf", "written")) for node in mission.nodes],
    }


def _requirement(requirement: RequirementVerdict, mission: MissionVerdicts) -> Json:
    return {
        "id": requirement.id,
        "mission": mission.name,
        "title": requirement.title,
        "verdict": requirement.verdict,
        "clauses": [_clause(each) for each in requirement.clauses],
    }


def _clause(clause: ClauseVerdict) -> Json:
    return {
        **_fields(clause, but=("of", "histogram", "timeline", "measures", "by_run")),
        "worst": _fields(clause.worst) if clause.worst is not None else None,
        "bounded": _fields(clause.bounded) if clause.bounded is not None else None,
        "limits": clause.limits if clause.interval is not None else None,
        "violations": [
            {
                **_fields(each, but=("passed",)),
                "start": timestamp(each.start),
                "measured": each.measured or None,
                "bound": each.bound or None,
                "chain": [_fields(link) for link in each.chain],
            }
            for each in clause.violations
        ],
        **({"by_run": [*map(_run_value, clause.by_run)]} if clause.by_run else {}),
        **({"measures": _measures(clause.measures)} if clause.measures is not None else {}),
    }


def _run_value(value: RunValue) -> Json:
    return {**_fields(value), "start": timestamp(value.start)}


def _measures(measures: Measures) -> Json:
    margins = measures.margins.written() if measures.margins is not None else None
    return {**_fields(measures), "margins": margins}


def _fields(record: object, but: Container[str] = ()) -> dict[str, Json]:
    """The fields of a record by name; the schema has them."""
    return {name: value for name, value in as_dict(record).items() if name not in but}
