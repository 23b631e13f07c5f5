"""`sarif`: SARIF 2.1.0 (OASIS, sarif-v2.1.0-os), which GitHub code scanning, Azure DevOps and editors read.

Invariant: one run, one result a finding, and just the rules that have results, in the order of the table of rules.
Columns are code points, which `columnKind` declares.  Relative paths are below `%SRCROOT%`, GitHub's name for the
checkout.  One departure: `{` in a message is not doubled, as §3.11.5 demands; viewers do not undo that in messages
without arguments, and `{{goal}}` would mislead.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from urllib.parse import quote

from btq_lang.diagnostics.model import Fix, Place
from btq_lang.diagnostics.rules import RULES, Severity, page
from btq_lang.render.report import Finding, Report, location
from btq_lang.util.version import __version__
from btq_lang.workspace.loader import LoadProblem

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note", Severity.HINT: "note"}

Json = dict[str, object]


def render(report: Report, page: Callable[[str], str] = page) -> Iterator[str]:
    """The log, in one piece; `page` returns the Markdown page of a rule."""
    used = {finding.diagnostic.rule for finding in report.findings}
    indexes = {rule: index for index, rule in enumerate(rule for rule in RULES if rule in used)}
    log = {
        "$schema": _SCHEMA,
        "version": "2.1.0",
        "runs": [
            {
                "tool": {
                    "driver": {
                        "name": "btq",
                        "version": __version__,
                        "rules": [_rule(rule, page) for rule in indexes],
                    }
                },
                **_invocations(report.troubles),
                "columnKind": "unicodeCodePoints",
                "results": [_result(report, finding, indexes) for finding in report.findings],
            }
        ],
    }
    yield json.dumps(log, indent=2) + "\n"


def _rule(name: str, page: Callable[[str], str]) -> Json:
    rule = RULES[name]
    text = page(name)
    return {
        "id": name,
        "shortDescription": {"text": rule.summary},
        "help": {"text": text, "markdown": text},
        "defaultConfiguration": {"level": _LEVELS[rule.severity]},
    }


def _invocations(troubles: tuple[LoadProblem, ...]) -> Json:
    """The failures to read or write files (§3.20); empty without any."""
    if not troubles:
        return {}
    notifications = [
        {"level": "error", "message": {"text": trouble.message}, "locations": [{"physicalLocation": _where(trouble)}]}
        for trouble in troubles
    ]
    return {"invocations": [{"executionSuccessful": False, "toolExecutionNotifications": notifications}]}


def _where(trouble: LoadProblem) -> Json:
    where: Json = {"artifactLocation": _artifact(trouble.path)}
    if trouble.position is not None:
        where["region"] = {"startLine": trouble.position.line + 1, "startColumn": trouble.position.column + 1}
    return where


def _result(report: Report, finding: Finding, indexes: dict[str, int]) -> Json:
    diagnostic = finding.diagnostic
    result: Json = {
        "ruleId": diagnostic.rule,
        "ruleIndex": indexes[diagnostic.rule],
        "level": _LEVELS[diagnostic.effective_severity],
        "message": {"text": "\n".join([diagnostic.message, *(f"note: {note}" for note in diagnostic.notes)])},
        "locations": [{"physicalLocation": _physical(report, finding)}],
    }
    if diagnostic.related:
        result["relatedLocations"] = [
            {
                "id": number,
                "message": {"text": related.message},
                "physicalLocation": _physical(report, finding, related.place),
            }
            for number, related in enumerate(diagnostic.related, 1)
        ]
    if fixes := [_fix(report, finding, fix) for fix in diagnostic.fixes if fix.changes]:
        result["fixes"] = fixes
    return result


def _fix(report: Report, finding: Finding, fix: Fix) -> Json:
    changes: dict[str, list[Json]] = {}
    for change in fix.changes:
        replacement = {
            "deletedRegion": _region(report, finding, change.place),
            "insertedContent": {"text": change.text},
        }
        changes.setdefault(change.place.path or finding.path, []).append(replacement)
    return {
        "description": {"text": fix.title},
        "artifactChanges": [
            {"artifactLocation": _artifact(path), "replacements": replacements}
            for path, replacements in changes.items()
        ],
    }


def _physical(report: Report, finding: Finding, place: Place | None = None) -> Json:
    path = finding.path if place is None or place.path is None else place.path
    return {"artifactLocation": _artifact(path), "region": _region(report, finding, place)}


def _region(report: Report, finding: Finding, place: Place | None) -> Json:
    where = location(report, finding, place)
    return {
        "startLine": where.line,
        "startColumn": where.column,
        "endLine": where.end_line,
        "endColumn": where.end_column,
    }


def _artifact(path: str) -> Json:
    try:
        name = path.encode("utf-8", "surrogateescape")  # a file name may contain bytes that are not UTF-8
    except UnicodeEncodeError:
        name = path.encode("utf-8", "surrogatepass")
    uri = quote(name, safe="/")
    if path.startswith("/"):
        return {"uri": f"file://{uri}"}
    if path[1:3] == ":/":  # a drive of Windows
        return {"uri": f"file:///{path[0]}:{uri[len(path[0]) + 3 :]}"}
    return {"uri": uri, "uriBaseId": "%SRCROOT%"}
