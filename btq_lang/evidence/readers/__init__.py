"""Readers of logs: a module a format, chosen by the first bytes of a file, whatever its name.

One invariant: a log is read while it is judged, never all at once, and a bad file gives one NotALog or OSError whose
message names what was expected.

    btlog.py, sqlite.py   the files of the engine's loggers, and groot2/ what its publisher sends
    bag.py                ROS 2 bags; `truncated_bags`: what is left of a broken one
    tree_log.py, topics.py   what Nav2 publishes about its trees, and samples of signals, from a bag
    samples.py            samples of signals from CSV and Parquet files
    tree.py, side.py      the tree in a log, and the side file beside it
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.model import LoggedTree, LogSession, NamedLog, SampleSeries
from btq_lang.evidence.readers import bag, btlog, sqlite, tree_log
from btq_lang.evidence.readers.topics import Clock
from btq_lang.evidence.readers.tree import NotALog as NotALog
from btq_lang.evidence.readers.truncated_bags import MCAP

if TYPE_CHECKING:
    from btq_lang.workspace.project_evidence import SignalSource

SUFFIXES: Final = (".btlog", ".db3", ".btdb", ".mcap")  # of the files read below a folder


def read(path: str, sources: Iterable[SignalSource] = ()) -> Iterator[LogSession | NamedLog]:
    """The sessions of a log, a file or the folder of a ROS 2 bag; each must be read before the next is requested.

    Args:
        sources: where samples of signals come from; those that are topics are read from bags.

    Raises:
        NotALog: no format fits, or the file is damaged beyond use.
        OSError: it cannot be read.
    """
    reader = _reader(path)
    return tree_log.read(path, sources) if reader is tree_log else reader.read(path)


def trees(path: str) -> list[LoggedTree]:
    """The trees of a log's sessions, or those on the topics of a bag, in their order.

    Raises:
        NotALog, OSError: as `read` does.
    """
    reader = _reader(path)
    return tree_log.trees(path) if reader is tree_log else [session.tree for session in reader.read(path)]


def samples_of_bags(
    paths: Iterable[str], sources: Sequence[SignalSource]
) -> tuple[dict[str, SampleSeries], list[str], set[str]]:
    """The samples of bags without a log of a tree, by signal, with notes about them, and which bags these are.

    A file that cannot be read is skipped; `read` reports it.
    """
    series_by_signal: dict[str, SampleSeries] = {}
    remarks: list[str] = []
    bags = set()
    for path in paths if any(source.topic for source in sources) else ():
        try:
            samples = tree_log.samples(path, sources) if _reader(path) is tree_log else None
        except (NotALog, OSError):
            continue
        if samples is not None:
            bags.add(path)
            remarks += samples[1]
            for signal, series in samples[0].items():
                into = series_by_signal.setdefault(signal, SampleSeries(series.unit))
                for time, value in zip(series.times, series.values, strict=True):
                    into.add(time, value)
    return series_by_signal, remarks, bags


def clocks(path: str) -> dict[str, Clock]:
    """The clock of each log in a bag, by topic; empty for a log that is not a bag.

    Raises:
        NotALog, OSError: it cannot be read.
    """
    return tree_log.clocks(path) if _reader(path) is tree_log else {}


def _reader(path: str) -> ModuleType:
    """The module that reads a file."""
    if os.path.isdir(path):
        return tree_log
    with open(path, "rb") as file:
        start = file.read(_LONGEST)
    if not start:
        raise NotALog("the file is empty")
    if start.startswith(btlog.MAGIC):
        return btlog
    if start.startswith(MCAP) or (start.startswith(sqlite.MAGIC) and sqlite.is_bag(path)):
        return tree_log
    if start.startswith(sqlite.MAGIC):
        return sqlite
    raise NotALog(
        "expected a BehaviorTree.CPP log (.btlog from FileLogger2, .db3 or .btdb from SqliteLogger) or a ROS 2 bag"
        " (.mcap, .db3, or a folder with metadata.yaml)"
    )


def whole_bags(paths: Iterable[str]) -> tuple[str, ...]:
    """Paths with the files of a bag replaced by the bag's folder, where its `metadata.yaml` is among them."""
    unique = dict.fromkeys(paths)
    files = {
        file: folder
        for folder in (os.path.dirname(path) for path in unique if os.path.basename(path) == bag.METADATA)
        for file in bag.files_in(folder)
    }
    kept = (path for path in unique if path in files or not path.endswith(bag.METADATA))
    return tuple(dict.fromkeys(files.get(path, path) for path in kept))


_LONGEST: Final = max(map(len, (btlog.MAGIC, sqlite.MAGIC, MCAP)))
