"""Converts places to lines and columns that count from 1.

Invariant: every place has a location; a span outside its text is clamped, a file without a text counts as empty.
"""

from __future__ import annotations

from functools import lru_cache

from btq_lang.diagnostics.model import Place
from btq_lang.render.report import Finding, Report
from btq_lang.util.record import Record
from btq_lang.util.text import LineIndex, Span


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
