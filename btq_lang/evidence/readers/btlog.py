"""`.btlog`, the file of BehaviorTree.CPP's FileLogger2: the tree as XML, then nine bytes a status change.

One invariant: sizes in the file are checked before they are used, and of a file truncated anywhere all complete records
are read.  No content of a file beside it affects that.

`<name>.bb.jsonl` beside `<name>.btlog` holds the blackboard as klein records it from a running robot: a header, then a
line for each change in order of time: µs since the header's time, the blackboard, the entry, and its value or its
removal.  A line that cannot be read is skipped and counted.

Sources: src/loggers/bt_file_logger_v2.cpp; `export_blackboard` in klein/btlog.py of johanubbink/klein-bt.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from struct import Struct
from typing import Any, BinaryIO, Final

from btq_lang.evidence.model import LogSession, SampleSeries, Transition, by_entry, is_sample
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
        remaining = size - _HEAD.size
        if not 0 <= length <= remaining - _START.size:
            raise NotALog(f"its tree and start should take {length} and {_START.size} bytes, and {remaining} are left")
        tree = read_tree(file.read(length))
        (start,) = _START.unpack(file.read(_START.size))
        session = LogSession(tree, _transitions(file, start), *_blackboard(path))
        if rest := (remaining - length - _START.size) % _RECORD.size:
            session.remarks.append(f"cut off: the last {rest} bytes are not a whole transition and are left out")
        yield session


def _transitions(file: BinaryIO, start: int) -> Iterator[Transition]:
    while block := file.read(_RECORD.size * _RECORDS_AT_ONCE):
        whole = len(block) - len(block) % _RECORD.size
        for low, high, uid, status in _RECORD.iter_unpack(block[:whole]):
            yield start + low + (high << 32), uid, status


def _blackboard(log: str) -> tuple[dict[str, SampleSeries], list[str]]:
    """The samples beside a log by entry, and notes about them; both empty without such a file."""
    path = f"{os.path.splitext(log)[0]}{_BLACKBOARD_SUFFIX}"
    name = os.path.basename(path)
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            header = _object(file.readline())
            if header is None or header.get("klein_blackboard") != _BLACKBOARD_VERSION:
                return {}, [f"{name}: expected a first line with `klein_blackboard` {_BLACKBOARD_VERSION}; left out"]
            start = _time(header.get("first_timestamp"))
            if start is None:
                return {}, [f"{name}: expected `first_timestamp` in the first line; left out"]
            boards: dict[str, dict[str, SampleSeries]] = {}
            malformed = 0
            for line in file:
                malformed += not _add(boards, _object(line), start)
    except FileNotFoundError:
        return {}, []
    except OSError as error:
        return {}, [f"{name}: cannot be read: {error.strerror or error}; left out"]
    remarks = [f"{name}: lines that cannot be read, left out: {malformed}"] if malformed else []
    main = header.get("tree_id")
    return by_entry(boards, main if isinstance(main, str) else None), remarks


def _add(boards: dict[str, dict[str, SampleSeries]], line: dict[str, Any] | None, start: int) -> bool:
    """Add the sample of a line, if it is one; returns whether the line could be read."""
    if line is None:
        return False
    time, board, key = _time(line.get("t")), line.get("board"), line.get("key")
    if not (time is not None and isinstance(board, str) and isinstance(key, str)):
        return False
    is_removed = line.get("removed") is True
    if is_removed or is_sample(line.get("value")):
        series = boards.setdefault(board, {}).setdefault(key, SampleSeries())
        series.add(start + time, None if is_removed else line["value"])
    return is_removed or "value" in line


def _object(line: str) -> dict[str, Any] | None:
    try:
        value = json.loads(line)
    except (ValueError, RecursionError):
        return None
    return value if isinstance(value, dict) else None


def _time(value: object) -> int | None:
    if isinstance(value, bool) or not isinstance(value, int) or abs(value) > _LATEST:
        return None
    return value


_VERSION: Final = 1
_HEAD: Final = Struct("<18sBi")  # magic, version, length of the tree
_START: Final = Struct("<q")  # µs since the epoch
_RECORD: Final = Struct("<IHHB")  # µs since the start in 48 bits, uid, status
_RECORDS_AT_ONCE: Final = 4096
_BLACKBOARD_SUFFIX: Final = ".bb.jsonl"
_BLACKBOARD_VERSION: Final = 1
_LATEST: Final = 1 << 61  # µs
