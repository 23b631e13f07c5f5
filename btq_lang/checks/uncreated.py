"""What is wrong in a tree that no main tree of its factory runs: the engine finds most of it only in a tree that it
creates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.checks import calls
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.util.record import replace


def as_uncreated(view: View, found: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """What was found in an item; errors are only warnings if the engine never comes to them."""
    name = view.tree_name.text if view.tree_name is not None else ""
    is_uncreated = view.factory is not None and view.ask(calls.is_uncreated, name)
    note = f"no main tree of the factory `{view.factory}` reaches `{name}`; the engine would refuse to create it"
    for each in found:
        if is_uncreated and each.rule in AT_CREATION and each.effective_severity is Severity.ERROR:
            yield replace(each, severity=Severity.WARNING, notes=(*each.notes, note))
        else:
            yield each


# What 4.6.2 and 4.10.0 load in such a tree, and refuse when it is created or ticked.  They refuse at once, and with it
# all trees of the file: wrong numbers of children, unknown nodes, names that they forbid, an ID that is missing.
AT_CREATION: Final = frozenset(
    (
        "unknown-port",
        "missing-port",
        "invalid-literal",
        "number-for-text",
        "entry-with-two-types",
        "switch-cases",
        "parallel-threshold",
        "unknown-tree",
        "recursive-tree",
        "duplicate-instance-name",
        "script-error",
        "empty-script",
    )
)
