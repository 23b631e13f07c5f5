"""Which files git ignores.  Git runs as a process; without git, nothing is ignored."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterable


def ignored(paths: Iterable[str]) -> frozenset[str]:
    """Those of some absolute paths that git ignores; a file that is tracked is not ignored."""
    repository_of: dict[str, str | None] = {}  # by folder
    by_repository: dict[str, list[str]] = {}
    for path in paths:
        repository = _repository(os.path.dirname(path), repository_of)
        if repository is not None and path != repository:
            by_repository.setdefault(repository, []).append(path)
    return frozenset().union(*(_ignored_in(root, below) for root, below in by_repository.items()))


def _repository(folder: str, known: dict[str, str | None]) -> str | None:
    """The nearest folder above with a `.git`, which is a file in a submodule or a second working tree."""
    if folder not in known:
        above = os.path.dirname(folder)
        if os.path.exists(f"{folder}/.git"):
            known[folder] = folder
        else:
            known[folder] = _repository(above, known) if above != folder else None
    return known[folder]


def _ignored_in(root: str, paths: list[str]) -> frozenset[str]:
    given = "\0".join(path.removeprefix(f"{root.rstrip('/')}/") for path in paths)
    try:
        run = subprocess.run(
            ["git", "-C", root, "check-ignore", "-z", "--stdin"], input=os.fsencode(given), capture_output=True
        )
    except OSError:  # git is not installed
        return frozenset()
    return frozenset(f"{root.rstrip('/')}/{path}" for path in os.fsdecode(run.stdout).split("\0") if path)
