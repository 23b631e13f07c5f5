"""Budgets that do not add up: the demands on the children do not fit into the demand on their parent."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from btq_lang.catalog.verbs import VERBS
from btq_lang.checks.demanded import Demanded, Found, found_at, highest, seconds, summed
from btq_lang.diagnostics.model import Related
from btq_lang.requirements.budget_parts import Budget, port_seconds
from btq_lang.requirements.durations import Range, Term, together
from btq_lang.requirements.model import Claim


def budget_exceeded(demanded: Demanded) -> Iterator[Found]:
    """The children may take more than their parent may: in the worst case, or always."""
    for applied, claim, node, place in demanded.claims:
        most = highest(claim) if VERBS[claim.verb].limits else None
        if most is None or not (node.children or node.category == "SubTree"):
            continue
        allowed = _held_against(claim, demanded.budgets.composed(node))
        if allowed is None:
            continue
        if allowed.low > most[0]:
            message = f"{node.shown} takes at least {seconds(allowed.low)}, so it always violates `{most[1]}`"
        elif applied.requirement.odds is not None:
            continue
        else:
            is_known = allowed.high < inf
            allowed = allowed if is_known else _held_against(claim, demanded.budgets.composed_of_known(node))
            if allowed is None or allowed.high <= most[0]:
                continue
            rest = "" if is_known else ", not counting steps without a bound"
            what = summed(together(allowed.terms))
            message = f"{node.shown} may take {seconds(allowed.high)}, more than `{most[1]}` allows: {what}{rest}"
        terms = together(allowed.terms)
        related = tuple(Related(term.node.place, _share(term)) for term in terms)
        yield found_at(place, "budget-exceeded", message, related=related)


def timeout_never_succeeds(demanded: Demanded) -> Iterator[Found]:
    """A Timeout shorter than the shortest way to its child's success."""
    for node in demanded.tree.all:
        if node.flow != "timeout":
            continue
        limit = port_seconds(node) if len(node.children) == 1 else None
        if not limit or node.path != demanded.view.path:
            continue
        (child,) = node.children
        success = demanded.budgets.of(child).success
        if success is None or success.low <= limit:
            continue
        related = (Related(child.place, f"takes at least {seconds(success.low)}"),)
        message = f"{node.shown} can never succeed: {child.shown} takes at least {seconds(success.low)}"
        yield found_at(node.place, "timeout-never-succeeds", message, related=related)


def _held_against(claim: Claim, budget: Budget) -> Range | None:
    """The part of a budget that a claim is about."""
    return budget.success if VERBS[claim.verb].limits == "success" else budget.completes


def _share(term: Term) -> str:
    return f"up to {seconds(term.seconds)}" + (f", {term.times} times" if term.times > 1 else "")
