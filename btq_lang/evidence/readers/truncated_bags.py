"""Reads what is left of truncated recordings, which `rosbags` cannot open: MCAP files and rosbag2's SQLite files.

One invariant: all complete records or messages are read, and a remark says that the rest is missing.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Collection, Iterator
from contextlib import ExitStack
from io import BufferedReader, RawIOBase
from typing import TYPE_CHECKING, Any, BinaryIO, Final

from btq_lang.evidence.readers import sqlite
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from rosbags.interfaces import Connection

MCAP: Final = b"\x89MCAP0\r\n"


class BagDatabase(ExitStack):
    """A SQLite file with its topics, once it is open; it has the interface of a storage of `rosbags`."""

    def __init__(self, path: str, remarks: list[str]) -> None:
        super().__init__()
        self._path: Final = path
        self._remarks: Final = remarks
        self._database: sqlite3.Connection
        self.connections: list[Connection] = []

    def open(self) -> None:
        """Read the topics.

        Raises:
            sqlite3.Error: they cannot be read.
        """
        from rosbags.interfaces import Connection, ConnectionExtRosbag2, MessageDefinition, MessageDefinitionFormat

        database = self._database = self.enter_context(sqlite.opened(self._path, self._remarks))
        definitions = {}
        if "message_definitions" in sqlite.tables(database):
            for name, encoding, text in database.execute(
                "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions"
            ):
                kind = MessageDefinitionFormat.IDL if encoding == "ros2idl" else MessageDefinitionFormat.MSG
                definitions[name] = MessageDefinition(kind, text)
        none = MessageDefinition(MessageDefinitionFormat.NONE, "")
        for number, topic, name in database.execute("SELECT id, name, type FROM topics"):
            ext = ConnectionExtRosbag2("cdr", [])
            self.connections.append(Connection(number, topic, name, definitions.get(name, none), "", 0, ext, self))

    def messages(self, connections: Collection[Connection]) -> Iterator[tuple[Connection, int, bytes]]:
        """The messages in the order in which they were written, which is that of reception.

        Raises:
            sqlite3.Error: the next one cannot be read.
        """
        by_id = {connection.id: connection for connection in connections}
        for topic, received, data in self._database.execute(
            "SELECT topic_id, timestamp, data FROM messages ORDER BY id"
        ):
            if topic in by_id:
                yield by_id[topic], received, data


class WholeFile(Record):
    """An MCAP file for `rosbags` to open; a truncated one appears as its complete records followed by an end."""

    path: str
    remarks: list[str]

    def open(self, _: str) -> BinaryIO:
        file = open(self.path, "rb")  # noqa: SIM115  # `rosbags` closes it
        size = os.fstat(file.fileno()).st_size
        file.seek(max(0, size - len(MCAP)))
        if file.read() == MCAP and size > len(MCAP):  # it has an end
            file.seek(0)
            return file
        parts = _whole_records(file, size)
        self.remarks.append(f"cut off: the last {size - parts[-1][1]} bytes are not a whole record and are left out")
        return BufferedReader(_Parts(file, parts))

    def __str__(self) -> str:
        return self.path


def _whole_records(file: BinaryIO, size: int) -> list[tuple[int, int]]:
    """The ranges of complete records: those before the cut, and those in a truncated, uncompressed chunk."""
    end, kind = _records(file, len(MCAP), size)
    parts = [(0, min(end, size))]
    if kind == _CHUNK:
        file.seek(end + _RECORD_HEAD + 28)  # skips two times, a size and a checksum
        compression = int.from_bytes(file.read(4), "little")
        begin = end + _RECORD_HEAD + 28 + 4 + 8
        if compression == 0 and begin <= size:
            inside, _ = _records(file, begin, size)
            parts.append((begin, inside))
    return parts


def _records(file: BinaryIO, begin: int, size: int) -> tuple[int, bytes]:
    """Where the last complete record ends, and the type of the record after it, if any."""
    while True:
        file.seek(begin)
        head = file.read(_RECORD_HEAD)
        after = begin + _RECORD_HEAD + int.from_bytes(head[1:], "little")
        if len(head) < _RECORD_HEAD or after > size:
            return begin, head[:1]
        begin = after


class _Parts(RawIOBase):
    """Parts of a file, concatenated, followed by the end of an MCAP file without an index."""

    def __init__(self, file: BinaryIO, parts: list[tuple[int, int]]) -> None:
        self._file: Final = file
        self._parts: Final = parts
        self._size: Final = sum(end - begin for begin, end in parts) + len(_NO_INDEX)
        self._position = 0

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._position = {os.SEEK_CUR: self._position, os.SEEK_END: self._size}.get(whence, 0) + offset
        return self._position

    def readinto(self, buffer: Any) -> int:
        data = self._at(self._position, len(buffer))
        buffer[: len(data)] = data
        self._position += len(data)
        return len(data)

    def _at(self, position: int, count: int) -> bytes:
        for begin, end in self._parts:
            if position < end - begin:
                self._file.seek(begin + position)
                return self._file.read(min(count, end - begin - position))
            position -= end - begin
        return _NO_INDEX[position : position + count]

    def close(self) -> None:
        self._file.close()
        super().close()


_CHUNK: Final = b"\x06"
_RECORD_HEAD: Final = 9  # its type, and its length in 64 bits
_NO_INDEX: Final = b"\x02" + (20).to_bytes(8, "little") + bytes(20) + MCAP
