"""Nodes whose parent resets what they remember, and nodes that fail although their last child succeeds.

Sources: what BehaviorTree.CPP 3.8.7, 4.6.2 and 4.10.0 and the branches of Nav2 do with children that have ended.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.kinds import Flow
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.checks.ports import adding_fix
from btq_lang.checks.results import result
from btq_lang.checks.statuses import SUCCESS
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related, replace_fix
from btq_lang.syntax.tree import Node
from btq_lang.workspace.node_names import wraps
from btq_lang.workspace.resolved import ResolvedNode

_REMEMBERING: Final[tuple[Flow, ...]] = ("notices", "throttle", "throttle-or-fail", "pass-once")
# While a later child runs, they tick again those that have succeeded.
_REPEATING: Final[frozenset[Flow]] = frozenset(("pipeline", "together"))


def memory_lost(view: View) -> Iterator[Diagnostic]:
    """A node that has an effect only with its memory of earlier ticks, below a parent that resets it."""
    for resolved in view.seen.of_flow(*_REMEMBERING):
        parent = resolved.parent
        if parent is None or _keeps(parent, resolved):
            continue
        effect = "never succeeds" if resolved.flow == "notices" else "holds nothing back"
        message = f"{resolved.shown} {effect} here: {parent.shown} resets it before it ticks it again"
        related = (Related(Place(parent.node.head.span), "resets it"),)
        yield Diagnostic(
            "memory-lost", resolved.node.head.span, message, related=related, notes=(_kept_elsewhere(resolved),)
        )


def last_success_lost(view: View) -> Iterator[Diagnostic]:
    """A node that takes turns and fails after its last child, though that may succeed."""
    for resolved in view.seen.of_flow("rotate"):
        last = resolved.node.children[-1] if resolved.node.children else None
        port = resolved.behavior.port_for("wraps") if resolved.behavior is not None else None
        if resolved.behavior is None or port is None or not isinstance(last, Node):
            continue
        if wraps(resolved.behavior, resolved.node) is not False or not result(view, last).ever & SUCCESS:
            continue
        value = resolved.node.attribute(port.name)
        title, text = f"Let the first child follow the last one: `{port.name} = true`", f'{port.name} = "true"'
        message = f"{resolved.shown} fails after its last child, {last.shown}, even if that succeeds"
        fixes = (replace_fix(title, value.span, "true"),) if value else adding_fix(view, resolved.node, title, text)
        notes = (f"it succeeds with its last child only with `{port.name}`",)
        related = (Related(Place(last.head.span), "its success is lost"),)
        yield Diagnostic(
            "last-success-lost", resolved.node.head.span, message, related=related, notes=notes, fixes=fixes
        )


def _keeps(parent: ResolvedNode, child: ResolvedNode) -> bool:
    """Whether a node may tick a child again after its end without a reset."""
    if parent.category == "Decorator":
        return False  # after its tick the engine resets the child, if that has ended
    if parent.flow == "choice":
        return child.index == 0 and parent.behavior is not None and parent.behavior.reactive
    if parent.flow in _REPEATING:
        is_last = child.index == len(parent.node.children) - 1
        return child.behavior is not None and child.behavior.memory == "success" and not is_last
    # Other nodes are unknown; one that resumes at a number instead of an entry begins there every time.
    return parent.flow in ("", "pause", "resume")


def _kept_elsewhere(resolved: ResolvedNode) -> str:
    """The note about the places where a node keeps its memory."""
    choice = next(kind.tag for kind in BUILTINS.values() if kind.flow == "choice" and kind.reactive)
    place = f"the condition of a {choice}"
    if resolved.behavior is not None and resolved.behavior.memory == "success":
        from btq_lang.catalog.nav2.nodes import NODES  # only for nodes of Nav2

        pipeline = next(kind.tag for kind in NODES.values() if kind.flow == "pipeline")
        place = f"a child of a {pipeline} before its last one, and {place}"
    return f"not reset: {place}"
