"""The forms of btq that are measured: interpreted and compiled, of this checkout and of another commit."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from turns import ROOT, Worker, progress, worker


@dataclass(frozen=True)
class Form:
    """A form of btq.

    Attributes:
        name: of its kind, `interpreted` or `compiled`, after the commit if that is another.
        package: the folder that holds `btq_lang`.
    """

    name: str
    package: Path

    def start(self) -> Worker:
        """A worker, which is sure to run this form and no other."""
        started = Worker(worker("with_btq"), self.package)
        kind = self.name.split()[-1]
        if (started.hello.get("form"), started.hello.get("package")) != (kind, str(self.package.resolve())):
            started.close()
            raise SystemExit(f"{self.name}: expected it {kind} in {self.package}, found {started.hello}")
        return started


def forms(checkout: Path, folder: Path, compiled: bool) -> list[Form]:
    """The forms of a checkout; what is compiled goes into a folder."""
    made = [Form("interpreted", checkout)]
    if compiled:
        progress("btq is being compiled")
        target = folder / "compiled"
        install(checkout, target, {"BTQ_COMPILE": "1"})
        made.append(Form("compiled", target))
    return made


def install(checkout: Path, target: Path, environment: dict[str, str]) -> None:
    """Install btq as its wheel is made, without what it depends on: the parser needs nothing."""
    command = (sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", str(target), str(checkout))
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ | environment)
    if done.returncode:
        raise SystemExit(f"btq cannot be installed from {checkout}:\n{done.stdout}{done.stderr}")


@contextmanager
def checkout_of(commit: str, folder: Path) -> Iterator[Path]:
    """A checkout of another commit, as long as it is needed."""
    path = folder / "checkout"
    _git("worktree", "add", "--quiet", "--detach", str(path), commit)
    try:
        yield path
    finally:
        _git("worktree", "remove", "--force", str(path))


def _git(*arguments: str) -> None:
    done = subprocess.run(("git", "-C", str(ROOT), *arguments), capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"`git {' '.join(arguments)}` failed: {done.stderr.strip()}")
