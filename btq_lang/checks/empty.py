"""Empty texts where a name is required, or where a reader expects a text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax import tree as syntax
from btq_lang.workspace.symbols import requirements_at

_Found: TypeAlias = "Iterator[tuple[str, syntax.Word | None]]"


def empty_text(view: View) -> Iterator[Diagnostic]:
    """An empty name, to which nothing can refer; or an empty text for readers."""
    if view.is_xml or not any(sign in view.text for sign in _EMPTY):
        return
    for what, word in _names(view.item):
        if word is not None and word.raw in _EMPTY:
            severity = Severity.HINT if what in _FOR_PEOPLE else None
            yield Diagnostic("empty-text", word.span, f"{what} is empty", severity=severity)


_EMPTY = ('""', "''", "{}")
_TITLE, _REASON = "this title", "this reason"
_FOR_PEOPLE = (_TITLE, _REASON)


def _names(item: syntax.Item) -> _Found:
    if isinstance(item, syntax.Tree):
        yield from _of_clauses(item.clauses)
        for node in item.walk():
            if node.clauses:
                yield from _of_clauses(node.clauses)
    elif isinstance(item, syntax.Requirement):
        yield from _of_requirement(item)
    elif isinstance(item, syntax.Model | syntax.Models):
        for model in syntax.models_in(item):
            yield "the node's ID", model.name
            yield from (("the port's type", port.type) for port in model.ports)
    elif isinstance(item, syntax.Signal):
        yield "the blackboard entry", item.source
    elif isinstance(item, syntax.Root):
        yield "the main tree's name", item.name
    elif isinstance(item, syntax.QualityDecl):
        yield "the quality's name", item.name
        yield from _of_quality(item.parent)


def _of_clauses(clauses: tuple[syntax.NodeClause, ...]) -> _Found:
    for clause in clauses:
        if isinstance(clause, syntax.Tags):
            yield from (("this tag", name) for name in clause.names)
        elif isinstance(clause, syntax.Satisfices):
            for quality in clause.qualities:
                yield from _of_quality(quality.path)
    for requirement in requirements_at(clauses):
        if isinstance(requirement, syntax.Requirement):
            yield from _of_requirement(requirement)


def _of_requirement(requirement: syntax.Requirement) -> _Found:
    yield "the requirement's ID", requirement.name
    yield from _of_quality(requirement.quality)
    if requirement.clauses:  # else it has no content, which is reported
        yield _TITLE, requirement.text
    yield from ((_REASON, clause.text) for clause in requirement.clauses if isinstance(clause, syntax.Because))


def _of_quality(path: syntax.QualityPath | None) -> _Found:
    yield from (("the quality's name", name) for name in (path.names if path is not None else ()))
