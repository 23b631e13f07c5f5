"""The formats in which `btq verify` writes verdicts, each with its writer."""

from __future__ import annotations

from btq_lang.record import Record

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Final

    from btq_lang.evidence.verdicts import Report


class Judged(Record):
    """What is to be written.

    Attributes:
        verbose, colour: for `table`.
    """

    report: Report
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


WRITERS: Final[dict[str, Callable[[Judged], str]]] = {
    "table": _table,
    "json": _json,
    "csv": _csv,
    "junit": _junit,
    "markdown": _markdown,
}
FORMATS: Final = tuple(WRITERS)
