"""`on violation fail` and `halt` that a build does not enforce."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.verbs import VERBS
from btq_lang.checks import lookups
from btq_lang.checks.demanded import Demanded, Found, judge_of, reported_at
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements.attach import claimed_of_no_tree, uses_of_nodes
from btq_lang.requirements.model import Applied, NodeTarget, ResolvedClaim
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def not_enforced(demanded: Demanded) -> Iterator[Found]:
    """A claim about a node that no build enforces, or only one that writes all files into one."""
    for applied, claim, node, place, why in demanded.hard:
        if place is None or _is_reported_otherwise(demanded, applied, claim, node, place):
            continue
        related = () if place == node.place else (Related(node.place, "node"),)
        if why is not None:
            yield place, _found(applied, place, why, related)
            continue
        elsewhere = next((each for each in _nodes(claim, node) if not _is_built(demanded, applied, claim, each)), None)
        if elsewhere is not None:
            from btq_lang.btcpp.enforceability import where_else  # few missions demand anything of other files' nodes

            path = elsewhere.path
            why = where_else(elsewhere, is_xml=demanded.view.store.ask(lookups.is_foreign, path))
            yield place, _found(applied, place, why, related, is_bundled=True)


def not_enforced_between(view: View, name: str) -> Iterator[Found]:
    """The same for the claims of a requirement that are about no particular node."""
    for applied in view.ask(claimed_of_no_tree, name):
        judge = judge_of(view)
        for claim in applied.requirement.claims:
            place = reported_at(view, applied, claim)
            why = judge.why_not(applied, claim) if place is not None else None
            if place is not None and why is not None:
                yield place, _found(applied, place, why, ())


def _found(
    applied: Applied, place: Place, why: str, related: tuple[Related, ...], *, is_bundled: bool = False
) -> Diagnostic:
    requirement = applied.requirement
    asked = "this" if requirement.classic else f"`on violation {requirement.action}`"  # classic ones are always hard
    note = (
        "nothing stops the robot, and `btq verify` can only check it in the logs afterwards; "
        "remove `on violation`, or write `on violation warn`"
    )
    message = f"the engine cannot enforce {asked}: {why}"
    notes = () if is_bundled or requirement.classic else (note,)
    severity = Severity.HINT if is_bundled else None
    return Diagnostic("not-enforced", place.span, message, related=related, notes=notes, severity=severity)


def _is_reported_otherwise(
    demanded: Demanded, applied: Applied, claim: ResolvedClaim, node: ResolvedNode, place: Place
) -> bool:
    """Whether a rule of its own reports why the engine does not enforce it."""
    if claim.signal is not None:
        return claim.signal.behaviour == "gauge"
    if not applied.requirement.is_enforceable or place == node.place:
        return False
    most = claim.highest if VERBS[claim.verb].limits else None
    return most is not None and (most[0] < 0.001 or not demanded.budgets.composed(node).waits)


def _nodes(claim: ResolvedClaim, node: ResolvedNode) -> Iterator[ResolvedNode]:
    """The nodes that get a wrapper."""
    yield node
    for other in (claim.per, claim.event.subject if claim.event is not None else None):
        if isinstance(other, NodeTarget):
            yield other.node


def _is_built(demanded: Demanded, applied: Applied, claim: ResolvedClaim, node: ResolvedNode) -> bool:
    """Whether the wrapper is written: in this file, or because the node's own file attaches the requirement."""
    if node.path == demanded.view.path:
        return True
    view = demanded.view
    seen = frozenset(view.store.ask(inputs.paths, node.path))
    asking = view.ask(_asking, applied.requirement.name, node)
    return not seen.isdisjoint(asking) or (applied.how == "subject" and claim.place.path in seen)


def _asking(store: Store[Workspace], viewpoint: str, name: str, node: ResolvedNode) -> frozenset[str | None]:
    """The files that attach a requirement to a node."""
    uses = uses_of_nodes(store, viewpoint, node.path, node.facts)
    return frozenset([use.place.path for use in uses if use.requirement == name and use.target.node is node])
