"""Reads the verdicts of a document that `json_document` has written."""

from __future__ import annotations

import json
from typing import Any

from btq_lang.evidence.json_document import FORMAT, VERSION
from btq_lang.evidence.verdicts import ClauseVerdict, Link, RequirementVerdict, Violation, Worst
from btq_lang.evidence.wording import time_of
from btq_lang.util.record import Record


class NotVerdicts(ValueError):
    """A text that is not such a document."""


class WrittenMission(Record):
    """The verdicts of a mission.

    Attributes:
        file: of the mission, as the document names it; empty in documents of older versions.
    """

    name: str
    file: str
    runs: int
    requirements: tuple[RequirementVerdict, ...]


def read_verdicts(text: str) -> tuple[WrittenMission, ...]:
    """The missions of a document.

    Raises:
        NotVerdicts: the text is something else.
    """
    try:
        found = json.loads(text)
        if found["format"] != FORMAT or found["version"] != VERSION:
            raise NotVerdicts(f"expected {FORMAT} {VERSION}, found {found['format']} {found['version']}")
        return tuple(
            WrittenMission(
                each["name"],
                each.get("file", ""),
                each["runs"],
                tuple(map(_requirement, (one for one in found["requirements"] if one["mission"] == each["name"]))),
            )
            for each in found["missions"]
        )
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        why = str(error) if isinstance(error, NotVerdicts) else "expected what btq verify --format json writes"
        raise NotVerdicts(why) from error


def _requirement(found: dict[str, Any]) -> RequirementVerdict:
    return RequirementVerdict(found["id"], found["title"], found["verdict"], tuple(map(_clause, found["clauses"])))


def _clause(found: dict[str, Any]) -> ClauseVerdict:
    fields = {name: found[name] for name in ClauseVerdict.__match_args__ if name in found}
    interval = found["interval"]
    fields |= {
        "of": "",
        "worst": Worst(**found["worst"]) if found["worst"] is not None else None,
        "interval": (interval[0], interval[1]) if interval is not None else None,
        "limits": found["limits"] or "one look",
        "violations": tuple(map(_violation, found["violations"])),
        "histogram": None,
    }
    return ClauseVerdict(**fields)


def _violation(found: dict[str, Any]) -> Violation:
    words = {"measured": found["measured"] or "", "bound": found["bound"] or "", "start": time_of(found["start"])}
    return Violation(**{**found, **words, "chain": tuple(Link(**each) for each in found["chain"])})
