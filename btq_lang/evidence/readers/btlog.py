"""`.btlog`, the file of BehaviorTree.CPP's FileLogger2: the tree as XML, then nine bytes a status change.

One invariant: sizes in the file are checked before they are used, and of a file truncated anywhere all complete records
are read.

Source: src/loggers/bt_file_logger_v2.cpp.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from struct import Struct
from typing import BinaryIO, Final

from btq_lang.evidence.model import LogSession, Transition
from btq_lang.evidence.readers import klein
from btq_lang.evidence.readers.tree import NotALog, read_tree

MAGIC: Final = b"BTCPP4-FileLogger2"


def read(path: str) -> Iterator[LogSession]:
    """The one session of a file.

    Raises:
        NotALog: it has another format or version, or ends before its tree does.
        OSError: it cannot be read.
    """
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        head = file.read(_HEAD.size)
        if not head.startswith(MAGIC):
            raise NotALog(f"expected a file that begins with {MAGIC.decode()}, as FileLogger2 writes it")
        if len(head) < _HEAD.size:
            raise NotALog("the file ends before its tree")
        _, version, length = _HEAD.unpack(head)
        if version != _VERSION:
            raise NotALog(f"version {version} of the format; btq reads version {_VERSION}")
        left = size - _HEAD.size
        if not 0 <= length <= left - _START.size:
            raise NotALog(f"its tree and start should take {length} and {_START.size} bytes, and {left} are left")
        tree = read_tree(file.read(length))
        (start,) = _START.unpack(file.read(_START.size))
        session = LogSession(tree, _transitions(file, start), *klein.read(path))
        if rest := (left - length - _START.size) % _RECORD.size:
            session.remarks.append(f"cut off: the last {rest} bytes are not a whole transition and are left out")
        yield session


def _transitions(file: BinaryIO, start: int) -> Iterator[Transition]:
    while block := file.read(_RECORD.size * _RECORDS_AT_ONCE):
        whole = len(block) - len(block) % _RECORD.size
        for low, high, uid, status in _RECORD.iter_unpack(block[:whole]):
            yield start + low + (high << 32), uid, status


_VERSION: Final = 1
_HEAD: Final = Struct("<18sBi")  # magic, version, length of the tree
_START: Final = Struct("<q")  # µs since the epoch
_RECORD: Final = Struct("<IHHB")  # µs since the start in 48 bits, uid, status
_RECORDS_AT_ONCE: Final = 4096
