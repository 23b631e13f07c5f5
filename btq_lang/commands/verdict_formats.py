"""The formats in which `btq verify` writes verdicts, each with its writer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.verdicts import Report


class Judged(Record):
    """What is to be written.

    Attributes:
        missions: that were given; those of the report are among them.
        verbose, colour: for `table`.
    """

    report: Report
    missions: Sequence[Candidate]
    verbose: bool = False
    colour: bool = False


def _table(judged: Judged) -> str:
    from btq_lang.evidence.table import table

    return table(judged.report, judged.colour, judged.verbose)


def _json(judged: Judged) -> str:
    from btq_lang.evidence.json_document import json_text

    return json_text(judged.report)


def _csv(judged: Judged) -> str:
    from btq_lang.evidence.csv_rows import csv_text

    return csv_text(judged.report)


def _junit(judged: Judged) -> str:
    from btq_lang.evidence.junit import junit

    return junit(judged.report)


def _markdown(judged: Judged) -> str:
    from btq_lang.evidence.markdown import markdown

    return markdown(judged.report)


def _html(judged: Judged) -> str:
    from btq_lang.trace.missions import trace_tables
    from btq_lang.trace.page import page
    from btq_lang.trace.verdicts import outcomes

    found = judged.report.missions
    files = {mission.file for mission in found}
    parts = [(each.workspace, [each.path]) for each in judged.missions if each.path in files]
    return page(trace_tables(parts, said_of=outcomes(found)).overview, found)


WRITERS: Final[dict[str, Callable[[Judged], str]]] = {
    "table": _table,
    "json": _json,
    "csv": _csv,
    "junit": _junit,
    "markdown": _markdown,
    "html": _html,
}
FORMATS: Final = tuple(WRITERS)
