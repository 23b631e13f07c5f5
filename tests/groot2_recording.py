"""Requests to a publisher and its replies, recorded once from the real one: `recordings/groot2-*.json`.

`pytest --update tests/engine/test_engine_live.py` writes them, with an engine that has its publisher.
"""

from __future__ import annotations

import json
import re
import struct
from collections.abc import Callable, Sequence
from pathlib import Path

import msgpack

RECORDINGS = Path(__file__).parent / "recordings"
BEFORE = ([b"\2T\1\0\0\0"], [b"\2S\2\0\0\0"], [b"\2B\3\0\0\0", b"Main;Part::4;None"], [b"\2r\4\0\0\0", b"start"])
AFTER = (
    [b"\2t\5\0\0\0"],
    [b"\2S\6\0\0\0"],
    [b"\2B\7\0\0\0", b"Main;Part::4;None"],
    [b"\2t\x08\0\0\0"],
    [b"short"],
    [b"\2Z\x09\0\0\0"],
    [b"\2B\x0a\0\0\0"],
    [b"\2r\x0b\0\0\0"],
    [b"\2r\x0c\0\0\0", b"stop"],
)
Exchange = tuple[list[bytes], list[bytes]]


def exchanges(ask: Callable[[list[bytes]], list[bytes]], run: Callable[[], object]) -> list[Exchange]:
    """What is asked and replied before and after a run; of the tree, without the models of the engine's own nodes."""
    found = [(request, ask(request)) for request in BEFORE]
    _, (head, xml) = found[0]
    found[0] = BEFORE[0], [head, re.sub(rb"\s*<TreeNodesModel>.*</TreeNodesModel>", b"", xml, flags=re.DOTALL)]
    run()
    return found + [(request, ask(request)) for request in AFTER]


def write(path: Path, found: Sequence[Exchange]) -> None:
    """Keep exchanges."""
    texts = [[[part.decode("latin-1") for part in parts] for parts in each] for each in found]
    path.write_text(json.dumps(texts, indent=1) + "\n", encoding="utf-8")


def read(path: Path) -> list[Exchange]:
    """The exchanges that were kept."""
    texts = json.loads(path.read_text(encoding="utf-8"))
    encoded = [[[part.encode("latin-1") for part in parts] for parts in each] for each in texts]
    return [(request, reply) for request, reply in encoded]


def meaning(found: Sequence[Exchange]) -> list[object]:
    """The replies without what differs from one publisher, and from one moment, to the next."""
    return [_meaning(request[0], reply) for request, reply in found]


def _meaning(asked: bytes, reply: list[bytes]) -> object:
    head, *content = reply
    if head == b"error":
        return [part.decode() for part in reply]
    assert len(head) == 22
    kind = chr(asked[1])
    if kind == "T":
        return head[:6], content
    if kind == "S":
        return head[:6], sorted(struct.iter_unpack("<HB", content[0]))
    if kind == "B":
        return head[:6], msgpack.unpackb(content[0])
    if kind == "t":
        return head[:6], [(uid, status) for _, uid, status in struct.iter_unpack("<6sHB", content[0])]
    return head[:6], [part.isdigit() for part in content]
