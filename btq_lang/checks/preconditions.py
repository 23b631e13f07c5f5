"""Preconditions that do not do what they seem to: `_failureIf`, `_successIf` and `_while` on nodes that run over
several ticks, and what skips the condition of a choice."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.checks.results import result
from btq_lang.checks.statuses import RUNNING
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.workspace.resolved import ResolvedNode

_PASS_SKIPPED_ON = frozenset(
    ("invert", "force-success", "force-failure", "timeout", "delay", "repeat", "retry", "once")
)


def one_shot_monitor(view: View) -> Iterator[Diagnostic]:
    """`_failureIf` on a node that runs over several ticks, though it is evaluated once.  `_successIf` gives a hint, as
    it mostly means "do it unless it is done"."""
    for resolved in view.seen.marked:
        for pair in resolved.node.attributes:
            key = pair.key.text
            if key not in ("_failureIf", "_successIf") or not result(view, resolved.node).ever & RUNNING:
                continue
            if pair.value is None or pair.value.text.strip() in ("true", "false", "1", "0"):
                continue
            is_failure = key == "_failureIf"
            watched = f"{view.spelt('R->' if is_failure else 'R?')} with a ScriptCondition in front of the node"
            start = view.spelt("->" if is_failure else "?")
            if is_failure and not view.is_xml:
                watched, start = f"{watched}, or a requirement with `keeps`", f"a requirement with `needs`, or {start}"
            message = f"the engine checks `{key}` once, when {resolved.shown_kind} starts, and not while it runs"
            notes = (
                f"to check it at every tick, use {watched}",
                f"to check it once, use {start} with a ScriptCondition in front of the node",
            )
            severity = None if is_failure else Severity.HINT
            yield Diagnostic("one-shot-monitor", pair.key.span, message, notes=notes, severity=severity)


def while_skip_is_success(view: View) -> Iterator[Diagnostic]:
    """`_while` on a step of a Sequence: when it becomes false, the step is halted and the next one begins.

    If another step has a `_while` or a `_skipIf` too, the steps are the branches of a choice, and that is intended.
    """
    for resolved in view.seen.marked:
        pair = next((pair for pair in resolved.node.attributes if pair.key.text == "_while"), None)
        if pair is None or not result(view, resolved.node).ever & RUNNING:
            continue
        step, parent = _skipped(resolved)
        if parent is None or not _takes_for_success(parent, step) or _is_choice(parent, step):
            continue
        is_last = parent.flow == "sequence" and step.index + 1 == len(parent.node.children)
        message = (
            f"when `_while` becomes false, {resolved.shown_kind} is halted and {parent.shown_kind} "
            f"{'succeeds' if is_last else 'continues as if it had succeeded'}"
        )
        notes = (
            "the halted node returns SKIPPED, which a Sequence treats as done",
            f"to fail instead, use {view.spelt('R->')} with a ScriptCondition in front of the node"
            + ("" if view.is_xml else ", or a requirement with `keeps`"),
        )
        severity = Severity.HINT if is_last else None  # nothing runs that should not
        yield Diagnostic("while-skip-is-success", pair.key.span, message, notes=notes, severity=severity)


def skipped_condition(view: View) -> Iterator[Diagnostic]:
    """`_skipIf` or `_while` on a child from which its parent does not accept SKIPPED: the condition of an IfThenElse or
    a WhileDoElse, and any child of some nodes."""
    for resolved in view.seen.marked:
        pair = next((pair for pair in resolved.node.attributes if pair.key.text in ("_skipIf", "_while")), None)
        if pair is None:
            continue
        condition, parent = _skipped(resolved)
        if parent is None or not (parent.flow == "together" or (parent.flow == "choice" and not condition.index)):
            continue
        message = f"if `{pair.key.text}` skips {resolved.shown_kind}, {parent.shown_kind} throws and the mission ends"
        notes = (f"move `{pair.key.text}` to {parent.shown_kind}, or check it in a ScriptCondition",)
        yield Diagnostic("skipped-condition", pair.key.span, message, notes=notes)


def _skipped(resolved: ResolvedNode) -> tuple[ResolvedNode, ResolvedNode | None]:
    """The topmost node that is skipped with a node, and its parent, which handles that."""
    while (parent := resolved.parent) is not None and (parent.flow in _PASS_SKIPPED_ON or _is_only_reactive(parent)):
        resolved = parent
    return resolved, parent


def _is_only_reactive(parent: ResolvedNode) -> bool:
    """A ReactiveSequence or ReactiveFallback with one child is skipped with it, in a later tick, too."""
    return parent.kind is not None and parent.kind.reactive and len(parent.node.children) == 1


def _takes_for_success(parent: ResolvedNode, step: ResolvedNode) -> bool:
    is_tried = parent.flow == "try" and step.index + 1 < len(parent.node.children)
    return is_tried or parent.flow == "sequence"


def _is_choice(parent: ResolvedNode, step: ResolvedNode) -> bool:
    return any(
        other is not step.node and (other.attribute("_while") is not None or other.attribute("_skipIf") is not None)
        for other in parent.node.nodes
    )
