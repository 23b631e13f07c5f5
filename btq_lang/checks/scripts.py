"""Scripts in attributes and ports: refused by the engine, empty, or read differently by its versions."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.versions import NEW_SCRIPTS
from btq_lang.checks.strings import moved
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Pair, Word
from btq_lang.util.record import replace
from btq_lang.workspace.resolved import ResolvedNode


def script_error(view: View) -> Iterator[Diagnostic]:
    """The problems in a script, in any version that the project targets: script-error, empty-script, script-version."""
    for resolved, pair, value in view.seen.values():
        expects_value = _expects_value(resolved, pair)
        if expects_value is not None:
            yield from _problems(view, resolved, pair.key.text, value, expects_value)


def is_script(resolved: ResolvedNode, pair: Pair) -> bool:
    """Whether an attribute holds a script."""
    return _expects_value(resolved, pair) is not None


def _expects_value(resolved: ResolvedNode, pair: Pair) -> bool | None:
    """Whether a script in this attribute must end in an expression with a value, as a condition does; None if the
    attribute is not a script.
    """
    key = pair.key.text
    attribute = RESERVED_ATTRIBUTES.get(key)
    if attribute is not None:
        return attribute.group == "pre" if attribute.is_script else None
    port = resolved.kind.port(key) if resolved.kind is not None else None
    if port is None or port.content != "script" or (pair.value is not None and is_pointer(pair.value.text)):
        return None
    return resolved.flow != "succeeds"  # a node that always succeeds ignores the value


def _problems(view: View, resolved: ResolvedNode, key: str, value: Word, expects_value: bool) -> Iterator[Diagnostic]:
    from btq_lang.syntax.script.check import check_script, is_in_double_quotes  # few files have a script; it is large

    for problem in check_script(view.script(value.text), versions=view.engines, expects_value=expects_value):
        diagnostic = moved(problem, value)
        notes: tuple[str, ...] = ()
        if problem.rule == "empty-script":
            diagnostic = _empty(resolved, key, value, diagnostic)
        elif problem.rule == "script-version" and not view.is_pinned:
            notes = (f'if you run {view.target}, set `engine = "{view.target}"` in btq.toml',)
        elif problem.rule == "script-error" and is_in_double_quotes(value.text, problem.span):
            notes = view.pin_note(lambda version: not NEW_SCRIPTS.holds(version))
        yield replace(diagnostic, notes=(*diagnostic.notes, *notes))


def _empty(resolved: ResolvedNode, key: str, value: Word, diagnostic: Diagnostic) -> Diagnostic:
    """The diagnostic for an empty script, with the whole value as its span.

    The engine accepts `""` as the code of a Script node; it rejects any other empty script.
    """
    is_port = resolved.kind is not None and resolved.kind.port(key) is not None
    if is_port and resolved.flow == "succeeds" and value.text == "":
        return replace(diagnostic, span=value.span, message="empty script", severity=Severity.WARNING)
    return replace(diagnostic, span=value.span)
