"""Servers that are forked from a process which has imported the server already, for that takes longer than most tests.

A forked server is a process of its own, with its own standard input and output, like one that an editor starts.  An
editor that starts its server itself is given `relay()` as the command.
"""

from __future__ import annotations

import atexit
import os
import select
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from typing import NoReturn

_LONGEST_PROGRAM = 65_536
_DIGITS = 10  # of a number that is answered
_found: list[str] = []  # where the process that forks is asked, once it is there


def serve(*arguments: str) -> str:
    """The program that is the server, with these arguments."""
    return f"import sys; from btq_lang.server import main; sys.exit(main({arguments!r}))"


class Forked:
    """A process that runs a Python program, with the part of `subprocess.Popen` that tests ask for."""

    def __init__(self, program: str) -> None:
        (stdin, write), (read, stdout), (read_errors, stderr) = os.pipe(), os.pipe(), os.pipe()
        self._answers, self.pid = _fork(_place(), program, [stdin, stdout, stderr])
        for end in (stdin, stdout, stderr):
            os.close(end)
        self.stdin = os.fdopen(write, "wb")
        self.stdout, self.stderr = os.fdopen(read, "rb"), os.fdopen(read_errors, "rb")
        self.returncode: int | None = None

    def __enter__(self) -> Forked:
        return self

    def __exit__(self, *_: object) -> None:
        self._close()
        self.wait()

    def kill(self) -> None:
        if self.returncode is None:
            with suppress(ProcessLookupError):  # it has ended by itself
                os.kill(self.pid, signal.SIGKILL)

    def wait(self, timeout: float | None = None) -> int:
        """The exit code as soon as the process has ended, less than 0 after a signal."""
        if self.returncode is None:
            if not select.select([self._answers], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired("the server", timeout or 0)
            with self._answers:
                self.returncode = _number(self._answers)
        return self.returncode

    def communicate(self, timeout: float | None = None) -> tuple[bytes, bytes]:
        """What is left of its output, no more than a pipe holds, when its input is closed and it has ended."""
        self.stdin.close()
        self.wait(timeout)
        written = self.stdout.read(), self.stderr.read()
        self._close()
        return written

    def _close(self) -> None:
        for file in (self.stdin, self.stdout, self.stderr):
            with suppress(BrokenPipeError):  # what it has not read any more
                file.close()


def relay() -> list[str]:
    """A command that is a server: a forked one takes over its standard input and output, and its folder."""
    return [sys.executable, "-S", "-E", __file__, _place()]


def _fork(place: str, program: str, files: list[int]) -> tuple[socket.socket, int]:
    """Have a program run with these standard files; where its exit code will be read, and its process."""
    answers = socket.socket(socket.AF_UNIX)
    answers.connect(place)
    socket.send_fds(answers, [program.encode()], files)
    return answers, _number(answers)


def _number(answers: socket.socket) -> int:
    return int(answers.recv(_DIGITS, socket.MSG_WAITALL))


def _place() -> str:
    """Start the process that forks, if it is not there; it ends when this one does."""
    if not _found:
        import tempfile  # not where this module is a relay, which is to start at once

        folder = tempfile.TemporaryDirectory(prefix="btq-")
        place = os.path.join(folder.name, "fork")
        with socket.socket(socket.AF_UNIX) as listening:
            listening.bind(place)
            listening.listen()
            command = [sys.executable, __file__, "--listen", str(listening.fileno())]
            process = subprocess.Popen(command, stdin=subprocess.PIPE, pass_fds=[listening.fileno()])
        atexit.register(folder.cleanup)
        atexit.register(process.communicate)
        _found.append(place)
    return _found[0]


def _listen(listening: socket.socket) -> None:
    """Fork a process for each program that is sent with its files, until the standard input ends."""
    from btq_lang.server import make_server

    _ = make_server().session  # what is forked finds all imported, and the types of messages resolved

    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for those that wait for a server
    awaited: list[socket.socket | int] = [listening, 0]
    while listening in select.select(awaited, [], [])[0]:
        answers, _ = listening.accept()
        if os.fork() == 0:
            listening.close()
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            _run_and_wait(answers)
        answers.close()


def _run_and_wait(answers: socket.socket) -> NoReturn:
    """Fork a process that runs a program; answer which it is, and its exit code when it has ended."""
    program, files, _, _ = socket.recv_fds(answers, _LONGEST_PROGRAM, 3)
    child = os.fork()
    if child == 0:
        answers.close()
        for number, file in enumerate(files):
            os.dup2(file, number)
            os.close(file)
        exec(compile(program, "<string>", "exec"), {"__name__": "__main__"})
        sys.exit()
    for file in (0, *files):
        os.close(file)
    answers.send(b"%*d" % (_DIGITS, child))
    answers.send(b"%*d" % (_DIGITS, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])))
    os._exit(0)


def _be_served(place: str, arguments: list[str]) -> int:
    program = f"import os; os.chdir({os.getcwd()!r})\n{serve(*arguments)}"
    answers, _ = _fork(place, program, [0, 1, 2])
    for file in (0, 1):
        os.close(file)  # who closes the other end is to see the server's alone
    return _number(answers)


if __name__ == "__main__":
    if sys.argv[1] == "--listen":
        _listen(socket.socket(fileno=int(sys.argv[2])))
    else:
        sys.exit(_be_served(sys.argv[1], sys.argv[2:]))
