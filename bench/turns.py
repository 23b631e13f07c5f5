"""Parsers in processes of their own (worker.py), which take turns: a parse each, so a busy minute hits all of them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, TypeVar

HERE = Path(__file__).parent
ROOT = HERE.parent

Memory = Literal["traced", "resident"]
T = TypeVar("T")


def worker(module: str) -> tuple[str, ...]:
    """The command of the worker that runs a module of `parsers/`."""
    return (sys.executable, str(HERE / "worker.py"), module)


class Worker:
    """A worker process, asked by lines and answering by lines; `hello` is its first answer.

    Args:
        command: starts it.
        package: the folder that it imports btq from.
    """

    def __init__(self, command: Sequence[str], package: Path = ROOT) -> None:
        self._process: subprocess.Popen[str] | None = None
        environment = os.environ | {"PYTHONPATH": str(package)}
        try:
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
            )
        except FileNotFoundError:
            self.hello: dict[str, str] = {"missing": f"`{command[0]}` is not installed"}
        else:
            self.hello = self._read()

    def time(self, path: Path, nodes: int, repeat: int = 1) -> list[float]:
        """Seconds of each parse of a file, or of all files of a folder, which have so many nodes."""
        seconds: list[float] = self._ask({"do": "time", "path": str(path), "repeat": repeat}, nodes)["seconds"]
        return seconds

    def peak(self, how: Memory, path: Path, nodes: int) -> int:
        """The peak of one parse in bytes."""
        peak: int = self._ask({"do": how, "path": str(path)}, nodes)["bytes"]
        return peak

    def close(self) -> None:
        if self._process is not None:
            self._process.communicate()

    def _ask(self, request: dict[str, object], nodes: int) -> dict[str, Any]:
        assert self._process is not None
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        answer = self._read()
        if answer["nodes"] != nodes:
            raise SystemExit(
                f"{self._process.args!r} found {answer['nodes']} nodes in {request['path']}, which has {nodes}"
            )
        return answer

    def _read(self) -> dict[str, Any]:
        assert self._process is not None
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise SystemExit(f"{self._process.args!r} ended without an answer")
        answer: dict[str, Any] = json.loads(line)
        return answer


def rotated(takers: Sequence[T], turn: int) -> list[T]:
    """In the order of a round: another one begins each time."""
    start = turn % len(takers)
    return [*takers[start:], *takers[:start]]


def progress(text: str) -> None:
    """Shows what is measured, where somebody watches."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


def row(*cells: str) -> str:
    """A row of a table in Markdown."""
    return f"| {' | '.join(cells)} |"


def rounded(value: float) -> str:
    """Three figures: the machine vouches for no more."""
    return f"{int(float(f'{value:.3g}')):,}"
