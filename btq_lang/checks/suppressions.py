"""`# btq: ignore[rule, …]`: a comment that silences rules on its line, or, alone on a line, on the next one.

Such comments may follow each other: they all mean the first line behind them that is no comment.

`# btq: ignore` without rules silences all of them there.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from btq_lang.diagnostics import Diagnostic
from btq_lang.tokens import COMMENT
from btq_lang.workspace import File

_IGNORE = r"btq:\s*ignore(?![\w-])(\s*\[([^\]]*)(\])?)?"  # few files have one, so it is compiled when it is used


def suppressed_lines(file: File) -> Callable[[Diagnostic], bool]:
    """Whether a comment of the file silences a diagnostic, whose span counts from the start of the file."""
    everything: set[int] = set()
    silenced: dict[int, set[str]] = {}
    meant: dict[int, int] = {}  # of lines that are only a comment: the line behind them that is more
    for token in reversed(file.parsed.tokens):
        if token.kind != COMMENT:
            continue
        start = file.lines.position(token.start)
        line = start.line
        if not file.lines.line(line)[: start.column].strip():
            behind = file.lines.position(token.end).line + 1
            meant[line] = meant.get(behind, behind)
            line = meant[line]
        match = re.search(_IGNORE, token.text)
        if match is None or (match[1] and not match[3]):
            continue
        if match[2] is None:
            everything.add(line)
        else:
            silenced.setdefault(line, set()).update(rule.strip() for rule in match[2].split(","))

    def suppressed(diagnostic: Diagnostic) -> bool:
        line = file.lines.position(diagnostic.span.start).line
        return line in everything or diagnostic.rule in silenced.get(line, ())

    return suppressed
