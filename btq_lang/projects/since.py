"""`btq check --since REV`: the files that changed since a revision, and those that depend on such a file.

A file depends on itself; on the project file; on what it includes, directly or not, also where an included file is not
there any more; in a factory on all files of it, and on the parameter file of Nav2 that names them; on the files of
requirements that the project imports;
and XML on the files of its pool that define the trees and nodes it uses, or did so at the revision.

One invariant: a file that is left out has the same findings as at the revision, as far as they depend on files.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Iterator

from btq_lang.btcpp.recognition import defined_in
from btq_lang.catalog.name_kinds import Kind
from btq_lang.projects.files import FileGroup
from btq_lang.projects.git import GitTrouble, Revisions, revisions
from btq_lang.util.record import replace
from btq_lang.workspace.config import include_candidates
from btq_lang.workspace.file import SUFFIXES, XML_SUFFIXES
from btq_lang.workspace.workspace import Workspace


def affected(groups: Iterable[FileGroup], revision: str) -> tuple[FileGroup, ...]:
    """The groups with only those requested files that a change since a revision concerns.

    Raises:
        GitTrouble: files are in no repository, the revision is not known, git is not installed.
    """
    if ".." in revision:
        raise GitTrouble(f"expected one revision, which the files are compared with, not `{revision}`")
    of_folder: dict[str, tuple[Revisions, frozenset[str]]] = {}
    affected_groups: list[FileGroup] = []
    for group in groups:
        for path in group.given[:1]:
            folder = posixpath.dirname(path)
            if folder not in of_folder:
                compared = revisions(revision, folder)
                of_folder[folder] = compared, compared.changed_paths()
            compared, changed = of_folder[folder]
            if group.project_file not in changed:
                concerned = _Concerned(group.workspace, changed, compared)
                group = replace(group, given=tuple(filter(concerned, group.given)))
        affected_groups.append(group)
    return tuple(affected_groups)


def has_changed(paths: Iterable[str], revision: str) -> bool:
    """Whether any of some files has changed since a revision.

    Raises:
        GitTrouble: as above.
    """
    first, *others = paths
    return not revisions(revision, posixpath.dirname(first)).changed_paths().isdisjoint((first, *others))


class _Concerned:
    """Whether a change of some files concerns a file of a workspace."""

    def __init__(self, workspace: Workspace, changed: frozenset[str], compared: Revisions) -> None:
        self._workspace = workspace
        self._changed = changed
        self._known = compared
        self._defined_before: dict[str, frozenset[str]] = {}

    def __call__(self, path: str) -> bool:
        seen: set[str] = set()
        waiting = [path]
        while waiting:
            needed = waiting.pop()
            if needed in self._changed:
                return True
            if needed in self._workspace.files and needed not in seen:
                seen.add(needed)
                waiting += self._needed(needed)
        return False

    def _needed(self, path: str) -> Iterator[str]:
        """The paths that a file itself depends on, existing or not."""
        workspace = self._workspace
        yield from workspace.scope(path).paths
        yield from workspace.project.imports
        if workspace.factory is not None and workspace.factory.nav2:
            yield workspace.factory.nav2
        for include, is_of_package in workspace.files[path].included_paths:
            if not is_of_package:
                yield from include_candidates(workspace.project, path, include)
        pool = workspace.project.pool_of(path) if workspace.files[path].is_foreign else None
        if pool is None:
            return
        changed = [changed_path for changed_path in self._changed if changed_path.startswith(pool)]
        for kind, name in workspace.files[path].used_names:
            if kind in (Kind.TREE, Kind.MODEL) and not workspace.scope(path).defines(kind, name):
                yield from (pooled.path for pooled in workspace.pooled(path, kind, name))
                yield from (changed_path for changed_path in changed if self._defined(changed_path, name))

    def _defined(self, path: str, name: str) -> bool:
        """Whether a changed file may have defined a tree or a node at the revision."""
        if path.endswith(SUFFIXES):
            return name in (self._known.old.text(path) or "")
        if path not in self._defined_before:
            text = self._known.old.text(path) if path.endswith(XML_SUFFIXES) else None
            self._defined_before[path] = defined_in(text or "")
        return name in self._defined_before[path]
