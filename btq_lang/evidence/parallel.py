"""Judges many logs in several processes, in the order of the logs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures.process import BrokenProcessPool
from typing import Final

from btq_lang.evidence.judging import JudgedLog, Means, judge
from btq_lang.util.processes import pool

_means: Means | None = None


def judge_all(logs: Sequence[str], means: Means, jobs: int) -> Iterator[JudgedLog]:
    """What was found in each log, in order; if a process is ended from outside, a problem instead of the rest."""
    # DuckDB, which may have threads here already, does not work in a forked process.
    start = None if means.keeping is None else "spawn"
    try:
        processes = pool(min(jobs, len(logs)), _begin, (means,), start)
    except NotImplementedError:  # there are no processes in a browser
        yield from (judge(log, means) for log in logs)
        return
    with processes:
        try:
            yield from processes.map(_judge, logs)
        except BrokenProcessPool:
            yield JudgedLog(0, (), (), (_ENDED,))


def _begin(means: Means) -> None:
    global _means
    _means = means


def _judge(log: str) -> JudgedLog:
    assert _means is not None, "every process begins with _begin"
    return judge(log, _means)


_ENDED: Final = "a process that judges logs was ended from outside, perhaps for lack of memory"
