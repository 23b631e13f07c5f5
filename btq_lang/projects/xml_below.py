"""Which XML files below a folder are missions, of the many that are not.

One invariant: each file that people wrote for the engine is in the result, unless git ignores it.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Hashable, Iterable, Set

from btq_lang.btcpp.marks import is_built_of, is_generated, named_beside
from btq_lang.btcpp.recognition import defined_in, is_mission, may_be_mission
from btq_lang.util.grouping import grouped
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import absolute, head, read, stamp


class XmlBelow:
    """Classifies files, and remembers the result until they change."""

    def __init__(self) -> None:
        self._seen: dict[str, tuple[Hashable, frozenset[str] | None, bool]] = {}  # stamp, IDs, whether it is generated

    def missions(self, top: str, paths: Iterable[str]) -> tuple[str, ...]:
        """All but the XML files that are not the engine's, that git ignores, or that were built from an existing
        .btq file.

        Args:
            top: the folder that contains the paths.  If git ignores the folder itself, its files are kept: the user
                asked for it by name.
            paths: the files of the mission language and the XML files in it.
        """
        paths = tuple(paths)
        sources = {os.path.basename(path) for path in paths if path.endswith(SUFFIXES)}
        xml = [path for path in paths if not path.endswith(SUFFIXES) and self._is_hand_written(path, sources)]
        left_out = ignored((top, *xml)) if xml else frozenset()
        kept = {path for path in xml if top in left_out or path not in left_out}
        return tuple(path for path in paths if path in kept or path.endswith(SUFFIXES))

    def may_define(self, path: str, names: Set[str]) -> bool:
        """Whether a file may define a tree or model of one of some names."""
        if path.endswith(SUFFIXES):
            text = read(path)[0] or ""
            return any(name in text for name in names)
        ids, _ = self._classify(path)
        return ids is not None and not ids.isdisjoint(names)

    def _is_hand_written(self, path: str, sources: set[str]) -> bool:
        """Whether an XML file is a mission, and not the output of a build whose .btq file still exists."""
        ids, was_generated = self._classify(path)
        if ids is None or not was_generated:
            return ids is not None
        return self.source_of(path) is None and not is_built_of(read(path)[0] or "", sources)

    def is_mission(self, path: str) -> bool:
        """Whether an XML file is the engine's."""
        return self._classify(path)[0] is not None

    def source_of(self, path: str) -> str | None:
        """The mission that an XML file was built from, if it exists: beside the XML, or at the path that its side file
        gives.
        """
        if not self._classify(path)[1]:
            return None
        named = named_beside(read(path)[0] or "", path, SUFFIXES)
        return next((mission for mission in (*named, *_named_by_side_file(path)) if os.path.isfile(mission)), None)

    def _classify(self, path: str) -> tuple[frozenset[str] | None, bool]:
        """The IDs of the trees and models in an XML file (None if BehaviorTree.CPP does not use it), and whether btq
        generated it.
        """
        current = stamp(path)
        remembered = self._seen.get(path)
        if remembered is None or remembered[0] != current:
            text = read(path)[0] or "" if may_be_mission(head(path)) else ""
            ids = defined_in(text) if is_mission(text) else None
            remembered = self._seen[path] = current, ids, is_generated(text)
        return remembered[1:]


def _named_by_side_file(path: str) -> tuple[str, ...]:
    """The mission that the side file of built XML names."""
    import json

    from btq_lang.btcpp.side_file import is_side_file, side_path  # imported here because few XML files are generated

    side = read(side_path(path))[0] if os.path.isfile(side_path(path)) else None
    if side is None or not is_side_file(side):
        return ()
    try:
        mission = json.loads(side)["mission"]["file"]
    except (ValueError, LookupError, TypeError):
        return ()
    return (absolute(os.path.join(os.path.dirname(path), mission)),) if isinstance(mission, str) else ()


def ignored(paths: Iterable[str]) -> frozenset[str]:
    """The absolute paths that git ignores; empty if git is not installed.  Tracked files are never ignored."""
    repository_of: dict[str, str | None] = {}  # by folder
    in_repository = ((_repository(os.path.dirname(path), repository_of), path) for path in paths)
    by_repository = grouped((root, path) for root, path in in_repository if root is not None and path != root)
    return frozenset().union(*(_ignored_in(root, below) for root, below in by_repository.items()))


def _repository(folder: str, repository_of: dict[str, str | None]) -> str | None:
    """The nearest folder above with a `.git`, which is a file in a submodule or a second working tree."""
    if folder not in repository_of:
        above = os.path.dirname(folder)
        if os.path.exists(f"{folder}/.git"):
            repository_of[folder] = folder
        else:
            repository_of[folder] = _repository(above, repository_of) if above != folder else None
    return repository_of[folder]


def _ignored_in(root: str, paths: list[str]) -> frozenset[str]:
    """The paths in one repository that git ignores."""
    names = "\0".join(path.removeprefix(f"{root.rstrip('/')}/") for path in paths)
    try:
        run = subprocess.run(
            ["git", "-C", root, "check-ignore", "-z", "--stdin"], input=os.fsencode(names), capture_output=True
        )
    except OSError:  # git is not installed
        return frozenset()
    return frozenset(f"{root.rstrip('/')}/{path}" for path in os.fsdecode(run.stdout).split("\0") if path)
