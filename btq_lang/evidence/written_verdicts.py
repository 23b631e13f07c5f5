"""Reads the verdicts of a document that `json_document` has written."""

from __future__ import annotations

import json
from typing import Any, Final

from btq_lang.evidence.json_document import FORMAT, VERSION
from btq_lang.evidence.margins import Margins
from btq_lang.evidence.verdicts import (
    Bounded,
    CauseLink,
    ClauseVerdict,
    Measures,
    RequirementVerdict,
    RunValue,
    Violation,
    Worst,
)
from btq_lang.evidence.wording import time_of
from btq_lang.util.record import Record


class NotVerdicts(ValueError):
    """A text that is not such a document."""


class WrittenSource(Record):
    """A log: its runs, the number of the first, when the last one ended, empty without any, whether all nodes were
    found in the mission, and the numbers there of runs that are counted in another log.
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
        found = json.loads(text)
        if found["format"] != FORMAT or found["version"] not in _VERSIONS:
            raise NotVerdicts(f"expected {FORMAT} {VERSION}, found {found['format']} {found['version']}")
        return tuple(
            WrittenMission(
                each["name"],
                each.get("file", ""),
                each["runs"],
                each.get("outline", ""),
                tuple(map(_source, (one for one in found["sources"] if one["mission"] == each["name"]))),
                tuple(map(_requirement, (one for one in found["requirements"] if one["mission"] == each["name"]))),
            )
            for each in found["missions"]
        )
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        why = str(error) if isinstance(error, NotVerdicts) else "expected what btq verify --format json writes"
        raise NotVerdicts(why) from error


def _requirement(found: dict[str, Any]) -> RequirementVerdict:
    return RequirementVerdict(found["id"], found["title"], found["verdict"], tuple(map(_clause, found["clauses"])))


def _source(found: dict[str, Any]) -> WrittenSource:
    is_whole = found["joined"] == found["nodes"]
    end, left_out = found["end"] or "", tuple(found.get("left_out", ()))
    return WrittenSource(found["file"], found["runs"], found["first_run"], end, is_whole, left_out)


def _clause(found: dict[str, Any]) -> ClauseVerdict:
    fields = {name: found[name] for name in ClauseVerdict.__match_args__ if name in found}
    interval = found["interval"]
    fields |= {
        "of": "",
        "worst": Worst(**found["worst"]) if found["worst"] is not None else None,
        "bounded": Bounded(**found["bounded"]) if found.get("bounded") is not None else None,
        "interval": (interval[0], interval[1]) if interval is not None else None,
        "limits": found["limits"] or "one look",
        "violations": tuple(map(_violation, found["violations"])),
        "by_run": tuple(map(_run_value, found.get("by_run", ()))),
        "histogram": None,
        "measures": _measures(found["measures"]) if "measures" in found else None,
    }
    return ClauseVerdict(**fields)


def _run_value(found: dict[str, Any]) -> RunValue:
    return RunValue(**{**found, "start": time_of(found["start"])})


def _measures(found: dict[str, Any]) -> Measures:
    odds, margins = found["odds"], found["margins"]
    read = {"odds": tuple(odds) if odds else None, "margins": Margins.read(margins) if margins else None}
    return Measures(**{**found, **read})


def _violation(found: dict[str, Any]) -> Violation:
    words = {"measured": found["measured"] or "", "bound": found["bound"] or "", "start": time_of(found["start"])}
    return Violation(**{**found, **words, "chain": tuple(CauseLink(**each) for each in found["chain"])})


_VERSIONS: Final = range(1, VERSION + 1)  # what an older one has, this one has too
