"""Reads what is left of a truncated rosbag2 SQLite file, which `rosbags` cannot open.

It has the interface of a storage of `rosbags`: open, connections, messages, close.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Iterator
from contextlib import ExitStack
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.readers import sqlite

if TYPE_CHECKING:
    from rosbags.interfaces import Connection


class BagDatabase(ExitStack):
    """The file, with its topics once it is open."""

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
        wanted = {each.id: each for each in connections}
        for topic, received, data in self._database.execute(
            "SELECT topic_id, timestamp, data FROM messages ORDER BY id"
        ):
            if topic in wanted:
                yield wanted[topic], received, data
