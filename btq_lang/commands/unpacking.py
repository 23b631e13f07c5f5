"""Where the files of a bundle go when its mission comes back.

One invariant: what a side file names may lead anywhere, what is written does not: only files that btq reads, and only
below the folder of the import, links followed.
"""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable

from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import LoadProblem, absolute, read


def place_of_mission(target: str, file: str, others: Iterable[tuple[str, str]]) -> str:
    """Where a mission goes so that the files that it includes have room: deeper, where it includes `../shared/a.btq`.

    Args:
        target: where it goes by itself.
        file: where it was, seen from its side file: its folders keep their names.
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
    """The places of the files that a mission includes, with their texts; None: one of them cannot be written.

    Args:
        others: the paths, seen from the mission, and the texts.
        root: the folder that all of them stay below.
        target: where the mission goes.
        taken: what no file may be written over, ever.
        force: files that are there may be written over; one that says the same is left as it is.
        problems: what keeps files from being written is added.
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
        elif not _says(path, text):
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


def _says(path: str, text: str) -> bool:
    return os.path.isfile(path) and read(path) == (text, None)


_FOREIGN = "\\:\0"  # what makes a path of its own of a name on some system
