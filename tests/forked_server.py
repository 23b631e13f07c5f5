"""Servers that are forked from a process which has imported the server already, for that takes longer than most tests.

A forked server is a process of its own, with its own standard input and output, like one that an editor starts.
"""

from __future__ import annotations

import atexit
import os
import select
import signal
import socket
import subprocess
import sys
from functools import cache
from typing import NoReturn

SERVE = "import sys; from btq_lang.server import main; sys.exit(main([]))"
LONGEST_PROGRAM = 65_536


class Forked:
    """A process that runs a Python program, with the part of `subprocess.Popen` that tests ask for."""

    def __init__(self, program: str) -> None:
        (stdin, typed), *others = (os.pipe() for _ in range(4))
        parent = _parent()
        socket.send_fds(parent, [program.encode()], [stdin, *(write for _, write in others)])
        self.pid = int(parent.recv(32))
        for end in (stdin, *(write for _, write in others)):
            os.close(end)
        self.stdin = os.fdopen(typed, "wb")
        self.stdout, self.stderr, self._ended = (os.fdopen(read, "rb") for read, _ in others)
        self.returncode: int | None = None

    def __enter__(self) -> Forked:
        return self

    def __exit__(self, *_: object) -> None:
        self._close()
        self.wait()

    def kill(self) -> None:
        if self.returncode is None:
            os.kill(self.pid, signal.SIGKILL)

    def wait(self, timeout: float | None = None) -> int:
        """The exit code as soon as the process has ended, less than 0 after a signal."""
        if self.returncode is None:
            if not select.select([self._ended], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired(SERVE, timeout or 0)
            with self._ended:
                self.returncode = int(self._ended.read())
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
            file.close()


@cache
def _parent() -> socket.socket:
    """A connection to the process that forks."""
    ours, theirs = socket.socketpair()
    process = subprocess.Popen([sys.executable, __file__], stdin=theirs)
    theirs.close()

    def end() -> None:
        ours.close()
        process.wait()

    atexit.register(end)
    return ours


def fork_on_request() -> None:
    """Fork a process for each program that comes, with the ends of its pipes, over the standard input."""
    import btq_lang.server  # noqa: F401  # what its children are to find imported

    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for those that wait for a server
    requests = socket.socket(fileno=os.dup(0))
    while True:
        program, ends, _, _ = socket.recv_fds(requests, LONGEST_PROGRAM, 4)
        if not program:
            return
        if os.fork() == 0:
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            _run_and_wait(program.decode(), ends, requests)
        for end in ends:
            os.close(end)


def _run_and_wait(program: str, ends: list[int], requests: socket.socket) -> NoReturn:
    """Fork a process that runs a program; answer who it is, and write its exit code to the last pipe."""
    child = os.fork()
    if child == 0:
        requests.close()
        os.close(ends.pop())
        for number, end in enumerate(ends):
            os.dup2(end, number)
            os.close(end)
        exec(compile(program, "<string>", "exec"), {"__name__": "__main__"})
        sys.exit()
    for end in ends[:3]:
        os.close(end)
    requests.send(str(child).encode())
    os.write(ends[3], str(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])).encode())
    os._exit(0)


if __name__ == "__main__":
    fork_on_request()
