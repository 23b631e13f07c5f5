"""SuccessIf and FailureIf in a requirement's description: what stands behind them is for people, or for tools."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

from btq_lang.checks.strings import in_source
from btq_lang.checks.view import View
from btq_lang.clauses import VERBS
from btq_lang.conditions import HEADS
from btq_lang.diagnostics import Diagnostic, Fix, replace_fix
from btq_lang.parser import parse
from btq_lang.record import record
from btq_lang.rules import Severity
from btq_lang.symbols import Kind
from btq_lang.syntax import Claim, Entry, Path, Requirement, Signal, Word
from btq_lang.text import Span
from btq_lang.units import Dimension, parse_unit

# How the keywords are spelt, FailuerIf by the original tool; folded.
_KEYWORDS = ("successif", "failureif", "failuerif")


@record
class _Constraint:
    """A keyword in a text, and what stands behind it.

    Attributes:
        keyword: where the keyword stands, counted from the start of the text.
        violates: it says when the requirement is violated.
    """

    keyword: Span
    violates: bool
    text: str


def prose_constraint(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A keyword with prose behind it, in a requirement that has no clause yet: told once, where it is defined."""
    for symbol in view.file.summary_of(entry).symbols:
        requirement = symbol.target
        if not isinstance(requirement, Requirement) or requirement.text is None or requirement.clauses:
            continue
        found = [each for each in _constraints(requirement.text) if not _can_be_checked(view, each.text)]
        first = view.scope.find(Kind.REQUIREMENT, symbol.name)
        if not found or (first is not None and first.symbol is not symbol):
            continue
        signals = _signals(view)
        proposals = (_as_clause(each, signals) for each in found)
        clauses = tuple(dict.fromkeys(clause for clause in proposals if clause is not None))
        keyword = found[0].keyword
        yield Diagnostic(
            "prose-constraint",
            in_source(requirement.text, keyword),
            f"no tool can check what stands behind `{requirement.text.text[keyword.start : keyword.end]}`",
            notes=_notes(clauses),
            fixes=_fixes(view, entry, requirement.text, symbol.name, clauses),
        )


def _constraints(word: Word) -> list[_Constraint]:
    """What stands behind each keyword, up to the next one."""
    text = word.text
    if "if" not in text.lower():
        return []
    found = list(_keyword_pattern().finditer(text))
    ends = [*(match.start() for match in found), len(text)][1:]
    return [
        _Constraint(
            Span(*match.span()), not match[0].lower().startswith("s"), text[match.end() : end].lstrip(":").strip()
        )
        for match, end in zip(found, ends, strict=True)
    ]


def _can_be_checked(view: View, text: str) -> bool:
    """Whether it is a script that the engine takes for a condition, or clauses of a requirement; `it takes at most 5 s`
    is none, unless there is a node `it`."""
    from btq_lang.script import check_script, parse_script  # few files have a keyword

    problems = check_script(parse_script(text), expects_value=True)
    if not any(problem.effective_severity is Severity.ERROR for problem in problems):
        return True
    words = text.replace(".", " ").split()
    if not words or (words[0] not in HEADS and VERBS.isdisjoint(words)):
        return False
    requirement = _requirement(text)
    return requirement is not None and all(
        view.node_names.issuperset(name.text for name in clause.subject.names)
        for clause in requirement.clauses
        if isinstance(clause, Claim) and isinstance(clause.subject, Path)
    )


def _as_clause(constraint: _Constraint, signals: dict[str, Dimension]) -> str | None:
    """The clause that stands for prose; a condition of a requirement needs but its verb."""
    from btq_lang.checks.wording import as_clause  # as above

    text = " ".join(constraint.text.split()).rstrip(".")
    condition = f"{'never' if constraint.violates else 'keeps'} {text}"
    if any(sign in text for sign in "<>=") and _requirement(condition) is not None:
        return condition
    return as_clause(text, violates=constraint.violates, signals=signals)


def _requirement(text: str) -> Requirement | None:
    """A requirement with these clauses; None where the text is anything else."""
    parsed = parse(f"QualityReq r {' '.join(text.split()).rstrip('.')}\n")
    item = parsed.entries[0].item
    if parsed.diagnostics or len(parsed.entries) > 1 or not isinstance(item, Requirement):
        return None
    says_more = item.parameters or item.quality is not None or item.text is not None
    return item if item.clauses and not says_more else None


def _signals(view: View) -> dict[str, Dimension]:
    """The signals in scope, with what they measure."""
    found: dict[str, Dimension] = {}
    for name in view.scope.names(Kind.SIGNAL):
        definition = view.scope.find(Kind.SIGNAL, name)
        signal = definition.symbol.target if definition is not None else None
        if (
            isinstance(signal, Signal)
            and signal.unit is not None
            and (unit := parse_unit(signal.unit.text)) is not None
        ):
            found[name] = unit.dimension
    return found


def _notes(clauses: tuple[str, ...]) -> tuple[str, ...]:
    if not clauses:
        return (
            "a clause can be checked: `takes at most 30 s`, or `keeps speed < 0.5 m/s` with a `signal speed : m/s`",
        )
    return (f"as a clause that can be checked: {', '.join(f'`{clause}`' for clause in clauses)}",)


def _fixes(view: View, entry: Entry, text: Word, name: str, clauses: tuple[str, ...]) -> tuple[Fix, ...]:
    """Add the clauses; not where the text is repeated in other places, which would then say something else."""
    if not clauses or entry.diagnostics or len(view.scope.all(Kind.REQUIREMENT, name)) > 1:
        return ()
    added = " ".join(clauses)
    return (replace_fix(f"Add `{added}`", Span(text.end, text.end), f" {added}"),)


@cache
def _keyword_pattern() -> re.Pattern[str]:
    return re.compile(rf"\b(?:{'|'.join(_KEYWORDS)})\b", re.IGNORECASE)
