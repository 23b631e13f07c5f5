"""What is wrong with the measurable part of requirements: what could not be resolved, and claims about nothing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.verbs import VERBS
from btq_lang.checks import lookups
from btq_lang.checks.view import View, has_names
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax.tree import Requirement
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store, hub
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.requirements.model import ResolvedClaim


@hub
def is_measured(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether any requirement in scope has a clause, or anything is declared for one: else nothing needs to be
    resolved."""
    view = View(store, viewpoint)
    if view.ask(has_names, Kind.SIGNAL) or view.ask(has_names, Kind.CONTEXT):
        return True
    names = view.ask(inputs.names, Kind.REQUIREMENT)
    return any(view.ask(_has_clauses, name) for name in names) or view.ask(lookups.has_apply)


def _has_clauses(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    view = View(store, viewpoint)
    meaning = view.ask(lookups.meaning, Kind.REQUIREMENT, name)
    target = meaning.target if meaning is not None else None
    return isinstance(target, Requirement) and bool(
        target.clauses or target.parameters or any(checkable for _, checkable in view.constraints(target))
    )


def unresolved(view: View) -> Iterator[Diagnostic]:
    """What is wrong with the requirements of an entry when they are resolved: units, signals, paths, arguments."""
    if not view.ask(is_measured):
        return
    from btq_lang.requirements.resolve import problems_in  # a file without clauses needs none of it

    yield from [problem.diagnostic for problem in view.ask(problems_in, view.path, view.facts)]


def requirement_without_subject(view: View) -> Iterator[Diagnostic]:
    """A claim about nothing, in a requirement that has other claims with subjects of their own; without any the whole
    requirement is unused, and reported as that.  Also what only applies to nodes, demanded of a span or a sum."""
    if not isinstance(view.item, Requirement) or not view.ask(is_measured):
        return
    names = [symbol.name for symbol in view.facts.summary.symbols]
    diagnostics = [
        diagnostic
        for name in names
        if view.defines_here(Kind.REQUIREMENT, name)
        for diagnostic in _without_subject(view, name)
    ]
    if (
        diagnostics and view.is_read and not view.ask(inputs.is_included)
    ):  # last, for both often change with an edit elsewhere
        yield from diagnostics


def _without_subject(view: View, name: str) -> Iterator[Diagnostic]:
    from btq_lang.requirements.definitions import requirement  # as above
    from btq_lang.requirements.model import DurationSum, Interval
    from btq_lang.requirements.nodes import has_nodes

    resolved, _ = view.ask(requirement, name)
    claims = resolved.claims if resolved is not None and view.ask(has_nodes) else ()
    is_about_nothing = all(claim.subject is None for claim in claims)
    for claim in claims:
        if isinstance(claim.subject, Interval | DurationSum) and VERBS[claim.verb].limits != "completion":
            subject = (
                "the time from one event to another" if isinstance(claim.subject, Interval) else "a sum of durations"
            )
            message = f"`{claim.verb}` is about a node, not about {subject}, so nothing can check it"
            note = "write `takes` after it, or a node before the verb"
            yield _diagnostic(claim, message, note)
        elif claim.subject is None and not is_about_nothing and not view.ask(_is_attached, name):
            message = f"missing subject of `{claim.text}`"
            note = "write a node before the verb, or attach the requirement to a node with `satisfies`"
            yield _diagnostic(claim, message, note)


def _diagnostic(claim: ResolvedClaim, message: str, note: str) -> Diagnostic:
    return Diagnostic("requirement-without-subject", claim.place.span, message, notes=(note,))


def _is_attached(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    from btq_lang.requirements.attach import attached_names  # as above

    return name in store.ask(attached_names, viewpoint)
