"""What is wrong with what requirements demand of the nodes that they apply to.

One invariant: a finding is in the file that is checked: at the claim, or if that is in another file, at the reference
that attaches it.  The rules are in modules by subject; this one combines them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks.requirements import is_measured
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.checks.demanded import Guard, PlacedDiagnostic

ByItem: TypeAlias = "dict[int, list[Diagnostic]]"


def demands(view: View) -> Iterator[Diagnostic]:
    """All findings of these rules in an entry."""
    yield from view.ask(_in_item, view.facts)


def demands_by_item(store: Store[Workspace], viewpoint: str) -> ByItem:
    """The findings in the file, by the `id` of the item."""
    if not store.ask(is_measured, viewpoint):
        return {}
    of_trees, _ = store.ask(_of_trees, viewpoint)
    findings = (*of_trees, *store.ask(_of_requirements, viewpoint), *store.ask(_of_signals, viewpoint))
    # Each once, for a claim may apply to nodes of many trees.  They are compared, for hashing one would hash the whole
    # items that its places are in.
    distinct: dict[tuple[int, str, Span, str], list[Diagnostic]] = {}
    for place, diagnostic in findings:
        similar = distinct.setdefault((id(place.anchor), diagnostic.rule, diagnostic.span, diagnostic.message), [])
        if diagnostic not in similar:
            similar.append(diagnostic)
    by_item: ByItem = {}
    for (item, *_), similar in distinct.items():
        by_item.setdefault(item, []).extend(similar)
    return by_item


def _in_item(store: Store[Workspace], viewpoint: str, facts: Facts) -> Sequence[Diagnostic]:
    return store.ask(demands_by_item, viewpoint).get(id(facts.item), ())


def _of_trees(store: Store[Workspace], viewpoint: str) -> tuple[tuple[PlacedDiagnostic, ...], tuple[Guard, ...]]:
    """The findings and the guards of all trees in scope."""
    results = [store.ask(_of_tree, viewpoint, *tree) for tree in store.ask(inputs.trees, viewpoint)]
    return tuple(chain(*[findings for findings, _ in results])), tuple(chain(*[guards for _, guards in results]))


def _of_tree(
    store: Store[Workspace], viewpoint: str, path: str, facts: Facts
) -> tuple[tuple[PlacedDiagnostic, ...], tuple[Guard, ...]]:
    """The findings about the nodes of a tree, and the claims about them for which the engine reads signals."""
    from btq_lang.checks import budgets, enforcement, limits, never_counted, renewals, signals  # few files need them
    from btq_lang.checks.demanded import Demanded

    demanded = Demanded(View(store, viewpoint), path, facts)
    rules = (
        limits.limit_too_small,
        limits.limit_on_synchronous_node,
        limits.dead_bound,
        limits.outbid_bound,
        limits.attempts_mismatch,
        never_counted.never_counted,
        limits.contradicting_bounds,
        budgets.budget_exceeded,
        budgets.timeout_never_succeeds,
        budgets.odds_beyond_children,
        enforcement.swallowed_failure,
        enforcement.not_enforced,
        renewals.guard_never_renewed,
    )
    findings = (finding for rule in rules for finding in rule(demanded))
    return _in_file(viewpoint, findings), tuple(signals.guards(demanded))


def _of_requirements(store: Store[Workspace], viewpoint: str) -> tuple[PlacedDiagnostic, ...]:
    """The findings about requirements that do not depend on nodes."""
    names = store.ask(inputs.names, viewpoint, Kind.REQUIREMENT)
    return tuple(chain(*[store.ask(_of_requirement, viewpoint, name) for name in names]))


def _of_requirement(store: Store[Workspace], viewpoint: str, name: str) -> tuple[PlacedDiagnostic, ...]:
    """The findings about a requirement that do not depend on nodes."""
    from btq_lang.checks import budgets, enforcement, limits  # as above
    from btq_lang.requirements.definitions import requirement

    view = View(store, viewpoint)
    resolved, _ = store.ask(requirement, viewpoint, name)
    if resolved is None:
        return ()
    findings = [*limits.goal_beyond_bound(view, resolved), *budgets.window_too_small(resolved)]
    findings += [*budgets.window_without_hours(resolved), *budgets.rate_without_confidence(resolved)]
    if resolved.demands_enforcement:
        findings += enforcement.not_enforced_between(view, name)
    return _in_file(viewpoint, findings)


def _of_signals(store: Store[Workspace], viewpoint: str) -> tuple[PlacedDiagnostic, ...]:
    """What is wrong with signals, and with the guards that read them."""
    from btq_lang.checks.signals import of_signals  # as above

    _, guards = store.ask(_of_trees, viewpoint)
    return _in_file(viewpoint, of_signals(View(store, viewpoint), guards))


def _in_file(viewpoint: str, findings: Iterable[PlacedDiagnostic]) -> tuple[PlacedDiagnostic, ...]:
    """The findings in the file that is checked."""
    return tuple([(place, diagnostic) for place, diagnostic in findings if place.path == viewpoint])
