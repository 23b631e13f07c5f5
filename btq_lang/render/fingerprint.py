"""The identity of a finding: it stays when lines around it come and go, or its file gets another name.

It is apart from `report`, which every run imports: hashing is only for baselines and GitLab.
"""

from __future__ import annotations

from hashlib import sha256

from btq_lang.render.report import Finding, clamped, line_index


def fingerprint(finding: Finding) -> str:
    """The same for findings of one rule at equal text: the first line of what is marked, in an equal line.

    Blanks do not count, nor does the message, which may name values of other places.
    """
    span = clamped(finding.diagnostic.span, finding.text)
    lines = line_index(finding.text)
    start = lines.position(span.start)
    line = lines.line(start.line)
    marked = line[start.column : start.column + span.end - span.start]
    parts = (finding.diagnostic.rule, " ".join(marked.split()), " ".join(line.split()))
    return digest(*parts)


def digest(*parts: str) -> str:
    """Sixteen hexadecimal digits for some texts."""
    return sha256("\0".join(parts).encode("utf-8", "surrogatepass")).hexdigest()[:16]
