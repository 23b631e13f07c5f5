"""The processes that hold the code under test, and the code of the frozen commit to run in one."""

from __future__ import annotations

import io
import json
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import frozen

UNDER_TEST = Path(__file__).with_name("under_test.py")
DIED = "it did not end, or its process died\n"


class Code(NamedTuple):
    """Code to run.

    Attributes:
        python: the interpreter.
        tree: the checkout that the code is taken from; None: what is installed for the interpreter.
    """

    python: str
    tree: Path | None

    def command(self, program: str) -> list[str]:
        """What starts a program of it."""
        return [self.python, str(UNDER_TEST), program, *([] if self.tree is None else [str(self.tree)])]


HERE = Code(sys.executable, frozen.ROOT)


@contextmanager
def code_of(revision: str) -> Iterator[Code]:
    """The code of a revision, in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        packed = frozen.git("archive", revision, "btq_lang", "pyproject.toml")
        with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
            archive.extractall(folder, filter="data")
        yield Code(sys.executable, Path(folder))


class Commands:
    """A process that runs the `btq` of some code."""

    def __init__(self, code: Code) -> None:
        self.code = code
        self._process = subprocess.Popen(
            code.command("btq"), stdin=subprocess.PIPE, stdout=subprocess.PIPE, encoding="utf-8"
        )

    def __enter__(self) -> Commands:
        return self

    def __exit__(self, *_: object) -> None:
        with self._process:  # closes its pipes, which ends it, and waits
            pass

    def digests(self, cases: Sequence[dict[str, Any]]) -> list[str]:
        """Four characters for what each case does."""
        return self._ask(cases, shows=False)

    def transcripts(self, cases: Sequence[dict[str, Any]]) -> list[str]:
        """What each case does."""
        return self._ask(cases, shows=True)

    def _ask(self, cases: Sequence[dict[str, Any]], shows: bool) -> list[str]:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        found: list[str] = []
        while len(found) < len(cases):
            self._process.stdin.write(json.dumps({"cases": cases[len(found) :], "shows": shows}) + "\n")
            self._process.stdin.flush()
            while (answer := json.loads(self._process.stdout.readline())) is not None:
                found.append(answer)
            if len(found) < len(cases):
                found.append(DIED if shows else "died")
        return found
