"""The findings of `btq check` in parameter files of Nav2, and in trees because of them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.projects.nav2_factory import ParameterFile, findings_of, in_distribution
from btq_lang.render import Finding
from btq_lang.util.record import replace
from btq_lang.workspace.loader import FoundProject, absolute, excluder, read
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from collections.abc import Callable, Container

    from btq_lang.projects.files import Files
    from btq_lang.projects.options import CheckOptions
    from btq_lang.workspace.config import Project
    from btq_lang.workspace.factories import Factory


def requested(files: Files, options: CheckOptions) -> tuple[ParameterFile, ...]:
    """The parameter files that were named, or that are in a requested folder and not excluded.

    Raises:
        GitTrouble: it is not known what has changed.
    """
    folders = [absolute(path).rstrip("/") + "/" for path in options.paths]

    def is_requested(file: ParameterFile) -> bool:
        if file.path in files.nav2_params:
            return True
        return file.path.startswith(tuple(folders)) and not excluder(file.project)(file.path)

    candidates = [file for file in files.parameter_files if is_requested(file)]
    # Of two with one path, that with the project of trees.
    wanted_files = tuple({file.path: file for file in reversed(candidates)}.values())
    if options.since:
        from btq_lang.projects.since import has_changed

        wanted_files = tuple(
            file for file in wanted_files if has_changed((*file.used, file.project_file or ""), options.since)
        )
    return wanted_files


def nav2_findings(
    parameter_files: Iterable[ParameterFile],
    files: Files,
    checked: Container[str],
    configured: Callable[[Project], Project],
    target: str | None = None,
) -> tuple[list[Finding], dict[str, str]]:
    """The findings in parameter files and in checked trees, and the texts of the files that they name.

    Args:
        checked: the paths of those trees.
        configured: returns a project with what the command line selects.
        target: the distribution that the robot moves to, as a project names its nodes, or another target.
    """
    findings: list[Finding] = []
    texts: dict[str, str] = {}
    for file in parameter_files:
        texts[file.path] = file.text
        home = FoundProject(file.project, file.project_file)

        def workspace_of(factory: Factory, home: FoundProject = home) -> Workspace:
            workspace = files.workspace_of(factory, home)
            texts.update((path, loaded.source) for path, loaded in workspace.files.items())
            return workspace

        file = replace(file, project=configured(file.project))
        moved = None
        if target is not None and target in PACKAGED:
            moved = in_distribution(file, target.removeprefix("nav2-"))
        for path, diagnostic in findings_of(file, workspace_of, moved):
            if path == file.path or path in checked:
                findings.append(Finding(path, texts[path], diagnostic))
                for other in [related.place.path for related in diagnostic.related if related.place.path is not None]:
                    texts[other] = texts.get(other) or read(other)[0] or ""
    return findings, texts
