"""`.db3` and `.btdb`, the database of BehaviorTree.CPP's SqliteLogger: sessions, each with its tree and transitions.

One invariant: the database is opened read-only, so a robot can write it meanwhile, and where its writer was killed, a
temporary copy is repaired; of a damaged one, all that is readable is read.

Source: src/loggers/bt_sqlite_logger.cpp.
"""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from shutil import copyfile
from tempfile import TemporaryDirectory
from typing import Final
from urllib.request import pathname2url

from btq_lang.evidence.model import LogSession, SampleSeries, Transition, is_sample
from btq_lang.evidence.readers.tree import NotALog, read_tree

BESIDE: Final = ("-journal", "-wal")  # the suffixes of the files that belong to a database


def read(path: str) -> Iterator[LogSession]:
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
            samples: dict[str, SampleSeries] = {}
            remarks = [*of_file]
            yield LogSession(read_tree(str(xml)), _transitions(database, number, samples, remarks), samples, remarks)


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
    """Open a database for reading, without the transaction in which its writer was killed, with a remark; a truncated
    one, for what is left of it, with a remark.

    Raises:
        NotALog: it is not a database, or is damaged where it is read.
        OSError: it cannot be read.
    """
    path = os.path.realpath(path)  # SQLite looks for a journal there
    missing = missing_bytes(path)
    try:
        with ExitStack() as stack:
            database = _in_place(path, stack)
            if database is None:
                path = _copied(path, stack)
                has_journal = os.path.exists(f"{path}-journal")
                database = _connected(path, "mode=rw", stack)
                if has_journal and not os.path.exists(f"{path}-journal"):  # SQLite has rolled back
                    remarks.append("its writer was killed in the middle of a transaction, which is left out")
                missing = missing_bytes(path)
            if missing:
                remarks.append(f"cut off: the last {missing} bytes of the database are missing")
            yield database
    except _DAMAGED as error:
        raise NotALog(f"the database cannot be read: {error}") from error


def _in_place(path: str, stack: ExitStack) -> sqlite3.Connection | None:
    """Open a database where it is; None if SQLite would have to write there first."""
    how = "mode=ro"
    if not os.path.exists(f"{path}-shm"):  # the index of a write-ahead log, there while a database is in use
        if is_unfinished(path, ("-wal",)):
            return None
        with open(path, "rb") as file:
            has_log = file.read(_HEAD)[18:20] == b"\2\2"
        how = "immutable=1" if has_log else how  # else SQLite creates an index, or cannot
    try:
        return _connected(path, how, stack)
    except sqlite3.OperationalError as error:
        if "locked" in str(error) or not is_unfinished(path):
            raise
        return None


def _connected(path: str, how: str, stack: ExitStack) -> sqlite3.Connection:
    """Open a database, to be closed at the end."""
    database = stack.enter_context(closing(sqlite3.connect(f"file:{pathname2url(path)}?{how}", uri=True)))
    database.text_factory = lambda data: data.decode("utf-8", "replace")
    database.execute("PRAGMA writable_schema = ON")  # else SQLite reads nothing of a truncated one; nothing is written
    database.execute("PRAGMA schema_version")  # now SQLite looks for a journal
    return database


def _copied(path: str, stack: ExitStack) -> str:
    """Copy a database with its journal and log to a temporary folder.

    Raises:
        NotALog: there is no room for a copy, or the database was written meanwhile.
    """
    files = {f"{path}{suffix}": f"log.db3{suffix}" for suffix in ("", *BESIDE) if os.path.exists(f"{path}{suffix}")}
    before = [_version(file) for file in files]
    folder = why = ""
    try:
        folder = stack.enter_context(TemporaryDirectory(prefix="btq-"))
        for source, name in files.items():
            copyfile(source, os.path.join(folder, name))
    except OSError as error:
        why = f"it needs a temporary copy, which cannot be made: {error.strerror or error}; TMPDIR says where"
    if before != [_version(file) for file in files]:
        why = "it was written while it was copied; read it again"
    if why:
        raise NotALog(why)
    return os.path.join(folder, "log.db3")


def _version(path: str) -> tuple[int, int] | None:
    """Size and time of a file, which differ after it was written; None if it is gone."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_size, status.st_mtime_ns


def is_unfinished(path: str, beside: Sequence[str] = BESIDE) -> bool:
    """Whether there is something in a database's journal or write-ahead log: it is being written, or its writer was
    killed.
    """
    versions = (_version(f"{os.path.realpath(path)}{suffix}") for suffix in beside)
    return any(version is not None and version[0] > 0 for version in versions)


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
    database: sqlite3.Connection, session: int, samples: dict[str, SampleSeries], remarks: list[str]
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


def _add_samples(samples: dict[str, SampleSeries], time: int, extra: object) -> None:
    """Add the samples in a row's extra data, from a logger's callback: each number, text or bool of a JSON object."""
    try:
        values = json.loads(extra) if isinstance(extra, str) else None
    except (ValueError, RecursionError):
        return
    for name, value in values.items() if isinstance(values, dict) else ():
        if is_sample(value):
            samples.setdefault(name, SampleSeries()).add(time, value)


_DAMAGED: Final = (sqlite3.Error, UnicodeDecodeError)  # reading an error message may raise the latter
MAGIC: Final = b"SQLite format 3\0"
_HEAD: Final = 100
_TRANSITIONS: Final = (
    "SELECT timestamp, node_uid, state, extra_data FROM Transitions WHERE session_id = ? ORDER BY timestamp"
)
