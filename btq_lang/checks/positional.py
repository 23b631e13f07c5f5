"""Values without the name of their port, as in calls of other languages: `MoveBase ("dock")`, `Retry 3`.

One invariant: the parser reports them; this module adds which port is meant, which the parser cannot know.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.catalog.nodes import PortKind, lookup
from btq_lang.checks.known_ports import first_port
from btq_lang.checks.scripts import is_script
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, write_fix
from btq_lang.syntax.tree import Tree, quote, written
from btq_lang.util.record import replace
from btq_lang.util.text import Span


def with_ports(view: View, reported: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """The parser's diagnostics of an item, with the ports of values that lack one."""
    for diagnostic in reported:
        if isinstance(view.item, Tree) and (quoted := _with_quotes(view, diagnostic)) is not None:
            yield quoted
            continue
        # `Script (x := 3)`, taken for an attribute's sign
        is_script = view.text.startswith(":=", diagnostic.span.start)
        yield (
            _with_port(view, diagnostic)
            if isinstance(view.item, Tree) and (is_script or not diagnostic.fixes)
            else diagnostic
        )


def _with_port(view: View, reported: Diagnostic) -> Diagnostic:
    text, span = view.text, reported.span
    resolved = view.node_before(span.start)
    after = _AFTER.match(text, (resolved.node.label or resolved.node.head).end) if resolved is not None else None
    if resolved is None or after is None or not after.end() <= span.start <= max(after.end(), resolved.node.end):
        return reported
    port = first_port(view, resolved)
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


def _with_quotes(view: View, reported: Diagnostic) -> Diagnostic | None:
    """The diagnostic for a script without quotes, `Script x = 3` or `Go (_skipIf = x == 3)`; None for any other."""
    resolved = view.node_before(reported.span.start)
    if resolved is None:
        return None
    offset = reported.span.start
    pair = next((candidate for candidate in reversed(resolved.node.attributes) if candidate.key.start < offset), None)
    if pair is not None and is_script(resolved, pair):
        unquoted = _UNQUOTED.match(view.text, pair.key.end)
        if unquoted is None or offset > unquoted.end():
            return None
        text = quote(unquoted["script"])
        message, fix = (
            f"a script goes in quotes: `{pair.key.raw} = {text}`",
            write_fix(text, Span(*unquoted.span("script"))),
        )
        return replace(reported, message=message, notes=(), fixes=(fix,))
    kind = lookup(resolved.node.head.text)
    ports = [port for port in kind.ports if port.content == "script"] if kind is not None else []
    bare = _BARE_SCRIPT.match(view.text, resolved.node.head.end)
    if kind is None or not ports or bare is None or offset > bare.end():
        return None
    sign = {"=": ":=" if kind.flow == "succeeds" else "=="}.get(bare["sign"], bare["sign"])
    script = quote(f"{bare['entry']} {sign} {bare['value']}")
    shown = f"({ports[0].name} = {script})"
    message = f"a script goes in quotes after the name of its port: `{shown}`"
    return replace(
        reported, message=message, notes=(), fixes=(write_fix(shown, Span(bare.start("entry"), bare.end())),)
    )


def _value(view: View, reported: Diagnostic, after: re.Match[str], port: PortKind) -> str | None:
    """The only value after a node, in brackets or at the end of the line; None if more follows."""
    text, span = view.text, reported.span
    if text[after.end()] in _OPENS_VALUE:
        is_whole = span.start == after.end() and (_CLOSING if after[1] else _LAST).match(text, span.end)
        return text[span.start : span.end] if is_whole else None
    script = _SCRIPT.match(text, after.end()) if after[1] and port.content == "script" else None
    return script[1] if script is not None else None


_ATOMS: Final = r"(?:(?!satisf|tags\b)[^\"#(),\r\n])*(?<!\s)"
_BARE_SCRIPT: Final = re.compile(
    r"[ \t]+(?P<entry>@?[^\W\d]\w*)[ \t]*(?P<sign>:=|[-+*/=!<>]?=|[<>])"
    rf"[ \t]*(?P<value>{_ATOMS})(?=[ \t]*(?:#|[\r\n]|\Z))"
)
_UNQUOTED: Final = re.compile(rf"[ \t]*=[ \t]*(?P<script>{_ATOMS})(?=[ \t]*[,)])")
_AFTER: Final = re.compile(r"[ \t]*(?:(\()\s*)?(?=\S)")
_OPENS_VALUE: Final = "\"'0123456789-{"
_CLOSING: Final = re.compile(r"\s*\)")
_LAST: Final = re.compile(r"[ \t]*(?:#|[\r\n]|\Z)")
_SCRIPT: Final = re.compile(r"([^\"#\r\n]*[^\"#\s])[ \t]*\)[ \t]*(?:#|[\r\n]|\Z)")
