"""Literals that a SubTree passes to a port without a type, and that a node below cannot read as they are.

One invariant: all ports below that read the value have one type; numbers have a rule of their own (typed_numbers.py).
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.literals import OLD_ENTRY, check_literal, is_pointer
from btq_lang.catalog.names import is_port_name
from btq_lang.checks import lookups
from btq_lang.checks.meant_entries import entry_of
from btq_lang.checks.view import View, port_of
from btq_lang.diagnostics.model import Diagnostic, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tokens import BRACED, QUANTITY
from btq_lang.workspace.port_types import is_number


def passed_literal(view: View) -> Iterator[Diagnostic]:
    """A text that a SubTree passes to a port, where the node below reads a number or another type."""
    for resolved in view.seen.subtrees:
        for pair in resolved.node.attributes if resolved.id is not None else ():
            value, key = pair.value, pair.key.text
            if resolved.id is None or value is None or value.kind in (BRACED, QUANTITY) or not is_port_name(key):
                continue
            text, declared = value.text, port_of(view, resolved, key)
            if not text.strip() or is_number(text.strip()) or is_pointer(text) or OLD_ENTRY.fullmatch(text):
                continue
            if (declared is not None and declared.type) or entry_of(view, value) is not None:
                continue  # which other rules report
            met = view.ask(lookups.read_below, resolved.id.text, key, view.target)
            problem = check_literal(met[3], text, view.target) if met is not None else None
            if met is None or problem is None:
                continue
            place, name, node, type_ = met
            message = f"expected {problem.expected} for `{name}` of `{node}`, found {problem.found or f'`{text}`'}"
            related = (Related(place, f"read here as {type_}"),)
            yield Diagnostic("invalid-literal", value.span, message, related=related, severity=Severity.WARNING)
