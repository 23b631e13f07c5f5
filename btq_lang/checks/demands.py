"""What is wrong with what requirements demand, seen from the nodes that they hold for.

One invariant: a finding stands in the file that is checked: at the claim, or where the claim is somebody else's, at the
reference that attaches it.  The rules are in modules by their subject; this one only brings them together.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.checks.view import View
from btq_lang.diagnostics import Diagnostic
from btq_lang.syntax import Entry


def demands(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """All that these rules find in an entry."""
    if view.requirements is not None:
        yield from view.demands.get(id(entry.item), ())


def all_demands(view: View) -> dict[int, list[Diagnostic]]:
    """What the rules find in the file, by the item that it stands in."""
    from btq_lang.checks import budgets, limits, odds, signals, swallowing  # few files need them
    from btq_lang.checks.demanded import Demanded

    held = Demanded(view)
    found: dict[int, dict[Diagnostic, None]] = {}  # each once: it may hold for many nodes
    for rule in (
        limits.limit_too_small,
        limits.limit_on_synchronous_node,
        limits.dead_bound,
        limits.outbid_bound,
        limits.goal_beyond_bound,
        limits.attempts_mismatch,
        limits.contradicting_bounds,
        budgets.budget_exceeded,
        budgets.timeout_never_succeeds,
        odds.odds_beyond_children,
        odds.window_too_small,
        signals.signal_never_written,
        signals.signal_of_text,
        signals.signal_may_be_unset,
        swallowing.swallowed_failure,
    ):
        for place, diagnostic in rule(held):
            if place.path == view.path:
                found.setdefault(id(place.anchor), {})[diagnostic] = None
    return {item: list(same) for item, same in found.items()}
