"""Where the files of a bundle go when its mission comes back.

One invariant: what a side file names may lead anywhere, what is written does not: only files that btq reads, and only
below the folder of the mission, links followed.
"""

from __future__ import annotations

import os
from collections.abc import Iterable

from btq_lang.loader import LoadProblem, absolute, read


def unpacked(
    others: Iterable[tuple[str, str]], target: str, taken: Iterable[str], force: bool, problems: list[LoadProblem]
) -> tuple[tuple[str, str], ...] | None:
    """The places of the files that a mission includes, with their texts; None: one of them cannot be written.

    Args:
        others: the paths, seen from the mission, and the texts.
        target: where the mission goes.
        taken: what no file may be written over, ever.
        force: files that are there may be written over; one that says the same is left as it is.
        problems: what keeps files from being written is added.
    """
    folder = os.path.dirname(target)
    found: dict[str, str] = {}
    known = len(problems)
    for name, text in others:
        path = _below(folder, name)
        if path is None:
            problems.append(LoadProblem(target, f"its bundle holds `{name}`, which is no .btq or XML file below it"))
        elif path in (target, *taken):
            problems.append(LoadProblem(target, f"its bundle holds `{name}`, too, which would be written over"))
        elif not os.path.lexists(path):
            found[path] = text
        elif not _says(path, text):
            found[path] = text
            if not force:
                problems.append(LoadProblem(path, "is there already: --force writes it anew"))
    return None if len(problems) > known else tuple(found.items())


def _below(folder: str, name: str) -> str | None:
    if not name.endswith(_KNOWN) or os.path.isabs(name) or any(char in name for char in "\\:\0") or "//" in name:
        return None
    path = absolute(os.path.join(folder, name))
    root, place = os.path.realpath(folder), os.path.realpath(path)
    is_below = os.path.normpath(path).startswith(os.path.join(os.path.normpath(folder), ""))
    return path if is_below and place.startswith(os.path.join(root, "")) else None


def _says(path: str, text: str) -> bool:
    return os.path.isfile(path) and read(path) == (text, None)


_KNOWN = (".btq", ".qualitybtcpp", ".xml")
