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
    """What is wrong with a script, in any version that the project targets: script-error, empty-script,
    script-version."""
    for seen in view.seen.given:
        for pair in seen.node.attributes:
            expects_value = _expects_value(seen, pair)
            if expects_value is None or pair.value is None:
                continue
            for problem in _problems(view, pair.value.text, expects_value):
                found = moved(problem, pair.value)
                if problem.rule == "empty-script":
                    yield _empty(seen, pair.key.text, pair.value, found)
                elif problem.rule == "script-version" and not view.is_pinned:
                    pin = f'if you run {view.target}, set `engine = "{view.target}"` in btq.toml'
                    yield replace(found, notes=(*found.notes, pin))
                else:
                    older: tuple[str, ...] = ()
                    if problem.rule == "script-error" and _is_in_double_quotes(pair.value.text, problem):
                        older = view.pin_note(lambda version: not NEW_SCRIPTS.holds(version))
                    yield replace(found, notes=(*found.notes, *older)) if older else found


def is_script(seen: ResolvedNode, pair: Pair) -> bool:
    """Whether an attribute holds a script."""
    return _expects_value(seen, pair) is not None


def _expects_value(seen: ResolvedNode, pair: Pair) -> bool | None:
    """Whether a script in this attribute must have a value, like a condition; None if it is not a script."""
    key = pair.key.text
    attribute = RESERVED_ATTRIBUTES.get(key)
    if attribute is not None:
        return attribute.group == "pre" if attribute.is_script else None
    port = seen.kind.port(key) if seen.kind is not None else None
    if port is None or port.content != "script" or (pair.value is not None and is_pointer(pair.value.text)):
        return None
    return seen.flow != "succeeds"  # else the node succeeds whatever the value


def _problems(view: View, script: str, expects_value: bool) -> tuple[Diagnostic, ...]:
    from btq_lang.syntax.script.check import check_script  # most files have no script, and it is large

    versions = view.engines
    return check_script(view.script(script), versions=versions, expects_value=expects_value)


def _is_in_double_quotes(script: str, problem: Diagnostic) -> bool:
    from btq_lang.syntax.script.check import is_in_double_quotes  # as above

    return is_in_double_quotes(script, problem.span)


def _empty(seen: ResolvedNode, key: str, value: Word, found: Diagnostic) -> Diagnostic:
    """The whole value is the place; the engine runs a Script without any character, and refuses all other empty
    ones."""
    is_port = seen.kind is not None and seen.kind.port(key) is not None
    if is_port and seen.flow == "succeeds" and value.text == "":
        return replace(found, span=value.span, message="empty script", severity=Severity.WARNING)
    return replace(found, span=value.span)
