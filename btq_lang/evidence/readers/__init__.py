"""Readers of logs: a module a format, found by what a file begins with, whatever its name.

One invariant: a log is read as it is judged, never all at once, and what is wrong with a file is one NotALog or OSError
that says what was expected.
"""

from __future__ import annotations

from btq_lang.evidence.readers import btlog, sqlite
from btq_lang.evidence.readers.tree import NotALog as NotALog

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Final

    from btq_lang.evidence.model import Session

SUFFIXES: Final = (".btlog", ".db3", ".btdb")  # of what is read below a folder


def read(path: str) -> Iterator[Session]:
    """The sessions of a log, each to be read before the next one is asked for.

    Raises:
        NotALog: no format fits, or the file is damaged where nothing of it can be used.
        OSError: it cannot be read.
    """
    with open(path, "rb") as file:
        start = file.read(max(len(btlog.MAGIC), len(sqlite.MAGIC)))
    if start.startswith(btlog.MAGIC):
        return btlog.read(path)
    if start.startswith(sqlite.MAGIC):
        return sqlite.read(path)
    raise NotALog("expected a BehaviorTree.CPP log: .btlog from FileLogger2, .db3 or .btdb from SqliteLogger")
