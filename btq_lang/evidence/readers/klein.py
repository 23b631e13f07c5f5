"""`<name>.bb.jsonl` beside `<name>.btlog`: what was on the blackboard, as klein records it from a running robot.

One invariant: a line that cannot be read is skipped and counted, and no content of the file affects reading the log.

The file has a header, then a line for each change in order of time: µs since the header's time, the blackboard, the
entry, and its value or its removal.  Source: `export_blackboard` in klein/btlog.py of johanubbink/klein-bt.
"""

from __future__ import annotations

import json
import os
from typing import Any, Final

from btq_lang.evidence.model import SampleSeries, by_entry, is_sample


def read(log: str) -> tuple[dict[str, SampleSeries], list[str]]:
    """The samples beside a log by entry, and notes about them; both empty without such a file."""
    path = f"{os.path.splitext(log)[0]}{SUFFIX}"
    name = os.path.basename(path)
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            header = _object(file.readline())
            if header is None or header.get("klein_blackboard") != _VERSION:
                return {}, [f"{name}: expected a first line with `klein_blackboard` {_VERSION}; left out"]
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
        found = json.loads(line)
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def _time(value: object) -> int | None:
    if isinstance(value, bool) or not isinstance(value, int) or abs(value) > _LATEST:
        return None
    return value


SUFFIX: Final = ".bb.jsonl"
_VERSION: Final = 1
_LATEST: Final = 1 << 61  # µs
