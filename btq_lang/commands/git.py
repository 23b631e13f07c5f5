"""The texts of a file's revisions in git.  Git runs as a process, here and in `xml_below`.

One invariant: nothing is written, and git reads no external argument as an option.
"""

from __future__ import annotations

import os
import posixpath
import subprocess
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Final

from btq_lang.btcpp.marks import is_built_of, named_beside
from btq_lang.btcpp.opening import file_of
from btq_lang.btcpp.recognition import is_mission
from btq_lang.btcpp.side_file import xml_path
from btq_lang.util.globs import glob_matcher
from btq_lang.workspace.config import Project, include_candidates
from btq_lang.workspace.file import SIDE_SUFFIX, SUFFIXES, File
from btq_lang.workspace.loader import absolute, find_project, read
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.workspace.factories import Factory


class GitTrouble(Exception):
    """Git is missing, or does not know a revision or file."""


class Revisions:
    """Two revisions of a repository.

    Attributes:
        old, new: commits; None is the working tree.
        names: of the commits, as on the command line.
    """

    def __init__(self, root: str, old: str, new: str | None, names: dict[str, str]) -> None:
        self.old: Final = old
        self.new: Final = new
        self.names: Final = names
        self._root: Final = root
        self._missions: dict[str | None, frozenset[str]] = {}  # results of `_sources`
        self._of_factories: dict[tuple[str, str], tuple[Workspace, ...]] = {}  # results of `_factories`
        self._paths: dict[str, tuple[str, ...]] = {}  # results of `paths`

    def changed(self, folder: str) -> list[tuple[str | None, str | None]]:
        """The missions below a folder whose text changed: their old and new paths, None if absent.

        XML counts as a mission if it is written by hand; built XML is covered by its .btq file, or without one
        represents the mission together with its side file.
        """
        commits = [self.old] if self.new is None else [self.old, self.new]
        run = ["diff", "--name-status", "--find-renames", "-z", *commits, "--", self._inside(folder) or "."]
        words = _git(self._root, *run).split("\0")
        pairs: dict[tuple[str | None, str | None], None] = {}
        at = 0
        while at + 1 < len(words):
            status, path = words[at][:1], self._outside(words[at + 1])
            target = self._outside(words[at + 2]) if status in ("R", "C") else path
            at += 3 if status in ("R", "C") else 2
            before, after = (None if status in ("A", "C") else path, None if status == "D" else target)
            if path.endswith(SIDE_SUFFIX) and target.endswith(SIDE_SUFFIX):  # its XML may be unchanged
                xml = xml_path(path), xml_path(target)
                before = xml[0] if self._is_there(self.old, xml[0]) else None
                after = xml[1] if self._is_there(self.new, xml[1]) else None
            ours = any(each is not None and each.endswith(SUFFIXES) for each in (before, after))
            if ours or self._is_xml(before, after):
                pairs[before, after] = None
        return [*pairs]

    def changed_paths(self) -> frozenset[str]:
        """The files of the repository that differ between the old revision and the working tree; those that git does
        not know yet, and under both names those that were renamed."""
        words = _git(self._root, "diff", "--name-only", "--no-renames", "-z", self.old, "--")
        words += _git(self._root, "ls-files", "--others", "--exclude-standard", "-z")
        return frozenset(self._outside(path) for path in words.split("\0") if path)

    def workspace(self, commit: str, path: str, known: dict[str, str] | None = None) -> Workspace | None:
        """A file of a commit with all its includes there, in the first factory of today's project file that registers
        it; None if the commit has no such file."""
        project = find_project(path).project
        if known is None:  # else the file is built XML, restored in memory
            of_factory = next((each for each in self._factories(commit, project) if path in each.registered), None)
            if of_factory is not None:
                return of_factory
        workspace = self._read(commit, (path,), project, known or {})
        return workspace if path in workspace.files else None

    def _factories(self, commit: str, project: Project) -> tuple[Workspace, ...]:
        """The workspaces of a project's factories in a commit."""
        key = commit, project.root
        if project.factories and key not in self._of_factories:
            from btq_lang.commands.factory_files import resolved  # few projects have any

            there = _Registered(self, commit)
            found: list[Factory] = []
            for each in project.factories:
                whole = resolved(each, project.root, there, there.matching)
                found += self._of_nav2(commit, whole, project, there) if each.nav2 else (whole,)
            self._of_factories[key] = tuple(self._of_factory(commit, project, each) for each in found)
        return self._of_factories.get(key, ())

    def _of_nav2(self, commit: str, factory: Factory, project: Project, there: _Registered) -> Iterator[Factory]:
        """The factories that a parameter file of Nav2 describes, with the files that are in its folders today."""
        from btq_lang.commands.nav2_factory import Sources, parameter_file  # few projects are for Nav2

        sources = Sources(partial(self.text, commit), there.source_of, partial(self._of_factory, commit, project))
        file, _ = parameter_file(factory, project, None, sources)
        yield from file.distinct if file is not None else ()

    def _of_factory(self, commit: str, project: Project, factory: Factory) -> Workspace:
        return self._read(commit, (*factory.files, *factory.node_files), project, {}, factory)

    def paths(self, commit: str) -> tuple[str, ...]:
        """All files of a commit, sorted."""
        if commit not in self._paths:
            words = _git(self._root, "ls-tree", "-r", "--name-only", "-z", commit).split("\0")
            self._paths[commit] = tuple(sorted(self._outside(path) for path in words if path))
        return self._paths[commit]

    def _read(
        self,
        commit: str,
        paths: Iterable[str],
        project: Project,
        known: Mapping[str, str],
        factory: Factory | None = None,
    ) -> Workspace:
        """Files of a commit with all their includes there."""
        files: dict[str, File] = {}
        waiting = [*paths]
        for each in waiting:
            text = known[each] if each in known else self.text(commit, each)
            if text is None or each in files:
                continue
            files[each] = file_of(each, text)
            for include in files[each].includes:
                if include.path is not None:
                    found = include_candidates(project, each, include.path.text)
                    waiting += [one for one in found if one in known or self.has(commit, one)][:1]
        return Workspace(files, project, factory)

    def had_folder(self, path: str) -> bool:
        """Whether a path is a folder in one of the revisions, even if it has been removed."""
        return any(self._kind(commit, path) == "tree" for commit in (self.old, self.new) if commit is not None)

    def text(self, commit: str, path: str) -> str | None:
        """The text of a file in a commit; None if there is none."""
        if not self.has(commit, path):
            return None
        data = _git_bytes(self._root, "cat-file", "blob", f"{commit}:{self._inside(path)}")
        return data.decode("utf-8", "replace").removeprefix("\ufeff")

    def _is_xml(self, before: str | None, after: str | None) -> bool:
        """Whether XML without its .btq file was or is a mission."""
        for revision, path in ((self.old, before), (self.new, after)):
            if path is None or not path.endswith(".xml"):
                continue
            text = read(path)[0] if revision is None else self.text(revision, path)
            if text is not None and is_mission(text) and not is_built_of(text, self._sources(revision)):
                return True
        return False

    def _is_there(self, revision: str | None, path: str) -> bool:
        return os.path.isfile(path) if revision is None else self.has(revision, path)

    def _sources(self, revision: str | None) -> frozenset[str]:
        """The names of a revision's .btq files, without folders."""
        if revision not in self._missions:
            run = ("ls-tree", "-r", "--name-only", "-z", revision) if revision is not None else _OF_WORKING_TREE
            paths = _git(self._root, *run).split("\0")
            names = frozenset(posixpath.basename(path) for path in paths if path.endswith(SUFFIXES))
            self._missions[revision] = names
        return self._missions[revision]

    def has(self, commit: str, path: str) -> bool:
        """Whether a commit has a file."""
        return self._kind(commit, path) == "blob"

    def _kind(self, commit: str, path: str) -> str:
        """`blob` for a file, `tree` for a folder; empty if the commit has nothing there."""
        return os.fsdecode(_run(self._root, "cat-file", "-t", f"{commit}:{self._inside(path)}").stdout).strip()

    def _inside(self, path: str) -> str:
        """A path relative to the root of the repository, as in git."""
        real = absolute(os.path.realpath(path))
        return "" if real == self._root else os.path.relpath(real, self._root).replace(os.sep, "/")

    def _outside(self, path: str) -> str:
        """A path of git's, relative to the current folder, even if that is reached through links."""
        return absolute(os.path.relpath(f"{self._root}/{path}", os.path.realpath(".")))


class _Registered:
    """What a factory needs to know of the files of a commit."""

    def __init__(self, known: Revisions, commit: str) -> None:
        self._known: Final = known
        self._commit: Final = commit

    def matching(self, folder: str, pattern: str) -> tuple[str, ...]:
        """The files that a pattern below a folder matches, sorted."""
        matcher = glob_matcher((f"{folder}/{pattern}",))
        return tuple(path for path in self._known.paths(self._commit) if matcher and matcher.fullmatch(path.strip("/")))

    def is_mission(self, path: str) -> bool:
        """Whether an XML file is the engine's."""
        return is_mission(self._known.text(self._commit, path) or "")

    def source_of(self, path: str) -> str | None:
        """The mission beside an XML file that was built of it."""
        named = named_beside(self._known.text(self._commit, path) or "", path, SUFFIXES)
        return next((each for each in named if self._known.has(self._commit, each)), None)


class Commit:
    """The files of one commit."""

    def __init__(self, known: Revisions, commit: str) -> None:
        self._known: Final = known
        self._commit: Final = commit

    def is_file(self, path: str) -> bool:
        return self._known.has(self._commit, path)

    def text(self, path: str) -> str | None:
        return self._known.text(self._commit, path)

    def workspace(self, path: str, known: dict[str, str]) -> Workspace | None:
        return self._known.workspace(self._commit, path, known)


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
        return Revisions(root, old, None, {old: first})
    new = _commit(root, second)
    if dots == "...":
        old = _git(root, "merge-base", old, new).strip()
        return Revisions(root, old, new, {old: f"{first}...{second}", new: second})
    return Revisions(root, old, new, {new: second, old: first})


def _commit(root: str, revision: str) -> str:
    words = ("rev-parse", "--verify", "--end-of-options", f"{revision}^{{commit}}")
    if _run(root, *words).returncode != 0:
        raise GitTrouble(f"git does not know the revision `{revision}`")
    return _git(root, *words).strip()


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
