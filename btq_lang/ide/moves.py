"""Files that are renamed or moved: the includes that follow them."""

from __future__ import annotations

import posixpath
from collections.abc import Mapping

from btq_lang.syntax.tree import quote
from btq_lang.util.text import Edit
from btq_lang.workspace.config import include_candidates
from btq_lang.workspace.workspace import Workspace


def moved_files(workspace: Workspace, moves: Mapping[str, str]) -> dict[str, tuple[Edit, ...]]:
    """The edits, by the old paths of files, that keep every include leading to the same file; `moves`: new paths of
    files and folders by old ones."""
    new = {path: _after(path, moves) for path in workspace.files}
    edits: dict[str, tuple[Edit, ...]] = {}
    for path, file in workspace.files.items():
        if file.is_foreign:
            continue
        for include in file.includes:
            target = workspace.included_by(path, include)
            if include.path is None or target is None or (new[path], new[target]) == (path, target):
                continue
            if new[target] in include_candidates(workspace.project, new[path], include.path.text)[:1]:
                continue
            shown = include_name(workspace, new[path], new[target])
            if shown != include.path.text:
                edit = Edit(include.path.span.shifted(file.start_of(include)), quote(shown))
                edits[path] = (*edits.get(path, ()), edit)
    return edits


def _after(path: str, moves: Mapping[str, str]) -> str:
    """The path of a file after it, or a folder above it, was moved."""
    for old, new in moves.items():
        if path == old or path.startswith(f"{old.rstrip('/')}/"):
            return new.rstrip("/") + path[len(old.rstrip("/")) :]
    return path


def include_name(workspace: Workspace, path: str, target: str) -> str:
    """A file as an include in another one names it: relative to an include path if one leads there."""
    names = [posixpath.relpath(target, posixpath.dirname(path) or ".")]
    names += [posixpath.relpath(target, folder) for folder in workspace.project.include_paths]
    return min(names, key=lambda name: (name.startswith(".."), len(name)))
