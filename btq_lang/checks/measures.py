"""What is wrong with the measurable part of requirements: what could not be resolved, and what is about nothing."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.checks.view import View
from btq_lang.diagnostics import Diagnostic
from btq_lang.symbols import Kind
from btq_lang.syntax import Entry, Requirement


def unresolved(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """What the resolved requirements complain of in an entry: units, signals, paths, arguments."""
    if view.requirements is not None:
        for problem in view.requirements.problems:
            if problem.entry is entry:
                yield problem.diagnostic


def requirement_without_subject(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A claim about nothing, in a requirement that has other claims with subjects of their own; without any the whole
    requirement is unused, and told for that."""
    found = view.requirements
    if found is None or not isinstance(entry.item, Requirement) or not found.nodes.all or not view.is_read:
        return
    for symbol in view.file.summary_of(entry).symbols:
        requirement = found.all.get(symbol.name) if symbol.kind is Kind.REQUIREMENT else None
        if requirement is None or requirement.entry is not entry or requirement.name in found.attached:
            continue
        if view.path in view.workspace.included_files or all(claim.subject is None for claim in requirement.claims):
            continue
        for claim in requirement.claims:
            if claim.subject is None:
                yield Diagnostic(
                    "requirement-without-subject",
                    claim.place.span,
                    f"nobody says what `{claim.text}` is about",
                    notes=("name a node in front of it, or attach the requirement to one with `satisfies`",),
                )
