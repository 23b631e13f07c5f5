"""How long each node ran each time, and nothing else of a log: the loop over its rows that one writes in plain Python,
and what one does with pandas instead."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from btq_lang.evidence.model import FAILURE, IDLE, RUNNING, SUCCESS
from btq_lang.evidence.readers.btlog import _HEAD, _RECORD, _START

Durations = dict[int, list[int]]  # of each activation of a node in µs, by the uid of the node
QUERY = "SELECT timestamp AS time, node_uid AS uid, state AS status FROM Transitions ORDER BY timestamp"
COLUMNS = [("low", "<u4"), ("high", "<u2"), ("uid", "<u2"), ("status", "u1")]


class Node:
    """What is kept of a node: its status, since when it runs, and how long it ran each time, in µs."""

    def __init__(self) -> None:
        self.status = IDLE
        self.since = 0
        self.durations: list[int] = []


def btlog(path: Path) -> Durations:
    """Those in a file of FileLogger2."""
    data, start, first = _opened(path)
    rows = _RECORD.iter_unpack(memoryview(data)[first:])
    return _by_node((start + low + (high << 32), uid, status) for low, high, uid, status in rows)


def db3(path: Path) -> Durations:
    """Those in a database of SqliteLogger."""
    return _by_node(sqlite3.connect(path).execute(QUERY))


def _by_node(rows: Iterable[tuple[int, int, int]]) -> Durations:
    nodes: dict[int, Node] = {}
    for time, uid, status in rows:
        node = nodes.get(uid)
        if node is None:
            node = nodes[uid] = Node()
        if status == RUNNING:
            if node.status != RUNNING:
                node.since = time
        elif node.status == RUNNING:
            node.durations.append(time - node.since)
        elif status in (SUCCESS, FAILURE):
            node.durations.append(0)
        node.status = status
    return {uid: node.durations for uid, node in nodes.items()}


def pandas_btlog(path: Path) -> Durations:
    """Those in a file of FileLogger2, by pandas."""
    import numpy as np
    import pandas as pd

    data, start, first = _opened(path)
    rows = pd.DataFrame(np.frombuffer(data, COLUMNS, offset=first))
    rows["time"] = start + rows.low.astype("int64") + rows.high.astype("int64") * 2**32
    return _by_column(rows)


def pandas_db3(path: Path) -> Durations:
    """Those in a database of SqliteLogger, by pandas."""
    import pandas as pd

    return _by_column(pd.read_sql_query(QUERY, sqlite3.connect(path)))


def _by_column(rows: Any) -> Durations:
    was_running = rows.groupby("uid").status.shift() == RUNNING
    is_running = rows.status == RUNNING
    since = rows.time.where(is_running & ~was_running).groupby(rows.uid).ffill()
    ended = ~is_running & (was_running | rows.status.isin([SUCCESS, FAILURE]))
    taken = (rows.time - since).where(was_running, 0)[ended].astype("int64")
    return {uid: of_node.tolist() for uid, of_node in taken.groupby(rows.uid)}


def _opened(path: Path) -> tuple[bytes, int, int]:
    """A file of FileLogger2, when it starts, and where its first row is."""
    data = path.read_bytes()
    _, _, length = _HEAD.unpack_from(data)
    (start,) = _START.unpack_from(data, _HEAD.size + length)
    return data, start, _HEAD.size + length + _START.size
