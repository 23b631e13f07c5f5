"""The sets of files in a store, one for each log, in a folder named by the SHA-256 of the log.

One invariant: such a folder is whole, because it gets its name by one rename when all its files are written.  What a
running robot did is in no file, so the name of its set is random.  A log
that is judged again leaves its set as it is if the same was found; otherwise the new set takes the old one's place.

Two renames replace a set: the old folder goes aside, the new one takes its name.  If a writer is killed between them,
the next one gives the old folder its name back.  Folders that killed writers were still filling are
never read, and are removed a day after their last change.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import re
import shutil
import time
import uuid
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any, Final

from btq_lang.evidence.readers import sqlite
from btq_lang.evidence.store.engine import NoEngine, write_parquet
from btq_lang.evidence.store.rows import Rows, digest, file_of, hash_file
from btq_lang.evidence.store.tables import ROWS
from btq_lang.util.record import Record


class NotKept(Exception):
    """The findings in a log cannot be kept; the message says why."""


class Keeping(Record):
    """Where findings are kept, and under which names.

    Attributes:
        folder: of the store.
        label, robot: of the logs; None: those that the log has in the store already.
        label_by, robot_by: `folder`: of each log, the name of its folder; `folder-above`: of the one that this is in.
    """

    folder: str
    label: str | None = None
    label_by: str | None = None
    robot: str | None = None
    robot_by: str | None = None

    def label_of(self, log: str) -> str | None:
        """The label of a log."""
        return _folder_of(log, self.label_by) if self.label_by else self.label

    def robot_of(self, log: str) -> str | None:
        """The robot of a log that names none."""
        return _folder_of(log, self.robot_by) if self.robot_by else self.robot


class Draft:
    """The set of a log while it is written.

    Attributes:
        rows: receives the findings.
        robot: of the log, unless it names its robots.
    """

    def __init__(self, store: str, folder: str, log: str, label: str | None, robot: str | None, rows: Rows) -> None:
        self._target: Final = os.path.join(store, log)
        self._folder: Final = folder
        self._log: Final = log
        self._label: Final = label
        self.rows: Final = rows
        self.robot: Final = robot or str(about(self._target).get("robot", ""))

    def publish(self, source: str) -> tuple[str, ...]:
        """Make it the set of its log, unless that has the same rows and label already.

        Args:
            source: the file, as people read it.

        Returns:
            The label and the robot that the log had, as far as it has another one now.

        Raises:
            OSError, NoEngine: it cannot be written.
            NotKept: a newer version of btq has written the set, perhaps with more columns.
        """
        self.rows.close()
        before = about(self._target)
        if before.get("version", VERSION) not in range(VERSION + 1):
            raise NotKept(f"cannot be kept: a newer version of btq has written {self._target}")
        whose = {"label": self._label or str(before.get("label", "")), "robot": self.robot}
        now = {"format": FORMAT, "version": VERSION, "log": self._log, **whose, "rows": digest(self._folder)}
        if now.items() <= before.items():
            return ()
        named = source.encode(errors="replace").decode()
        write_parquet(self._folder, {"log": self._log, "label": whose["label"], "source": named})
        for name in ROWS:
            os.remove(file_of(self._folder, name))
        with open(os.path.join(self._folder, ABOUT), "w", encoding="utf-8") as file:
            json.dump(now, file, indent=1)
        _take_place(self._folder, self._target)
        return tuple(f"the {name} {before[name]}" for name in whose if before.get(name, "") not in ("", whose[name]))


@contextmanager
def draft(keeping: Keeping, log: str, name: str | None = None) -> Iterator[Draft]:
    """A set to be filled; unless it is published, nothing is left of it.

    Args:
        name: of the set; None: the SHA-256 of the log.

    Raises:
        NotKept: the log or the store cannot be read or written.
    """
    try:
        name = name or sha256(log)
    except OSError as error:
        raise NotKept(f"cannot be read: {error.strerror or error}") from error
    try:
        folder = os.path.join(keeping.folder, f"{DRAFT}{name[:_SHORT]}-{uuid.uuid4().hex}")
        os.makedirs(folder)
    except OSError as error:
        raise NotKept(f"cannot be kept: {error.strerror or error}: {error.filename}") from error
    try:
        with Rows(folder) as rows:
            yield Draft(keeping.folder, folder, name, keeping.label_of(log), keeping.robot_of(log), rows)
    except OSError as error:
        raise NotKept(f"cannot be kept: {error.strerror or error}: {keeping.folder}") from error
    except NoEngine as error:
        raise NotKept(f"cannot be kept: {error}") from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def prepare(store: str) -> None:
    """Make the folder of a store, if there is none, and restore or remove what killed writers left.

    Raises:
        OSError: the store cannot be read or written.
    """
    os.makedirs(store, exist_ok=True)
    if not os.access(store, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), store)
    for name in os.listdir(store):
        path = os.path.join(store, name)
        if (aside := _ASIDE.fullmatch(name)) is not None:
            with suppress(OSError):  # another writer was faster
                os.rename(path, os.path.join(store, aside[1]))
                continue
            shutil.rmtree(path, ignore_errors=True)
        elif name.startswith(DRAFT) and time.time() - _changed(path) > _LIFE:
            shutil.rmtree(path, ignore_errors=True)


def about(folder: str) -> dict[str, Any]:
    """The description of a set; empty if there is no set, or none of this version."""
    try:
        with open(os.path.join(folder, ABOUT), encoding="utf-8") as file:
            content = json.load(file)
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def _take_place(folder: str, target: str) -> None:
    """Give a folder its name, even if another one has it."""
    store, name = os.path.split(target)
    aside = []
    while True:
        try:
            os.rename(folder, target)
            break
        except OSError as error:
            if error.errno not in (errno.ENOTEMPTY, errno.EEXIST):
                raise
        aside.append(os.path.join(store, f"{_OLD}{name}-{uuid.uuid4().hex}"))
        with suppress(FileNotFoundError):  # another writer is replacing it
            os.rename(target, aside[-1])
    for folder_aside in aside:
        shutil.rmtree(folder_aside, ignore_errors=True)


def sha256(log: str) -> str:
    """The SHA-256 of a file with what is unfinished beside it, or of all files of a bag, with their names."""
    digest_of_files = hashlib.sha256()
    for path in files_of_log(log):
        if path != log:
            name = path.removeprefix(log).lstrip(os.sep)
            digest_of_files.update(f"{name}\0{os.path.getsize(path)}\0".encode(errors="surrogateescape"))
        hash_file(digest_of_files, path)
    return digest_of_files.hexdigest()


def files_of_log(log: str) -> Sequence[str]:
    """A log's file, with the journal of a database whose writer was killed, or all files of a bag."""
    if not os.path.isdir(log):
        return [log, *(f"{log}{suffix}" for suffix in sqlite.BESIDE if sqlite.is_unfinished(log, [suffix]))]
    return sorted(os.path.join(folder, name) for folder, _, names in os.walk(log) for name in names)


def _changed(folder: str) -> float:
    """When a file in a folder last changed, in seconds since the epoch; now if the folder is gone."""
    try:
        return max(os.stat(path).st_mtime for path in (folder, *(entry.path for entry in os.scandir(folder))))
    except OSError:
        return time.time()


def _folder_of(log: str, by: str) -> str:
    folder = os.path.dirname(os.path.abspath(log))
    return os.path.basename(os.path.dirname(folder) if by == "folder-above" else folder)


FORMAT: Final = "btq-evidence"
VERSION: Final = 4  # one more with each new column: older versions then leave the set as it is
ABOUT: Final = "about.json"
DRAFT: Final = ".draft-"
_OLD: Final = ".old-"
_ASIDE: Final = re.compile(rf"{re.escape(_OLD)}([0-9a-f]{{64}})-[0-9a-f]{{32}}")
_LIFE: Final = 86_400.0  # s for which a draft may be unchanged: more than clocks of several machines differ
_SHORT: Final = 16
