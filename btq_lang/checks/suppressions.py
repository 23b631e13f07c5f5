"""`# btq: ignore[rule, …]`: a comment that silences rules on its line, or, alone on a line, on the next one.

`# btq: ignore` without rules silences all of them there.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from btq_lang.diagnostics import Diagnostic
from btq_lang.tokens import COMMENT
from btq_lang.workspace import File

_IGNORE = re.compile(r"btq:\s*ignore(?:\[([^\]]*)\])?")


def suppressed_lines(file: File) -> Callable[[Diagnostic], bool]:
    """Whether a comment of the file silences a diagnostic, whose span counts from the start of the file."""
    silenced: dict[int, set[str] | None] = {}  # None: every rule
    for token in file.parsed.tokens:
        if token.kind == COMMENT and (match := _IGNORE.search(token.text)):
            line = file.lines.position(token.start).line
            alone = not file.text[: token.start].rpartition("\n")[2].strip()
            rules = {rule.strip() for rule in match[1].split(",")} if match[1] is not None else None
            silenced[line + 1 if alone else line] = rules

    def suppressed(diagnostic: Diagnostic) -> bool:
        line = file.lines.position(diagnostic.span.start).line
        if line not in silenced:
            return False
        rules = silenced[line]
        return rules is None or diagnostic.rule in rules

    return suppressed
