"""Files from the disk as a workspace, as the commands see them."""

from __future__ import annotations

import os

from btq_lang.projects.files import Files
from btq_lang.projects.options import Refused
from btq_lang.util.record import replace
from btq_lang.workspace.loader import absolute, find_project, read, shown
from btq_lang.workspace.workspace import Workspace


def open_workspace(*paths: str, factory: str | None = None) -> Workspace:
    """The workspace of files and folders, with all that they include, in the project of the first path.

    XML finds what it lacks in the files of its project, as in `btq check`; these are in the workspace too. Paths in it
    are absolute, with `/` between names.

        >>> from btq_lang import open_workspace
        >>> workspace = open_workspace("examples/laboratory")
        >>> [path.rpartition("/")[2] for path in workspace.files]
        ['mission.btq', 'scenarios.btq']

    Args:
        paths: files, and folders for all missions below them, .btq files and the engine's XML; without any, the current
            folder.
        factory: the `[[factory]]` of the project file in which the files are looked at, with all that it registers;
            None: the one that registers all of these files, if there is one, else each file is one of its own.

    Raises:
        OSError: a file or folder cannot be read, or is not UTF-8; the message names it.
        ValueError: there is no such factory, or it registers none of these files.
    """
    opened = Files()
    groups, problems = opened.groups(paths or (".",), with_xml=True, for_checks=True)
    for problem in problems:
        raise OSError(str(problem))
    requested = {path for group in groups for path in group.given}
    for group in groups:
        own_factory = group.workspace.factory
        if own_factory is not None and (
            own_factory.name == factory if factory is not None else requested.issubset(group.given)
        ):
            return _shown_from_root(group.workspace)
    if factory is not None:
        raise ValueError(f"no factory `{factory}` registers any of these files")
    if len(groups) == 1 and not groups[0].workspace.project.factories:
        return _shown_from_root(groups[0].workspace)
    if not groups:
        return _shown_from_root(opened.workspace_of_nodes(find_project(absolute(paths[0] if paths else "."))))
    wholes = [group.workspace for group in groups]
    files = {
        path: whole.files[path]
        for group, whole in zip(groups, wholes, strict=True)
        for requested_path in (*group.given, *sorted(group.pooled), *whole.project.node_files)
        for path in whole.closure(requested_path)
    }
    pools = dict.fromkeys(pool for whole in wholes for pool in whole.project.pools)
    return _shown_from_root(Workspace(files, replace(wholes[0].project, pools=tuple(pools))))


def _shown_from_root(workspace: Workspace) -> Workspace:
    """The workspace with paths in messages relative to its project, whatever the current folder."""
    return workspace.with_project(replace(workspace.project, folders=()))


class Disk:
    """The files on the disk, as one side of a comparison with another revision."""

    def shown(self, path: str) -> str:
        """How messages name a file."""
        return shown(path)

    def is_file(self, path: str) -> bool:
        return os.path.isfile(path)

    def text(self, path: str) -> str | None:
        return read(path)[0]

    def workspace(self, path: str, texts: dict[str, str] | None = None) -> Workspace | None:
        """A file with all that it includes; `texts`: those that override those on the disk.

        Raises:
            Refused: the file cannot be read, and no texts override it.
        """
        files = Files()
        files.overlay.update(texts or {})
        groups, problems = files.groups(texts or [path])
        if problems and texts is None:
            raise Refused(*problems)
        group = next((group for group in groups if path in group.given), None)
        return None if problems or group is None else group.workspace
