"""A report: the findings of one run, the input of every format, and where they are.

Invariant: every place has a location; a span outside its text is clamped, a file without a text counts as empty.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

from btq_lang.diagnostics.model import Diagnostic, Place
from btq_lang.util.record import Record
from btq_lang.util.text import LineIndex, Span

if TYPE_CHECKING:
    from btq_lang.workspace.loader import LoadProblem


class Finding(Record):
    """A diagnostic on its way out: its spans count from the start of `text`, its places have no anchors."""

    path: str
    text: str
    diagnostic: Diagnostic


class Report(Record):
    """The findings of one run.

    Attributes:
        findings: in the order of output.
        texts: of other files that related places and fixes may name; a file without one is shown by its name.
        checked: the requested files, including those without findings.
        troubles: files that could not be read or written, or only in part, so that findings may be missing; for the
            formats for programs: for people, the command prints them itself.
        why_empty: why there are no findings, if known.
        known: the number of findings that a baseline has, and the report leaves out.
        is_quiet: leave out the summary.
    """

    findings: tuple[Finding, ...]
    texts: Mapping[str, str]
    checked: tuple[str, ...] = ()
    troubles: tuple[LoadProblem, ...] = ()
    why_empty: str | None = None
    known: int = 0
    is_quiet: bool = False


class Location(Record):
    """A range of a file; lines and columns from 1, columns in code points, the end exclusive."""

    path: str
    line: int
    column: int
    end_line: int
    end_column: int


def location(report: Report, finding: Finding, place: Place | None = None) -> Location:
    """The location of a place of a finding; without a place, of the finding itself."""
    path = finding.path if place is None or place.path is None else place.path
    span = finding.diagnostic.span if place is None else place.span
    lines = line_index(text_of(report, finding, path) or "")
    start, end = lines.position(span.start), lines.position(max(span))
    return Location(path, start.line + 1, start.column + 1, end.line + 1, end.column + 1)


def text_of(report: Report, finding: Finding, path: str) -> str | None:
    """The text of a file that a finding names; None if it is unknown."""
    return finding.text if path == finding.path else report.texts.get(path)


def clamped(span: Span, text: str) -> Span:
    """The part of a span within the text; empty if there is none."""
    start = max(0, min(span.start, len(text)))
    return Span(start, max(start, min(span.end, len(text))))


@lru_cache(16)  # findings come file by file, so few texts are enough; the hash of a text is computed once
def line_index(text: str) -> LineIndex:
    return LineIndex(text)
