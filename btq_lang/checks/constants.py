"""Numbers that a SubTree passes to text ports."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.versions import TYPED_CONSTANTS
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tokens import QUANTITY
from btq_lang.syntax.tree import Port, Tree, Word, models_in
from btq_lang.workspace.port_types import is_number


def number_for_text(view: View) -> Iterator[Diagnostic]:
    """A number that a SubTree passes to a port, or that is a port's default, where a node below expects a text."""
    if not TYPED_CONSTANTS.holds(view.target):
        return
    for seen in view.seen.subtrees:
        if seen.id is None:
            continue
        for pair in seen.node.attributes:
            met = _text_below(view, seen.id, pair.key, pair.value)
            if met is not None and pair.value is not None:
                yield _diagnostic(pair.value, met, None)
    for tree, port in _ports_of_trees(view):
        met = _text_below(view, tree, port.name, port.default)
        if met is not None and port.default is not None:
            # Only if a SubTree passes nothing else to the port.
            yield _diagnostic(port.default, met, Severity.WARNING)


def _text_below(view: View, tree: Word, port: Word | None, value: Word | None) -> tuple[Place, str, str] | None:
    """The text port that receives a number: its place, its name, its node."""
    if value is None or port is None or value.kind == QUANTITY or not is_number(value.text):
        return None
    if not is_port_name(port.text):
        return None
    return view.look_up(lookups.text_below, tree.text, port.text)


def _diagnostic(value: Word, met: tuple[Place, str, str], severity: Severity | None) -> Diagnostic:
    place, name, node = met
    port = f"`{name}` of `{node}`"
    message = (
        f"BehaviorTree.CPP {TYPED_CONSTANTS.since} and later refuse to load this tree: `{value.text}` is a number, "
        f"{port} a string"
    )
    return Diagnostic(
        "number-for-text",
        value.span,
        message,
        related=(Related(place, "the string port"),),
        notes=(f"pass an entry that holds the string: `Script (code = \"text := '{value.text}'\")`, then `{{text}}`",),
        severity=severity,
    )


def _ports_of_trees(view: View) -> Iterator[tuple[Word, Port]]:
    item = view.item
    if isinstance(item, Tree) and item.name is not None:
        yield from ((item.name, port) for port in item.ports)
    for model in models_in(item):
        if model.category.raw == "SubTree" and model.name is not None:
            yield from ((model.name, port) for port in model.ports)
