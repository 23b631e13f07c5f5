"""`gitlab`: a Code Quality report, which GitLab compares with that of the target branch and shows in merge requests.

    [{"description": "unknown-node: …", "check_name": "unknown-node", "fingerprint": "…", "severity": "minor",
      "location": {"path": "lab.btq", "positions": {"begin": {"line": 3, "column": 9}, "end": …}}}]

Invariant: fingerprints are unique in a report, and stay when lines above are added or removed.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator

from btq_lang.diagnostics.rules import Severity
from btq_lang.render.fingerprint import digest, fingerprint
from btq_lang.render.report import Finding, Report, location
from btq_lang.workspace.loader import LoadProblem

_SEVERITIES = {Severity.ERROR: "major", Severity.WARNING: "minor", Severity.INFO: "info", Severity.HINT: "info"}


def render(report: Report) -> Iterator[str]:
    """The report, in one piece."""
    counts: Counter[tuple[str, str]] = Counter()
    issues = [*map(_trouble, report.troubles), *(_issue(report, finding, counts) for finding in report.findings)]
    yield json.dumps(issues, indent=2) + "\n"


def _issue(report: Report, finding: Finding, counts: Counter[tuple[str, str]]) -> dict[str, object]:
    diagnostic, where = finding.diagnostic, location(report, finding)
    identity = finding.path, fingerprint(finding)
    counts[identity] += 1  # only their order distinguishes findings with equal text
    return {
        "description": f"{diagnostic.rule}: {diagnostic.message}",  # GitLab does not show check_name
        "check_name": diagnostic.rule,
        "fingerprint": digest(*identity, str(counts[identity])),
        "severity": _SEVERITIES[diagnostic.effective_severity],
        "location": {
            "path": finding.path,
            "positions": {
                "begin": {"line": where.line, "column": where.column},
                "end": {"line": where.end_line, "column": where.end_column},
            },
        },
    }


def _trouble(trouble: LoadProblem) -> dict[str, object]:
    line, column = trouble.position or (0, 0)
    begin = {"line": line + 1, "column": column + 1}
    return {
        "description": f"io-error: {trouble.message}",
        "check_name": "io-error",
        "fingerprint": digest("io-error", str(trouble)),
        "severity": "critical",
        "location": {"path": trouble.path, "positions": {"begin": begin, "end": begin}},
    }
