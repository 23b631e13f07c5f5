"""The clauses of a requirement that demand nothing, resolved: where it is from, what it refines and mitigates, how
important it is, and who has approved it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import date
from typing import Final

from btq_lang.requirements import model
from btq_lang.requirements.paths import PathReader
from btq_lang.syntax import tree as syntax
from btq_lang.util.text import Span


def metadata_of(reader: PathReader, clauses: Sequence[syntax.Clause]) -> dict[str, object]:
    """The fields of a resolved requirement that these clauses set; of several priorities the first counts."""
    sources: list[str] = []
    refines: list[str] = []
    mitigates: list[str] = []
    approvals: list[model.ResolvedApproval] = []
    priority: str | None = None
    for clause in clauses:
        if isinstance(clause, syntax.Source) and clause.text is not None:
            sources.append(clause.text.text)
        elif isinstance(clause, syntax.Refines):
            refines += [name.text for name in clause.names]
        elif isinstance(clause, syntax.Mitigates):
            mitigates += [name.text for name in clause.names]
        elif isinstance(clause, syntax.Priority) and clause.tag is not None:
            priority = priority or clause.tag.text
        elif isinstance(clause, syntax.Approval) and clause.by is not None and clause.on is not None:
            _check_date(reader, clause.on)
            fingerprint = clause.of.text if clause.of is not None else None
            place = reader.place(Span(clause.start, clause.end))
            approvals.append(model.ResolvedApproval(clause.by.text, clause.on.text, fingerprint, place))
    return {
        "sources": tuple(sources),
        "refines": tuple(dict.fromkeys(refines)),
        "mitigates": tuple(dict.fromkeys(mitigates)),
        "priority": priority,
        "approvals": tuple(approvals),
    }


def is_date(text: str) -> bool:
    """Whether a text is a date as ISO 8601 writes it with hyphens: `2026-11-29`."""
    try:
        return _DATE.fullmatch(text) is not None and bool(date.fromisoformat(text))
    except ValueError:
        return False


def _check_date(reader: PathReader, word: syntax.Word) -> None:
    if not is_date(word.text):
        message = f"expected a date as `2026-11-29`, found `{word.text}`"
        reader.complain("invalid-literal", word.span, message)


_DATE: Final = re.compile(r"\d{4}-\d\d-\d\d")
