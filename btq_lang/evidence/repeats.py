"""Runs that several logs hold, as those of two loggers, of a copy, or of a log that was copied while it was written.

A log that is given twice, under two names, counts once.

One invariant: a run is left out only if another one that is kept holds all its rows: node and status of each, in their
order, within a millisecond; of equal runs the one in the session with more rows is kept, or else the first. Only
sessions in which runs begin or end at the same time are read for this.
"""

from __future__ import annotations

import os
from array import array
from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, lru_cache
from itertools import accumulate
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.evidence.model import PLACES
from btq_lang.evidence.store.sets import files_of_log, sha256
from btq_lang.util.grouping import grouped

if TYPE_CHECKING:
    from btq_lang.evidence.model import Activation, Transition


WITHIN: Final = 1000  # µs between two rows of one change of a node


class LoggedRuns:
    """Where the runs in a session of a log are.

    Attributes:
        log, number: which session: of the log, counted from 0 among those that were judged.
        whose: only runs with equal ones may be one: the mission, and the label.
        robot: its name, if the log has one; robots with other names have other runs.
        begins, ends: in µs since the epoch.
        first, last: the numbers of their rows among the transitions of the session, from 1.
    """

    def __init__(self, log: str, number: int, whose: tuple[str, str | None], robot: str = "") -> None:
        self.log: Final = log
        self.number: Final = number
        self.whose: Final = whose
        self.robot: Final = robot
        self.begins: Final = array("q")
        self.ends: Final = array("q")
        self.first: Final = array("q")
        self.last: Final = array("q")

    def add(self, root: Activation) -> None:
        """Add a run."""
        for (time, place), times, rows in ((root.shown, self.begins, self.first), (root.ended, self.ends, self.last)):
            times.append(min(time, _LATEST))
            rows.append(place // PLACES)

    @property
    def rows(self) -> int:
        """How many rows there are up to the end of the last run."""
        return self.last[-1]


class LoggedRows:
    """The rows of a session."""

    def __init__(self, transitions: Sequence[Transition] | Iterator[Transition]) -> None:
        self.times: Final = array("q")
        self.changes: Final = array("q")
        for time, uid, status in transitions:
            self.times.append(min(time, _LATEST))
            self.changes.append(hash((uid, status)))

    @cached_property
    def latest(self) -> array[int]:
        """The latest time up to each row: later than its own where the clock was set back."""
        return array("q", accumulate(self.times, max))

    @cached_property
    def earliest(self) -> array[int]:
        """The earliest time from each row on."""
        backwards = array("q", accumulate(reversed(self.times), min))
        backwards.reverse()
        return backwards

    def find(self, other: LoggedRows, first: int, last: int) -> tuple[int, int] | None:
        """The first and the last of the rows that match those of another session from `first` to `last`, counted from
        1; None if one has no match.
        """
        index = bisect_left(self.latest, other.times[first - 1] - WITHIN)
        begin = -1
        for time, change in zip(other.times[first - 1 : last], other.changes[first - 1 : last], strict=True):
            while index < len(self.times) and not (
                self.changes[index] == change and -WITHIN <= self.times[index] - time <= WITHIN
            ):
                if self.earliest[index] > time + WITHIN:
                    return None
                index += 1
            if index == len(self.times):
                return None
            begin = index if begin < 0 else begin
            index += 1
        return begin + 1, index


LeftOut: TypeAlias = dict[int, LoggedRuns]  # by the run's number in its session, from 0: where it is counted


def repeated(
    sessions: Sequence[LoggedRuns], read: Callable[[str], Sequence[LoggedRows]]
) -> list[tuple[LoggedRuns, LeftOut]]:
    """The sessions with runs that are left out because other sessions hold them.

    Args:
        read: the rows of all sessions in a log, in their order; what is not read again is missing.
    """
    rows_of = lru_cache(_LOGS_AT_ONCE)(read)
    left_out_of: dict[int, LeftOut] = {}
    for alike in grouped((session.whose, session) for session in sessions if session.begins).values():
        checked = _LeftOut(_overlapping(alike), rows_of)
        left_out_of.update(zip(map(id, checked.sessions), checked.runs, strict=True))
    return [(session, left_out) for session in sessions if (left_out := left_out_of.get(id(session)))]


def notes(
    repeats: Sequence[tuple[LoggedRuns, LeftOut]], sessions: Sequence[LoggedRuns], shown: Callable[[str], str]
) -> Iterator[str]:
    """Which runs of which logs are not counted, a note for each two logs; `sessions`: all of them."""
    runs: Counter[str] = Counter()
    for logged in sessions:
        runs[logged.log] += len(logged.begins)
    pairs = Counter((session.log, kept.log) for session, left_out in repeats for kept in left_out.values())
    for (log, kept), number in pairs.items():
        where = f"in {shown(kept)} too" if kept != log else "there twice"
        verb = "is" if number == 1 else "are"
        yield f"{shown(log)}: {number} of its {runs[log]} runs {verb} {where}, and not counted again"


def _overlapping(sessions: Sequence[LoggedRuns]) -> list[LoggedRuns]:
    """The sessions during which another one has runs, those with the most rows first."""
    overlapping: set[int] = set()
    latest: tuple[int, LoggedRuns] | None = None
    for begin, end, place in sorted(
        (min(session.begins), max(session.ends), index) for index, session in enumerate(sessions)
    ):
        session = sessions[place]
        if latest is not None and begin <= latest[0] + WITHIN:
            overlapping.update((id(latest[1]), id(session)))
        if latest is None or end > latest[0]:
            latest = end, session
    in_order = [session for session in sessions if id(session) in overlapping]
    return sorted(in_order, key=lambda session: -session.rows)


class _LeftOut:
    """Sessions, and the runs of each that are left out.

    Attributes:
        sessions: those with the most rows first.
    """

    def __init__(self, sessions: Sequence[LoggedRuns], rows_of: Callable[[str], Sequence[LoggedRows]]) -> None:
        self.sessions: Final = sessions
        self.runs: Final[list[LeftOut]] = [{} for _ in sessions]
        self._rows_of: Final = rows_of
        self._marks: Final = [
            sorted(
                (time, index, run) for index, session in enumerate(sessions) for run, time in enumerate(times(session))
            )
            for times in _TIMES
        ]
        for index in range(len(sessions)):
            for other in self._beside(index):
                self._leave_out(other, index, is_first=False)
                self._leave_out(index, other, is_first=True)

    def _beside(self, index: int) -> list[int]:
        """The later sessions whose counted runs begin or end at the same time as some of this one."""
        others = set()
        for marks, times in zip(self._marks, _TIMES, strict=True):
            for run in self._counted(index):
                time = times(self.sessions[index])[run]
                begin = bisect_left(marks, (time - WITHIN,))
                for _, other, other_run in marks[begin : bisect_right(marks, (time + WITHIN + 1,))]:
                    if other > index and other_run not in self.runs[other] and self._may_be_one(index, other):
                        others.add(other)
        return sorted(others)

    def _may_be_one(self, index: int, other: int) -> bool:
        robots = {self.sessions[index].robot, self.sessions[other].robot}
        return len(robots - {""}) < 2

    def _counted(self, index: int) -> Iterator[int]:
        return (run for run in range(len(self.sessions[index].begins)) if run not in self.runs[index])

    def _leave_out(self, index: int, other: int, is_first: bool) -> None:
        """Leave out the runs of a session that another one holds; `is_first`: not those that are equal."""
        session, kept = self.sessions[index], self.sessions[other]
        rows, wider = self._rows(session), self._rows(kept)
        for run in [*self._counted(index)]:
            first, last = session.first[run], min(session.last[run], len(rows.times))
            if first <= last and (match := wider.find(rows, first, last)) is not None:
                begin, end = match
                held = range(bisect_left(kept.last, begin), bisect_right(kept.first, end))  # the runs with these rows
                if held and not self.runs[other].keys() & held:
                    number = max(end, kept.last[held[-1]]) - min(begin, kept.first[held[0]])
                    if number > last - first or not is_first:
                        self.runs[index][run] = kept

    def _rows(self, session: LoggedRuns) -> LoggedRows:
        of_log = self._rows_of(session.log)
        return of_log[session.number] if session.number < len(of_log) else LoggedRows(())


def without_copies(logs: Sequence[str]) -> tuple[Sequence[str], dict[str, str]]:
    """The logs without copies of earlier ones, and for each copy the log that it equals.

    Only logs of the same size are read for this.
    """
    sizes = {log: _size(log) for log in logs}
    alike = Counter(sizes.values())
    first: dict[str, str] = {}
    copies: dict[str, str] = {}
    for log in logs:
        if sizes[log] is not None and alike[sizes[log]] > 1:
            original = first.setdefault(sha256(log), log)
            if original != log:
                copies[log] = original
    return [log for log in logs if log not in copies], copies


def _size(log: str) -> int | None:
    """The bytes of all files of a log; None if it cannot be read."""
    try:
        files = files_of_log(log)
        return sum(map(os.path.getsize, files)) if all(os.access(file, os.R_OK) for file in files) else None
    except OSError:
        return None


_TIMES: Final[tuple[Callable[[LoggedRuns], array[int]], ...]] = (lambda each: each.begins, lambda each: each.ends)
_LATEST: Final = 2**63 - 1  # what an array takes; a damaged log may be later
_LOGS_AT_ONCE: Final = 4  # whose rows are in memory
