"""Numbers that a SubTree gives to ports of text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.kinds import at_least
from btq_lang.catalog.names import is_port_name
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tokens import QUANTITY
from btq_lang.syntax.tree import Entry, Model, Models, Port, Tree, Word
from btq_lang.workspace.port_types import Meeting, is_number, is_text, meetings

if TYPE_CHECKING:
    from btq_lang.checks.view import View

# Before, the engine kept the text and whoever read it converted it.
_TYPED_SINCE = "4.9.1"


def number_for_text(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A number that a SubTree gives to a port, or that is a port's default, where a node below takes a text."""
    if not at_least(view.project.target, _TYPED_SINCE):
        return
    for seen in view.seen(entry).subtrees:
        if seen.id is None:
            continue
        for pair in seen.node.attributes:
            met = _text_below(view, seen.id, pair.key, pair.value)
            if met is not None and pair.value is not None:
                yield _told(pair.value, met, None)
    for tree, port in _ports_of_trees(entry):
        met = _text_below(view, tree, port.name, port.default)
        if met is not None and port.default is not None:
            # Only where a SubTree gives the port nothing else.
            yield _told(port.default, met, Severity.WARNING)


def _text_below(view: View, tree: Word, port: Word | None, value: Word | None) -> Meeting | None:
    if value is None or port is None or value.kind == QUANTITY or not is_number(value.text):
        return None
    if not is_port_name(port.text):
        return None
    found = meetings(view.scope, view.project.target, tree.text, port.text)
    return next((meeting for meeting in found if is_text(meeting.type)), None)


def _told(value: Word, met: Meeting, severity: Severity | None) -> Diagnostic:
    port = f"`{met.pair.key.text}` of `{met.node.head.text}`"
    message = (
        f"BehaviorTree.CPP {_TYPED_SINCE} and later refuse to load this tree: `{value.text}` is a number, "
        f"{port} a string"
    )
    return Diagnostic(
        "number-for-text",
        value.span,
        message,
        related=(Related(Place(met.pair.key.span, met.tree.path, met.tree.entry.item), "the string port"),),
        notes=(f"pass an entry that holds the string: `Script (code = \"text := '{value.text}'\")`, then `{{text}}`",),
        severity=severity,
    )


def _ports_of_trees(entry: Entry) -> Iterator[tuple[Word, Port]]:
    item = entry.item
    if isinstance(item, Tree) and item.name is not None:
        yield from ((item.name, port) for port in item.ports)
    for model in item.models if isinstance(item, Models) else (item,):
        if isinstance(model, Model) and model.category.raw == "SubTree" and model.name is not None:
            yield from ((model.name, port) for port in model.ports)
