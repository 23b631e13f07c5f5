"""Diagnostics of files that are written in XML, shown on the XML.

One invariant: results count from the start of the file on the disk, whatever its language, and no fix changes a file in
another language.
"""

from __future__ import annotations

from collections.abc import Iterable

from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.util.record import replace
from btq_lang.util.text import Span
from btq_lang.workspace.workspace import Workspace


def shown_on_origins(workspace: Workspace, path: str, found: Iterable[Diagnostic]) -> list[Diagnostic]:
    """The diagnostics of a file, with those of its own XML, if it is XML."""
    foreign = workspace.origins
    origin = foreign.get(path)

    def on_origin(span: Span, where: str | None) -> Span:
        there = foreign.get(where or path)
        return span if there is None else there.places.origin(span)

    shown: list[Diagnostic] = []
    for each in found:
        if origin is not None and each.rule in _OF_SPELLING:
            continue
        related = each.related
        if each.rule not in _OF_SHOWN:
            related = tuple(
                Related(Place(on_origin(near.place.span, near.place.path), near.place.path), near.message)
                for near in related
            )
        fixes = tuple(
            fix for fix in each.fixes if not any((change.place.path or path) in foreign for change in fix.changes)
        )
        shown.append(replace(each, span=on_origin(each.span, path), related=related, fixes=fixes))
    return shown if origin is None else [*origin.diagnostics, *shown]


# What can only be wrong with the spelling of a .btq file.
_OF_SPELLING = frozenset(("string-over-items", "unknown-escape"))

# Rules that report diagnostics of included files, which are shown on origins already.
_OF_SHOWN = frozenset(("include-with-errors",))
