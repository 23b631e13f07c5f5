"""Logs that are given twice, under two names: their runs count once."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence

from btq_lang.evidence.store.sets import files_of_log, sha256


def without_copies(logs: Sequence[str]) -> tuple[Sequence[str], dict[str, str]]:
    """The logs without those that have the same bytes as one before, and of each of these which one that is.

    Only logs of the same size are read for this.
    """
    sizes = {log: _size(log) for log in logs}
    alike = Counter(sizes.values())
    first: dict[str, str] = {}
    copies: dict[str, str] = {}
    for log in logs:
        if sizes[log] is not None and alike[sizes[log]] > 1:
            known = first.setdefault(sha256(log), log)
            if known != log:
                copies[log] = known
    return [log for log in logs if log not in copies], copies


def _size(log: str) -> int | None:
    """The bytes of all files of a log; None if it cannot be read."""
    try:
        files = files_of_log(log)
        return sum(map(os.path.getsize, files)) if all(os.access(each, os.R_OK) for each in files) else None
    except OSError:
        return None
