"""What came of the scenarios that verify requirements, by a document of `btq test --format json`."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Final, TypeAlias

from btq_lang.trace.overview import Overview, VerificationRow
from btq_lang.util.record import Record, replace
from btq_lang.workspace.loader import absolute

Results: TypeAlias = "Mapping[tuple[str, str], WrittenResult]"  # by file and title


class WrittenResult(Record):
    """A scenario that ran; fingerprint: of its text, empty if it is not known."""

    outcome: str
    fingerprint: str


def read_results(text: str) -> Results | None:
    """The results in a document; None if it is something else."""
    try:
        document = json.loads(text)
        if (document["format"], document["version"]) != _FORMAT:
            return None
        return {
            (absolute(each["file"]), " ".join(each["title"].split())): WrittenResult(
                str(each["outcome"]), str(each.get("fingerprint", ""))
            )
            for each in document["scenarios"]
        }
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None


def with_results(overview: Overview, results: Results) -> Overview:
    """An overview in which each scenario has what came of it."""
    return replace(
        overview,
        requirements=tuple(
            replace(row, verification=tuple(_told(row.verification, results))) for row in overview.requirements
        ),
        external=tuple(replace(row, scenarios=tuple(_told(row.scenarios, results))) for row in overview.external),
    )


def _told(ways: Iterable[VerificationRow], results: Results) -> Iterable[VerificationRow]:
    for way in ways:
        if way.at is None:
            yield way
        elif (result := results.get((absolute(way.at.path), way.id))) is None:
            yield replace(way, outcome="not run")
        else:
            is_stale = result.fingerprint not in ("", way.fingerprint)
            yield replace(way, outcome=result.outcome, is_stale=is_stale)


_FORMAT: Final = ("btq-scenarios", 1)
