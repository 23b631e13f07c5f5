"""Verdicts for programs: writes and reads a document that `verdicts.schema.json` describes."""

from __future__ import annotations

import json
from collections.abc import Container, Iterable, Iterator
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from btq_lang.evidence.margins import Margins
from btq_lang.evidence.verdicts import (
    Bounded,
    CauseLink,
    ClauseVerdict,
    Measures,
    Pooled,
    RequirementLinks,
    RequirementVerdict,
    RunValue,
    Violation,
    Worst,
)
from btq_lang.evidence.wording import time_of, timestamp
from btq_lang.util.record import Record, as_dict, fields_of
from btq_lang.workspace.loader import shown

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import EvidenceFile, Foreign, MissionVerdicts, VerdictReport

    Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"


FORMAT: Final = "btq-verdicts"
VERSION: Final = 2


def render(report: VerdictReport) -> str:
    """Write the report as JSON."""
    sources = [_source(source, mission) for mission in report.missions for source in mission.sources]
    sources += [
        {"file": foreign.file, "mission": None, "runs": foreign.runs, **_unjoined(foreign), "remarks": []}
        for foreign in report.foreign
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
        "nodes": [_fields(node, exclude=("is_leaf", "written")) for node in mission.nodes],
    }


def _requirement(requirement: RequirementVerdict, mission: MissionVerdicts) -> Json:
    return {
        "id": requirement.id,
        "mission": mission.name,
        "title": requirement.title,
        "verdict": requirement.verdict,
        **{name: links if isinstance(links, str) else [*links] for name, links in requirement.links.named.items()},
        **({"fingerprints": [*requirement.fingerprints]} if requirement.fingerprints else {}),
        **({"suspect": True} if requirement.is_suspect else {}),
        "clauses": [_clause(each) for each in requirement.clauses],
    }


def _clause(clause: ClauseVerdict) -> Json:
    return {
        **_fields(clause, exclude=("of", "histogram", "timeline", "measures", "by_run", "pooled")),
        "worst": _fields(clause.worst) if clause.worst is not None else None,
        "bounded": _fields(clause.bounded) if clause.bounded is not None else None,
        "limits": clause.limits if clause.interval is not None else None,
        "violations": [
            {
                **_fields(violation, exclude=("passed",)),
                "start": timestamp(violation.start),
                "measured": violation.measured or None,
                "bound": violation.bound or None,
                "chain": [_fields(link) for link in violation.chain],
            }
            for violation in clause.violations
        ],
        **({"pooled": _fields(clause.pooled)} if clause.pooled is not None else {}),
        **({"by_run": [*map(_run_value, clause.by_run)]} if clause.by_run else {}),
        **({"measures": _measures(clause.measures)} if clause.measures is not None else {}),
    }


def _run_value(value: RunValue) -> Json:
    return {**_fields(value), "start": timestamp(value.start)}


def _measures(measures: Measures) -> Json:
    margins = measures.margins.written() if measures.margins is not None else None
    return {**_fields(measures), "margins": margins}


def _fields(record: object, exclude: Container[str] = ()) -> dict[str, Json]:
    """The fields of a record, by name; the schema describes each of them."""
    return {name: value for name, value in as_dict(record).items() if name not in exclude}


class NotVerdicts(ValueError):
    """Text that is not a verdicts document."""


class WrittenSource(Record):
    """A log, as the document describes it.

    Attributes:
        runs: how many runs of the mission it contains.
        first_run: the number of the first of them.
        end: when the last of them ended; empty if there are none.
        is_whole: whether all nodes of the log were found in the mission.
        left_out: the numbers, in this log, of the runs that are counted in another log.
    """

    file: str
    runs: int
    first_run: int
    end: str
    is_whole: bool
    left_out: tuple[int, ...]


class WrittenMission(Record):
    """The verdicts of a mission.

    Attributes:
        file: of the mission, as the document names it; empty in documents of older versions.
        outline: as in `MissionVerdicts`.
        sources: the logs, in the order of their runs.
    """

    name: str
    file: str
    runs: int
    outline: str
    sources: tuple[WrittenSource, ...]
    requirements: tuple[RequirementVerdict, ...]


def read_verdicts(text: str) -> tuple[WrittenMission, ...]:
    """The missions of a document.

    Raises:
        NotVerdicts: the text is something else.
    """
    try:
        document = json.loads(text)
        if document["format"] != FORMAT or document["version"] not in _VERSIONS:
            expected = " or ".join(map(str, _VERSIONS))
            raise NotVerdicts(f"expected {FORMAT} {expected}, found {document['format']} {document['version']}")
        return tuple(
            WrittenMission(
                mission["name"],
                mission.get("file", ""),
                mission["runs"],
                mission.get("outline", ""),
                tuple(map(_read_source, _parts_of(mission, document["sources"]))),
                tuple(map(_read_requirement, _parts_of(mission, document["requirements"]))),
            )
            for mission in document["missions"]
        )
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        why = str(error) if isinstance(error, NotVerdicts) else _OTHER_TEXT
        raise NotVerdicts(why) from error


def _parts_of(mission: dict[str, Any], parts: Iterable[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """The sources or the requirements of a mission."""
    return (part for part in parts if part["mission"] == mission["name"])


def _read_requirement(data: dict[str, Any]) -> RequirementVerdict:
    links: dict[str, Any] = {
        name: data[name] if isinstance(data[name], str) else tuple(data[name])
        for name in fields_of(RequirementLinks())
        if name in data
    }
    return RequirementVerdict(
        *(data["id"], data["title"], data["verdict"], tuple(map(_read_clause, data["clauses"]))),
        RequirementLinks(**links),
        tuple(data.get("fingerprints", ())),
    )


def _read_source(data: dict[str, Any]) -> WrittenSource:
    is_whole = data["joined"] == data["nodes"]
    end, left_out = data["end"] or "", tuple(data.get("left_out", ()))
    return WrittenSource(data["file"], data["runs"], data["first_run"], end, is_whole, left_out)


def _read_clause(data: dict[str, Any]) -> ClauseVerdict:
    fields = {name: data[name] for name in ClauseVerdict.__match_args__ if name in data}
    interval = data["interval"]
    fields |= {
        "of": "",
        "worst": Worst(**data["worst"]) if data["worst"] is not None else None,
        "bounded": Bounded(**data["bounded"]) if data.get("bounded") is not None else None,
        "interval": (interval[0], interval[1]) if interval is not None else None,
        "limits": data["limits"] or "one look",
        "violations": tuple(map(_read_violation, data["violations"])),
        "by_run": tuple(map(_read_run_value, data.get("by_run", ()))),
        "histogram": None,
        "pooled": Pooled(**data["pooled"]) if "pooled" in data else None,
        "measures": _read_measures(data["measures"]) if "measures" in data else None,
    }
    return ClauseVerdict(**fields)


def _read_run_value(data: dict[str, Any]) -> RunValue:
    return RunValue(**{**data, "start": time_of(data["start"])})


def _read_measures(data: dict[str, Any]) -> Measures:
    odds, margins = data["odds"], data["margins"]
    read = {"odds": tuple(odds) if odds else None, "margins": Margins.read(margins) if margins else None}
    return Measures(**{**data, **read})


def _read_violation(data: dict[str, Any]) -> Violation:
    converted = {"measured": data["measured"] or "", "bound": data["bound"] or "", "start": time_of(data["start"])}
    return Violation(**{**data, **converted, "chain": tuple(CauseLink(**link) for link in data["chain"])})


_VERSIONS: Final = range(1, VERSION + 1)  # each version only adds fields
_OTHER_TEXT: Final = "this is not a document that btq verify --format json wrote"
