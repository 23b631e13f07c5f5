"""What is frozen: what a commit does, and the files of one, read from git, so that nothing later moves a case."""

from __future__ import annotations

import builtins
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = Path(__file__).with_name("golden.tsv")
THIS_PYTHON = "{}.{}".format(*sys.version_info)

BLOCK = re.compile(r"^```(?:btq|text)[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)


def git(*words: str) -> bytes:
    """What git prints in this checkout; raises OSError where it refuses."""
    run = subprocess.run(["git", *words], cwd=ROOT, capture_output=True)
    if run.returncode:
        raise OSError(f"git {' '.join(words)}: {run.stderr.decode().strip()}")
    return run.stdout


@cache
def commit() -> str:
    """The commit that the inputs come from."""
    return _head()[0]


def behaviour() -> str:
    """The commit whose behaviour the golden file has."""
    return _head()[1]


def python() -> str:
    """The version of Python that the golden file was written with, whose argparse words help and errors its own way."""
    return _head()[2]


def _head() -> list[str]:
    return GOLDEN.read_text(encoding="utf-8").partition("\n")[0].split("\t")


def begin(revision: str, inputs: str | None) -> str:
    """Freeze the behaviour of a commit, before any file is read; the first line of its golden file.

    Args:
        inputs: the commit that the inputs are to come from; None: as it is.
    """
    names = [git("rev-parse", f"{name}^{{commit}}").decode().strip() for name in (inputs or commit(), revision)]
    head = "\t".join((*names, THIS_PYTHON))
    GOLDEN.write_text(f"{head}\n", encoding="utf-8")
    commit.cache_clear()
    return head


@cache
def paths(folder: str) -> tuple[str, ...]:
    """The files below a folder, or below every folder of a name, in order."""
    return tuple(path for path in _all() if f"/{folder}/" in f"/{path}")


def named(name: str) -> str:
    """The path of the only file of this name, wherever the commit has it."""
    (path,) = (path for path in _all() if path.endswith(f"/{name}"))
    return path


@cache
def _all() -> tuple[str, ...]:
    return tuple(git("ls-tree", "-r", "--name-only", "-z", "--full-tree", commit()).decode().split("\0")[:-1])


@cache
def text(path: str) -> str:
    """A file's text."""
    return git("show", f"{commit()}:{path}").decode("utf-8")


@cache
def blocks(page: str) -> tuple[str, ...]:
    """The missions, and the outputs, that a page shows."""
    return tuple(BLOCK.findall(text(page)))


@cache
def pages() -> tuple[str, ...]:
    """The pages of the documentation and of the rules."""
    readmes = [path for path in paths("examples") if path.endswith(".md")]
    rules = [path for path in paths("rules") if path.endswith(".md")]
    return tuple(path for path in (*paths("docs"), *readmes, *rules) if path.endswith(".md"))


def missions() -> tuple[tuple[str, str], ...]:
    """Every mission in one text that the repository has, by a name."""
    whole = [
        *(path for path in paths("golden") if path.endswith(".btq")),
        *(path for path in paths("examples") if path.endswith((".btq", ".qualitybtcpp"))),
        named("every_form.btq"),
        named("lab.btq"),
    ]
    found = [(path, text(path)) for path in whole]
    found += [(f"{page} {number}", block) for page in pages() for number, block in enumerate(blocks(page), 1)]
    return tuple(found)


def module(name: str, **stand_ins: object) -> SimpleNamespace:
    """The names of the module in a file of this name, which imports nothing but the standard library.

    Args:
        stand_ins: for other packages, by their names; any that is not among them has a class of every name.
    """
    made = ModuleType("frozen_module")

    def import_(name: str, *rest: Any) -> object:
        first = name.partition(".")[0]
        if first in sys.stdlib_module_names:
            return builtins.__import__(name, *rest)
        return stand_ins.get(first, _Anything())

    vars(made)["__builtins__"] = {**vars(builtins), "__import__": import_}
    sys.modules[made.__name__] = made  # dataclasses look their module up
    exec(compile(text(named(name)), name, "exec"), vars(made))
    return SimpleNamespace(**vars(made))


class _Anything:
    def __getattr__(self, name: str) -> type:
        return object
