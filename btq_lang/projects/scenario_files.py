"""The scenarios that run requested missions, requested or not."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from btq_lang.projects.files import FileGroup, Files
from btq_lang.util.record import replace
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import collect, matching, read
from btq_lang.workspace.workspace import Workspace


def with_scenario_files(files: Files, groups: Sequence[FileGroup]) -> tuple[FileGroup, ...]:
    """The groups with all files of their projects that have scenarios; without a project file, those of the folders of
    what is given.

    These are in the workspace with all that they include, and are not given.  One that cannot be read is left out, for
    it was not requested.
    """
    return tuple(_with_scenarios(files, group) for group in groups)


def _with_scenarios(files: Files, group: FileGroup) -> FileGroup:
    workspace = group.workspace
    others = [path for path in _around(group) if path not in workspace.files and "scenario" in (read(path)[0] or "")]
    if not others:
        return group
    with_scenarios, _ = files.groups(others)
    more = {path: file for other in with_scenarios for path, file in other.workspace.files.items()}
    return replace(group, workspace=Workspace({**more, **workspace.files}, workspace.project, workspace.factory))


def _around(group: FileGroup) -> Iterator[str]:
    if group.project_file is not None:
        yield from collect([group.project.root], group.project)[0] if group.given else ()
        return
    for folder in dict.fromkeys(map(os.path.dirname, group.given)):
        for suffix in SUFFIXES:
            yield from matching(folder, f"*{suffix}")
