"""A session: the open files of an editor, in the workspaces of its folders.

One invariant: open texts override files on the disk; and every workspace equals one read from scratch.  An edit derives
a new workspace from the old one; only changes that may add or remove files read the disk again.  The protocol is
unknown here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Set
from time import perf_counter
from typing import TYPE_CHECKING, Final
from weakref import ReferenceType, ref

from btq_lang.btcpp.opening import file_of
from btq_lang.btcpp.recognition import is_mission
from btq_lang.btcpp.side_file import side_path
from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import check, findings, forget, keep, let_go
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import RULES
from btq_lang.projects.files import Files, lacking_names
from btq_lang.util.globs import path_matcher
from btq_lang.util.record import replace
from btq_lang.util.text import LineIndex
from btq_lang.workspace.config import SEVERITIES, Project
from btq_lang.workspace.external_requirements import IMPORTED_SUFFIXES
from btq_lang.workspace.factories import merged
from btq_lang.workspace.file import CPP_SUFFIXES, SIDE_SUFFIX, SUFFIXES, YAML_SUFFIXES, File
from btq_lang.workspace.findings import FileFindings, Reported
from btq_lang.workspace.inputs import advance
from btq_lang.workspace.item_index import Name
from btq_lang.workspace.loader import LoadProblem, find_project, is_project_file, read, stamp, work_in
from btq_lang.workspace.overrides import Override, Severities
from btq_lang.workspace.queries import Cancelled
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.ide.verdicts import ProjectVerdicts

_ENDINGS: Final = (*SUFFIXES, ".xml", "/btq.toml", "/pyproject.toml")  # of missions and project files


class Session:
    """The state of a server: folders, open texts, workspaces, and the diagnostics that were found in them.

    Attributes:
        folders: the editor's folders; empty if single files are open.
        open: the texts of open files, by path.
        settings: what the editor's user has set.
        projects: the project files that are open or have problems: their texts and problems.
        parameters: the parameter files of Nav2 that projects name: their findings, as of the last reload, and the files
            that these refer to.
        check_seconds: the duration of the last check of an open file, by path.
    """

    # How names of files end that may matter; those of side files end in .json.
    watched: Final = (*_ENDINGS, *IMPORTED_SUFFIXES, *YAML_SUFFIXES, *CPP_SUFFIXES)

    def __init__(self) -> None:
        self.folders: tuple[str, ...] = ()
        self.settings: dict[str, object] = {}
        self.open: dict[str, str] = {}
        self.projects: dict[str, tuple[str, tuple[LoadProblem, ...]]] = {}
        self.parameters: dict[str, tuple[Workspace, FileFindings]] = {}
        self.check_seconds: dict[str, float] = {}
        self._interrupted_seconds: dict[str, float] = {}  # of the pieces of a check that has not ended
        self._evidence: dict[str, ProjectVerdicts] = {}  # by the folder of the project
        self._files = Files()
        self._files.overlay = self.open
        self._read_for: tuple[tuple[str, ...], dict[str, object]] | None = None  # which folders and settings
        self._workspaces: list[Workspace] = []  # their caches are for open files
        self._home: dict[str, int] = {}
        self._pooled: frozenset[str] = frozenset()  # files that only define what open XML lacks
        # With answers for what open XML included or lacked before a key has made it unreadable.
        self._aside: list[Workspace] = []
        # Weak: a file's findings must not keep an old workspace alive until its next check.
        self._checked: dict[str, tuple[tuple[ReferenceType[Workspace], ...], FileFindings]] = {}

    # ---- what changes ----

    def work_in(self, folders: tuple[str, ...]) -> None:
        """Set the editor's folders; paths are shown relative to the first."""
        self.folders = folders
        work_in(folders[0] if folders else "")

    def configure(self, settings: object) -> None:
        """Set what the editor's user has set, if it is a table."""
        if isinstance(settings, dict):
            self.settings = {str(name): value for name, value in settings.items()}

    def edit(self, path: str, text: str) -> tuple[str, ...]:
        """Change the text of an open file; returns the files to check again, the most important first."""
        is_new = path not in self.open
        self.open[path] = text
        home = self._home.get(path)
        if home is None:
            return (path, *self.reload())
        before = self._workspaces[home]
        old = before.files[path]
        if old.source == text and (not old.is_foreign or not is_new):  # opened, and equal to the file on the disk
            return (path,)
        new = file_of(path, text)
        if (is_new and new.is_foreign) or not _is_xml_alike(old, new):
            return (path, *self.reload())  # open XML has a pool, in which it finds what it lacks
        is_pool_same = True
        for index, workspace in enumerate(self._workspaces):
            if path in workspace.files:
                self._workspaces[index] = workspace.with_read(new)
                advance(workspace, self._workspaces[index])
                lacking = [_lacking(each, self.open) for each in (workspace, self._workspaces[index])]
                is_pool_same = is_pool_same and lacking[0] == lacking[1]
        after = self._workspaces[home]
        if old.inclusion != after.files[path].inclusion or not is_pool_same:
            return (path, *self.reload())
        linked: set[str] = set()  # uses are known in both directions
        for other in self._workspaces:
            if path in other.files:
                looking = {*other.xml} - self._pooled if other.project.pools else ()  # for what it lacks
                linked.update(other.linked(path, *looking))
        if renamed := old.defined_names ^ after.files[path].defined_names:
            linked.update(other for other in after.files if other != path and _lacks_definition(after, other, renamed))
        return path, *sorted(linked - {path}, key=lambda other: (other not in self.open, other))

    def close(self, path: str) -> tuple[str, ...]:
        """Close a file: the one on the disk counts again."""
        text = self.open.pop(path, None)
        is_xml = path in self._home and self._workspaces[self._home[path]].files[path].is_foreign
        for workspace in self.workspaces_of(path):
            forget(workspace, path)
        self.check_seconds.pop(path, None)
        self._interrupted_seconds.pop(path, None)
        self._checked.pop(path, None)  # its offsets count from items that are no longer kept
        is_of_folder = any(path.startswith(f"{folder}/") for folder in self.folders)
        if is_of_folder and not is_xml and text is not None and read(path)[0] == text:
            return (path,)
        return self.reload()

    def reload(self) -> tuple[str, ...]:
        """Read folders and projects again; returns all files."""
        self._read_for = self.folders, {**self.settings}
        self._files.folders = self.folders
        self._files.know(workspace.files[path] for path in self.open if (workspace := self.workspace_of(path)))
        severities = self._severities()
        missions = (path for path in self.open if not is_project_file(path) and not path.endswith(YAML_SUFFIXES))
        groups, problems = self._files.groups((*self.folders, *missions), for_checks=True)
        self._read_projects(problems)
        self._read_parameters(severities)
        before = {(workspace.factory, *workspace.files): workspace for workspace in (*self._aside, *self._workspaces)}
        self._workspaces = []
        self._home = {}
        self._pooled = frozenset().union(*(group.pooled for group in groups))
        registered: set[str] = set()
        for index, group in enumerate(groups):
            workspace = group.workspace
            if severities:
                workspace = workspace.with_project(_with_severities(workspace.project, severities))
            predecessor = before.pop((workspace.factory, *workspace.files), None)
            if predecessor is not None and predecessor is not workspace:
                advance(predecessor, workspace)
            self._workspaces.append(workspace)
            for path in workspace.files:
                own_paths = workspace.registered or group.given
                if path in own_paths and path not in registered:
                    registered.add(path)
                    self._home[path] = index
                self._home.setdefault(path, index)
        unread = [path for path in self.open if (home := self.workspace_of(path)) and home.files[path].last_read]
        self._aside = [workspace for workspace in before.values() if not workspace.files.keys().isdisjoint(unread)]
        return self.paths()

    def _read_projects(self, problems: Iterable[LoadProblem]) -> None:
        """Store the problems of project files, those of missions and open ones."""
        homes = {path: find_project(path, self.open) for path in self.open if is_project_file(path)}
        of_open = [problem for home in homes.values() for problem in home.problems]
        by_path: dict[str, dict[LoadProblem, None]] = {path: {} for path in homes}
        for problem in (*problems, *of_open):
            if is_project_file(problem.path):
                by_path.setdefault(problem.path, {})[problem] = None
        texts = {path: self.open[path] if path in self.open else read(path)[0] or "" for path in by_path}
        self.projects = {path: (texts[path], tuple(of_file)) for path, of_file in by_path.items()}

    def _read_parameters(self, severities: Severities) -> None:
        """Store the findings in parameter files."""
        self.parameters = {}
        if not self._files.parameter_files:
            return
        from btq_lang.projects.nav2_check import nav2_findings  # few projects are for Nav2

        files = self._files.parameter_files
        all_findings, texts = nav2_findings(
            files, self._files, (), lambda project: _with_severities(project, severities)
        )
        workspace = Workspace.of(texts)
        for file in files:
            placed = (finding.diagnostic for finding in all_findings if finding.path == file.path)
            self.parameters[file.path] = workspace, FileFindings.placed(placed)

    def with_code_of_nav2(self, workspace: Workspace) -> Workspace:
        """A workspace with the C++ of Nav2's nodes, if it is on this machine."""
        from btq_lang.projects.cpp_files import with_code_of_nav2  # few editors ask for it

        return with_code_of_nav2(workspace, self._files.cpp)

    @property
    def has_read(self) -> bool:
        """Whether the folders were read with the current settings."""
        return self._read_for == (self.folders, self.settings)

    def _severities(self) -> Severities:
        """The severities set by the user, which override those of the project."""
        rules = self.settings.get("rules")
        words = {name: str(word) for name, word in rules.items() if name in RULES} if isinstance(rules, dict) else {}
        return tuple((name, SEVERITIES[word]) for name, word in words.items() if word in SEVERITIES)

    def let_go(self) -> None:
        """Release what edits have replaced and, if they take much memory, the trees of files that are not worked in:
        they are most of the memory of a large folder, and few are needed again.  After a request about all files there
        are many, so only a few are released each time, to stay responsive.
        """
        for workspace in self._workspaces:
            let_go(workspace)
        if any(home.files[path].last_read for path in self.open if (home := self.workspace_of(path))):
            return  # what such a file looked up in others counts again when it can be read
        active = self._active_files()
        for workspace in self.workspaces():
            held = [path for path, file in workspace.files.items() if file.is_parsed]
            idle = [path for path in held if path not in active]
            if sum([len(workspace.files[path].text) for path in idle]) > _MOST_IDLE:
                for other in self.workspaces():  # each of these keeps the replaced objects alive
                    other.let_go(idle[:_AT_ONCE])

    def _active_files(self) -> set[str]:
        """The open files, those linked with them, and those in which linked XML finds what it lacks, in any workspace:
        workspaces may share files.
        """
        active: set[str] = set()
        for workspace in self.workspaces():
            missions = {workspace.missions.get(path) for path in self.open} - {None}
            linked = [path for path, mission in workspace.missions.items() if mission in missions]
            active.update(linked)
            for name in _lacking(workspace, linked):
                for kind in (Kind.TREE, Kind.MODEL):
                    active.update(workspace.files_defining(kind, name))
        return active

    # ---- queries ----

    def lines(self, path: str) -> LineIndex:
        """The line index of an open file."""
        workspace = self.workspace_of(path)
        return workspace.files[path].source_lines if workspace is not None else LineIndex(self.open.get(path, ""))

    def workspace_of(self, path: str) -> Workspace | None:
        """The workspace of a file; None for an unknown file, such as one that was closed meanwhile."""
        home = self._home.get(path)
        return None if home is None else self._workspaces[home]

    def workspaces_of(self, path: str) -> tuple[Workspace, ...]:
        """The workspaces in which a file is looked at: those of its factories, or its only one, as for C++."""
        home = self.workspace_of(path)
        if home is None or home.factory is None or home.files[path].is_cpp:
            return () if home is None else (home,)
        return tuple(workspace for workspace in self._workspaces if path in workspace.registered)

    def knows(self, path: str) -> bool:
        """Whether a path is that of a mission, a project file or a C++ source that is reported on."""
        workspace = self.workspace_of(path)
        if workspace is None or path in self._pooled:
            return path in self.projects or path in self.parameters
        file = workspace.files[path]
        is_used = path in workspace.included_files or path in workspace.registered
        return not file.is_foreign or file.is_cpp or is_used or is_mission(file.source)

    def workspaces(self) -> tuple[Workspace, ...]:
        return tuple(self._workspaces)

    def paths(self) -> tuple[str, ...]:
        """All known files that are reported on, open ones first."""
        reported = {*(self._home.keys() - self._pooled), *self.projects, *self.parameters}
        return tuple(sorted(reported, key=lambda path: (path not in self.open, path)))

    def unsent(self) -> tuple[str, ...]:
        """The files that are reported on and that an editor does not send: of projects, parameters, and C++ sources."""
        cpp = (path for path, home in self._home.items() if self._workspaces[home].files[path].is_cpp)
        return (*self.projects, *self.parameters, *cpp)

    def concerns(self, changed: Set[str]) -> bool:
        """Whether changes on the disk may matter: most deleted files and folders do not, nor does most C++."""
        if any(path.endswith(_ENDINGS) for path in changed) or not changed.isdisjoint(self.places()):
            return True
        cpp = [path for path in changed if path.endswith(CPP_SUFFIXES)]  # that a project may name: it may be new
        projects = [workspace.project for workspace in self._workspaces] if cpp else ()
        return any(any(map(path_matcher(project.cpp_patterns, project.root), cpp)) for project in projects)

    def is_side_file(self, path: str) -> bool:
        """Whether a path is that of a side file, on which only lenses and hovers depend."""
        return path.endswith(SIDE_SUFFIX)

    def is_cpp(self, path: str) -> bool:
        """Whether a file is C++, which counts as it is on the disk: it is read when it is saved."""
        return path.endswith(CPP_SUFFIXES)

    def places(self) -> set[str]:
        """All known files, also of imported requirements, and all folders above them."""
        places: set[str] = set()
        imports = {path for workspace in self._workspaces for path in workspace.project.imports}
        for place in (*self.paths(), *imports):
            while place not in places:
                places.add(place)
                place = place.rpartition("/")[0]
        return places

    def check(self, path: str, is_cancelled: Callable[[], bool]) -> None:
        """Check an open file.

        Args:
            is_cancelled: whether to end it now; asked before every step.

        Raises:
            Cancelled: it is; results so far are cached.
        """
        stores = [workspace.store for workspace in self.workspaces_of(path)] if path in self.open else []
        for store in stores:
            store.is_cancelled = is_cancelled
        try:
            if stores:
                self.findings(path)
        finally:
            for store in stores:
                store.is_cancelled = lambda: False

    def findings(self, path: str) -> FileFindings:
        """The current findings of a file."""
        workspaces = self.workspaces_of(path)
        if not workspaces:
            return FileFindings([])
        checked = self._checked.get(path)
        if checked is not None and [id(each()) for each in checked[0]] == [*map(id, workspaces)]:
            return checked[1]
        if path in self.open:
            begin = perf_counter() - self._interrupted_seconds.pop(path, 0)
            for workspace in workspaces:
                keep(workspace, path)
            try:
                of_each = [findings(workspace.store, path, self._seen(workspace, path)) for workspace in workspaces]
            except Cancelled:
                self._interrupted_seconds[path] = perf_counter() - begin
                raise
            file_findings = of_each[0]
            if len(of_each) > 1:
                file_findings = self._merged(workspaces, [each.diagnostics for each in of_each])
            self.check_seconds[path] = perf_counter() - begin
        else:  # placed: offsets that count from items would keep these alive
            of_closed = [
                findings(workspace.store, path, seen).diagnostics
                if (seen := self._seen(workspace, path))
                else check(workspace, path)
                for workspace in workspaces
            ]
            file_findings = self._merged(workspaces, of_closed)
        self._checked[path] = tuple(map(ref, workspaces)), file_findings
        return file_findings

    def _seen(self, workspace: Workspace, path: str) -> tuple[Reported, ...]:
        """Findings about the requirements at the nodes of a file, by logs."""
        evidence = self.evidence(workspace)
        if evidence is None:
            return ()
        from btq_lang.ide.verdicts import verdict_findings  # few projects have logs

        return verdict_findings(workspace, path, evidence)

    def evidence(self, workspace: Workspace) -> ProjectVerdicts | None:
        """The verdicts on a project's requirements, if it names logs and these have been judged."""
        project = workspace.project
        return self._evidence.get(project.root) if project.evidence is not None and project.evidence.logs else None

    def show(self, root: str, evidence: ProjectVerdicts) -> None:
        """Use these verdicts on the requirements of the project in a folder."""
        self._evidence[root] = evidence
        self._checked.clear()

    def _merged(self, workspaces: Iterable[Workspace], diagnostics: Iterable[tuple[Diagnostic, ...]]) -> FileFindings:
        """The findings in one file, merged from those in each of its factories."""
        of_each = [(workspace.factory, each) for workspace, each in zip(workspaces, diagnostics, strict=True)]
        return FileFindings.placed(merged(of_each))

    def diagnostics(self, path: str) -> tuple[Diagnostic, ...]:
        """The diagnostics of a file, counted from its start."""
        return self.findings(path).diagnostics

    def forget(self, path: str) -> None:
        """Forget a file that no longer exists."""
        self._checked.pop(path, None)

    def side_file(self, path: str) -> str | None:
        """The text of the side file of an XML file, empty if it cannot be read; None if there is none."""
        if not path.endswith(".xml"):
            return None
        side = side_path(path)
        return None if stamp(side) is None else read(side)[0] or ""

    def is_on(self, name: str) -> bool:
        """Whether a setting is on, as all are unless the user switches them off."""
        return self.settings.get(name) is not False


def _with_severities(project: Project, severities: Severities) -> Project:
    """The project with severities that count before its own."""
    if not severities:
        return project
    return replace(project, overrides=(*project.overrides, Override(("*",), severities)))  # for all files, and the last


def _is_xml_alike(old: File, new: File) -> bool:
    """Whether both texts of a file, or neither, look like XML, so that it has a pool."""
    of_each = [file.is_foreign and file.source.lstrip()[:1] for file in (old, new)]
    return of_each[0] == of_each[1]


def _lacking(workspace: Workspace, paths: Iterable[str]) -> frozenset[str]:
    """The names that those of the paths that are XML look up in their pool."""
    xml = workspace.foreign.keys() & paths if workspace.project.pools else ()
    return lacking_names(workspace, xml) if xml else frozenset()


def _lacks_definition(workspace: Workspace, path: str, names: Set[Name]) -> bool:
    """Whether a file uses one of the names without a definition, so that its diagnostics name definitions elsewhere."""
    missed = workspace.files[path].used_names & names
    defined = (workspace.files[each].defined_names for each in workspace.closure(path))
    return bool(missed and missed.difference(*defined))


_MOST_IDLE = 30_000  # characters; each takes about 40 bytes when parsed
_AT_ONCE = 5  # files
