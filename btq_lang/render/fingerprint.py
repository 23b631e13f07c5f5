"""What identifies a finding when lines around it come and go, or its file gets another name."""

from __future__ import annotations

from hashlib import sha256

from btq_lang.render.report import Finding, clamped, line_index


def fingerprint(finding: Finding) -> str:
    """The same for findings of one rule at equal text: the first line of what is marked, in an equal line.

    Blanks do not count, nor does the message, which may name values of other places.
    """
    span = clamped(finding.diagnostic.span, finding.text)
    lines = line_index(finding.text)
    at = lines.position(span.start)
    line = lines.line(at.line)
    marked = line[at.column : at.column + span.end - span.start]
    parts = (finding.diagnostic.rule, " ".join(marked.split()), " ".join(line.split()))
    return digest(*parts)


def digest(*parts: str) -> str:
    """Sixteen hexadecimal digits for some texts."""
    return sha256("\0".join(parts).encode("utf-8", "surrogatepass")).hexdigest()[:16]
