"""`.db3` and `.btdb`, the database of BehaviorTree.CPP's SqliteLogger: sessions, each with its tree and transitions.

One invariant: the database is opened read-only, so a robot can write it meanwhile; of a damaged one, all that is
readable is read.

Source: src/loggers/bt_sqlite_logger.cpp.
"""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final
from urllib.request import pathname2url

from btq_lang.evidence.model import Series, Session, Transition, is_sample
from btq_lang.evidence.readers.tree import NotALog, read_tree


def read(path: str) -> Iterator[Session]:
    """The sessions of a database, in their order.

    Raises:
        NotALog: it is not a database of SqliteLogger.
        OSError: it cannot be read.
    """
    of_file: list[str] = []
    with opened(path, of_file) as database:
        if missing := sorted({"Definitions", "Transitions"} - tables(database)):
            raise NotALog(f"expected the tables of SqliteLogger; missing: {', '.join(missing)}")
        for number, xml in _definitions(database, of_file):
            samples: dict[str, Series] = {}
            remarks = [*of_file]
            yield Session(read_tree(str(xml)), _transitions(database, number, samples, remarks), samples, remarks)


def is_bag(path: str) -> bool:
    """Whether a database is a ROS 2 bag, by its tables.

    Raises:
        NotALog: it cannot be read as a database.
        OSError: it cannot be read.
    """
    with opened(path, []) as database:
        return {"topics", "messages"} <= tables(database)


@contextmanager
def opened(path: str, remarks: list[str]) -> Iterator[sqlite3.Connection]:
    """Open a database for reading; a truncated one, for what is left of it, with a remark.

    Raises:
        NotALog: it is not a database, or is damaged where it is read.
        OSError: it cannot be read.
    """
    missing = missing_bytes(path)
    how = "mode=ro"
    if not os.access(os.path.dirname(path) or ".", os.W_OK) and not os.path.exists(f"{path}-shm"):
        # In such a folder SQLite cannot create the index that it needs for a write-ahead log, even an absent one.
        if has_log(path):
            raise NotALog(f"{os.path.basename(path)}-wal has a part of it; copy both to a folder that can be written")
        how = "immutable=1"
    database = sqlite3.connect(f"file:{pathname2url(path)}?{how}", uri=True)
    try:
        database.text_factory = lambda data: data.decode("utf-8", "replace")
        if missing:
            remarks.append(f"cut off: the last {missing} bytes of the database are missing")
            database.execute("PRAGMA writable_schema = ON")  # else SQLite reads nothing of it; nothing is written
        yield database
    except _DAMAGED as error:
        raise NotALog(f"the database cannot be read: {error}") from error
    finally:
        database.close()


def has_log(path: str) -> bool:
    """Whether a part of a database is in its write-ahead log: it is being written, or its writer was killed."""
    try:
        return os.path.getsize(f"{path}-wal") > 0
    except OSError:
        return False


def missing_bytes(path: str) -> int:
    """How many bytes a database lacks; 0 if none, or if its header does not tell.

    Raises:
        NotALog: it is not a database.
        OSError: it cannot be read.
    """
    with open(path, "rb") as file:  # SQLite does not give the reason
        head = file.read(_HEAD)
        size = os.fstat(file.fileno()).st_size
    if not head.startswith(MAGIC):
        raise NotALog("expected a SQLite database, as SqliteLogger writes it")
    if len(head) < _HEAD or head[24:28] != head[92:96]:  # then the page count is not valid
        return 0
    page = int.from_bytes(head[16:18], "big")
    return max(0, (65536 if page == 1 else page) * int.from_bytes(head[28:32], "big") - size)


def tables(database: sqlite3.Connection) -> set[str]:
    """The names of a database's tables."""
    return {name for (name,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}


def _definitions(database: sqlite3.Connection, remarks: list[str]) -> list[tuple[int, object]]:
    """The number of each session, and its tree."""
    definitions: list[tuple[int, object]] = []
    try:
        for definition in database.execute("SELECT session_id, xml_tree FROM Definitions ORDER BY session_id"):
            definitions.append(definition)
    except _DAMAGED as error:
        if not definitions:
            raise
        remarks.append(f"the database is damaged, and sessions after number {definitions[-1][0]} are left out: {error}")
    return definitions


def _transitions(
    database: sqlite3.Connection, session: int, samples: dict[str, Series], remarks: list[str]
) -> Iterator[Transition]:
    """The transitions of a session; samples and remarks are appended while they are read."""
    malformed = 0
    try:
        for time, uid, status, extra in database.execute(_TRANSITIONS, (session,)):
            if type(time) is type(uid) is type(status) is int:
                if extra:
                    _add_samples(samples, time, extra)
                yield time, uid, status
            else:
                malformed += 1
    except _DAMAGED as error:
        remarks.append(f"the database is damaged, and the rows after the damage are left out: {error}")
    if malformed:
        remarks.append(f"rows whose time, uid or state is not a whole number, left out: {malformed}")


def _add_samples(samples: dict[str, Series], time: int, extra: object) -> None:
    """Add the samples in a row's extra data, from a logger's callback: each number, text or bool of a JSON object."""
    try:
        values = json.loads(extra) if isinstance(extra, str) else None
    except (ValueError, RecursionError):
        return
    for name, value in values.items() if isinstance(values, dict) else ():
        if is_sample(value):
            samples.setdefault(name, Series()).add(time, value)


_DAMAGED: Final = (sqlite3.Error, UnicodeDecodeError)  # reading an error message may raise the latter
MAGIC: Final = b"SQLite format 3\0"
_HEAD: Final = 100
_TRANSITIONS: Final = (
    "SELECT timestamp, node_uid, state, extra_data FROM Transitions WHERE session_id = ? ORDER BY timestamp"
)
