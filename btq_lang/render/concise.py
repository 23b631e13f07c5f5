"""`concise`: one line a finding, `path:line:column: severity[rule] message`, as editors and grep read it.

It is apart from `full`, because a run imports only the renderer that it uses.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.render.cells import printable
from btq_lang.render.colour import painter
from btq_lang.render.report import Report, location
from btq_lang.render.summary import last_line


def render(report: Report, *, colour: bool = False) -> Iterator[str]:
    """A line for each finding, then the summary."""
    paint = painter(colour)
    for finding in report.findings:
        where = location(report, finding)
        severity = finding.diagnostic.effective_severity.value
        rule = paint(severity, f"{severity}[{finding.diagnostic.rule}]")
        yield f"{printable(where.path)}:{where.line}:{where.column}: {rule} {printable(finding.diagnostic.message)}\n"
    yield last_line(report)
