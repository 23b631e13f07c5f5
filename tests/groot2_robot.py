"""A robot that speaks as BehaviorTree.CPP's Groot2Publisher does, with a tree whose nodes change as a test says.

`evidence/readers/test_groot2_recording.py` holds its replies against those of the real one.
"""

from __future__ import annotations

import secrets
import struct
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any
from xml.etree import ElementTree

import msgpack
import zmq
from evidence_logs import rows

KEPT = 1000  # transitions; the publisher drops older ones


class Publisher:
    """What a publisher replies, without a network.

    Attributes:
        boards: what is on each blackboard.
        id: of the publisher.
        asked: the types of the requests so far.
    """

    def __init__(
        self,
        xml: str,
        boards: dict[str, Any] | None = None,
        clock: Callable[[], int] = lambda: time.time_ns() // 1000,
    ) -> None:
        """
        Args:
            clock: the robot's, in µs since the epoch.
        """
        self.xml = xml
        self.boards = boards if boards is not None else {}
        self.id = secrets.token_bytes(16)
        self.asked: list[str] = []
        self.clock = clock
        uids = [int(node.attrib["_uid"]) for node in ElementTree.fromstring(xml).iter() if "_uid" in node.attrib]
        self._published = dict.fromkeys(sorted(uids), 0)  # 10 + the status before, for a node that has become idle
        self._kept: deque[bytes] = deque(maxlen=KEPT)
        self._began: int | None = None
        self._lock = threading.Lock()

    def change(self, uid: int, status: int, at: int | None = None) -> None:
        """Change the status of a node.

        Args:
            at: the time that is published; None: now.
        """
        with self._lock:
            self._published[uid] = status or 10 + self._published[uid]
            if self._began is not None:
                since = (self.clock() if at is None else at) - self._began
                self._kept.append((since % (1 << 48)).to_bytes(6, "little") + struct.pack("<HB", uid, status))

    def drain(self) -> None:
        """Take the transitions, as another program may."""
        self.answer([b"\2t\0\0\0\0"])

    def answer(self, parts: Sequence[bytes]) -> list[bytes]:
        """The reply to a request."""
        if len(parts[0]) != 6:
            return [b"error", b"wrong request header"]
        kind = chr(parts[0][1])
        head = b"\2" + parts[0][1:] + self.id
        if kind in "Br" and len(parts) != 2:
            return [b"error", b"must be 2 parts message"]
        with self._lock:
            self.asked.append(kind)
            if kind == "T":
                return [head, self.xml.encode()]
            if kind == "S":
                return [head, b"".join(struct.pack("<HB", *each) for each in self._published.items())]
            if kind == "B":
                names = [*parts[1].decode().split(";"), "ROOT"]  # the root's, if there is one, is never asked for
                found = {name: self.boards[name] for name in names if name in self.boards}
                return [head, msgpack.packb(found or None)]
            if kind == "r":
                self._began = self.clock() if parts[1] == b"start" else None
                if self._began is None:
                    return [head]
                self._kept.clear()
                return [head, str(self._began).encode()]
            if kind == "t":
                content = b"".join(self._kept)
                self._kept.clear()
                return [head, content]
        return [b"error", b"Request not recognized"]


class Robot(Publisher):
    """A publisher on this machine.

    Attributes:
        is_gone: it publishes no more.
    """

    def __init__(self, xml: str, boards: dict[str, Any] | None = None, port: int = 0) -> None:
        """
        Args:
            port: where it publishes; 0: at any that is free.
        """
        super().__init__(xml, boards)
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.REP)
        self._socket.setsockopt(zmq.LINGER, 0)
        self._socket.bind(f"tcp://127.0.0.1:{port or '*'}")
        self.address = self._socket.getsockopt_string(zmq.LAST_ENDPOINT).rstrip("\0")
        self.port = int(self.address.rpartition(":")[2])
        self.is_gone = False
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def __enter__(self) -> Robot:
        return self

    def __exit__(self, *_: object) -> None:
        self.is_gone = True
        self._thread.join()
        self._socket.close()
        self._context.term()

    def play(self, *texts: str) -> None:
        """Change statuses, as `evidence_logs.rows` reads them, at these times, and publish exactly these."""
        for text in texts:
            begin = self.clock()
            for at, uid, status in rows(text):
                time.sleep(max(0, begin + at - self.clock()) / 1e6)
                self.change(uid, status, begin + at)

    def wait_for(self, *kinds: str) -> None:
        """Wait until requests of these types have come, one after the other."""
        at = len(self.asked)
        end = time.monotonic() + 20
        for kind in kinds:
            while kind not in self.asked[at:]:
                assert time.monotonic() < end, f"no request {kind}"
                time.sleep(0.005)
            at = self.asked.index(kind, at) + 1

    def _serve(self) -> None:
        while not self.is_gone:
            if self._socket.poll(20):
                self._socket.send_multipart(self.answer(self._socket.recv_multipart()))
