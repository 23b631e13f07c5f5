"""Diagnostics of files that are written in XML, shown on the XML.

One invariant: the spans of results count from the start of the file on the disk.  A fix of a file in another language
is offered only if that edit can be made there exactly.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

from btq_lang.btcpp.exact_edits import exact_edits
from btq_lang.checks.engines import is_for_version_4
from btq_lang.checks.suppressions import is_silenced_in_xml
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related
from btq_lang.util.record import replace
from btq_lang.util.text import Edit, Span
from btq_lang.workspace.workspace import Workspace


def shown_on_origins(workspace: Workspace, path: str, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """The diagnostics of a file, with those of its own XML, if it is XML."""
    foreign, file = workspace.foreign, workspace.files[path]

    def on_origin(span: Span, place_path: str | None) -> Span:
        foreign_file = foreign.get(place_path or path)
        return span if foreign_file is None else foreign_file.on_disk(span)

    shown: list[Diagnostic] = []
    for diagnostic in diagnostics:
        if file.is_foreign and diagnostic.rule in _OF_SPELLING:
            continue
        related = diagnostic.related
        if diagnostic.rule not in _OF_SHOWN:
            related = tuple(
                Related(
                    Place(on_origin(related_place.place.span, related_place.place.path), related_place.place.path),
                    related_place.message,
                )
                for related_place in related
            )
        fixes = tuple(placed for fix in diagnostic.fixes if (placed := _placed(workspace, path, fix)) is not None)
        shown.append(replace(diagnostic, span=on_origin(diagnostic.span, path), related=related, fixes=fixes))
    if not file.is_foreign:
        return shown
    return [
        *(diagnostic for diagnostic in file.source_diagnostics if not is_silenced_in_xml(file.source, diagnostic)),
        *shown,
    ]


def _placed(workspace: Workspace, path: str, fix: Fix) -> Fix | None:
    """The fix with its changes made in the XML; None if they cannot be made there.

    Fixes are safe for version 4 of the engine, so not in XML that may be for version 3.
    """
    changes: list[FixEdit] = []
    is_safe = fix.safe
    for change in fix.changes:
        file = workspace.files[change.place.path or path]
        if not file.is_foreign:
            changes.append(change)
        elif edits := exact_edits(file, Edit(change.place.span, change.text)):
            changes += [FixEdit(Place(edit.span, change.place.path), edit.text) for edit in edits]
            is_safe = is_safe and workspace.store.ask(is_for_version_4, change.place.path or path)
        else:
            return None
    spans = sorted(change.place.span for change in changes if change.place.path in (None, path))
    is_torn = any(one.end > other.start for one, other in pairwise(spans))  # of a word that the language has in pieces
    return None if is_torn else Fix(fix.title, tuple(changes), is_safe)


# What can only be wrong with the spelling of a .btq file.
_OF_SPELLING = frozenset(("string-over-items", "unknown-escape"))

# Rules that report diagnostics of included files, which are shown on origins already.
_OF_SHOWN = frozenset(("include-with-errors",))
