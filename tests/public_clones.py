"""Clones of public repositories that somebody has, each in `OWNER+NAME/repo` below the folder that BTQ_CLONES names."""

from __future__ import annotations

import os
from pathlib import Path
from subprocess import run

import pytest


def texts_of(repository: str, commit: str, suffixes: tuple[str, ...], folders: tuple[str, ...] = ()) -> dict[str, str]:
    """The files of a commit with some suffixes, by path; the test is skipped if there is no clone."""
    clone = Path(os.environ.get("BTQ_CLONES", "")) / repository / "repo"
    if not os.environ.get("BTQ_CLONES") or not clone.is_dir():
        pytest.skip(f"no clone of {repository}: set BTQ_CLONES to a folder with one in `{repository}/repo`")

    def git(*words: str) -> str:
        return run(["git", "-C", str(clone), *words], capture_output=True, check=True).stdout.decode("utf-8", "replace")

    names = git("ls-tree", "-r", "--name-only", commit, *folders).splitlines()
    return {each: git("show", f"{commit}:{each}") for each in names if each.endswith(suffixes)}
