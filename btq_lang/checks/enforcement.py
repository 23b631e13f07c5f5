"""`on violation fail` and `halt` without effect: a build does not enforce them, or a node above goes on after the
failure.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from btq_lang.catalog.verbs import VERBS
from btq_lang.checks import lookups
from btq_lang.checks.children import wrong_number
from btq_lang.checks.demanded import Demanded, PlacedDiagnostic, diagnostic_at, enforceability_of, reported_at
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.attach import claimed_of_no_tree, uses_of_nodes
from btq_lang.requirements.budget_parts import port_count
from btq_lang.requirements.model import NodeTarget, ResolvedClaim, signals_in
from btq_lang.requirements.nodes import callers, mission
from btq_lang.workspace import inputs
from btq_lang.workspace.node_names import wraps
from btq_lang.workspace.queries import Store, hub
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

Swallower: TypeAlias = tuple[ResolvedNode, str]  # the node that does not fail when something below it does, and why


def not_enforced(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """A claim about a node that no build enforces, or only a build into one file."""
    for applied, claim, node, place, why in demanded.hard:
        if (
            place is None
            or wrong_number(node) is not None
            or _is_reported_otherwise(demanded, applied, claim, node, place)
        ):
            continue
        related = () if place == node.place else (Related(node.place, "node"),)
        if why is not None:
            yield place, _diagnostic(applied, place, why, related)
            continue
        elsewhere = next(
            (wrapped for wrapped in _nodes(applied, claim, node) if not _is_built(demanded, applied, claim, wrapped)),
            None,
        )
        if elsewhere is not None:
            from btq_lang.btcpp.enforceability import where_else  # few missions demand anything of other files' nodes

            path = elsewhere.path
            why = where_else(elsewhere, is_xml=demanded.view.store.ask(lookups.is_xml, path))
            yield place, _diagnostic(applied, place, why, related, is_bundled=True)


def not_enforced_between(view: View, name: str) -> Iterator[PlacedDiagnostic]:
    """A claim about no particular node that no build enforces."""
    for applied in view.ask(claimed_of_no_tree, name):
        enforceability = enforceability_of(view)
        for claim in applied.requirement.claims:
            place = reported_at(view, applied, claim)
            why = enforceability.why_not(applied, claim) if place is not None else None
            if place is not None and why is not None:
                yield place, _diagnostic(applied, place, why, ())


def _diagnostic(
    applied: Applied, place: Place, why: str, related: tuple[Related, ...], *, is_bundled: bool = False
) -> Diagnostic:
    requirement = applied.requirement
    demand = "this" if requirement.classic else f"`on violation {requirement.action}`"  # classic ones are always hard
    note = (
        "nothing stops the robot, and `btq verify` can only check it in the logs afterwards; "
        "remove `on violation`, or write `on violation warn`"
    )
    if requirement.is_verified_by_people:
        with_monitor = f"`{requirement.verification.replace('by ', 'by monitor, ', 1)}`"
        note = f"neither the engine nor `btq verify` checks it; to have both check it, too, write {with_monitor}"
    message = f"the engine cannot enforce {demand}: {why}"
    notes = () if is_bundled or requirement.classic else (note,)
    severity = Severity.HINT if is_bundled else None
    return Diagnostic("not-enforced", place.span, message, related=related, notes=notes, severity=severity)


def _is_reported_otherwise(
    demanded: Demanded, applied: Applied, claim: ResolvedClaim, node: ResolvedNode, place: Place
) -> bool:
    """Whether another rule reports why the engine does not enforce a claim."""
    signals = signals_in((claim.condition, *(scope.condition for scope in applied.requirement.scopes)))
    if any(
        signal.key is None and not demanded.view.store.ask(lookups.is_read, signal.place.path or demanded.view.path)
        for signal in signals
    ):
        return True  # its entry may be on a line that could not be read
    if claim.signal is not None:
        return claim.signal.behaviour == "gauge"
    if not applied.requirement.is_enforceable or place == node.place:
        return False
    most = claim.highest if VERBS[claim.verb].limits else None
    return most is not None and (most[0] < 0.001 or not demanded.budgets.composed(node).waits)


def _nodes(applied: Applied, claim: ResolvedClaim, node: ResolvedNode) -> Iterator[ResolvedNode]:
    """The nodes that get a wrapper."""
    yield node
    events = claim.event.atoms if claim.event is not None else ()
    span = applied.requirement.span
    events += (*span.first.atoms, *span.last.atoms) if span is not None else ()
    for other in (claim.per, *[atom.subject for atom in events]):
        if isinstance(other, NodeTarget):
            yield other.node


def _is_built(demanded: Demanded, applied: Applied, claim: ResolvedClaim, node: ResolvedNode) -> bool:
    """Whether the wrapper is written: in this file, or because the node's own file attaches the requirement."""
    if node.path == demanded.view.path:
        return True
    view = demanded.view
    paths = frozenset(view.store.ask(inputs.paths, node.path))
    attaching = view.ask(_asking, applied.requirement.name, node)
    return not paths.isdisjoint(attaching) or (applied.how == "subject" and claim.place.path in paths)


def _asking(store: Store[Workspace], viewpoint: str, name: str, node: ResolvedNode) -> frozenset[str | None]:
    """The files that attach a requirement to a node."""
    uses = uses_of_nodes(store, viewpoint, node.path, node.facts)
    return frozenset([use.place.path for use in uses if use.requirement == name and use.target.node is node])


def swallowed_failure(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """A failure that never reaches the root, on whichever way the node is run."""
    for applied, claim, node, place in demanded.claims:
        requirement = applied.requirement
        if requirement.action != "fail" or not requirement.is_enforceable or not VERBS[claim.verb].enforced:
            continue
        if claim.limit is not None and claim.highest is None:
            continue  # too short a time is only noticed afterwards
        swallower = _in_tree(node) or demanded.view.ask(_above, node.tree)
        if swallower is None:
            continue
        above, reason = swallower
        message = f"when {node.shown} fails because of this, {above.shown} {reason}"
        related = (Related(above.place, "the failure stops here"), Related(node.place, "failing node"))
        notes = ("to stop the mission instead, write `on violation halt`",)
        yield diagnostic_at(place, "swallowed-failure", message, related=related, notes=notes)


def _above(store: Store[Workspace], viewpoint: str, tree: str | None) -> Swallower | None:
    """Where a failure of a tree ends, if it ends on every way up."""
    first: Swallower | None = None
    visited: set[int] = set()
    waiting = [*store.ask(_callers, viewpoint, tree)]
    ends = not waiting
    while waiting:
        node = waiting.pop()
        if id(node) in visited:
            continue
        visited.add(id(node))
        end = _in_tree(node)
        first = first or end
        if end is None:
            above = store.ask(_callers, viewpoint, node.tree)
            ends = ends or not above
            waiting += above
    return None if ends else first


@hub
def _callers(store: Store[Workspace], viewpoint: str, tree: str | None) -> tuple[ResolvedNode, ...]:
    """The SubTree nodes that run a tree; empty for the mission's, where failures end."""
    return store.ask(callers, viewpoint, tree) if tree != store.ask(_main_tree, viewpoint) else ()


def _main_tree(store: Store[Workspace], viewpoint: str) -> str | None:
    """The name of the mission's tree."""
    root = store.ask(mission, viewpoint)
    return root.tree if root is not None else None


def _in_tree(node: ResolvedNode) -> Swallower | None:
    below, above = node, node.parent  # without a generator: in a chain of trees this is asked for each of all others
    while above is not None:
        reason = _swallows(above, below)
        if reason is not None:
            return above, reason
        below, above = above, above.parent
    return None


def _swallows(parent: ResolvedNode, child: ResolvedNode) -> str | None:
    """Why a node does not fail when this child of it fails; None if it may fail."""
    flow = parent.flow
    last = child.index == len(parent.node.children) - 1
    if flow == "fallback":
        return None if last else "continues with its next child"
    if flow == "retry":
        return None if port_count(parent, "count") == 1 else "tries again"
    if flow in ("force-success", "invert"):
        return "succeeds"
    if flow == "recover" and child.index == 0:
        return None if port_count(parent, "retries") == 0 else "runs its second child"
    if flow == "rotate" and parent.behavior is not None:
        goes_on = not last or (wraps(parent.behavior, parent.node) and child.index)
        return "continues with its next child" if goes_on else None
    if flow == "choice" and child.index == 0:
        return "runs its third child" if len(parent.node.children) == 3 else None
    if flow in ("parallel", "parallel-all") and _failures_needed(parent) > 1:
        return "continues: it fails only after more than one failure"
    return None


def _failures_needed(parallel: ResolvedNode) -> int:
    """The number of children that must fail before a Parallel fails; 1 if unknown."""
    n = len(parallel.node.children)
    counts = [port_count(parallel, role) for role in ("successes", "failures")]
    successes, failures = [n + count + 1 if count is not None and count < 0 else count for count in counts]
    if failures is None or parallel.flow == "parallel-all":
        return failures if failures is not None else 1
    return min(failures, n - successes + 1) if successes is not None else 1
