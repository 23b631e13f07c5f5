"""`on violation fail` under a node that goes on when something in it fails."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from btq_lang.catalog.verbs import VERBS
from btq_lang.checks.demanded import Demanded, Found, found_at
from btq_lang.diagnostics.model import Related
from btq_lang.requirements.budget_parts import port_count
from btq_lang.requirements.nodes import callers, mission
from btq_lang.workspace.node_names import wraps
from btq_lang.workspace.queries import Store, hub
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

Swallower: TypeAlias = tuple[ResolvedNode, str]  # the node that does not fail when something below it does, and why


def swallowed_failure(demanded: Demanded) -> Iterator[Found]:
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
        yield found_at(place, "swallowed-failure", message, related=related, notes=notes)


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
    """The number of children that must fail for it to fail; 1 if unknown."""
    n = len(parallel.node.children)
    counts = [port_count(parallel, role) for role in ("successes", "failures")]
    successes, failures = [n + count + 1 if count is not None and count < 0 else count for count in counts]
    if failures is None or parallel.flow == "parallel-all":
        return failures if failures is not None else 1
    return min(failures, n - successes + 1) if successes is not None else 1
