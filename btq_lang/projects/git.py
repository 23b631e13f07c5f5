"""The texts of a file's revisions in git.  Git runs as a process, here and in `xml_below`.

One invariant: nothing is written, and git reads no external argument as an option.
"""

from __future__ import annotations

import os
import posixpath
import subprocess
from collections.abc import Iterable, Iterator, Mapping
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING, Final

from btq_lang.btcpp.marks import is_built_of, named_beside
from btq_lang.btcpp.opening import file_of
from btq_lang.btcpp.recognition import is_mission
from btq_lang.btcpp.side_file import xml_path
from btq_lang.projects.options import Refused
from btq_lang.util.globs import glob_matcher
from btq_lang.util.record import Record
from btq_lang.workspace.config import Project, include_candidates
from btq_lang.workspace.file import SIDE_SUFFIX, SUFFIXES, File
from btq_lang.workspace.loader import absolute, find_project, read, shown
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.workspace.factories import Factory


class GitTrouble(Refused):
    """Git is missing, or does not know a revision or file."""


class Commit:
    """The files of a commit.

    Attributes:
        id: in git.
        name: as on the command line.
    """

    def __init__(self, root: str, id: str, name: str) -> None:
        self.id: Final = id
        self.name: Final = name
        self._root: Final = root
        self._of_factories: dict[str, tuple[Workspace, ...]] = {}  # results of `_factories`, by the project's root

    def shown(self, path: str) -> str:
        """How messages name a file of the commit."""
        return f"{self.name}:{shown(path)}"

    @cached_property
    def paths(self) -> tuple[str, ...]:
        """All files, sorted."""
        words = _git(self._root, "ls-tree", "-r", "--name-only", "-z", self.id).split("\0")
        return tuple(sorted(_outside(self._root, path) for path in words if path))

    def text(self, path: str) -> str | None:
        """The text of a file; None if there is none."""
        if not self.is_file(path):
            return None
        data = _git_bytes(self._root, "cat-file", "blob", f"{self.id}:{_inside(self._root, path)}")
        return data.decode("utf-8", "replace").removeprefix("\ufeff")

    def is_file(self, path: str) -> bool:
        """Whether the commit has a file."""
        return self._kind(path) == "blob"

    def is_folder(self, path: str) -> bool:
        """Whether the commit has a folder."""
        return self._kind(path) == "tree"

    def _kind(self, path: str) -> str:
        object_ = f"{self.id}:{_inside(self._root, path)}"
        return os.fsdecode(_run(self._root, "cat-file", "-t", object_).stdout).strip()

    def matching(self, folder: str, pattern: str) -> tuple[str, ...]:
        """The files that a pattern below a folder matches, sorted."""
        matcher = glob_matcher((f"{folder}/{pattern}",))
        return tuple(path for path in self.paths if matcher and matcher.fullmatch(path.strip("/")))

    def is_mission(self, path: str) -> bool:
        """Whether an XML file is the engine's."""
        return is_mission(self.text(path) or "")

    def source_of(self, path: str) -> str | None:
        """The mission beside an XML file that was built of it."""
        return next(filter(self.is_file, named_beside(self.text(path) or "", path, SUFFIXES)), None)

    def workspace(self, path: str, texts: dict[str, str] | None = None) -> Workspace | None:
        """A file with all its includes, in the first factory of today's project file that registers it; None if there
        is no such file; `texts`: those that override those of the commit."""
        project = find_project(path).project
        if texts is None:  # else the file is built XML, restored in memory
            of_factory = next(
                (workspace for workspace in self._factories(project) if path in workspace.registered), None
            )
            if of_factory is not None:
                return of_factory
        workspace = self._read((path,), project, texts or {})
        return workspace if path in workspace.files else None

    def _factories(self, project: Project) -> tuple[Workspace, ...]:
        """The workspaces of a project's factories."""
        if project.factories and project.root not in self._of_factories:
            from btq_lang.projects.factory_files import resolved  # few projects have any

            factories: list[Factory] = []
            for factory in project.factories:
                whole = resolved(factory, project.root, self, self.matching)
                factories += self._of_nav2(whole, project) if factory.nav2 else (whole,)
            self._of_factories[project.root] = tuple(self._of_factory(project, factory) for factory in factories)
        return self._of_factories.get(project.root, ())

    def _of_nav2(self, factory: Factory, project: Project) -> Iterator[Factory]:
        """The factories that a parameter file of Nav2 describes, with the files that are in its folders today."""
        from btq_lang.projects.nav2_factory import ParameterSources, parameter_file  # few projects are for Nav2

        sources = ParameterSources(self.text, self.source_of, partial(self._of_factory, project))
        file, _ = parameter_file(factory, project, None, sources)
        yield from file.distinct if file is not None else ()

    def _of_factory(self, project: Project, factory: Factory) -> Workspace:
        return self._read((*factory.files, *factory.node_files), project, {}, factory)

    def _read(
        self, paths: Iterable[str], project: Project, texts: Mapping[str, str], factory: Factory | None = None
    ) -> Workspace:
        """Files with all their includes."""
        files: dict[str, File] = {}
        waiting = [*paths]
        for path in waiting:
            text = texts[path] if path in texts else self.text(path)
            if text is None or path in files:
                continue
            files[path] = file_of(path, text)
            for include in files[path].includes:
                if include.path is not None:
                    candidates = include_candidates(project, path, include.path.text)
                    existing = [candidate for candidate in candidates if candidate in texts or self.is_file(candidate)]
                    waiting += existing[:1]
        return Workspace(files, project, factory)


class Revisions(Record):
    """Two revisions of a repository, below `root`; `new`: None is the working tree."""

    root: str
    old: Commit
    new: Commit | None

    def changed(self, folder: str) -> list[tuple[str | None, str | None]]:
        """The missions below a folder whose text changed: their old and new paths, None if absent.

        XML counts as a mission if it is written by hand; built XML is covered by its .btq file, or without one
        represents the mission together with its side file.
        """
        commits = [commit.id for commit in (self.old, self.new) if commit is not None]
        inside = _inside(self.root, folder) or "."
        words = _git(self.root, "diff", "--name-status", "--find-renames", "-z", *commits, "--", inside).split("\0")
        pairs: dict[tuple[str | None, str | None], None] = {}
        index = 0
        while index + 1 < len(words):
            status, path = words[index][:1], _outside(self.root, words[index + 1])
            target = _outside(self.root, words[index + 2]) if status in ("R", "C") else path
            index += 3 if status in ("R", "C") else 2
            before, after = (None if status in ("A", "C") else path, None if status == "D" else target)
            if path.endswith(SIDE_SUFFIX) and target.endswith(SIDE_SUFFIX):  # its XML may be unchanged
                xml = xml_path(path), xml_path(target)
                before = xml[0] if self.old.is_file(xml[0]) else None
                after = xml[1] if (os.path.isfile if self.new is None else self.new.is_file)(xml[1]) else None
            ours = any(each is not None and each.endswith(SUFFIXES) for each in (before, after))
            if ours or self._is_xml(before, after):
                pairs[before, after] = None
        return [*pairs]

    def changed_paths(self) -> frozenset[str]:
        """The files of the repository that differ between the old revision and the working tree; those that git does
        not know yet, and under both names those that were renamed."""
        words = _git(self.root, "diff", "--name-only", "--no-renames", "-z", self.old.id, "--")
        words += _git(self.root, "ls-files", "--others", "--exclude-standard", "-z")
        return frozenset(_outside(self.root, path) for path in words.split("\0") if path)

    def had_folder(self, path: str) -> bool:
        """Whether a path is a folder in one of the revisions, even if it has been removed."""
        return any(commit.is_folder(path) for commit in (self.old, self.new) if commit is not None)

    def _is_xml(self, before: str | None, after: str | None) -> bool:
        """Whether XML without its .btq file was or is a mission."""
        for revision, path in ((self.old, before), (self.new, after)):
            if path is None or not path.endswith(".xml"):
                continue
            text = read(path)[0] if revision is None else revision.text(path)
            if text is not None and is_mission(text) and not is_built_of(text, self._sources(revision)):
                return True
        return False

    @cache  # noqa: B019  # there is one for a command
    def _sources(self, revision: Commit | None) -> frozenset[str]:
        """The names of a revision's .btq files, without folders."""
        paths = _git(self.root, *_OF_WORKING_TREE).split("\0") if revision is None else revision.paths
        return frozenset(posixpath.basename(path) for path in paths if path.endswith(SUFFIXES))


def revisions(spec: str, path: str) -> Revisions:
    """Resolve `REV`, `REV..REV` and `REV...REV` for a file or folder (gitrevisions(7)).

    Args:
        spec: a single revision is compared with the working tree; `A..B` means these two, `A...B` their merge base and
            B.

    Raises:
        GitTrouble: the path is in no repository, a revision is not known, git is not installed.
    """
    folder = path
    while not os.path.isdir(folder) and os.path.dirname(folder) != folder:  # a revision may contain it
        folder = os.path.dirname(folder)
    root = absolute(_git(folder, "rev-parse", "--show-toplevel").rstrip("\n"))
    first, dots, second = spec.partition("..." if "..." in spec else "..")
    first, second = first or "HEAD", second or "HEAD"
    old = _commit(root, first)
    if not dots:
        return Revisions(root, Commit(root, old, first), None)
    new = _commit(root, second)
    if dots == "...":
        old, first = _git(root, "merge-base", old, new).strip(), f"{first}...{second}"
    return Revisions(root, Commit(root, old, first), Commit(root, new, second))


def _commit(root: str, revision: str) -> str:
    words = ("rev-parse", "--verify", "--end-of-options", f"{revision}^{{commit}}")
    if _run(root, *words).returncode != 0:
        raise GitTrouble(f"git does not know the revision `{revision}`")
    return _git(root, *words).strip()


def _inside(root: str, path: str) -> str:
    """A path relative to the root of the repository, as in git."""
    real = absolute(os.path.realpath(path))
    return "" if real == root else os.path.relpath(real, root).replace(os.sep, "/")


def _outside(root: str, path: str) -> str:
    """A path of git's, relative to the current folder, even if that is reached through links."""
    return absolute(os.path.relpath(f"{root}/{path}", os.path.realpath(".")))


def _git(folder: str, *arguments: str) -> str:
    return os.fsdecode(_git_bytes(folder, *arguments))


def _git_bytes(folder: str, *arguments: str) -> bytes:
    run = _run(folder, *arguments)
    if run.returncode != 0:
        message = os.fsdecode(run.stderr).strip().removeprefix("fatal: ")
        raise GitTrouble(f"git: {message}")
    return run.stdout


def _run(folder: str, *arguments: str) -> subprocess.CompletedProcess[bytes]:
    try:
        return subprocess.run(["git", "-C", folder or ".", *arguments], capture_output=True)
    except OSError as error:
        raise GitTrouble(f"git cannot be run: {error.strerror}") from error


_OF_WORKING_TREE: Final = ("ls-files", "--cached", "--others", "--exclude-standard", "-z")
