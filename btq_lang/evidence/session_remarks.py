"""Remarks on a session that has been read: what its times and samples look as if had gone wrong."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Final

from btq_lang.evidence.wording import duration


def clock_remarks(durations: Mapping[str, Sequence[int]]) -> Iterator[str]:
    """Of each node, by its path, with a duration that is much longer than its others: in µs."""
    for path, times in durations.items():
        longest = max(times, default=0)
        if longest > _HOUR and longest > _FACTOR * (median := sorted(times)[len(times) // 2]):
            took = f"{path} took {duration(longest / 1e6)} once, and half of the times at most {duration(median / 1e6)}"
            yield f"{took}: was the clock set forward?"


def sample_remarks(series: Iterable[tuple[str, float | None, Sequence[int]]], end: int) -> Iterator[str]:
    """Of each signal whose samples end long before the log, compared with the times between them.

    Args:
        series: its name, its `fresh within` in s, and the times of its samples in the session.
        end: of the session.
    """
    for name, fresh, times in series:
        gaps = sorted(after - before for before, after in pairwise(times))
        if len(gaps) < _FEW:
            continue
        median = gaps[len(gaps) // 2]
        # A signal that is written when it changes has long gaps anyway.
        allowed = fresh * 1e6 if fresh is not None else max(_GAPS * median, gaps[-1])
        if end - times[-1] > allowed:
            lacking, usual = (duration(time / 1e6) for time in (end - times[-1], median))
            holds = "" if fresh is not None else "; without `fresh within` the last one counts until the end"
            yield f"the samples of `{name}`, mostly one each {usual}, end {lacking} before the log does{holds}"


_HOUR: Final = 3_600_000_000  # µs
_FACTOR: Final = 1000
_FEW: Final = 10  # fewer times between samples say nothing about them
_GAPS: Final = 10
