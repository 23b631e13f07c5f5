"""Files for version 3 of the engine in a project that does not say that they are."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.nav2 import ENGINES
from btq_lang.catalog.versions import DEFAULT_VERSION, VERSION_3
from btq_lang.checks import lookups
from btq_lang.checks.engines import is_for_version_3, old_words
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.util.text import Span


def version_3_file(view: View) -> Iterator[Diagnostic]:
    """What says that a file is for version 3, once: all else that version 4 refuses in it follows."""
    words, project = view.ask(old_words), view.project
    if not words or project.written_for:
        return
    shown = ", ".join(f"`{word}`" for word in words[:_SHOWN]) + (" …" if len(words) > _SHOWN else "")
    distribution = view.look_up(lookups.distribution)
    declared = ""
    if project.pinned:
        declared = f", but btq.toml names {project.target}"
    elif distribution is not None:
        declared = f", but {distribution.title()} has {ENGINES[distribution]}"
    start = view.item.start
    message = f"this file is for version 3 of the engine: it has {shown}{declared}"
    is_refused = view.ask(is_for_version_3)  # else a version 4 loads it, and takes it otherwise
    instead = (
        f"`btq check --target {DEFAULT_VERSION}` finds what version 4 refuses or takes otherwise, and `btq import` "
        "translates the file"
        if is_refused
        else "if it runs version 4, write `_autoremap`, and braces round the names of entries"
    )
    notes = (
        f'if the robot runs version 3, write `engine = "{VERSION_3}"` or `nodes = ["nav2-humble"]` into btq.toml',
        instead,
    )
    severity = Severity.ERROR if declared and is_refused else None
    yield Diagnostic("version-3-file", Span(start, start + len("Root")), message, notes=notes, severity=severity)


_SHOWN = 4
