"""Side files beside logs: the mission of a log, and the nodes that its build numbered."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence

from btq_lang.util.record import Record
from btq_lang.workspace.file import SIDE_SUFFIX
from btq_lang.workspace.loader import absolute, read


class SideFile(Record):
    """A side file, the mission that it names, and the nodes that it lists."""

    path: str
    mission: str
    nodes: list[tuple[int, str]]


def side_files_beside(logs: Sequence[str]) -> Iterator[SideFile]:
    """The side files beside logs."""
    for folder in dict.fromkeys(os.path.dirname(absolute(log)) for log in logs):
        try:
            names = sorted(os.listdir(folder))
        except OSError:
            continue  # reading the log reports that
        for name in names:
            if name.endswith(SIDE_SUFFIX) and (side := side_file_at(f"{folder}/{name}")) is not None:
                yield side


def side_file_at(path: str) -> SideFile | None:
    """The side file at a path; None if it is missing or damaged."""
    text = read(path)[0] if os.path.isfile(path) else None
    try:
        data = json.loads(text or "")
        mission = absolute(os.path.join(os.path.dirname(path), data["mission"]["file"]))
        return SideFile(path, mission, [(node["uid"], node["path"]) for node in data["nodes"]])
    except (ValueError, RecursionError, KeyError, TypeError):
        return None
