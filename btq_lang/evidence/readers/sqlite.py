"""`.db3` and `.btdb`, the database of BehaviorTree.CPP's SqliteLogger: sessions, each with its tree and transitions.

One invariant: the database is opened to be read only, so a robot can write it meanwhile; a damaged one gives what can
be read.

Source: src/loggers/bt_sqlite_logger.cpp.
"""

from __future__ import annotations

import json
import sqlite3
from contextlib import contextmanager
from urllib.request import pathname2url

from btq_lang.evidence.model import Series, Session, is_sample
from btq_lang.evidence.readers.tree import NotALog, read_tree

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Final

    from btq_lang.evidence.model import Transition


def read(path: str) -> Iterator[Session]:
    """The sessions of a database, in their order.

    Raises:
        NotALog: it is not a database of SqliteLogger.
        OSError: it cannot be read.
    """
    with _opened(path) as database:
        yield from _sessions(database)


def is_bag(path: str) -> bool:
    """Whether a database is a ROS 2 bag, by its tables.

    Raises:
        NotALog: it cannot be read as a database.
        OSError: it cannot be read.
    """
    with _opened(path) as database:
        return {"topics", "messages"} <= _tables(database)


@contextmanager
def _opened(path: str) -> Iterator[sqlite3.Connection]:
    with open(path, "rb") as file:  # for the reason, which SQLite does not give
        if file.read(len(MAGIC)) != MAGIC:
            raise NotALog("expected a SQLite database, as SqliteLogger writes it")
    database = sqlite3.connect(f"file:{pathname2url(path)}?mode=ro", uri=True)
    try:
        database.text_factory = lambda data: data.decode("utf-8", "replace")
        yield database
    except _DAMAGED as error:
        raise NotALog(f"the database cannot be read: {error}") from error
    finally:
        database.close()


def _tables(database: sqlite3.Connection) -> set[str]:
    return {name for (name,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}


def _sessions(database: sqlite3.Connection) -> Iterator[Session]:
    if missing := sorted({"Definitions", "Transitions"} - _tables(database)):
        raise NotALog(f"expected the tables of SqliteLogger; missing: {', '.join(missing)}")
    for number, xml in database.execute("SELECT session_id, xml_tree FROM Definitions ORDER BY session_id").fetchall():
        samples: dict[str, Series] = {}
        remarks: list[str] = []
        yield Session(read_tree(str(xml)), _transitions(database, number, samples, remarks), samples, remarks)


def _transitions(
    database: sqlite3.Connection, session: int, samples: dict[str, Series], remarks: list[str]
) -> Iterator[Transition]:
    """The transitions of a session; samples and remarks are added to while they are read."""
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
    """What a logger's callback has put beside a row: of a JSON object each number, text or bool is a sample."""
    try:
        values = json.loads(extra) if isinstance(extra, str) else None
    except (ValueError, RecursionError):
        return
    for name, value in values.items() if isinstance(values, dict) else ():
        if is_sample(value):
            samples.setdefault(name, Series()).add(time, value)


_DAMAGED: Final = (sqlite3.Error, UnicodeDecodeError)  # which a message of SQLite may itself end in
MAGIC: Final = b"SQLite format 3\0"
_TRANSITIONS: Final = (
    "SELECT timestamp, node_uid, state, extra_data FROM Transitions WHERE session_id = ? ORDER BY timestamp"
)
