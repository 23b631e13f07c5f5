"""Asks a Groot2Publisher through pyzmq, which only this module imports.

One invariant: `ask` returns or raises within a few seconds, and after either it may be called again.
"""

from __future__ import annotations

import random
import socket
from collections.abc import Callable
from contextlib import suppress
from importlib.util import find_spec
from time import monotonic
from typing import Any, Final
from urllib.parse import urlsplit

from btq_lang.evidence.readers.groot2.messages import Reply, reply, request
from btq_lang.evidence.readers.tree import NotALog


class NoLive(Exception):
    """pyzmq or msgpack is missing; the message says how to get them."""


class NoAnswer(Exception):
    """The publisher does not answer."""


class NotAPublisher(NotALog):
    """Something else listens at the address; the message says what came."""


def check_installed() -> None:
    """Check that the packages that read a running robot are installed.

    Raises:
        NoLive: it is not.
    """
    if find_spec("zmq") is None or find_spec("msgpack") is None:
        raise NoLive("a running robot is read with pyzmq; install it with pip install 'btq-lang[live]'")


class Publisher:
    """A publisher at an address, which may come and go."""

    def __init__(self, address: str, is_over: Callable[[], bool]) -> None:
        """
        Args:
            address: as in `tcp://127.0.0.1:1667`.
            is_over: whether nothing more will be asked, so that waiting for an answer is in vain.
        """
        import zmq

        self._address: Final = address
        self._is_over: Final = is_over
        self._zmq: Final = zmq
        self._context: Final = zmq.Context()
        self._socket: Any = None
        self._has_answered = False
        self._silences = 0  # requests that something heard and did not answer

    def ask(self, kind: str, argument: str | None = None) -> Reply:
        """The reply to a request.

        Raises:
            NoAnswer: none came in time.
            NotAPublisher: no publisher has ever replied, and something else has.
            BadReply: as `messages.reply`.
        """
        if self._socket is None:
            self._socket = self._context.socket(self._zmq.REQ)
            self._socket.setsockopt(self._zmq.LINGER, 0)
            self._socket.setsockopt(self._zmq.MAXMSGSIZE, MOST)
            self._socket.connect(self._address)
        parts = request(kind, random.getrandbits(32), argument)
        try:
            self._socket.send_multipart(parts, self._zmq.NOBLOCK)
            self._wait()
            answer = self._socket.recv_multipart(self._zmq.NOBLOCK)
        except self._zmq.ZMQError as error:
            self._forget()
            if not (self._has_answered or self._is_over()):
                self._look_who_is_there()
            raise NoAnswer from error
        self._has_answered = True
        return reply(answer, parts[0])

    def close(self) -> None:
        """Ask nothing more."""
        self._forget()
        self._context.term()

    def _wait(self) -> None:
        """Wait until a reply is there, or for as long as one may take."""
        patience = _PATIENCE
        begin = monotonic()
        while not self._socket.poll(_SLICE):
            if self._is_over():
                patience = _LAST_PATIENCE
            if monotonic() - begin > patience:
                return

    def _look_who_is_there(self) -> None:
        """Find out, by a new connection, what it is that does not answer."""
        greeting = _greeted(self._address)
        if greeting is None:
            self._silences = 0
            return
        self._silences += 1
        if greeting and not (greeting[:1] == _SIGNATURE[:1] and greeting[9:10] == _SIGNATURE[9:]):
            line = greeting.splitlines()[0].decode("utf-8", "replace")
            raise NotAPublisher(f"{_EXPECTED}, found something else, which says {line!r}")
        if self._silences > 1:
            listener = "a ZeroMQ socket of another type" if greeting else "something"
            raise NotAPublisher(f"{_EXPECTED}, found {listener} that does not answer; {_OTHER_PORTS}")

    def _forget(self) -> None:
        """Drop the socket: one that waits for a reply cannot ask again."""
        with suppress(self._zmq.ZMQError):
            if self._socket is not None:
                self._socket.close()
        self._socket = None


def _greeted(address: str) -> bytes | None:
    """What comes from an address after ZeroMQ's greeting and an empty line, empty if nothing does; None if it takes no
    connection, or ends it, as a tunnel does to a robot on which nothing runs yet.
    """
    parts = urlsplit(address)
    try:
        with socket.create_connection((parts.hostname or "", parts.port or 0), _GREETING) as connection:
            connection.sendall(_SIGNATURE + b"\r\n\r\n")
            try:
                return connection.recv(_SHOWN) or None
            except TimeoutError:
                return b""
    except OSError:
        return None


MOST: Final = 1 << 24  # bytes of a part of a reply; larger ones end the connection
_SLICE: Final = 100  # ms between two looks at whether to go on waiting
_PATIENCE: Final = 2.0  # s
_LAST_PATIENCE: Final = 0.3  # s, when nothing more will be asked
_SIGNATURE: Final = b"\xff\0\0\0\0\0\0\0\1\x7f"  # the first bytes that a ZeroMQ socket sends
_EXPECTED: Final = "expected a Groot2Publisher of BehaviorTree.CPP 4"
_OTHER_PORTS: Final = "Groot2Publisher has the port 1667 unless the program names another one"
_SHOWN: Final = 60  # bytes
_GREETING: Final = 1.0  # s
