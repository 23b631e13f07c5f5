"""The paths of a bundle's files when its mission is imported.

One invariant: whatever paths a side file names, only files that btq reads are written, and only below the folder of the
import, links followed.
"""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable

from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import LoadProblem, absolute, read


def place_of_mission(target: str, file: str, others: Iterable[tuple[str, str]]) -> str:
    """The path of a mission that leaves room for its includes: deeper, if it includes `../shared/a.btq`.

    Args:
        target: its path without includes.
        file: its old path, relative to its side file: folders keep their names.
        others: the paths, seen from the mission, and the texts.
    """
    up = max((name.split("/").count("..") for name, _ in others), default=0)
    folders = file.split("/")[:-1]
    names = folders[len(folders) - up :] if 0 < up <= len(folders) else []
    if any(name in ("", ".", "..") or any(char in name for char in _FOREIGN) for name in names):
        return target
    return absolute(os.path.join(os.path.dirname(target), *names, os.path.basename(target)))


def unpacked(
    others: Iterable[tuple[str, str]],
    root: str,
    target: str,
    taken: Iterable[str],
    force: bool,
    problems: list[LoadProblem],
) -> tuple[tuple[str, str], ...] | None:
    """The paths of the files that a mission includes, with their texts; None: one of them cannot be written.

    Args:
        others: the paths, seen from the mission, and the texts.
        root: the folder that must contain all of them.
        target: the path of the mission.
        taken: files that must not be overwritten.
        force: existing files may be overwritten; equal ones are not touched.
        problems: errors are appended.
    """
    folder = os.path.dirname(target)
    found: dict[str, str] = {}
    known = len(problems)
    for name, text in others:
        path = _below(root, folder, name)
        if path is None:
            problems.append(
                LoadProblem(
                    target, f"its bundle contains `{name}`, which is not a .btq or XML file below the output folder"
                )
            )
        elif path in (target, *taken):
            problems.append(LoadProblem(target, f"its bundle contains `{name}`, which the import would overwrite"))
        elif not os.path.lexists(path):
            found[path] = text
        elif not os.path.isfile(path) or read(path) != (text, None):
            found[path] = text
            if not force:
                problems.append(LoadProblem(path, "already exists; --force overwrites it"))
    return None if len(problems) > known else tuple(found.items())


def _below(root: str, folder: str, name: str) -> str | None:
    if not name.endswith((*SUFFIXES, ".xml")) or os.path.isabs(name) or any(char in name for char in _FOREIGN):
        return None
    path = absolute(os.path.join(folder, name))
    if posixpath.normpath(name) != name or not path.startswith(f"{root.rstrip('/')}/"):
        return None
    return path if os.path.realpath(path).startswith(os.path.join(os.path.realpath(root), "")) else None


_FOREIGN = "\\:\0"  # on some systems, characters that turn a name into another path
