"""`# btq: ignore[rule, …]`: a comment that silences rules on its line, or, alone on a line, on the next one.

Such comments may follow each other: they all apply to the next line that is not a comment.

`# btq: ignore` without rules silences all of them there.  Nothing silences an error after which the file cannot be read
reliably.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from btq_lang.diagnostics.model import Diagnostic, replace_fix, write_fix
from btq_lang.diagnostics.rules import RULES, UNREADABLE, Severity
from btq_lang.syntax.tokens import COMMENT, Token
from btq_lang.syntax.tree import quote
from btq_lang.util.spelling import near
from btq_lang.util.text import Span
from btq_lang.workspace.config import unknown_rule
from btq_lang.workspace.file import File

_IGNORE = r"btq:\s*ignore(?![\w-])(\s*\[([^\]]*)(\])?)?"  # few files have one, so it is compiled when it is used

# What a comment in XML silences for the rules on the XML itself: the next tag, and the text before it.
_UP_TO_TAG = r"""(?:[^<]|<!--.*?-->)*<(?:[^"'>]|"[^"]*"|'[^']*')*"""


def is_silenced_in_xml(xml: str, diagnostic: Diagnostic) -> bool:
    """Whether a comment in XML silences a diagnostic of the XML itself, which counts from its start."""
    if diagnostic.rule in UNREADABLE or "btq:" not in xml:
        return False
    for comment in re.finditer(r"<!--.*?-->", xml[: diagnostic.span.start], re.DOTALL):
        match = re.search(_IGNORE, comment[0])
        if match is None or (match[1] and not match[3]):
            continue
        named = match[2] is None or diagnostic.rule in re.split(r"[\s,]+", match[2])
        silenced = re.compile(_UP_TO_TAG, re.DOTALL).match(xml, comment.end()) if named else None
        if silenced is not None and diagnostic.span.start <= silenced.end():
            return True
    return False


class Suppressions:
    """The comments of a file that silence rules.

    Attributes:
        useless: diagnostics about comments; spans count from the start of the file.
    """

    def __init__(self, file: File) -> None:
        self._lines = file.lines
        self._is_btq = file.is_btq
        self._everything: set[int] = set()
        self._silenced: dict[int, set[str]] = {}
        self.useless: list[Diagnostic] = []
        target_lines: dict[int, int] = {}  # by each line that is only a comment, the next line that is not
        for token in reversed(file.parsed.tokens):
            if token.kind != COMMENT:
                continue
            start = file.lines.position(token.start)
            line = start.line
            if not file.lines.line(line)[: start.column].strip():
                next_line = file.lines.position(token.end).line + 1
                target_lines[line] = target_lines.get(next_line, next_line)
                line = target_lines[line]
            self._read(token, line)

    def silence(self, diagnostic: Diagnostic) -> bool:
        """Whether a comment silences a diagnostic, whose span counts from the start of the file."""
        if diagnostic.rule in UNREADABLE:
            return False
        line = self._lines.position(diagnostic.span.start).line
        return line in self._everything or diagnostic.rule in self._silenced.get(line, ())

    def _read(self, token: Token, line: int) -> None:
        match = re.search(_IGNORE, token.text)
        if match is None:
            self.useless += _include(token) if self._is_btq else ()
            return
        if match[1] and not match[3]:
            span = Span(*match.span()).shifted(token.start)
            message = "this comment silences nothing: missing `]`"
            self.useless.append(Diagnostic("useless-ignore", span, message))
        elif match[2] is None:
            self._everything.add(line)
        else:
            for name in re.finditer(r"[^\s,](?:[^,]*[^\s,])?", match[2]):
                self._silenced.setdefault(line, set()).add(name[0])
                self.useless += _useless(name[0], Span(*name.span()).shifted(token.start + match.start(2)))


def _include(token: Token) -> Iterator[Diagnostic]:
    """`#include "stations.btq"`, as in C++."""
    match = re.fullmatch(r"""#(?:include|import)[ \t]*["'<]?([^"'<>\s]+\.(?:btq|xml))["'>]?[ \t]*;?""", token.text)
    if match is not None:
        span = Span(token.start, token.end)
        line = f"include {quote(match[1])}"
        message = f"this is a comment; did you mean `{line}`?"
        yield Diagnostic("missing-include", span, message, fixes=(write_fix(line, span),), severity=Severity.HINT)


def _useless(name: str, span: Span) -> Iterator[Diagnostic]:
    if message := unknown_rule(name):
        likely = near(name, RULES, limit=1)
        fixes = tuple(replace_fix(f"Replace `{name}` with `{rule}`", span, rule) for rule in likely)
        yield Diagnostic("useless-ignore", span, message, fixes=fixes)
    elif name in UNREADABLE:
        message = f"`{name}` cannot be silenced: after this error btq cannot read the file reliably"
        yield Diagnostic("useless-ignore", span, message)
