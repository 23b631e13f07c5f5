"""What the rules about demands share: the claims that apply to nodes, the places to report them, and wording."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.catalog.verbs import VERBS
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.attach import applied_in
from btq_lang.requirements.budgets import Budgets
from btq_lang.requirements.durations import DurationTerm
from btq_lang.requirements.model import Interval, ResolvedClaim, ResolvedSignal
from btq_lang.requirements.nodes import mission
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.resolved import ResolvedNode, tree_nodes

if TYPE_CHECKING:
    from btq_lang.btcpp.enforceability import Enforceability

PlacedDiagnostic: TypeAlias = tuple[Place, Diagnostic]
Guard: TypeAlias = tuple[tuple[ResolvedSignal, ...], tuple[str, ...], Place]


class Demanded:
    """The demands on the nodes of a tree.

    Attributes:
        view: of the file that the findings are about.
        tree: the tree.
        budgets: how long nodes take if all nodes meet their requirements.
        claims: all that apply to nodes of the tree and can be reported in this file: what is applied, the claim, the
            node (for a span, the one with the same duration), and where to report it.
        hard: all that are to be enforced, for any node of the tree, with their place, None if nothing in this file is
            about it, and why the engine does not enforce it, if so.
    """

    def __init__(self, view: View, path: str, facts: Facts) -> None:
        self.view: Final = view
        self.tree: Final = view.ask(tree_nodes, path, facts)
        self.budgets: Final = Budgets(view.store, view.path)
        self.claims: Final[list[tuple[Applied, ResolvedClaim, ResolvedNode, Place]]] = []
        self.hard: Final[list[tuple[Applied, ResolvedClaim, ResolvedNode, Place | None, str | None]]] = []
        enforceability: Enforceability | None = None
        for applied in view.ask(applied_in, path, facts).applied:
            for claim in applied.requirement.claims:
                node, place = _node(applied, claim, self.budgets), reported_at(view, applied, claim)
                if node is not None and place is not None:
                    self.claims.append((applied, claim, node, place))
                if applied.requirement.demands_enforcement:
                    enforceability = enforceability or enforceability_of(view)
                    node = node or applied.nodes[0]
                    shown = node.place if place is None and node.path == view.path else place
                    self.hard.append((applied, claim, node, shown, enforceability.why_not(applied, claim)))


def enforceability_of(view: View) -> Enforceability:
    """What decides which clauses the engine can enforce, as if all files were written into one."""
    from btq_lang.btcpp.enforceability import Enforceability  # few missions have a claim that is to be enforced

    is_shared = view.ask(inputs.is_included)
    return Enforceability(view.store, view.path, lambda: view.ask(mission), files=None, is_shared=is_shared)


def _node(applied: Applied, claim: ResolvedClaim, budgets: Budgets) -> ResolvedNode | None:
    """The node that a claim is about; for a span, the one with the same duration."""
    if isinstance(applied.subject, Interval) and VERBS[claim.verb].limits == "completion":
        from btq_lang.requirements.spans import node_of  # few claims are about a span

        return node_of(applied.subject, budgets)
    return applied.node


def reported_at(view: View, applied: Applied, claim: ResolvedClaim) -> Place | None:
    """The claim, or the reference that gave it its values or brought it into this file."""
    if claim.place.path == view.path and not (applied.arguments and applied.how != "subject"):
        return claim.place
    return next((place for place in (applied.place, claim.place) if place.path == view.path), None)


def diagnostic_at(
    place: Place,
    rule: str,
    message: str,
    related: tuple[Related, ...] = (),
    notes: tuple[str, ...] = (),
    severity: Severity | None = None,
) -> PlacedDiagnostic:
    """A diagnostic of a rule, with its place."""
    return place, Diagnostic(rule, place.span, message, related, notes, severity=severity)


def seconds(value: float) -> str:
    """A duration in a readable unit: `250 ms`, `45 s`, `2.5 min`."""
    if value == inf:
        return "forever"
    if 0.0 < value < 1.0:
        return f"{value * 1000:.4g} ms"
    for size, unit in ((3600.0, "h"), (60.0, "min")):
        if value >= 2 * size:
            return f"{value / size:.4g} {unit}"
    return f"{value:.4g} s"


def summed(terms: tuple[DurationTerm, ...]) -> str:
    """The terms of a duration: `A` 20 s + 3 × `B` 5 s."""
    parts = (
        f"{f'{term.times} × ' if term.times > 1 else ''}{term.node.shown} {seconds(term.seconds)}" for term in terms
    )
    return " + ".join(parts)
