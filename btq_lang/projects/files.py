"""The files of a command line, in their projects, cached until they change."""

from __future__ import annotations

import os.path
import sys
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from glob import glob
from typing import TYPE_CHECKING

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.name_kinds import Kind
from btq_lang.util.record import Record, replace
from btq_lang.workspace.file import SUFFIXES, XML_SUFFIXES, File, is_xml
from btq_lang.workspace.loader import (
    FoundProject,
    LoadProblem,
    absolute,
    collect,
    decoded,
    excluder,
    find_project,
    load,
    pool_of,
    read,
)
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.diagnostics.model import Diagnostic
    from btq_lang.projects.cpp_files import CppFiles, ProjectSources
    from btq_lang.projects.external_files import ExternalFiles
    from btq_lang.projects.nav2_factory import ParameterFile
    from btq_lang.projects.xml_below import XmlBelow
    from btq_lang.workspace.config import Project
    from btq_lang.workspace.factories import Factory

STDIN = "-"


class FileGroup(Record):
    """The files of one project.

    Attributes:
        workspace: those files, and what they include.
        given: the requested paths in `workspace`, those that could be read.
        damaged: the paths of files that are not UTF-8 and are never written back.
        absent: the paths of missing includes.
        project_file: from which the project was read, if any.
        pooled: the paths in `workspace` of files that define what requested XML lacks, and are not checked with it.
        cpp: the paths in `workspace` of C++ sources below requested folders.
    """

    workspace: Workspace
    given: tuple[str, ...]
    damaged: tuple[str, ...]
    absent: tuple[str, ...]
    project_file: str | None
    pooled: frozenset[str] = frozenset()
    cpp: tuple[str, ...] = ()

    @property
    def project(self) -> Project:
        """The project of the files."""
        return self.workspace.project

    @property
    def watched(self) -> Iterator[str]:
        """The files that another run would depend on."""
        return (
            path for path in (*self.workspace.files, *self.absent, *self.project.imports, self.project_file) if path
        )


def usage_problem(paths: Sequence[str], is_watching: bool = False) -> str | None:
    """The usage error in the paths of a command line, without accessing the disk."""
    if is_watching and STDIN in paths:
        return "--watch cannot watch standard input"
    return "empty path; `.` is this folder" if "" in paths else None


def logs_of(project: Project) -> Sequence[str]:
    """The paths that the project's patterns of logs match; a pattern that matches none is kept, to be reported."""
    paths: list[str] = []
    for pattern in project.evidence.logs if project.evidence is not None else ():
        path = os.path.join(project.root, pattern)
        paths += sorted(glob(path, recursive=True)) or [path]
    return paths


def no_mission_below(paths: Iterable[str], groups: Iterable[FileGroup], missing: str = "no .btq file") -> str | None:
    """The message if folders were requested and none contains a mission."""
    folders = [path.rstrip("/") + "/" for path in paths if os.path.isdir(path)]
    if not folders or any(group.given for group in groups):
        return None
    return f"{missing} below {', '.join(folders)}"


def write_stdout(text: str) -> None:
    """Print a file verbatim: standard output would translate line ends on some systems."""
    sys.stdout.flush()
    sys.stdout.buffer.write(text.encode())


class Files:
    """A cache of files; it parses again only what has changed.

    Attributes:
        overlay: texts that replace files on the disk, by path: standard input, an editor's buffers.
        stdin: the path assigned to standard input, once it was read.
        folders: the bases of paths that are shown: the current folder, or an editor's folders.
        nav2_params: more parameter files of Nav2 than those that projects name.
        project_files: those whose mistakes are requested, and not only reported with their missions.
        parameter_files: all parameter files that were read for the last request.
    """

    def __init__(self) -> None:
        self.nav2_params: tuple[str, ...] = ()
        self.project_files: tuple[str, ...] = ()
        self.parameter_files: list[ParameterFile] = []
        self.overlay: dict[str, str] = {}
        self.stdin: str | None = None
        self._stdin_problem: LoadProblem | None = None
        self.folders: tuple[str, ...] = (absolute("."),)
        self._parsed: dict[str, File] = {}
        self._external: ExternalFiles | None = None
        self._sources: dict[str, ProjectSources] = {}  # the C++ of the last request, by the path of the project file

    def groups(
        self,
        paths: Iterable[str],
        stdin_filename: str | None = None,
        *,
        with_xml: bool = False,
        for_checks: bool = False,
    ) -> tuple[tuple[FileGroup, ...], tuple[LoadProblem, ...]]:
        """The files that paths denote, by project and factory, and read errors.

        Each file belongs to the nearest project file above it, whatever the current folder, and to the factories that
        register it.

        Args:
            with_xml: below folders, the engine's XML counts too, and not only this language.
            for_checks: look at a file in each of its factories, and not only in the first, and add the files of the
                project that define what requested XML lacks.
        """
        paths = tuple(paths)
        self.parameter_files.clear()
        self._sources.clear()
        projects = _Projects(self.overlay, self._with_imports)
        absolute_paths = (self._read_stdin(stdin_filename) if path == STDIN else absolute(path) for path in paths)
        requested = self._requested(absolute_paths, projects, with_xml)
        folders = [f"{path.rstrip('/')}/" for path in map(absolute, paths) if os.path.isdir(path)]
        groups: list[FileGroup] = []
        by_file = projects.by_file()
        for project_file, tops in requested.items():
            home = FoundProject(by_file[project_file], project_file or None)
            of_project, problems = self._groups_of(tops, home, projects.of, for_checks)
            groups += (_with_cpp(group, folders) for group in of_project)
            projects.problems += problems
            if for_checks and home.project.simulation is not None:
                projects.problems += self._simulation_problems(home, of_project, folders)
        for path in (*self.nav2_params, *self.project_files):
            projects.govern(path)
        for project_file, home in projects.governing.items():
            if project_file not in requested:  # no tree of it is checked, but its parameters of Nav2 may be
                projects.problems += self._declared(home)[1]
        return tuple(groups), tuple(dict.fromkeys(projects.problems))

    def _requested(self, paths: Iterable[str], projects: _Projects, with_xml: bool) -> dict[str, dict[str, str]]:
        """The files that absolute paths denote, by project file, each with the folder in which it was requested."""
        requested: dict[str, dict[str, str]] = {}
        suffixes = (*SUFFIXES, *XML_SUFFIXES) if with_xml else SUFFIXES
        for path in paths:
            if path == self.stdin and self._stdin_problem is not None:
                projects.problems += [self._stdin_problem] if self._stdin_problem not in projects.problems else []
                if path not in self.overlay:
                    continue
            if path in self.overlay:
                requested.setdefault(projects.govern(path).path or "", {})[path] = os.path.dirname(path)
                continue
            files, unreachable = collect([path], projects.govern(path).project, suffixes)
            if with_xml and files != (path,):
                files = self._missions(path, files)
            projects.problems += unreachable
            for file in files:
                home = projects.govern(file)
                if file == path or not excluder(home.project)(file):
                    top = path if file != path else os.path.dirname(path)
                    requested.setdefault(home.path or "", {})[file] = top
        return requested

    def _groups_of(
        self, tops: Mapping[str, str], home: FoundProject, project_of: Callable[[str], FoundProject], for_checks: bool
    ) -> tuple[list[FileGroup], list[LoadProblem]]:
        """The requested files of one project, by factory; `tops`: each with the folder in which it was requested."""
        factories, problems = self._declared(home)
        groot: tuple[Factory, ...] = ()
        pools: dict[str, tuple[str, ...]] = {}
        if for_checks and (xml := {path: top for path, top in tops.items() if self._may_be_xml(path)}):
            from btq_lang.projects.factory_files import groot_projects  # many projects have no XML

            pools = self._pools(xml, home)
            of_factories = {path for factory in factories for path in factory.files}
            groot = tuple(groot_projects(pools.values(), xml.keys() - of_factories))
        group, unreadable = self._load(tuple(tops), home, factories + groot)
        problems += unreadable
        empty = [factory for factory in factories if not factory.files]
        problems += [LoadProblem(home.path or "", f"the factory `{factory.name}` loads no file") for factory in empty]
        groups: list[FileGroup] = []
        for some_factories in (factories, groot):  # those of the project file come first
            groups += _by_factory(group, some_factories, for_checks)
            registered = {path for each in groups for path in each.given}
            group = replace(group, given=tuple(path for path in group.given if path not in registered))
        if group.given or not groups:
            has_xml = any(group.workspace.files[path].is_foreign for path in group.given)
            if pools and has_xml:
                group = _with_created(self._with_pools(group, pools, project_of), tuple(pools))
            groups.append(group)
        return groups, problems

    def _simulation_problems(
        self, home: FoundProject, groups: Iterable[FileGroup], folders: Iterable[str]
    ) -> list[LoadProblem]:
        """What is wrong with the names in `[simulate]` of a project; `folders`: those that were requested."""
        from btq_lang.projects.simulated_names import at_their_keys, checked_names  # few projects simulate runs

        settings = home.project.simulation
        assert settings is not None, "the caller has looked"
        checked = checked_names(settings, [(group.workspace, group.given) for group in groups])
        if checked.unknown and not f"{home.project.root.rstrip('/')}/".startswith(tuple(folders)):
            parameter_files = [*self.parameter_files]
            projects = _Projects(self.overlay, self._with_imports)
            tops = self._requested([home.project.root], projects, with_xml=True).get(home.path or "", {})
            all_groups, _ = self._groups_of(tops, home, projects.of, True)
            checked = checked_names(settings, [(group.workspace, group.given) for group in all_groups])
            self.parameter_files[:] = parameter_files
        return at_their_keys(home, (*checked.problems, *checked.unknown), self.overlay)

    def _may_be_xml(self, path: str) -> bool:
        text = self.overlay.get(path)
        return not path.endswith(SUFFIXES) if text is None else is_xml(path, text)

    def _pools(self, tops: Mapping[str, str], home: FoundProject) -> dict[str, tuple[str, ...]]:
        """The pools of XML files, each with all files in it that may be missions."""
        folders = {(os.path.dirname(path), top) for path, top in tops.items()}
        pools = {home.project.root} if home.path else {pool_of(*folder) for folder in folders}
        suffixes = (*SUFFIXES, *XML_SUFFIXES)
        return {pool: collect([pool], home.project, suffixes)[0] for pool in sorted(pools)}

    def _declared(self, home: FoundProject) -> tuple[tuple[Factory, ...], list[LoadProblem]]:
        """The factories of a project with their files and C++ sources."""
        factories, problems = self._factories(home)
        if home.project.cpp or any(factory.cpp_files for factory in factories):
            sources = self._sources[home.path or ""] = self.cpp.read(home, factories)
            factories = tuple(map(sources.declared_in, factories))
            problems += sources.problems
        return factories, problems

    def _factories(self, home: FoundProject) -> tuple[tuple[Factory, ...], list[LoadProblem]]:
        """The factories of a project with their files."""
        if not home.project.factories and not self.nav2_params:
            return (), []
        from btq_lang.projects.factory_files import resolved  # few projects have any

        factories: list[Factory] = []
        problems: list[LoadProblem] = []
        goals: tuple[tuple[str, Diagnostic], ...] = ()
        named = (*home.project.factories, *self._requested_factories(home))
        with_files = [resolved(factory, home.project.root, self.xml) for factory in named]
        others = tuple(factory for factory in with_files if not factory.nav2)
        for factory in with_files:
            if not factory.nav2:
                factories.append(factory)
                continue
            from btq_lang.projects.nav2_factory import ParameterSources, parameter_file  # few projects are for Nav2

            senders = others if len(others) == len(with_files) - 1 else ()  # to which of several robots is unknown
            of_factory = partial(self.workspace_of, home=home)
            sources = ParameterSources(self.overlay.get, self.xml.source_of, of_factory, senders)
            file, problem = parameter_file(factory, home.project, home.path, sources)
            if problem is not None and file is None and home.path is not None:
                problem = LoadProblem(home.path, f"`{factory.nav2}` {problem.message}")  # where editors show it
            problems += [problem] if problem is not None else []
            if file is not None:
                self.parameter_files.append(file)
                factories += file.distinct
                goals = file.goals if senders else ()
        return tuple(replace(factory, goals=factory.goals or goals) for factory in factories), problems

    def _requested_factories(self, home: FoundProject) -> Iterator[Factory]:
        """A factory for each requested parameter file that the project does not name."""
        from btq_lang.workspace.factories import Factory  # few projects have any

        root = home.project.root
        named = {absolute(os.path.join(root, factory.nav2)) for factory in home.project.factories if factory.nav2}
        for path in self.nav2_params:
            if path not in named:
                yield Factory(os.path.basename(path), nav2=path)

    def workspace_of(self, factory: Factory, home: FoundProject) -> Workspace:
        """The workspace of all files of a factory, requested or not."""
        sources = self._sources.get(home.path or "")
        whole = sources.declared_in(factory) if sources is not None else factory
        return self._load((), home, (whole,))[0].workspace.of_factory(whole)

    def workspace_of_nodes(self, home: FoundProject) -> Workspace:
        """The workspace of the nodes that a project of the last request declares, without missions."""
        return self._load((), home, ())[0].workspace

    def _with_pools(
        self, group: FileGroup, pools: Mapping[str, tuple[str, ...]], project_of: Callable[[str], FoundProject]
    ) -> FileGroup:
        """The group with the files of its pools that define what its XML lacks."""
        workspace = group.workspace
        project = replace(workspace.project, pools=tuple(pools))
        lacking = lacking_names(workspace, group.given)
        files = dict(workspace.files)
        for pool, paths in pools.items() if lacking else ():
            others = tuple(path for path in paths if path not in files and project_of(path).path == group.project_file)
            for path in self._missions(pool, others):
                if self.xml.may_define(path, lacking):
                    text = self.overlay[path] if path in self.overlay else read(path)[0]
                    files.update({path: self._file(path, text)} if text is not None else {})
        pooled = frozenset(files.keys() - workspace.files.keys())
        return replace(group, workspace=Workspace(files, project), pooled=pooled)

    @cached_property
    def xml(self) -> XmlBelow:
        """The XML below folders."""
        from btq_lang.projects.xml_below import XmlBelow  # many projects have no XML

        return XmlBelow()

    @cached_property
    def cpp(self) -> CppFiles:
        """The C++ sources."""
        from btq_lang.projects.cpp_files import CppFiles  # few projects name any

        return CppFiles()

    def _with_imports(self, home: FoundProject) -> FoundProject:
        """A project with the requirements that it imports."""
        if not home.project.imports:
            return home
        from btq_lang.projects.external_files import ExternalFiles  # few projects import any

        self._external = self._external or ExternalFiles(self.overlay)
        return self._external.read(home)

    def _missions(self, folder: str, paths: tuple[str, ...]) -> tuple[str, ...]:
        """Those of a folder's files that are missions."""
        return paths if all(path.endswith(SUFFIXES) for path in paths) else self.xml.missions(folder, paths)

    def know(self, files: Iterable[File]) -> None:
        """Reuse files parsed elsewhere, while their texts are the same."""
        self._parsed.update({file.path: file for file in files})

    def _read_stdin(self, filename: str | None) -> str:
        if self.stdin is None:
            self.stdin = absolute(filename or "<stdin>")
            text, self._stdin_problem = decoded(self.stdin, sys.stdin.buffer.read())
            if text is not None:
                self.overlay[self.stdin] = text
        return self.stdin

    def _load(
        self, paths: tuple[str, ...], home: FoundProject, factories: Iterable[Factory]
    ) -> tuple[FileGroup, list[LoadProblem]]:
        """The requested files of a project, with those of its factories and all that they include."""
        sources = self._sources.get(home.path or "")
        project, cpp = (home.project, {}) if sources is None else (sources.project, sources.files)

        def includes_of(path: str, text: str) -> Iterator[str]:
            return (include for include, _ in self._file(path, text).included_paths)

        registered = (path for factory in factories for path in (*factory.files, *factory.node_files))
        named = dict.fromkeys((*paths, *registered, *project.node_files))
        wanted = tuple(path for path in named if path not in cpp)
        texts = {path: self.overlay[path] for path in wanted if path in self.overlay}
        loaded = load((path for path in wanted if path not in texts), project, includes_of, texts, self.overlay)
        files = {path: self._file(path, text) for path, text in loaded.texts.items()}
        given = tuple(path for path in paths if path in files)
        files.update(cpp)
        damaged = loaded.damaged
        if self._stdin_problem is not None:
            damaged += tuple(path for path in given if path == self.stdin)
        project = replace(project, folders=self.folders)
        group = FileGroup(Workspace(files, project), given, damaged, loaded.absent, home.path)
        return group, list(loaded.problems)

    def _file(self, path: str, text: str) -> File:
        file = self._parsed.get(path)
        if file is None or file.source != text:
            file = self._parsed[path] = file_of(path, text)
        return file


class _Projects:
    """The projects of what is requested.

    Attributes:
        governing: those that must be right, by their files; others may be of no concern.
        problems: their mistakes, and others of the request, in order.
    """

    def __init__(self, overlay: Mapping[str, str], completed: Callable[[FoundProject], FoundProject]) -> None:
        self._overlay = overlay
        self._completed = completed
        self._of_folder: dict[str, FoundProject] = {}
        self.governing: dict[str, FoundProject] = {}
        self.problems: list[LoadProblem] = []

    def of(self, path: str) -> FoundProject:
        """The project of a file or folder."""
        folder = path if os.path.isdir(path) else os.path.dirname(path)
        if folder not in self._of_folder:
            self._of_folder[folder] = self._completed(find_project(folder, self._overlay))
        return self._of_folder[folder]

    def govern(self, path: str) -> FoundProject:
        """The project of something that is requested, so that its mistakes count."""
        home = self.of(path)
        self.governing[home.path or ""] = home
        self.problems.extend(home.problems)
        return home

    def by_file(self) -> dict[str, Project]:
        """All projects found so far, by their files."""
        return {home.path or "": home.project for home in self._of_folder.values()}


def _by_factory(group: FileGroup, factories: Iterable[Factory], in_each: bool) -> Iterator[FileGroup]:
    """The requested files of a project that its factories register, a group for each factory that has any; a file that
    several register belongs to the first, or `in_each` to each.

    A file of scenarios runs what it includes, so it belongs to the factory of that, except `in_each`.
    """
    taken: set[str] = set()
    whole = group.workspace
    for factory in factories:
        workspace = whole.of_factory(factory)
        registered = workspace.registered
        runs = [path for path in group.given if not in_each and _runs_any(whole, path, registered)]
        given = tuple(path for path in group.given if (path in registered or path in runs) and path not in taken)
        if given:
            if runs:
                workspace = whole.of_factory(replace(factory, files=(*factory.files, *runs)))
            yield replace(group, workspace=workspace, given=given)
            taken.update(() if in_each else given)


def _runs_any(workspace: Workspace, path: str, registered: Container[str]) -> bool:
    """Whether a file has only scenarios and includes one of some files."""
    is_outside = path not in registered and workspace.files[path].has_only_scenarios
    return is_outside and any(each in registered for each in workspace.closure(path))


def _with_cpp(group: FileGroup, folders: Iterable[str]) -> FileGroup:
    """The group with its C++ sources below some folders."""
    files = group.workspace.files
    cpp = tuple(path for path in files if files[path].is_cpp and path.startswith(tuple(folders)))
    return replace(group, cpp=cpp) if cpp else group


def _with_created(group: FileGroup, pools: tuple[str, ...]) -> FileGroup:
    """The group with the main trees that programs of its pools create."""
    if all(len(group.workspace.files[path].names.by_kind[Kind.TREE]) < 2 for path in group.given):
        return group
    from btq_lang.projects.created_trees import with_created_trees  # most files have one tree

    return replace(group, workspace=with_created_trees(group.workspace, group.given, pools))


def lacking_names(workspace: Workspace, paths: Iterable[str]) -> frozenset[str]:
    """The trees and nodes that XML files and their includes lack."""
    from btq_lang.catalog.nodes import BUILTINS  # a large table, and many projects have no XML

    names: set[str] = set()
    for path in paths:
        scope, file = workspace.scope(path), workspace.files[path]
        for kind in (Kind.TREE, Kind.MODEL) if file.is_foreign else ():
            names.update(name for name in file.names_used(kind) if not scope.defines(kind, name))
    return frozenset(names.difference(BUILTINS))
