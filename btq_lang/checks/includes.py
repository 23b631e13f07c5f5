"""Included files that are missing, that include themselves, or that cannot be read."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Container, Iterator
from typing import TypeAlias

from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, replace_fix
from btq_lang.syntax.tree import Include, quote
from btq_lang.util.spelling import near
from btq_lang.util.text import Span, counted
from btq_lang.workspace.file import is_of_package
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

ErrorsIn: TypeAlias = "Callable[[Store[Workspace], str], tuple[tuple[Place, str], ...]]"

NOWHERE = "; neither this file nor its includes define it"


def missing_include(view: View) -> Iterator[Diagnostic]:
    """An included file that cannot be found."""
    include = view.item
    if not isinstance(include, Include) or include.path is None or is_of_package(include):
        return
    path = include.path.text
    if view.ask(lookups.included, view.facts) is not None:
        return
    folder = posixpath.dirname(view.path)
    fixes = tuple(
        replace_fix(f"Replace it with `{other}`", include.path.span, quote(other))
        for other in _likely_files(view, path)
    )
    project = view.project
    places = ", ".join(
        f"`{project.shown(place)}`{' (no folder)' if place in project.lost_paths else ''}"
        for place in (folder or ".", *project.include_paths)
    )
    message = f"cannot find the file `{path}`" if path else "missing file name after `include`"
    notes = (f"searched {places}; add folders with `include-paths` in btq.toml",)
    yield Diagnostic("missing-include", include.path.span, message, notes=notes, fixes=fixes)


def cyclic_include(view: View) -> Iterator[Diagnostic]:
    """A file that includes itself, directly or not."""
    include = view.item
    if not isinstance(include, Include) or include.path is None:
        return
    target = view.ask(lookups.included, view.facts)
    if target is None or view.path not in view.store.ask(lookups.closure, target):
        return
    how = "itself" if target == view.path else f"`{include.path.text}`, which includes this file again"
    message = f"this file includes {how}"
    notes = ("the engine follows the cycle until it crashes",)
    yield Diagnostic("cyclic-include", include.path.span, message, notes=notes)


def include_with_errors(view: View, errors_in: ErrorsIn) -> Iterator[Diagnostic]:
    """An included file that cannot be read or loaded as it is, or one that includes such a file.

    Args:
        errors_in: the query for the errors that keep a file from being read.
    """
    include = view.item
    target = view.ask(lookups.included, view.facts)
    if target is None or not isinstance(include, Include) or include.path is None:
        return
    for path in reversed(view.store.ask(lookups.closure, target)):
        errors = view.store.ask(errors_in, path) if path != view.path else ()
        if not errors:
            continue
        place, message = errors[0]
        shown = posixpath.relpath(path, posixpath.dirname(view.path) or ".")
        which = f"`{shown}`" if path == target else f"`{shown}`, which that file includes,"
        notes: tuple[str, ...] = ("`btq build` refuses every file that includes it",)
        # XML in a folder is checked only if it is named.
        if len(errors) > 1 and view.store.ask(lookups.is_xml, path):
            notes += (f"run `btq check {shown}` to see all of them",)
        yield Diagnostic(
            "include-with-errors",
            include.path.span,
            f"{which} has {counted(len(errors), 'error')}: {message}",
            related=(Related(place, "first error" if len(errors) > 1 else "here"),),
            notes=notes,
        )
        return


def is_reported_beside(diagnostic: Diagnostic, checked: Container[str]) -> bool:
    """Whether a diagnostic about an included file only repeats what is reported of that file, which is checked too."""
    return diagnostic.rule == "include-with-errors" and diagnostic.related[0].place.path in checked


def include_fix(view: View, path: str) -> Fix:
    """The fix that adds an include after the existing ones."""
    offset, line = include_line(view.ask(lookups.head), view.path, path)
    shown = posixpath.relpath(path, posixpath.dirname(view.path) or ".")
    return Fix(f"Include `{shown}`", (FixEdit(Place(Span(offset, offset), view.path), line),))


def include_line(head: tuple[int, str], path: str, other: str) -> tuple[int, str]:
    """The line that includes another file in the one at `path`, and the offset to insert it.

    Args:
        head: of `lookups.head`.
    """
    offset, margin = head
    return offset, f"{margin}include {quote(posixpath.relpath(other, posixpath.dirname(path) or '.'))}\n"


def _likely_files(view: View, path: str) -> tuple[str, ...]:
    name = posixpath.basename(path)
    others = view.ask(lookups.other_files)
    return tuple([other for other in others if posixpath.basename(other) == name][:3]) or near(path, others)
