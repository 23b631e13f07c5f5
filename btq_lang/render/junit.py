"""`junit`: the XML that CI servers read as test results: a test case for each file that was checked.

Errors and warnings of a file make its one `<failure>`, a line each, because GitLab and Jenkins ignore a second one;
milder findings are in its `<system-out>`.  A file that could not be read or written has an `<error>`.  Invariant: the
XML is well formed for every text.  Format: the JUnit schema of Jenkins' xUnit plugin (junit-10.xsd).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.diagnostics.rules import Severity
from btq_lang.render.cells import printable
from btq_lang.render.report import Finding, Report, location
from btq_lang.render.summary import counted_by_severity
from btq_lang.util.grouping import grouped
from btq_lang.workspace.loader import LoadProblem

_FAILURES = (Severity.ERROR, Severity.WARNING)


def render(report: Report) -> Iterator[str]:
    """The document, line by line."""
    by_path = grouped((finding.path, finding) for finding in report.findings)
    troubles = grouped((trouble.path, trouble) for trouble in report.troubles)
    cases = {path: by_path.get(path, []) for path in (*report.checked, *by_path, *troubles)}
    failures = sum(any(map(_fails, case)) for path, case in cases.items() if path not in troubles)
    numbers = f'tests="{len(cases)}" failures="{failures}" errors="{len(troubles)}"'
    yield '<?xml version="1.0" encoding="UTF-8"?>\n'
    yield f'<testsuites name="btq check" {numbers}>\n'
    yield f'  <testsuite name="btq check" {numbers}>\n'
    for path, findings in cases.items():
        yield from _case(report, path, findings, troubles.get(path, []))
    yield "  </testsuite>\n</testsuites>\n"


def _case(report: Report, path: str, findings: list[Finding], troubles: list[LoadProblem]) -> Iterator[str]:
    """A test case; with an `<error>` it has no `<failure>`, because a test case has one result."""
    failures = [finding for finding in findings if not troubles and _fails(finding)]
    others = [finding for finding in findings if troubles or not _fails(finding)]
    start = f'    <testcase classname="btq" name="{escaped(path)}" file="{escaped(path)}" time="0"'
    if not findings and not troubles:
        yield start + "/>\n"
        return
    yield start + ">\n"
    if troubles:
        yield f'      <error type="io-error" message="{escaped(troubles[0].message)}">'
        yield "\n".join(escaped(str(trouble)) for trouble in troubles) + "</error>\n"
    if failures:
        severities = {finding.diagnostic.effective_severity for finding in failures}
        worst = next(severity for severity in _FAILURES if severity in severities)
        yield f'      <failure type="{worst.value}" message="{counted_by_severity(failures)}">'
        yield "\n".join(_lines(report, failures)) + "</failure>\n"
    if others:
        yield "      <system-out>" + "\n".join(_lines(report, others)) + "</system-out>\n"
    yield "    </testcase>\n"


def _fails(finding: Finding) -> bool:
    return finding.diagnostic.effective_severity in _FAILURES


def _lines(report: Report, findings: Iterable[Finding]) -> Iterator[str]:
    for finding in findings:
        where, diagnostic = location(report, finding), finding.diagnostic
        severity = diagnostic.effective_severity.value
        yield escaped(f"{where.path}:{where.line}:{where.column}: {severity}[{diagnostic.rule}] {diagnostic.message}")
        for note in diagnostic.notes:
            yield from (escaped(f"  {line}") for line in note.split("\n"))


def escaped(text: str) -> str:
    """The text escaped for XML 1.0 content and attributes; `printable` removes control characters and surrogates."""
    return printable(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;").replace('"', "&quot;")
