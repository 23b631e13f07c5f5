"""Readers of logs: a module a format, found by what a file begins with, whatever its name.

One invariant: a log is read as it is judged, never all at once, and what is wrong with a file is one NotALog or OSError
that says what was expected.
"""

from __future__ import annotations

import os

from btq_lang.evidence.readers import bag, btlog, sqlite, tree_log
from btq_lang.evidence.readers.tree import NotALog as NotALog

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from typing import Final

    from btq_lang.evidence.model import NamedLog, Session

SUFFIXES: Final = (".btlog", ".db3", ".btdb", ".mcap")  # of what is read below a folder


def read(path: str) -> Iterator[Session | NamedLog]:
    """The sessions of a log, each to be read before the next one is asked for.

    Args:
        path: of a file, or of the folder of a ROS 2 bag.

    Raises:
        NotALog: no format fits, or the file is damaged where nothing of it can be used.
        OSError: it cannot be read.
    """
    if os.path.isdir(path):
        return tree_log.read(path)
    with open(path, "rb") as file:
        start = file.read(_LONGEST)
    if start.startswith(btlog.MAGIC):
        return btlog.read(path)
    if start.startswith(bag.MCAP) or (start.startswith(sqlite.MAGIC) and sqlite.is_bag(path)):
        return tree_log.read(path)
    if start.startswith(sqlite.MAGIC):
        return sqlite.read(path)
    raise NotALog(
        "expected a BehaviorTree.CPP log (.btlog from FileLogger2, .db3 or .btdb from SqliteLogger) or a ROS 2 bag"
        " (.mcap, .db3, or a folder with metadata.yaml)"
    )


def whole_bags(paths: Iterable[str]) -> tuple[str, ...]:
    """Paths with the files of a bag replaced by the bag's folder, where its `metadata.yaml` is among them."""
    given = dict.fromkeys(paths)
    files = {
        file: folder
        for folder in (os.path.dirname(path) for path in given if os.path.basename(path) == bag.METADATA)
        for file in bag.files_in(folder)
    }
    return tuple(dict.fromkeys(files.get(path, path) for path in given if path in files or not _is_metadata(path)))


def _is_metadata(path: str) -> bool:
    """Whether it was found for its name only, and not for what is in it."""
    return path.endswith(bag.METADATA)


_LONGEST: Final = max(map(len, (btlog.MAGIC, sqlite.MAGIC, bag.MCAP)))
