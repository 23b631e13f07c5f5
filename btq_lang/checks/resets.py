"""Nodes whose parent resets what they remember, those that it does not reset, and nodes that fail although their last
child succeeds.

Sources: what BehaviorTree.CPP 3.8.7, 4.6.2 and 4.10.0 and the branches of Nav2 do with children that have ended.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.kinds import Flow
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.checks import cpp_lookups, lookups
from btq_lang.checks.ports import adding_fix
from btq_lang.checks.results import result
from btq_lang.checks.statuses import FAILURE, RUNNING, SUCCESS
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
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


def stateful_condition(view: View) -> Iterator[Diagnostic]:
    """An action as the condition of a node that ticks it after its end without a reset.  Of a WhileDoElse there is no
    hint where the action is unknown: most of those are conditions that a model calls actions.

    Sources: action_node.cpp, if_then_else_node.cpp, while_do_else_node.cpp; of Nav2, bt_action_node.hpp.
    """
    for resolved in view.seen.of_flow("choice"):
        condition = next((child for child in resolved.children if child.index == 0), None)
        if condition is None or resolved.behavior is None or not _may_be_stateful(view, condition):
            continue
        if not resolved.behavior.reactive:
            is_kept = len(resolved.node.children) == 2 and result(view, condition.node).ever & FAILURE
            when, instead = "after it has failed", "add a third child, such as AlwaysFailure"
        else:
            is_kept = any(result(view, child).ever & RUNNING for child in resolved.node.children[1:])
            when, instead = "while a later child runs", "use a condition, which is evaluated at every tick"
        is_certain = is_kept and _is_stateful(view, condition)
        if is_certain or (is_kept and not resolved.behavior.reactive):
            it = condition.shown if is_certain else f"if {condition.shown} is a StatefulActionNode, it"
            message = f"{it} is not started again {when}: {resolved.shown_kind} does not reset it"
            severity = None if is_certain else Severity.HINT
            place = condition.node.head.span
            yield Diagnostic("stateful-condition", place, message, notes=(instead,), severity=severity)


def _may_be_stateful(view: View, resolved: ResolvedNode) -> bool:
    is_leaf = not (resolved.node.children or resolved.is_subtree)
    return is_leaf and resolved.category == "Action" and bool(result(view, resolved.node).ever & RUNNING)


def _is_stateful(view: View, resolved: ResolvedNode) -> bool:
    """Whether an action is known to start only when it has been reset; of the engine's own, those that take time do."""
    if resolved.kind is not None or resolved.id is None:
        return resolved.kind is not None
    name = resolved.id.text
    if view.ask(lookups.distribution) is not None:
        from btq_lang.catalog.nav2.creation import SERVERS  # only for nodes of Nav2

        if name in SERVERS:
            return True
    return view.ask(cpp_lookups.keeps_its_result, Kind.MODEL, name)


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
