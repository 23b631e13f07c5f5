"""Counts and times that make a node ineffective.

Source: the tick functions of RepeatNode, RetryNode, TimeoutNode and DelayNode in 4.6.2, 4.8.4 and 4.10.0.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.kinds import NodeKind
from btq_lang.catalog.versions import at_least, last_of
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import QUANTITY
from btq_lang.syntax.tree import Word
from btq_lang.workspace.resolved import ResolvedNode


def count_of_nothing(view: View) -> Iterator[Diagnostic]:
    """A Repeat or a Retry that never runs its child, a Timeout that never ends, a Delay that does not wait."""
    if view.is_pinned and not view.project.written_for:  # what moves on meets the change itself
        yield from _delays(view)
    for resolved in view.seen.of_flow("repeat", "retry", "timeout"):
        if resolved.kind is None:
            continue
        port = resolved.kind.port_for("time" if resolved.flow == "timeout" else "count")
        value = resolved.node.attribute(port.name) if port is not None else None
        number = _number(value) if value is not None else None
        if value is None or number is None:
            continue
        if resolved.flow == "timeout":
            if number == 0:
                yield _timeout(resolved.kind, value)
        elif number < 1 and number != -1:
            yield _loop(resolved, value, number)


def _delays(view: View) -> Iterator[Diagnostic]:
    """Each Delay, if a release of a line that the project names does not wait in it."""
    delays = view.seen.of_flow("delay")
    if not delays:
        return
    from btq_lang.catalog.engine_changes import NO_DELAY  # few files have a Delay and are for one line

    if any(at_least(last_of(line), NO_DELAY.since) and not at_least(line, NO_DELAY.until) for line in view.engines):
        for resolved in delays:
            message = f"{resolved.shown_kind} {NO_DELAY.what}"
            yield Diagnostic("count-of-nothing", resolved.node.head.span, message, notes=(NO_DELAY.instead,))


def _loop(resolved: ResolvedNode, value: Word, number: float) -> Diagnostic:
    fixes = (replace_fix("Write `-1` for endless", value.span, "-1"),) if number < 0 else ()
    message = f"{resolved.shown_kind} never runs its child with `{value.raw}`"
    notes = ("-1 means endless, other numbers below 1 mean never",)
    return Diagnostic("count-of-nothing", value.span, message, notes=notes, fixes=fixes)


def _timeout(kind: NodeKind, value: Word) -> Diagnostic:
    message = f"a {kind.tag} of `{value.raw}` is disabled: it never halts its child"
    return Diagnostic("count-of-nothing", value.span, message)


def _number(value: Word) -> float | None:
    if value.kind == QUANTITY:
        quantity = parse_quantity(value.raw)
        return quantity[0] if quantity is not None else None
    text = value.text
    return int(text) if text.removeprefix("-").isdecimal() and len(text) < 12 else None
