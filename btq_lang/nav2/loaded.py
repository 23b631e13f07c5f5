"""The trees that bt_navigator creates, and the files that it reads for them.

One invariant: a file or folder that is not on this machine is an error only if the package that should have it is
installed here.  It is a warning if its package is in the workspace, or if a relative path leads to no file of the
project, as a launch file or a build may put another one in its place.
"""

from __future__ import annotations

import os.path
import re
from collections.abc import Callable, Iterator
from functools import cache, partial
from typing import Final, TypeAlias

from btq_lang.btcpp.recognition import listed_trees
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import TREE_OF_GOAL, ports_of
from btq_lang.catalog.nav2.navigator import NAVIGATORS, OWN_PACKAGE
from btq_lang.diagnostics.model import Place
from btq_lang.diagnostics.rules import Severity
from btq_lang.nav2.parameters import Parameters, ParameterText, is_id
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Span
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import absolute, collect, matching, package_folder, read
from btq_lang.workspace.workspace import Workspace

ReadFile: TypeAlias = Callable[[str], str | None]
FindPackage: TypeAlias = Callable[[str], str | None]


class Located(Record):
    """A file or folder that parameters name.

    Attributes:
        named: its name in the parameters, and where; None for the default.
        path: None if it is not on this machine.
        problem: the reason why it is not here, for a message; empty if that is no mistake.
        severity: of the problem; an error if the robot certainly lacks it too.
    """

    named: ParameterText | None
    path: str | None = None
    problem: str = ""
    severity: Severity = Severity.HINT


class SkippedFile(Record):
    """A file that bt_navigator passes over.

    Attributes:
        place: of its first tree, or of the one that another file has too.
        id: of that tree, and where it is in the other file; None: no tree has an ID.
        loses: whether that has an effect: it has a tree that no other file has, or either file may be skipped.
        ids: of all its trees.
    """

    place: Place
    id: str | None
    other: Place | None
    loses: bool
    ids: tuple[str, ...] = ()


class Load(Record):
    """A tree that bt_navigator creates, and what it reads for it.

    Attributes:
        label: the navigator, or the tree that goals name.
        tree: the file with the tree; None if an ID names it.
        main: that ID.
        files: that it registers, in order.
        skipped: files that it passes over, with the reasons.
        refused: files that keep it from loading anything: nothing says which of their trees is the main one; the
            place is that of the second tree.
        folders: that it searches.
        goals: the places that name it for goals.
    """

    label: str
    tree: Located | None
    main: ParameterText | None
    files: tuple[str, ...]
    skipped: tuple[SkippedFile, ...] = ()
    refused: tuple[Place, ...] = ()
    folders: tuple[Located, ...] = ()
    goals: tuple[Place, ...] = ()

    @property
    def is_whole(self) -> bool:
        """Whether all that it reads is known."""
        places = (*self.folders, *([self.tree] if self.tree is not None else ()))
        return all(place.path is not None for place in places)


class Loads:
    """What bt_navigator loads in a distribution.

    Args:
        root: a folder in the workspace with the packages.
        read: returns the text of a file.
    """

    def __init__(self, parameters: Parameters, distribution: str | None, root: str, read: ReadFile) -> None:
        self._parameters = parameters
        self._root = root
        self._find = cache(partial(package_folder, start=root))  # each time, it looks through the workspace
        self._folders = tuple(_folders(parameters, self._find, root)) if distribution == "lyrical" else None
        self._read = read

    def by_default(self) -> Iterator[Load]:
        """The trees that it creates when it starts."""
        for navigator, (parameter, default, _) in NAVIGATORS.items():
            if navigator not in self._parameters.navigators:
                continue
            named = self._parameters.text(parameter)
            if self._folders is not None and named is not None and is_id(named.text):
                yield self._searched(navigator, None, named)
            elif named is not None:
                yield self._searched(navigator, _located(named, self._find, self._root))
            else:
                yield self._searched(navigator, _of_nav2(f"behavior_trees/{default}", self._find))

    def of_file(self, path: str) -> Load:
        """The tree of a file, for goals that name it."""
        return self._searched(os.path.basename(path), Located(None, path))

    def of_goal(self, name: str, is_replaced: bool) -> Load:
        """The tree that goals name: by the path of a file, in which a launch file may replace `$(…)`, or in Lyrical by
        its ID."""
        named = ParameterText(name, Span(0, 0))
        if self._folders is not None and (is_id(name) or not (is_replaced or name.endswith(".xml"))):
            return self._searched(name, None, named)
        if "$(" in name and not is_replaced:
            why = "`$(…)` is replaced in parameters only"
            return self._searched(name, Located(named, None, why, Severity.ERROR))
        if is_id(name):
            why = "before Lyrical, a goal names the file of its tree, not the ID"
            return self._searched(name, Located(named, None, why, Severity.WARNING))
        return self._searched(os.path.basename(name), _located(named, self._find, self._root))

    def _searched(self, label: str, tree: Located | None, named: ParameterText | None = None) -> Load:
        """What is read for a tree: its file, then those in the folders."""
        first = tree.path if tree is not None else None
        if self._folders is None:
            return Load(label, tree, None, (first,) if first is not None else ())
        paths = [first] if first is not None else []
        for folder in self._folders:
            paths += matching(folder.path, "*.xml") if folder.path is not None else ()
        skipped: list[SkippedFile] = []
        refused: list[Place] = []
        owners: dict[str, Place] = {}
        for path in dict.fromkeys(paths):
            text = self._read(path) or ""
            listed = listed_trees(text)
            ids, main = listed or ((), None)
            clash = next((tree_id for tree_id in ids if tree_id in owners), None)
            places = [Place(Span(*match.span()), path) for match in _TREE.finditer(text)] or [Place(Span(0, 0), path)]
            if listed is not None and not main and (len(ids) > 1 or (path == first and not ids)):
                refused.append(places[min(1, len(places) - 1)])
            elif not ids:
                skipped.append(SkippedFile(places[0], None, None, text.find("<BehaviorTree") >= 0))
            elif clash is not None:
                place = next(
                    (
                        candidate
                        for candidate in places
                        if f'"{clash}"' in text[candidate.span.start : candidate.span.end]
                    ),
                    places[0],
                )
                is_certain = owners[clash].path == first  # else the other file may be the one that is skipped
                skipped.append(
                    SkippedFile(place, clash, owners[clash], not is_certain or not owners.keys() >= {*ids}, ids)
                )
            else:
                owners.update(zip(ids, [*places, *[places[-1]] * len(ids)], strict=False))
        files = tuple(dict.fromkeys(place.path for place in owners.values() if place.path is not None))
        return Load(label, tree, named, files, tuple(skipped), tuple(refused), self._folders)


def _located(named: ParameterText, find: FindPackage, root: str, is_folder: bool = False) -> Located:
    """The file or folder that a string names."""
    lost: list[str] = []
    packages: list[str] = []

    def share(match: re.Match[str]) -> str:
        folder = find(match[1])
        packages.extend([folder] if folder is not None else [])
        lost.extend([match[1]] if folder is None else [])
        return folder or ""

    text = _SHARE.sub(share, named.text)
    if lost:
        return Located(named, None, f"neither the workspace nor AMENT_PREFIX_PATH has the package `{lost[0]}`")
    if "$(" in text:
        return Located(named)
    if not text:
        return Located(named, None, "it is empty")
    if not os.path.isabs(text):
        why = "a relative path counts from the folder in which bt_navigator runs"
        is_path = text.endswith(".xml") and not any(map(str.isspace, text))  # and not a sentence
        is_lost = is_path and not os.path.isfile(os.path.join(root, text))
        return Located(named, None, why, Severity.WARNING if is_lost else Severity.HINT)
    path = absolute(text)
    is_there = os.path.isdir if is_folder else os.path.isfile
    if not is_there(path) and (match := _INSTALLED.fullmatch(path)) and (folder := find(match[1])) is not None:
        packages.append(folder)  # where a build has installed it, perhaps on another machine
        path = folder + match[2]
    if is_there(path):
        return Located(named, path)
    for package in packages:
        lacks = f"the package in {package} has no such {_KINDS[is_folder]}"
        if os.path.basename(os.path.dirname(package)) == "share":  # it is installed
            return Located(named, None, lacks, Severity.ERROR)
        candidates = _inside(package, is_folder)
        elsewhere = [candidate for candidate in candidates if os.path.basename(candidate) == os.path.basename(path)]
        if len(elsewhere) == 1:  # a build may install it elsewhere
            return Located(named, elsewhere[0])
        if _stem(path) not in map(_stem, candidates):
            likely = near(os.path.basename(path), map(os.path.basename, candidates), 1)
            return Located(named, None, lacks + did_you_mean(likely), Severity.WARNING)
    return Located(named, None, f"this machine has no such {_KINDS[is_folder]}")


def _folders(parameters: Parameters, find: FindPackage, root: str) -> Iterator[Located]:
    directories = parameters.texts("bt_search_directories")
    if directories is None:
        yield _of_nav2("behavior_trees", find)
    for directory in directories or ():
        yield _located(directory, find, root, is_folder=True)


def _of_nav2(inside: str, find: FindPackage) -> Located:
    """A file or folder of Nav2 itself, which is not here without Nav2."""
    package = find(OWN_PACKAGE)
    path = f"{package}/{inside}"
    return Located(None, path if package is not None and os.path.exists(path) else None)


def file_with(tree: str, root: str) -> Place | None:
    """Where a file below a folder has a tree with this ID."""
    for path in collect((root,), Project(), (".xml",))[0]:
        for match in _TREE.finditer(read(path)[0] or ""):
            if re.search(rf"""\sID\s*=\s*["']{re.escape(tree)}["']""", match[0]):
                return Place(Span(*match.span()), path)
    return None


def _inside(package: str, is_folder: bool) -> list[str]:
    """The files of a package that is not built, or the folders of its XML; XML may be built of a mission."""
    files, _ = collect((package,), Project(), (".xml",) if is_folder else (".xml", *SUFFIXES))
    return sorted({os.path.dirname(path) if is_folder else path for path in files})


def _stem(path: str) -> str:
    return os.path.splitext(os.path.basename(path))[0]


def goals_in(workspace: Workspace) -> Iterator[tuple[str, Place]]:
    """The trees that nodes of Nav2 name for the goals that they send, in the files that a program registers, each with
    its place.  The names in entries, and the goals of scripts and other programs, are unknown."""
    for path in workspace.registered:
        file = workspace.files[path]
        for entry, use in file.uses if TREE_OF_GOAL in file.text else ():
            if use.kind is not Kind.MODEL or use.node is None or TREE_OF_GOAL not in (ports_of(use.name) or ()):
                continue
            for pair in use.node.attributes:
                name = pair.value.text if pair.key.text == TREE_OF_GOAL and pair.value is not None else ""
                if name and "{" not in name and pair.value is not None:
                    span = pair.value.span.shifted(entry.start)
                    yield name, Place(file.on_disk(span), path)


_SHARE: Final = re.compile(r"""\$\(find-pkg-share\s+["']?([\w-]+)["']?\s*\)""")
_INSTALLED: Final = re.compile(r".*/share/([\w-]+)(/.+)")
_TREE: Final = re.compile(r"<BehaviorTree\b[^>]*>")
_KINDS: Final = ("file", "folder")
