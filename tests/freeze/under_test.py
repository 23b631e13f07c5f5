"""The process that runs `btq`, or is `btq-lsp`: all that touches the code under test.  It runs under any Python.

    PYTHON under_test.py btq [TREE]        reads lists of cases, a line of JSON each, and answers with a line a case
    PYTHON under_test.py btq-lsp [TREE]    becomes the language server

The two programs are found as the installed project names them, or the checkout TREE does.  Each list of cases is run in
a process of its own, forked where the programs are imported already; each command as a shell would run it, with a
working directory, arguments, standard input, and whatever it writes taken down.
"""

from __future__ import annotations

import base64
import hashlib
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Iterator
from importlib import import_module, metadata
from pathlib import Path
from typing import Any

import logs

MOST_SECONDS = 120  # for a case
IN_MEMORY = "/dev/shm"  # there a file that is written is not waited for
GIT = {
    **{f"GIT_{who}_{what}": "btq@example.org" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")},
    **{f"GIT_{who}_DATE": "2026-11-20T21:22:20Z" for who in ("AUTHOR", "COMMITTER")},
    "GIT_CONFIG_GLOBAL": os.devnull,
    "GIT_CONFIG_SYSTEM": os.devnull,
}


def program(name: str, tree: str | None) -> Any:
    """The function that a console script calls."""
    if tree is None:
        (found,) = (each.value for each in metadata.entry_points(group="console_scripts") if each.name == name)
    else:
        sys.path.insert(0, tree)
        scripts = Path(tree, "pyproject.toml").read_text(encoding="utf-8").partition("[project.scripts]")[2]
        found = re.findall(rf'^{name} = "(.*)"$', scripts, re.MULTILINE)[0]
    module, _, function = found.partition(":")
    imported = import_module(module)
    where = os.path.realpath(imported.__file__ or "")
    if tree is not None and not where.startswith(os.path.realpath(tree) + os.sep):
        sys.exit(f"{name} was imported from {where}, not from {tree}")
    return getattr(imported, function)


class Ended(BaseException):
    """The program under test has ended."""


class Command:
    """`btq`, run again and again in this process."""

    def __init__(self, tree: str | None) -> None:
        self.leave = os._exit
        os._exit = self._end
        self._process = os.getpid()
        self._program = program("btq", tree)
        out = self.run(["--version"], "")[1]
        self.version = out.split()[-1]

    def _end(self, code: int) -> None:
        if os.getpid() != self._process:  # of a process that the program has started
            self.leave(code)
        raise Ended(code)

    def forked(self) -> None:
        """This is another process now."""
        self._process = os.getpid()

    def run(self, arguments: list[str], stdin: str) -> tuple[object, str, str]:
        """The exit code, and what was written to standard output and standard error."""
        before = sys.stdin, sys.stdout, sys.stderr, sys.argv
        out, err = io.BytesIO(), io.BytesIO()
        sys.stdin = io.TextIOWrapper(io.BytesIO(stdin.encode("utf-8", "surrogateescape")), encoding="utf-8")
        sys.stdout = io.TextIOWrapper(out, encoding="utf-8", errors="backslashreplace", newline="\n")
        sys.stderr = io.TextIOWrapper(err, encoding="utf-8", errors="backslashreplace", newline="\n")
        sys.argv = ["btq", *arguments]
        code: object = None
        try:
            code = self._program()
        except (Ended, SystemExit) as end:
            code = end.args[0] if end.args else None
        finally:
            streams = sys.stdout, sys.stderr
            sys.stdin, sys.stdout, sys.stderr, sys.argv = before
            for stream in streams:
                if not stream.closed:
                    stream.flush()
            written = [stream.getvalue().decode("utf-8", "backslashreplace") for stream in (out, err)]
        return code or 0, *written


def transcript(command: Command, case: dict[str, Any], folder: str) -> str:
    """What a case does: each command with its exit code, its output and the files that it has changed."""
    os.makedirs(folder)
    for name, content in case["files"].items():
        path = Path(folder, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(base64.b64decode(content[1:]) if content[:1] == "\0" else content.encode("utf-8"))
    os.chdir(folder)
    known = _contents(folder)
    said: list[str] = []
    for step in case["steps"]:
        words, stdin, needed = step["words"], step.get("stdin", ""), step.get("needs")
        if needed is not None and not os.path.exists(needed):
            continue
        if words[:1] == ["git"]:
            subprocess.run(["git", *words[1:]], check=True, capture_output=True, env={**os.environ, **GIT})
            continue
        if words[:1] == ["log"]:
            logs.write(words[1], Path(folder))
            known = _contents(folder)
            continue
        said.append(f"$ btq {' '.join(words)}\n")
        code, out, err = command.run(words, stdin)
        said.append(f"{out}{'' if out[-1:] in ('', chr(10)) else '<no line end>' + chr(10)}")
        said += [f"! {line}\n" for line in err.splitlines()]
        said.append(f"exit code {code}\n")
        now = _contents(folder)
        for name in sorted({*known, *now}):
            if known.get(name) != now.get(name):
                content = now.get(name)
                said.append(f"-- {name}{' is gone' if content is None else ':'}\n")
                said.append((content or b"").decode("utf-8", "backslashreplace"))
                said.append("\n")
        known = now
    os.chdir(os.path.dirname(folder))
    shutil.rmtree(folder)
    return normalized("".join(said), folder, command.version)


def normalized(text: str, folder: str, version: str) -> str:
    """A text without what is another one in every run: the folder, the version of btq, and the words of a failure."""
    text = text.replace(folder, "/case")
    text = re.sub(rf"(?<![\w.]){re.escape(version)}(?![\w.])", "VERSION", text)
    text = re.sub(r"file://[^\s\"]*/rules/", "file:///rules/", text)
    return re.sub(r"internal error: (\w+).*", r"internal error: \1", text)


def digest(text: str) -> str:
    """Four characters for a text."""
    return base64.urlsafe_b64encode(hashlib.sha256(text.encode("utf-8", "surrogatepass")).digest())[:4].decode()


def _contents(folder: str) -> dict[str, bytes]:
    found = {}
    for above, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if name != ".git"]
        for name in files:
            path = os.path.join(above, name)
            found[os.path.relpath(path, folder)] = Path(path).read_bytes()
    return found


def settle() -> None:
    """An environment that is the same everywhere."""
    for name in [*os.environ]:
        if name.startswith(("GITHUB_", "BTQ_", "AMENT_", "ROS_", "XDG_")) or name in ("NO_COLOR", "FORCE_COLOR", "CI"):
            del os.environ[name]
    os.environ |= {"COLUMNS": "100", "LINES": "40", "TZ": "UTC", "LC_ALL": "C.UTF-8", "LANGUAGE": "C", "TERM": "dumb"}
    time.tzset()


def answers(command: Command, asked: dict[str, Any], room: str) -> Iterator[str]:
    """The transcript of each case, or its digest."""
    for number, case in enumerate(asked["cases"]):
        signal.alarm(MOST_SECONDS)  # ends this process
        text = transcript(command, case, f"{room}/{number:04}")
        yield text if asked["shows"] else digest(text)


def serve(command: Command) -> None:
    """Answer each list of cases: a line for each, and `null` at the end, which comes early where the process died."""
    lines, output = os.fdopen(os.dup(0), encoding="utf-8"), os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)  # nothing that is printed may get between the answers
    room = os.path.realpath(tempfile.mkdtemp(dir=IN_MEMORY if os.path.isdir(IN_MEMORY) else None))
    os.environ["HOME"] = room
    try:
        for line in lines:
            child = os.fork()
            if child == 0:
                command.forked()
                try:
                    for answer in answers(command, json.loads(line), room):
                        print(json.dumps(answer), file=output, flush=True)
                    command.leave(0)
                finally:
                    traceback.print_exc()
                    command.leave(1)
            os.waitpid(child, 0)
            for left in os.listdir(room):
                shutil.rmtree(os.path.join(room, left))
            print("null", file=output, flush=True)
    finally:
        shutil.rmtree(room)


WARMING = """include "b.btq"
signal battery : % from {battery} initially 3 %
QualityReq rq1 : performance-efficiency.time-behaviour
    takes at most 30 s
    keeps battery > 2 %
    on violation halt
Root Main
BehaviorTree Main
    -> A
        Timeout (msec = 3 s)
            Moev (to = {x}) satisfies rq1
        Script (code = "x := 1")
        SubTree B
"""


def warm_up(command: Command) -> None:
    """Run most commands once, so that what they import is there."""
    files = {"a.btq": WARMING, "b.btq": "BehaviorTree B\n    Move\n"}
    lines = [
        *(
            "check a.btq",
            "check --output-format json a.btq",
            "build --bundle a.btq",
            "import a.xml -o c",
            "trace a.btq",
        ),
        *("diff a.btq a.xml", "graph a.btq", "check --output-format sarif a.btq", "format --diff a.btq", "build a.btq"),
    ]
    with tempfile.TemporaryDirectory() as room:
        steps = [{"words": line.split()} for line in lines]
        transcript(command, {"files": files, "steps": steps}, os.path.join(os.path.realpath(room), "warm"))


def main() -> None:
    settle()
    name, tree = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
    if name == "btq-lsp":
        found = program(name, tree)
        sys.argv = [name]
        sys.exit(found())
    command = Command(tree)
    warm_up(command)
    serve(command)


if __name__ == "__main__":
    main()
