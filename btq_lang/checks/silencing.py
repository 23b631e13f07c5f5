"""Edits that add a comment to silence rules: at the end of a line or above it; in XML before the element.

One invariant: an edit adds a comment, and blanks and line ends around it, and changes nothing else.  `suppressions`
reads the comment, and decides what it silences.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import UNREADABLE
from btq_lang.syntax.scan import string_end
from btq_lang.syntax.tokens import COMMENT, STRING
from btq_lang.util.text import LINE_END, Edit, Position, Span
from btq_lang.workspace.file import File


def line_to_silence(file: File, diagnostic: Diagnostic) -> int | None:
    """The line on which a comment can silence a diagnostic of a file; None if no comment can.

    Args:
        diagnostic: counted from the start of the file on the disk.
    """
    start = diagnostic.span.start
    if diagnostic.rule in UNREADABLE:
        return None
    if not file.is_foreign:
        return file.lines.position(start).line
    if any(other.rule == diagnostic.rule for other in file.source_diagnostics):  # it is about the XML, not about a line
        return None
    offset = file.from_disk(start, exact=False)
    return None if offset is None else file.lines.position(offset).line


def at_line_end(file: File, line: int, rules: Sequence[str], reason: str = "") -> Edit | None:
    """A comment at the end of a line; None if it would be in another comment or a text there."""
    end = file.lines.offset(Position(line, len(file.lines.line(line))))
    tokens = file.parsed.tokens
    if any(token.start < end <= token.end and _runs_on(token.text, token.kind) for token in tokens):
        return None
    return Edit(Span(end, end), f"  # {_directive(rules, reason)}")


def above_line(file: File, line: int, rules: Sequence[str], reason: str = "") -> Edit | None:
    """A comment on a line of its own above; None if it would be in another comment or a text there."""
    start = file.lines.offset(Position(line, 0))
    if any(token.start < start < token.end and token.text.strip() for token in file.parsed.tokens):
        return None
    text = file.lines.line(line)
    blanks = text[: len(text) - len(text.lstrip())]
    return Edit(Span(start, start), f"{blanks}# {_directive(rules, reason)}{_line_end(file.text)}")


def before_element(file: File, line: int, rules: Sequence[str], reason: str = "") -> Edit | None:
    """A comment before the element of the XML from which a line was made."""
    if file.places is None:
        return None
    xml, start = file.source, file.lines.offset(Position(line, 0))
    end = start + len(file.lines.line(line))
    begins = [piece[2] for piece in file.places.pieces if start <= piece[0] < end]
    offset = xml.rfind("<", 0, begins[0]) if begins else -1
    return _comment_before(xml, offset, rules, reason) if offset >= 0 else None


def before_tag(file: File, diagnostic: Diagnostic, reason: str = "") -> Edit | None:
    """A comment before the tag or the text of a diagnostic about the XML itself; None for any other diagnostic."""
    if not file.is_foreign or diagnostic.rule in UNREADABLE or diagnostic not in file.source_diagnostics:
        return None
    start = diagnostic.span.start
    tags = (tag.span() for tag in re.finditer(_TAG, file.source, re.DOTALL))
    offset = next((begin for begin, end in tags if begin <= start < end), start)
    return _comment_before(file.source, offset, (diagnostic.rule,), reason)


def _comment_before(xml: str, offset: int, rules: Sequence[str], reason: str) -> Edit:
    blanks = xml[xml.rfind("\n", 0, offset) + 1 : offset]
    above = "" if not blanks.strip() else _line_end(xml)  # else the comment would belong to what is before it
    after = _line_end(xml) + (blanks if not above else "")
    return Edit(Span(offset, offset), f"{above}<!-- {_directive(rules, reason)} -->{after}")


_TAG = r"""<!--.*?-->|<(?:[^"'>]|"[^"]*"|'[^']*')*>"""


def _directive(rules: Sequence[str], reason: str) -> str:
    return f"btq: ignore[{', '.join(rules)}]{' ' if reason else ''}{reason}"


def _line_end(text: str) -> str:
    match = LINE_END.search(text)
    return match[0] if match else "\n"


def _runs_on(text: str, kind: int) -> bool:
    """Whether nothing can follow a token on its line: it is a comment, or a text that goes on or is not closed."""
    if kind == STRING and string_end(text, 1, text[0]) < 0:
        return True
    return kind == COMMENT or ("\n" in text.strip() or "\r" in text.strip())
