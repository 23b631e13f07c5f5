"""Values without the name of their port, as in calls of other languages: `MoveBase ("dock")`, `Retry 3`.

One invariant: the parser has reported them; this only adds which port is meant, which it cannot know.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.catalog.nodes import PortKind
from btq_lang.checks.ports import first_port
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, write_fix
from btq_lang.syntax.tree import Tree, quote, written
from btq_lang.util.record import replace
from btq_lang.util.text import Span


def with_ports(view: View, reported: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """What the parser has reported of an item, with the ports of values that lack one."""
    for each in reported:
        is_script = view.text.startswith(":=", each.span.start)  # `Script (x := 3)`, taken for an attribute's sign
        yield _with_port(view, each) if isinstance(view.item, Tree) and (is_script or not each.fixes) else each


def _with_port(view: View, reported: Diagnostic) -> Diagnostic:
    text, span = view.text, reported.span
    seen = view.node_before(span.start)
    after = _AFTER.match(text, (seen.node.label or seen.node.head).end) if seen is not None else None
    if seen is None or after is None or not after.end() <= span.start <= max(after.end(), seen.node.end):
        return reported
    port = first_port(view, seen)
    value = _value(view, reported, after, port) if port is not None else None
    if port is None or value is None:
        return reported
    pair = f"{written(port.name)} = {value if value[0] in _OPENS_VALUE else quote(value)}"
    shown = pair if after[1] else f"({pair})"
    if port.unit and value[-1].isdecimal():
        with_unit = "`, or with a unit, `".join((shown, shown.replace(value, f"{value} s")))
        return replace(reported, notes=(f"a value goes after the name of its port: `{with_unit}`",))
    note = f"a value goes after the name of its port: `{shown}`"
    fix = write_fix(shown, Span(after.end(), after.end() + len(value)))
    return replace(reported, notes=(note,), fixes=(fix,))


def _value(view: View, reported: Diagnostic, after: re.Match[str], port: PortKind) -> str | None:
    """The one value after a node, in brackets or at the end of the line; None if there is something else."""
    text, span = view.text, reported.span
    if text[after.end()] in _OPENS_VALUE:
        is_whole = span.start == after.end() and (_CLOSING if after[1] else _LAST).match(text, span.end)
        return text[span.start : span.end] if is_whole else None
    script = _SCRIPT.match(text, after.end()) if after[1] and port.content == "script" else None
    return script[1] if script is not None else None


_AFTER: Final = re.compile(r"[ \t]*(?:(\()\s*)?(?=\S)")
_OPENS_VALUE: Final = "\"'0123456789-{"
_CLOSING: Final = re.compile(r"\s*\)")
_LAST: Final = re.compile(r"[ \t]*(?:#|[\r\n]|\Z)")
_SCRIPT: Final = re.compile(r"([^\"#\r\n]*[^\"#\s])[ \t]*\)[ \t]*(?:#|[\r\n]|\Z)")
