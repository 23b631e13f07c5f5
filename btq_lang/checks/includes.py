"""Included files that are missing, or that include themselves."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator

from btq_lang.checks.view import View
from btq_lang.diagnostics import Change, Diagnostic, Fix, Place, replace_fix
from btq_lang.syntax import Entry, Include, quote
from btq_lang.text import Span


def missing_include(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """An included file that cannot be found."""
    include = entry.item
    if not isinstance(include, Include) or include.path is None or _from_ros_package(include):
        return
    path = include.path.text
    if view.workspace.included_by(view.path, include) is not None:
        return
    folder = posixpath.dirname(view.path)
    fixes = tuple(
        replace_fix(f"Replace it by `{other}`", include.path.span, quote(other)) for other in _meant(view, path)
    )
    places = ", ".join(f"`{place}`" for place in (folder or ".", *view.workspace.project.include_paths))
    yield Diagnostic(
        "missing-include",
        include.path.span,
        f"there is no file `{path}`" if path else "this include names no file",
        notes=(f"looked for in {places}; `include-paths` in btq.toml adds folders",),
        fixes=fixes,
    )


def cyclic_include(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A file that includes itself, directly or not."""
    include = entry.item
    if not isinstance(include, Include) or include.path is None:
        return
    target = view.workspace.included_by(view.path, include)
    if target is None or view.path not in view.workspace.closure(target):
        return
    how = "itself" if target == view.path else f"`{include.path.text}`, which includes this file again"
    yield Diagnostic(
        "cyclic-include",
        include.path.span,
        f"this file includes {how}",
        notes=("the engine follows such a circle until it crashes",),
    )


def include_fix(view: View, path: str) -> Fix:
    """Include another file, behind the includes that are there."""
    shown = posixpath.relpath(path, posixpath.dirname(view.path) or ".")
    at, margin = behind_includes(view)
    return Fix(f"Include `{shown}`", (Change(Place(Span(at, at), view.path), f"{margin}include {quote(shown)}\n"),))


def behind_includes(view: View) -> tuple[int, str]:
    """Where a line may be put in that belongs to the head of a file, and what it is indented with."""
    text = view.file.text
    includes = [entry for entry in view.file.parsed.entries if isinstance(entry.item, Include)]
    if includes:
        last = includes[-1]
        at = text.find("\n", last.start + last.item.end) + 1
        if at:
            return at, text[last.start : last.start + last.item.start]
    return (1 if text.startswith("\ufeff") else 0), ""


def _from_ros_package(include: Include) -> bool:
    return any(pair.key.text == "ros_pkg" for pair in include.attributes)


def _meant(view: View, path: str) -> tuple[str, ...]:
    name = posixpath.basename(path)
    same_name = [other for other in view.other_files if posixpath.basename(other) == name]
    return tuple(same_name[:3]) or view.near(path, None)
