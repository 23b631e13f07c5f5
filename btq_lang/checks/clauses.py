"""Clauses of one requirement that are repeated, about nothing, or incomplete, and conditions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related, Tag, replace_fix
from btq_lang.syntax.tokens import NAME
from btq_lang.syntax.tree import (
    Clause,
    Confidence,
    Context,
    Goal,
    How,
    NodeClause,
    Odds,
    OnViolation,
    Operand,
    ReqRef,
    Requirement,
    Tree,
    Window,
    Word,
    walk,
)
from btq_lang.util.text import Span
from btq_lang.workspace.symbols import requirements_at

_ONCE: dict[type, str] = {
    Odds: "how often it must hold",
    Confidence: "a confidence",
    Window: "a window",
    OnViolation: "what happens on violation",
    Goal: "a goal",
    How: "how to verify it",
}


def duplicate_clause(view: View) -> Iterator[Diagnostic]:
    """A second clause of a kind of which the first counts; an equal one can be removed."""
    for symbol, requirement in view.requirements:
        first: dict[type, Clause] = {}
        for clause in requirement.clauses:
            if type(clause) in _ONCE and (counts := first.setdefault(type(clause), clause)) is not clause:
                # If one of several equal definitions lacked it, it would contradict the others.
                is_alone = not view.is_repeated(symbol.kind, symbol.name)
                yield _duplicate(view, counts, clause, is_alone)


def clause_without_odds(view: View) -> Iterator[Diagnostic]:
    """A confidence, or a window of runs or activations, in a requirement without a required probability."""
    for _, requirement in view.requirements:
        if any(isinstance(clause, Odds) for clause in requirement.clauses):
            continue
        if view.is_torn(requirement.start, requirement.end):
            continue  # the odds may be on a line that could not be read
        for clause in requirement.clauses:
            if isinstance(clause, Confidence) or (isinstance(clause, Window) and clause.experiments is not None):
                said = "a confidence" if isinstance(clause, Confidence) else "the window"
                yield Diagnostic(
                    "clause-without-odds",
                    Span(clause.start, clause.end),
                    f"{said} has no effect here: without a required probability a single violation counts",
                    notes=("state how often it must hold: `in at least 95 % of activations`",),
                )


def unused_parameter(view: View) -> Iterator[Diagnostic]:
    """A parameter that no clause of its requirement uses, so that its value has no effect."""
    for _, requirement in view.requirements:
        if not requirement.parameters:
            continue
        if view.is_torn(requirement.start, requirement.end):
            continue  # its use may be on a line that could not be read
        named = {word.text for word in walk(requirement.clauses) if isinstance(word, Word)}
        for parameter in requirement.parameters:
            if parameter.name.text not in named:
                message = f"no clause uses the parameter `{parameter.name.text}`, so its value has no effect"
                yield Diagnostic("unused-parameter", parameter.name.span, message, tags=(Tag.UNNECESSARY,))


def subtraction_without_blanks(view: View) -> Iterator[Diagnostic]:
    """`full-empty`, one name, where only `full` and `empty` are known: a subtraction needs blanks."""
    for operand in _operands(view):
        word = operand.word
        if word.kind != NAME or "-" not in word.text or _is_known(view, word.text):
            continue
        for at, character in enumerate(word.text):
            left, right = word.text[:at], word.text[at + 1 :]
            if character == "-" and _is_known(view, left) and _is_known(view, right):
                yield Diagnostic(
                    "subtraction-without-blanks",
                    word.span,
                    f"undefined name `{word.text}`; write spaces around `-` to subtract",
                    notes=("without spaces `-` is part of the name",),
                    fixes=(replace_fix(f"Write `{left} - {right}`", word.span, f"{left} - {right}", safe=True),),
                )
                break


def _duplicate(view: View, counts: Clause, clause: Clause, is_alone: bool) -> Diagnostic:
    text = view.text
    said, again = (" ".join(text[each.start : each.end].split()) for each in (counts, clause))
    removals = [(again, clause)] if said == again else [(again, clause), (said, counts)]
    return Diagnostic(
        "duplicate-clause",
        Span(clause.start, clause.end),
        f"the requirement already states {_ONCE[type(clause)]}: `{said}`",
        related=(Related(Place(Span(counts.start, counts.end)), "this one takes effect"),),
        fixes=tuple(
            replace_fix(f"Remove `{words}`", with_blanks(text, each), "", safe=is_alone and said == again)
            for words, each in removals
        ),
    )


def with_blanks(text: str, clause: Clause | NodeClause) -> Span:
    """A clause with the blanks that would remain, and with its line if nothing else is on it."""
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


def _operands(view: View) -> Iterator[Operand]:
    item = view.item
    if isinstance(item, Tree):
        clauses = (item.clauses, *[seen.node.clauses for seen in view.seen.demanding])
        roots: Iterable[Requirement | ReqRef | Context] = (
            requirement for each in clauses for requirement in requirements_at(each)
        )
    elif isinstance(item, Requirement | Context):
        roots = (item,)
    else:
        return
    text = view.text
    for root in roots:
        # Other parts of a requirement are words: its name, its quality, its text.
        parts: tuple[object, ...] = root.arguments if isinstance(root, ReqRef) else ()
        clauses_of: tuple[Clause | Context, ...] = (root,) if isinstance(root, Context) else ()
        if isinstance(root, Requirement):
            parts, clauses_of = root.parameters, root.clauses
        # Nearly all clauses are without a `-`, and need not be searched word by word.
        minus = [each for each in clauses_of if "-" in text[each.start : each.end]]
        for part in walk((*parts, *minus)):
            if isinstance(part, Operand):
                yield part


def _is_known(view: View, name: str) -> bool:
    if any(view.find(kind, name) for kind in (Kind.SIGNAL, Kind.CONTEXT)):
        return True
    item = view.item
    return isinstance(item, Requirement) and any(parameter.name.text == name for parameter in item.parameters)
