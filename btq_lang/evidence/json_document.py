"""Verdicts for programs: a document that `verdicts.schema.json` describes."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.evidence.wording import timestamp

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import ClauseVerdict, MissionVerdicts, Repeats, Report, RequirementVerdict, Source

    Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"

FORMAT: Final = "btq-verdicts"
VERSION: Final = 1
_OF_NODES: Final = (
    "path",
    "kind",
    "runs",
    "succeeded",
    "failed",
    "halted",
    "interrupted",
    "failures_began",
    "p50",
    "p95",
    "tick_p95",
    "tick_worst",
)


def render(report: Report) -> str:
    """Write the report as JSON."""
    sources = [_source(source, mission) for mission in report.missions for source in mission.sources]
    sources += [{"file": each.file, "mission": None, "runs": each.runs, "remarks": []} for each in report.foreign]
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


def _source(source: Source, mission: MissionVerdicts) -> Json:
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
        "remarks": list(source.remarks),
    }


def _mission(mission: MissionVerdicts) -> Json:
    return {
        "name": mission.name,
        "runs": mission.runs,
        "outcomes": dict(mission.outcomes),
        "retries": _repeats(mission.retries),
        "recoveries": _repeats(mission.recoveries),
        "contexts": [{"name": each.name, "runs": each.runs, "unknown": each.unknown} for each in mission.contexts],
        "nodes": [{name: getattr(node, name) for name in _OF_NODES} for node in mission.nodes],
    }


def _repeats(repeats: Repeats) -> Json:
    return {"total": repeats.total, "most": repeats.most, "run": repeats.run}


def _requirement(requirement: RequirementVerdict, mission: MissionVerdicts) -> Json:
    return {
        "id": requirement.id,
        "mission": mission.name,
        "title": requirement.title,
        "verdict": requirement.verdict,
        "clauses": [_clause(each) for each in requirement.clauses],
    }


def _clause(clause: ClauseVerdict) -> Json:
    worst = clause.worst
    return {
        "text": clause.text,
        "path": clause.path,
        "verdict": clause.verdict,
        "why": clause.why,
        "unit": clause.unit,
        "counted": clause.counted,
        "violated": clause.violated,
        "unknown": clause.unknown,
        "cut_off": clause.cut_off,
        "worst": {"si": worst.si, "text": worst.text, "run": worst.run} if worst is not None else None,
        "interval": list(clause.interval) if clause.interval is not None else None,
        "confidence": clause.confidence,
        "more": clause.more,
        "violations": [
            {
                "run": each.run,
                "source": each.source,
                "path": each.path,
                "start": timestamp(each.start),
                "at": each.at,
                "measured": each.measured or None,
                "bound": each.bound or None,
                "why": each.why,
                "chain": [
                    {
                        "kind": link.kind,
                        "path": link.path,
                        "text": link.text,
                        "seconds": link.seconds,
                        "activations": link.activations,
                        "failed": link.failed,
                    }
                    for link in each.chain
                ],
            }
            for each in clause.violations
        ],
    }
