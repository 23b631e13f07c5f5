"""A report: the findings of one run, the input of every format."""

from __future__ import annotations

from collections.abc import Mapping

from btq_lang.diagnostics.model import Diagnostic
from btq_lang.util.record import Record


class Finding(Record):
    """A diagnostic on its way out: its spans count from the start of `text`, its places have no anchors."""

    path: str
    text: str
    diagnostic: Diagnostic


class Trouble(Record):
    """A file that could not be read or written, or only in part, so that findings may be missing.

    Line and column count from 1; None: the whole file.
    """

    path: str
    message: str
    line: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        place = f":{self.line}:{self.column}" if self.line is not None else ""
        return f"{self.path}{place}: {self.message}"


class Report(Record):
    """The findings of one run.

    Attributes:
        findings: in the order of output.
        texts: of other files that related places and fixes may name; a file without one is shown by its name.
        checked: the requested files, including those without findings.
        troubles: for the formats for programs; for people, the command prints them itself.
        why_empty: why there are no findings, if known.
        known: the number of findings that a baseline has, and the report leaves out.
    """

    findings: tuple[Finding, ...]
    texts: Mapping[str, str]
    checked: tuple[str, ...] = ()
    troubles: tuple[Trouble, ...] = ()
    why_empty: str | None = None
    known: int = 0
