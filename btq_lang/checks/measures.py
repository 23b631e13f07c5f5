"""What is wrong with the measurable part of requirements: what could not be resolved, and what is about nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax.tree import Entry, Requirement

if TYPE_CHECKING:
    from btq_lang.workspace.item_index import Facts
    from btq_lang.workspace.queries import Store
    from btq_lang.workspace.workspace import Workspace


def unresolved(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """What the resolved requirements complain of in an entry: units, signals, paths, arguments."""
    yield from view.ask(_unresolved, view.facts)


def requirement_without_subject(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A claim about nothing, in a requirement that has other claims with subjects of their own; without any the whole
    requirement is unused, and told for that.  And what only a node can do, of a time between events or of a sum."""
    found = view.ask(_without_subject, view.facts)
    if found and view.is_read and not view.is_included:
        yield from found


def _unresolved(store: Store[Workspace], viewpoint: str, facts: Facts) -> Sequence[Diagnostic]:
    return store.ask(_all_unresolved, viewpoint).get(id(facts.item), ())


def _all_unresolved(store: Store[Workspace], viewpoint: str) -> dict[int, list[Diagnostic]]:
    view = View(store, viewpoint)
    found: dict[int, list[Diagnostic]] = {}
    for problem in view.requirements.problems if view.requirements is not None else ():
        found.setdefault(id(problem.item), []).append(problem.diagnostic)
    return found


def _without_subject(store: Store[Workspace], viewpoint: str, facts: Facts) -> Sequence[Diagnostic]:
    return store.ask(_all_without_subject, viewpoint).get(id(facts.item), ())


def _all_without_subject(store: Store[Workspace], viewpoint: str) -> dict[int, list[Diagnostic]]:
    requirements = View(store, viewpoint).requirements
    if requirements is None or not requirements.nodes.are_known:
        return {}
    from btq_lang.requirements.model import Span, Total  # a file without clauses needs none

    found: dict[int, list[Diagnostic]] = {}
    for requirement in requirements.all.values():
        if not isinstance(requirement.item, Requirement):
            continue
        is_attached = requirement.name in requirements.attached
        is_about_nothing = all(claim.subject is None for claim in requirement.claims)
        for claim in requirement.claims:
            if isinstance(claim.subject, Span | Total) and VERBS[claim.verb].limits != "completion":
                of = "the time from one event to another" if isinstance(claim.subject, Span) else "a sum of durations"
                message = f"`{claim.verb}` is about a node, not about {of}, so nothing can check it"
                note = "write `takes` after it, or a node before the verb"
            elif claim.subject is None and not is_attached and not is_about_nothing:
                message = f"missing subject of `{claim.text}`"
                note = "write a node before the verb, or attach the requirement to a node with `satisfies`"
            else:
                continue
            diagnostic = Diagnostic("requirement-without-subject", claim.place.span, message, notes=(note,))
            found.setdefault(id(requirement.item), []).append(diagnostic)
    return found
