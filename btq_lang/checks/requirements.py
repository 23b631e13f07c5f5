"""Requirements that are unknown, contradict themselves, are never used, or say nothing."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.checks.includes import include_fix
from btq_lang.checks.kinds import written
from btq_lang.checks.view import View
from btq_lang.diagnostics import Diagnostic, Tag, replace_fix
from btq_lang.near import near
from btq_lang.symbols import Kind, same_requirement
from btq_lang.syntax import Claim, Entry, Requirement, Tree


def unknown_requirement(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A requirement that is named but defined nowhere."""
    for use in view.uses(entry, Kind.REQUIREMENT):
        if view.scope.find(Kind.REQUIREMENT, use.name) is not None or not view.scope.complete:
            continue
        fixes = tuple(
            replace_fix(f"Replace `{use.name}` by `{name}`", use.span, written(name))
            for name in near(use.name, view.scope.names(Kind.REQUIREMENT))
        )
        elsewhere = view.workspace.defined_anywhere(Kind.REQUIREMENT, use.name)
        fixes += tuple(include_fix(view, definition.path) for definition in elsewhere[:3])
        message = f"no requirement `{use.name}` is defined here or in an included file"
        yield Diagnostic("unknown-requirement", use.span, message, fixes=fixes)


def conflicting_requirement(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """One ID with two texts; one ID with one text is one requirement in several places."""
    for symbol in view.file.summary_of(entry).symbols:
        first = view.scope.find(symbol.kind, symbol.name)
        if symbol.kind is not Kind.REQUIREMENT or first is None or first.symbol is symbol:
            continue
        target, other = symbol.target, first.symbol.target
        if isinstance(target, Requirement) and isinstance(other, Requirement) and not same_requirement(target, other):
            yield Diagnostic(
                "conflicting-requirement",
                symbol.span,
                f"the requirement `{symbol.name}` says something else in another place",
                related=(view.defined_at(first, "the first definition, which counts"),),
                notes=(
                    f"to refer to it, write `satisfies {written(symbol.name)}`; another requirement needs another ID",
                ),
            )


def unused_requirement(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A requirement at file level that no node, no `apply` and no subject of its own connects to the mission."""
    requirement = entry.item
    if not isinstance(requirement, Requirement) or requirement.name is None:
        return
    if any(isinstance(clause, Claim) and clause.subject is not None for clause in requirement.clauses):
        return
    if not _has_trees(view):
        return  # a file of requirements: its users may be anywhere
    definition = view.scope.find(Kind.REQUIREMENT, requirement.name.text)
    if definition is None or not view.is_this(definition, entry) or view.workspace.references(definition):
        return
    yield Diagnostic(
        "unused-requirement",
        requirement.name.span,
        f"nothing satisfies the requirement `{requirement.name.text}`",
        notes=(f"attach it to a node with `satisfies {written(requirement.name.text)}`, or with `apply`",),
        tags=(Tag.UNNECESSARY,),
    )


def requirement_without_text(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A requirement with neither a text nor a clause."""
    for symbol in view.file.summary_of(entry).symbols:
        requirement = symbol.target
        if not isinstance(requirement, Requirement) or requirement.clauses:
            continue
        if requirement.text is not None and requirement.text.text.strip():
            continue
        message = f"the requirement `{symbol.name}` says nothing"
        note = "give it a text in quotes, or a clause such as `takes at most 30 s`"
        yield Diagnostic("requirement-without-text", symbol.span, message, notes=(note,))


def _has_trees(view: View) -> bool:
    return any(isinstance(entry.item, Tree) for entry in view.file.parsed.entries)
