"""Files for version 3 of the engine in a project that does not say so, and for version 4 in one of version 3."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.catalog.nav2 import ENGINES
from btq_lang.catalog.versions import DEFAULT_VERSION, VERSION_3
from btq_lang.checks import lookups
from btq_lang.checks.engines import is_for_version_3, old_words
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.util.text import Span
from btq_lang.workspace.file import Signs


def version_3_file(view: View) -> Iterator[Diagnostic]:
    """A file for version 3, reported once with its words of that version; what version 4 refuses in it follows from
    that."""
    words, project = view.ask(old_words), view.project
    if not words or project.original_engines:
        return
    shown = ", ".join(f"`{word}`" for word in words[:_SHOWN]) + (" …" if len(words) > _SHOWN else "")
    distribution = view.ask(lookups.distribution)
    declared = ""
    if project.pinned:
        declared = f", but btq.toml names {project.target}"
    elif distribution is not None:
        declared = f", but {distribution.title()} has {ENGINES[distribution]}"
    message = f"this file is for version 3 of the engine: it has {shown}{declared}"
    is_refused = view.ask(is_for_version_3)  # else version 4 loads it, with another meaning
    instead = (
        f"`btq check --target {DEFAULT_VERSION}` finds what version 4 refuses or takes otherwise, and `btq import` "
        "translates the file"
        if is_refused
        else "if it runs version 4, write `_autoremap`, and braces round the names of entries"
    )
    of_nav2 = '`nodes = ["nav2-humble"]`'
    advice = f'write `engine = "{VERSION_3}"` or {of_nav2} into btq.toml'
    if project.pinned:
        advice = f'write `engine = "{VERSION_3}"` into btq.toml, or {of_nav2} into the factory that loads this file'
    notes = (
        f"if the robot runs version 3, {advice}",
        instead,
    )
    severity = Severity.ERROR if declared and is_refused else None
    yield Diagnostic("version-3-file", _root(view), message, notes=notes, severity=severity)


def refuses(diagnostics: Iterable[Diagnostic], signs: Signs | None) -> bool:
    """Whether version 3 refuses several things in a file that version 4 takes; one is enough if only the file's own
    declaration names version 3.  A file with words of version 3 is for that version."""
    is_declared = signs is not None and signs.is_new and signs.format == VERSION_3[:1]
    rules = [
        diagnostic.rule
        for diagnostic in diagnostics
        if diagnostic.effective_severity is Severity.ERROR or diagnostic.rule == _OLD_WORD
    ]
    return _OLD_WORD not in rules and sum(rule in _OF_VERSION_4 for rule in rules) > (not is_declared)


def version_4_file(view: View) -> Diagnostic:
    """The diagnostic for a file for version 4, in place of all that version 3 refuses in it; the item is its Root."""
    distribution = view.ask(lookups.distribution)
    declared = f"btq.toml names {view.project.target}"
    if distribution is not None and not view.project.pinned:
        declared = f"{distribution.title()} has {ENGINES[distribution]}"
    signs = view.ask(lookups.signs)
    if not view.project.original_engines and signs is not None and signs.format == VERSION_3[:1]:
        message = "this file is for version 4 of the engine, but declares version 3"
        notes: tuple[str, ...] = ('write `BTCPP_format="4"`',)
        return Diagnostic("version-4-file", _root(view), message, notes=notes)
    message = f"this file is for version 4 of the engine, but {declared}"
    notes = (
        f'if the robot runs version 4, write `engine = "{DEFAULT_VERSION}"` or a later distribution, such as '
        '`nodes = ["nav2-jazzy"]`, into btq.toml',
        "what else is wrong with the file is reported when that is decided",
    )
    return Diagnostic("version-4-file", _root(view), message, notes=notes)


def _root(view: View) -> Span:
    return Span(view.item.start, view.item.start + len("Root"))


_SHOWN = 4
_OLD_WORD = "not-an-engine-node"
_OF_VERSION_4 = frozenset(("newer-engine-node", "unknown-port", "unknown-attribute"))
