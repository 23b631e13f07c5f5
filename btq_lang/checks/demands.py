"""What is wrong with what requirements demand, seen from the nodes that they hold for.

One invariant: a finding stands in the file that is checked: at the claim, or where the claim is somebody else's, at the
reference that attaches it.  The rules are in modules by their subject; this one only brings them together: what they
find of the nodes of a tree is kept for as long as what they look at stays the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, TypeAlias

from btq_lang.checks.view import View

if TYPE_CHECKING:
    from btq_lang.checks.demanded import Demanded, Found, Guard
    from btq_lang.diagnostics.model import Diagnostic
    from btq_lang.requirements.attach import Held
    from btq_lang.requirements.model import Requirement
    from btq_lang.requirements.trees import TreeNodes
    from btq_lang.syntax.tree import Entry
    from btq_lang.workspace.item_index import Facts
    from btq_lang.workspace.queries import Store
    from btq_lang.workspace.workspace import Workspace

ByItem: TypeAlias = "dict[int, list[Diagnostic]]"


def demands(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """All that these rules find in an entry."""
    yield from view.ask(_demands, view.facts)


def _demands(store: Store[Workspace], viewpoint: str, facts: Facts) -> Sequence[Diagnostic]:
    return store.ask(_all_demands, viewpoint).get(id(facts.item), ())


def _all_demands(store: Store[Workspace], viewpoint: str) -> ByItem:
    """What the rules find in the file, by the item that it is in."""
    view = View(store, viewpoint)
    if view.requirements is None:
        return {}
    from btq_lang.checks.demanded import Demanded  # few files need it
    from btq_lang.checks.signals import of_signals

    demanded = Demanded(view)
    memory = view.resolved
    found: list[ByItem] = []
    guards: list[Guard] = []
    table = memory.table("demands of trees", demanded)
    held = demanded.requirements.by_tree
    trees = [tree for tree in demanded.requirements.nodes.trees if tree.timeouts or id(tree.item) in held]
    budgets = [*map(demanded.budgets.in_tree, trees)]  # another one where what is applied is another
    for known in table.all(trees, budgets, lambda at: _of_tree(demanded, trees[at])):
        if known[0]:
            found.append(known[0])
        if known[1]:
            guards += known[1]
    table = memory.table("demands by themselves", demanded)
    pairs = zip(demanded.requirements.all.values(), demanded.requirements.held, strict=True)
    told = [(each, _between(each, held)) for each, held in pairs]
    told = [(each, held) for each, held in told if each.goal is not None or each.window is not None or held is not None]
    lonely, between = [each for each, _ in told], [held for _, held in told]
    found += table.all(lonely, between, lambda at: _of_requirement(demanded, lonely[at], between[at]))
    found.append(_by_item(view, of_signals(demanded, guards, memory)))
    return _together(found)


def _of_tree(demanded: Demanded, tree: TreeNodes) -> tuple[ByItem, list[Guard]]:
    """What the rules find of the nodes of a tree, and the claims about them for which the engine reads signals."""
    from btq_lang.checks import budgets, limits, odds, renewals, signals, swallowing, unenforced  # as above

    demanded.look_at(tree)
    rules = (
        limits.limit_too_small,
        limits.limit_on_synchronous_node,
        limits.dead_bound,
        limits.outbid_bound,
        limits.attempts_mismatch,
        limits.contradicting_bounds,
        budgets.budget_exceeded,
        budgets.timeout_never_succeeds,
        odds.odds_beyond_children,
        swallowing.swallowed_failure,
        unenforced.not_enforced,
        renewals.guard_never_renewed,
    )
    found = [each for rule in rules for each in rule(demanded)]
    return _by_item(demanded.view, found), list(signals.guards(demanded))


def _between(requirement: Requirement, held: Held) -> Held | None:
    """What a requirement holds for that is to be enforced, if there is more of it than what nodes are held to."""
    is_hard = requirement.action in ("fail", "halt")
    return held if is_hard and len(held.applied) > len(held.by_tree) else None


def _of_requirement(demanded: Demanded, requirement: Requirement, between: Held | None) -> ByItem:
    """What is wrong with a requirement, whatever it holds for."""
    from btq_lang.checks import limits, odds, unenforced  # as above

    view = demanded.view
    found = [*limits.goal_beyond_bound(view, requirement), *odds.window_too_small(requirement)]
    if between is not None:
        found += unenforced.not_enforced_between(demanded, between)
    return _by_item(view, found)


def _by_item(view: View, found: Iterable[Found]) -> ByItem:
    by_item: ByItem = {}
    for place, diagnostic in found:
        if place.path == view.path:
            by_item.setdefault(id(place.anchor), []).append(diagnostic)
    return {item: _once([diagnostics]) for item, diagnostics in by_item.items()}


def _together(found: list[ByItem]) -> ByItem:
    """All of it, each once: a claim may hold for nodes of many trees."""
    lists: dict[int, list[list[Diagnostic]]] = {}
    for by_item in found:
        for item, diagnostics in by_item.items():
            lists.setdefault(item, []).append(diagnostics)
    return {item: same[0] if len(same) == 1 else _once(same) for item, same in lists.items()}


def _once(lists: list[list[Diagnostic]]) -> list[Diagnostic]:
    """They are compared, for to hash one is to hash the whole items that its places stand in."""
    known: dict[tuple[object, ...], list[Diagnostic]] = {}
    for diagnostics in lists:
        for each in diagnostics:
            same = known.setdefault((each.rule, each.span, each.message), [])
            if each not in same:
                same.append(each)
    return [each for same in known.values() for each in same]
