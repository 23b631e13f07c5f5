"""Clauses that qualify all claims of their requirement, and are written as if they qualified one.

One invariant: nothing is reported where the layout says what holds: claims on one line, and a qualifier on its own line
or on the line of each claim.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from btq_lang.catalog.verbs import POOLED, VERBS
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.scan import line_start
from btq_lang.util.text import Span

SPLIT: Final = "to have it for one claim alone, split the requirement"


def qualifier_of_all(view: View) -> Iterator[Diagnostic]:
    """A qualifier on the line of one of several claims, all of which it qualifies."""
    for _, requirement in view.requirements:
        claims = [clause for clause in requirement.clauses if isinstance(clause, syntax.Claim)]
        if len(claims) < 2:
            continue
        for clause in requirement.clauses:
            if not isinstance(clause, _QUALIFIERS) or not _takes_effect(requirement, clause, claims):
                continue
            if is_beside_one(view.text, requirement, clause) and not view.is_torn(requirement.start, requirement.end):
                message = f"`{_words(view.text, clause)}` holds for all {len(claims)} claims of this requirement"
                span, notes = Span(clause.start, clause.end), (f"put it on its own line; {SPLIT}",)
                fixes = _fixes(view.text, requirement, clause)
                if isinstance(clause, syntax.FromUntil) and not all(VERBS[claim.row].is_of_moments for claim in claims):
                    notes, fixes = (f"{SPLIT}: `from … until` is for `keeps` and `never` only",), ()
                yield Diagnostic("qualifier-of-all", span, message, notes=notes, fixes=fixes)


def is_beside_one(text: str, requirement: syntax.Requirement, clause: syntax.Clause) -> bool:
    """Whether a clause is on the line of one of several claims, without an equal one on the line of each other."""
    starts = _line_starts(text, requirement)
    claimed = {starts[other.start] for other in requirement.clauses if isinstance(other, syntax.Claim)}
    if len(claimed) < 2 or starts[clause.start] not in claimed:
        return False
    shape = syntax.shape(clause)
    return not claimed <= {starts[other.start] for other in requirement.clauses if syntax.shape(other) == shape}


def _line_starts(text: str, requirement: syntax.Requirement) -> dict[int, int]:
    """Where each clause begins, and where the line does on which it begins."""
    return {clause.start: line_start(text, 0, clause.start) for clause in requirement.clauses}


def _takes_effect(requirement: syntax.Requirement, clause: syntax.Clause, claims: Sequence[syntax.Claim]) -> bool:
    """Whether a qualifier takes effect on all claims, so that nothing else is reported of it."""
    if not isinstance(clause, _SEVERAL) and [_kind(other) for other in requirement.clauses].count(_kind(clause)) > 1:
        return False
    if isinstance(clause, syntax.Average):
        return all(f"{claim.row} on average" in POOLED for claim in claims)
    return not _is_of_time(clause) or all(f"{claim.row} of time" in VERBS for claim in claims)


def _kind(clause: syntax.Clause) -> tuple[type, bool]:
    """Equal for clauses of which one counts; the share of time and the odds are two."""
    return type(clause), _is_of_time(clause)


def _is_of_time(clause: syntax.Clause) -> bool:
    return isinstance(clause, syntax.Odds) and clause.is_of_time


def _fixes(text: str, requirement: syntax.Requirement, clause: syntax.Clause) -> tuple[Fix, ...]:
    """The fix that breaks the line before and after a clause, where another clause is there; none without an example of
    how far to indent it."""
    starts = _line_starts(text, requirement)
    indents = [text[line:start] for start, line in starts.items() if text[line:start].isspace()]
    if not indents:
        return ()
    line_break = ("\r\n" if "\r\n" in text else "\n") + indents[0]
    beside = sorted(start for start, line in starts.items() if line == starts[clause.start])
    index = beside.index(clause.start)
    breaks = beside[max(index, 1) : index + 2]
    edits = [FixEdit(Place(Span(len(text[:start].rstrip(" \t")), start)), line_break) for start in breaks]
    return (Fix(f"Put `{_words(text, clause)}` on its own line", tuple(edits)),)


def _words(text: str, clause: syntax.Clause) -> str:
    return " ".join(text[clause.start : clause.end].split())


_QUALIFIERS: Final = (
    *(syntax.ScopeClause, syntax.Assuming, syntax.FromUntil, syntax.Average),
    *(syntax.Odds, syntax.Confidence, syntax.Window, syntax.OnViolation),
)
_SEVERAL: Final = (syntax.ScopeClause, syntax.Assuming)  # all of which take effect
