"""Files from the disk, in this language or in XML, as a workspace."""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.workspace.file import SUFFIXES, File, Origin
from btq_lang.workspace.loader import find_project, load
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from collections.abc import Iterator


def open_workspace(*paths: str) -> Workspace:
    """The workspace of files and folders, with all that they include, in the project of the first path.

    Its paths are absolute, with `/` between names.

        >>> from btq_lang import open_workspace
        >>> workspace = open_workspace("examples/laboratory")
        >>> [path.rpartition("/")[2] for path in workspace.files]
        ['mission.btq']

    Args:
        paths: files, and folders for all .btq files below them; without any, the current folder.

    Raises:
        OSError: a file or folder cannot be read, or is not UTF-8; the message names it.
    """
    found = find_project(paths[0] if paths else ".")
    files: dict[str, File] = {}

    def includes_of(path: str, text: str) -> Iterator[str]:
        files[path] = file_of(path, text)
        return (include.path.text for include in files[path].includes if include.path is not None)

    loaded = load((*(paths or (".",)), *found.project.node_files), found.project, includes_of)
    for problem in (*found.problems, *loaded.problems):
        raise OSError(str(problem))
    return Workspace(files, found.project)


def with_source(workspace: Workspace, path: str, text: str) -> Workspace:
    """The workspace after a change of the text that a file has on the disk, whatever its language."""
    if workspace.files[path].origin is None:
        return workspace.with_file(path, text)
    after = file_of(path, text)
    return workspace.with_file(path, after.text, after.origin)


def file_of(path: str, text: str) -> File:
    """The file for a path and its text; XML is imported without changing it, whatever its version.

    XML is what is called .xml, and what begins with `<` under an unknown suffix: some projects call trees for Groot
    .tree or .bt.
    """
    if path.endswith(SUFFIXES) or not (path.endswith(".xml") or text.lstrip().startswith("<")):
        return File(path, text)
    from btq_lang.btcpp.importing import import_xml  # needs lxml, which most missions do without

    done = import_xml(text, keep_v3=True, for_people=False)
    return File(path, done.text, Origin(text, done.places, done.diagnostics, done.is_complete, done.defines))
