"""Values without the name of their port, as in calls of other languages: `MoveBase ("dock")`.

One invariant: the parser has reported them; this only adds which port is meant, which it cannot know.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from btq_lang.checks.ports import first_port
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.syntax.tree import Tree, written
from btq_lang.util.record import replace
from btq_lang.util.text import Span


def with_ports(view: View, reported: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """What the parser has reported of an item, with the ports of values that lack one."""
    for each in reported:
        yield _with_port(view, each) if isinstance(view.item, Tree) and not each.fixes else each


def _with_port(view: View, reported: Diagnostic) -> Diagnostic:
    text, span = view.text, reported.span
    value = text[span.start : span.end]
    if _VALUE.match(value) is None or _CLOSING.match(text, span.end) is None:
        return reported
    for seen in view.nodes:
        node = seen.node
        if text[(node.label or node.head).end : span.start].strip() != "(":
            continue
        port = first_port(view, seen)
        if port is None or (port.unit and value[-1].isdecimal()):
            return reported  # a number, of which the unit is unknown
        pair = f"{written(port.name)} = {value}"
        fix = replace_fix(f"Write `{pair}`", Span(span.start, span.start), f"{written(port.name)} = ")
        return replace(reported, notes=(f"a value goes after the name of its port: `{pair}`",), fixes=(fix,))
    return reported


_VALUE = re.compile(r"[\"'0-9-]")
_CLOSING = re.compile(r"\s*\)")
