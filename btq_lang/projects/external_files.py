"""The files of requirements that projects import, read again only when they change."""

from __future__ import annotations

from collections.abc import Mapping

from btq_lang.requirements.external import read_external
from btq_lang.requirements.external.fields import ImportProblem
from btq_lang.util.record import replace
from btq_lang.util.text import Position
from btq_lang.util.toml_places import find_key
from btq_lang.workspace.config import keys_above
from btq_lang.workspace.external_requirements import ExternalRequirement, ExternalRequirements
from btq_lang.workspace.loader import FoundProject, LoadProblem, read, stamp


class ExternalFiles:
    """A cache of requirements by their files; `overlay`: texts that replace those on the disk, by path."""

    def __init__(self, overlay: Mapping[str, str]) -> None:
        self._overlay = overlay
        self._stamps: dict[str, object] = {}
        self._results: dict[str, tuple[list[ExternalRequirement], str]] = {}

    def read(self, home: FoundProject) -> FoundProject:
        """A project with the requirements of its files, and with the problems of these at the places where it names
        them."""
        problems: list[LoadProblem] = []
        requirements: list[ExternalRequirement] = []
        names = home.project.requirements.imports if home.project.requirements is not None else ()
        for name, path in zip(names, home.project.imports, strict=True):
            of_file, problem = self._requirements(name, path)
            requirements += of_file
            if problem and home.path is not None:
                problems.append(LoadProblem(home.path, problem, self._place(home.path, name)))
        project = replace(home.project, external_requirements=ExternalRequirements(requirements, not problems))
        return replace(home, project=project, problems=(*home.problems, *problems))

    def _requirements(self, name: str, path: str) -> tuple[list[ExternalRequirement], str]:
        """The requirements of a file, and what is wrong with it."""
        if path not in self._results or self._stamps[path] != stamp(path):
            self._stamps[path] = stamp(path)
            self._results[path] = _read(name, path)
        return self._results[path]

    def _place(self, project_file: str, name: str) -> Position | None:
        text = self._overlay.get(project_file) or read(project_file)[0] or ""
        return find_key(text, (*keys_above(project_file), "requirements", "import"), name)


def _read(name: str, path: str) -> tuple[list[ExternalRequirement], str]:
    text, problem = read(path)
    if text is None or problem is not None:
        return [], f"`{name}`: {problem.message}" if problem is not None else ""
    try:
        return read_external(path, text), ""
    except ImportProblem as error:
        return [], f"`{name}:{error.line}:{error.column}`: {error.message}"
