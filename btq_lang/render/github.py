"""`github`: workflow commands, which GitHub Actions shows as annotations on the changed lines.

    ::error file=lab.btq,line=3,endLine=3,col=9,endColumn=13,title=unknown-node::lab.btq:3:9: no node `Rety` is known

The escapes are those of actions/toolkit (packages/core/src/command.ts), except `%0D`: carriage returns do not get that
far.  The log shows only the message, so that repeats the place.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.diagnostics.rules import Severity
from btq_lang.render.cells import printable
from btq_lang.render.report import Finding, Report, location
from btq_lang.workspace.loader import LoadProblem

_COMMANDS = {
    Severity.ERROR: "error",
    Severity.WARNING: "warning",
    Severity.INFO: "notice",
    Severity.HINT: "notice",
}


def render(report: Report) -> Iterator[str]:
    """A line for each file that could not be read or written, and for each finding."""
    yield from map(_trouble, report.troubles)
    for finding in report.findings:
        yield _command(report, finding)


def _trouble(trouble: LoadProblem) -> str:
    position = trouble.position
    place = f",line={position.line + 1},col={position.column + 1}" if position is not None else ""
    return f"::error file={_property(trouble.path)}{place},title=io-error::{_data([str(trouble)])}\n"


def _command(report: Report, finding: Finding) -> str:
    diagnostic = finding.diagnostic
    where = location(report, finding)
    properties = {"file": printable(where.path), "line": where.line, "endLine": where.end_line}
    if where.line == where.end_line:  # GitHub refuses columns for annotations over several lines
        properties |= {"col": where.column, "endColumn": where.end_column}
    properties["title"] = diagnostic.rule
    lines = [
        f"{where.path}:{where.line}:{where.column}: {diagnostic.message}",
        *(f"note: {note}" for note in diagnostic.notes),
        *(f"help: {fix.title}" for fix in diagnostic.fixes),
    ]
    parameters = ",".join(f"{key}={_property(str(value))}" for key, value in properties.items())
    return f"::{_COMMANDS[diagnostic.effective_severity]} {parameters}::{_data(lines)}\n"


def _data(lines: list[str]) -> str:
    shown = "\n".join(printable(line) for text in lines for line in text.split("\n"))
    return shown.replace("%", "%25").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data([text]).replace(":", "%3A").replace(",", "%2C")
