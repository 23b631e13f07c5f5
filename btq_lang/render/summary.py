"""The findings of a run as counts and in one line."""

from __future__ import annotations

from collections.abc import Iterable

from btq_lang.diagnostics.rules import Severity
from btq_lang.render.report import Finding, Report
from btq_lang.util.text import counted
from btq_lang.workspace.loader import is_project_file

_WORDS = {
    Severity.ERROR: "error",
    Severity.WARNING: "warning",
    Severity.INFO: "info message",
    Severity.HINT: "hint",
}


def last_line(report: Report) -> str:
    """The summary as a line; nothing in a quiet report."""
    return "" if report.is_quiet else f"{summary(report)}\n"


def summary(report: Report) -> str:
    """`Found 3 errors, 1 warning (2 fixable with --fix)`, or that nothing was found."""
    if not report.findings and not report.checked:
        return f"No files were checked: {report.why_empty}" if report.why_empty else "No files were checked"
    serious = [each for each in report.troubles if not (is_project_file(each.path) and each.path in report.checked)]
    incomplete = f"; incomplete because of {serious[0]}" if serious else ""
    if not report.findings and report.troubles:
        return f"Found {counted(len(report.troubles), 'error')}" if not serious else f"Found nothing{incomplete}"
    in_baseline = f", and {report.known} in the baseline" if report.known else ""
    if not report.findings:
        new = "new " if in_baseline else ""
        return f"No {new}problems found in {counted(len(report.checked), 'file')}{in_baseline}"
    fixable = sum(map(is_fixable, report.findings))
    return (
        f"Found {counted_by_severity(report.findings)}"
        + (f" ({fixable} fixable with --fix)" if fixable else "")
        + in_baseline
        + incomplete
    )


def counted_by_severity(findings: Iterable[Finding]) -> str:
    """`3 errors, 1 warning`, worst first; empty for no findings."""
    counts = count(findings)
    return ", ".join(counted(counts[severity], word) for severity, word in _WORDS.items() if counts[severity])


def count(findings: Iterable[Finding]) -> dict[Severity, int]:
    """How many findings there are of each severity, worst first."""
    counts = dict.fromkeys(Severity, 0)
    for finding in findings:
        counts[finding.diagnostic.effective_severity] += 1
    return counts


def is_fixable(finding: Finding) -> bool:
    """Whether `btq check --fix` fixes it."""
    return any(fix.safe for fix in finding.diagnostic.fixes)
