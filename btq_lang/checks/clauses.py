"""Clauses of one requirement that are repeated, about nothing, or incomplete."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related, Tag, replace_fix
from btq_lang.syntax import tree as syntax
from btq_lang.util.text import Span

_ONCE: dict[type, str] = {
    syntax.Odds: "how often it must hold",
    syntax.Confidence: "a confidence",
    syntax.Window: "a window",
    syntax.OnViolation: "what happens on violation",
    syntax.Goal: "a goal",
    syntax.How: "how to verify it",
}


def duplicate_clause(view: View) -> Iterator[Diagnostic]:
    """A second clause of a kind of which the first counts; an equal one can be removed."""
    for symbol, requirement in view.requirements:
        first: dict[type, syntax.Clause] = {}
        for clause in requirement.clauses:
            if type(clause) in _ONCE and (counts := first.setdefault(type(clause), clause)) is not clause:
                # If one of several equal definitions lacked it, it would contradict the others.
                is_alone = not view.ask(lookups.is_repeated, symbol.kind, symbol.name)
                yield _duplicate(view, counts, clause, is_alone)


def clause_without_odds(view: View) -> Iterator[Diagnostic]:
    """A confidence, or a window of runs or activations, in a requirement without a required probability."""
    for _, requirement in view.requirements:
        if any(isinstance(clause, syntax.Odds) for clause in requirement.clauses):
            continue
        if view.is_torn(requirement.start, requirement.end):
            continue  # the odds may be on a line that could not be read
        for clause in requirement.clauses:
            is_confidence = isinstance(clause, syntax.Confidence)
            if is_confidence or (isinstance(clause, syntax.Window) and clause.experiments is not None):
                subject = "a confidence" if is_confidence else "the window"
                message = f"{subject} has no effect here: without a required probability a single violation counts"
                notes = ("state how often it must hold: `in at least 95 % of activations`",)
                yield Diagnostic("clause-without-odds", Span(clause.start, clause.end), message, notes=notes)


def unused_parameter(view: View) -> Iterator[Diagnostic]:
    """A parameter that no clause of its requirement uses, so that its value has no effect."""
    for _, requirement in view.requirements:
        if not requirement.parameters:
            continue
        if view.is_torn(requirement.start, requirement.end):
            continue  # its use may be on a line that could not be read
        used = {word.text for word in syntax.walk(requirement.clauses) if isinstance(word, syntax.Word)}
        for parameter in requirement.parameters:
            if parameter.name.text not in used:
                message = f"no clause uses the parameter `{parameter.name.text}`, so its value has no effect"
                yield Diagnostic("unused-parameter", parameter.name.span, message, tags=(Tag.UNNECESSARY,))


def _duplicate(view: View, counts: syntax.Clause, clause: syntax.Clause, is_alone: bool) -> Diagnostic:
    text = view.text
    stated, restated = (" ".join(text[repeated.start : repeated.end].split()) for repeated in (counts, clause))
    removals = [(restated, clause)] if stated == restated else [(restated, clause), (stated, counts)]
    message = f"the requirement already states {_ONCE[type(clause)]}: `{stated}`"
    fixes = tuple(
        replace_fix(f"Remove `{words}`", with_blanks(text, removed), "", safe=is_alone and stated == restated)
        for words, removed in removals
    )
    related = (Related(Place(Span(counts.start, counts.end)), "this one takes effect"),)
    return Diagnostic("duplicate-clause", Span(clause.start, clause.end), message, related=related, fixes=fixes)


def with_blanks(text: str, clause: syntax.Clause | syntax.NodeClause | syntax.Port) -> Span:
    """A clause or port with the blanks that would remain, and with its line if nothing else is on it."""
    start, end = clause.start, clause.end
    while start and text[start - 1] in " \t":
        start -= 1
    is_first = start == 0 or text[start - 1] in "\r\n"
    is_last = text[end : end + 1] in ("", "\r", "\n")
    if is_first and is_last:
        start -= 2 if text[:start].endswith("\r\n") else 1
    elif is_first:
        start = clause.start
        end += len(text[end:]) - len(text[end:].lstrip(" \t"))
    return Span(start, end)
