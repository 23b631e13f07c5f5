"""`json`: everything a report holds, for programs.

The document, format 1; a later btq adds keys but changes none without a new number:

    {"format": 1, "tool": "btq", "version": VERSION,
     "diagnostics": [{"rule": NAME, "severity": "error" | "warning" | "info" | "hint", "message": TEXT,
                      "path": PATH, "range": RANGE, "related": [{"message": TEXT, "path": PATH, "range": RANGE}],
                      "notes": [TEXT], "tags": ["unnecessary" | "deprecated"],
                      "fixes": [{"title": TEXT, "safe": BOOL,
                                 "edits": [{"path": PATH, "range": RANGE, "text": TEXT}]}]}],
     "summary": {"error": N, "warning": N, "info": N, "hint": N, "fixable": N, "files": N}}

    RANGE = {"start": {"line": N, "column": N}, "end": {"line": N, "column": N}}

A file that could not be read or written, or that is not UTF-8, has an entry of its own: `rule` is "io-error", which is
not a rule's name, and `severity` "error"; the summary counts it.

Lines and columns count from 1, columns in Unicode code points, and the end is exclusive.  A fix is `safe` if `btq check
--fix` applies it.  The text is ASCII, so that every terminal and locale carries it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator

from btq_lang.diagnostics.model import Place
from btq_lang.diagnostics.rules import Severity
from btq_lang.render.report import Finding, Report, location
from btq_lang.render.summary import count, is_fixable
from btq_lang.util.version import __version__
from btq_lang.workspace.loader import LoadProblem


def render(report: Report) -> Iterator[str]:
    """The document, in one piece."""
    document = {
        **head(),
        "diagnostics": [
            *map(_trouble, report.troubles),
            *(_diagnostic(report, finding) for finding in report.findings),
        ],
        "summary": summed_up(report),
    }
    yield json.dumps(document, indent=2) + "\n"


def head() -> dict[str, object]:
    """The format's number, and what wrote the document."""
    return {"format": 1, "tool": "btq", "version": __version__}


def summed_up(report: Report) -> dict[str, int]:
    """The totals of a report."""
    counts = count(report.findings)
    counts[Severity.ERROR] += len(report.troubles)
    return {
        **{severity.value: number for severity, number in counts.items()},
        "fixable": sum(map(is_fixable, report.findings)),
        "files": len(report.checked),
    }


def _trouble(trouble: LoadProblem) -> dict[str, object]:
    line, column = trouble.position or (0, 0)
    start = {"line": line + 1, "column": column + 1}
    return {
        "rule": "io-error",
        "severity": Severity.ERROR.value,
        "message": trouble.message,
        "path": trouble.path,
        "range": {"start": start, "end": start},
        "related": [],
        "notes": [],
        "tags": [],
        "fixes": [],
    }


def _diagnostic(report: Report, finding: Finding) -> dict[str, object]:
    diagnostic = finding.diagnostic
    return {
        "rule": diagnostic.rule,
        "severity": diagnostic.effective_severity.value,
        "message": diagnostic.message,
        **_range(report, finding),
        "related": [
            {"message": related.message, **_range(report, finding, related.place)} for related in diagnostic.related
        ],
        "notes": list(diagnostic.notes),
        "tags": [tag.name.lower() for tag in diagnostic.tags],
        "fixes": [
            {
                "title": fix.title,
                "safe": fix.safe,
                "edits": [{**_range(report, finding, change.place), "text": change.text} for change in fix.changes],
            }
            for fix in diagnostic.fixes
        ],
    }


def _range(report: Report, finding: Finding, place: Place | None = None) -> dict[str, object]:
    where = location(report, finding, place)
    return {
        "path": where.path,
        "range": {
            "start": {"line": where.line, "column": where.column},
            "end": {"line": where.end_line, "column": where.end_column},
        },
    }
