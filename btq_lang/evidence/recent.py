"""`over last N runs`, `over last 8 h`: the counts of a clause in a sliding window.

One invariant: only the judgements in the window, the latest ones, are kept, whatever the order in which logs are read.
"""

from __future__ import annotations

from bisect import insort
from collections.abc import Iterable
from operator import itemgetter
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.evidence.tally import Run, Tally
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.evidence.verbs import Judgement
    from btq_lang.evidence.verdicts import CauseLink
    from btq_lang.requirements.model import ResolvedOdds, ResolvedWindow

    _Entry: TypeAlias = tuple[Judgement, str, int, tuple[CauseLink, ...]]


class Recent:
    """Counts the last activations, the last runs with a judgement, or a last period; what is cut off, in all logs."""

    def __init__(self, window: ResolvedWindow, odds: ResolvedOdds | None, confidence: float | None) -> None:
        self.cut_off = 0
        self._window: Final = window
        self._odds: Final = odds
        self._confidence: Final = confidence
        self._now: Final[list[_Entry]] = []  # of the open run
        self._kept: Final[list[tuple[Run, list[_Entry]]]] = []  # the earliest run first
        self._end = 0  # of the last run

    def add(self, judgement: Judgement, path: str, end: int, chain: tuple[CauseLink, ...]) -> None:
        """Count a judgement in the open run, as `Tally.add`."""
        self._now.append((judgement, path, end, chain))

    def end_run(self, run: Run) -> None:
        """Close the open run."""
        self._end = max(self._end, run.end)
        if self._now:
            found = sorted(self._now, key=_END)
            insort(self._kept, (run, found), key=_begin)
            self._now.clear()
        self._leave_out()

    def add_all(self, other: Recent, runs: int) -> None:
        """Add the judgements of other logs, judged by themselves; `runs`: how many runs were before theirs."""
        self.cut_off += other.cut_off
        self._end = max(self._end, other._end)
        for run, judgements in other._kept:
            insort(self._kept, (replace(run, number=run.number + runs), judgements), key=_begin)
        self._leave_out()

    def __getstate__(self) -> dict[str, object]:
        """The judgements, as `Tally.__getstate__`."""
        return {**self.__dict__, "_odds": None, "_window": None}

    def is_worst_in(self, run: Run) -> bool:
        """Unknown until all logs are read."""
        return False

    def so_far(self, run: Run, broken: Iterable[tuple[Judgement, str]] = ()) -> Tally:
        """The tally without the open run."""
        return self.result()

    def result(self) -> Tally:
        """The tally of the judgements in the window."""
        is_of_odds = self._odds is None or self._odds.experiments == self._window.experiments
        tally = Tally(self._odds, self._confidence, "window", self._window.count if is_of_odds else None)
        tally.cut_off = self.cut_off
        for run, judgements in self._kept:
            for each in judgements:
                tally.add(*each)
            tally.end_run(run)
        return tally

    def _leave_out(self) -> None:
        """Drop what is no longer in the window."""
        kept, count = self._kept, self._window.count
        if count is None:
            assert self._window.seconds is not None, "a window is a number or a time"
            begin = self._end - round(self._window.seconds * 1e6)
            for _, judgements in kept:
                judgements[:] = [each for each in judgements if _END(each) >= begin]
            kept[:] = [each for each in kept if each[1]]
        elif self._window.experiments == "runs":
            del kept[: max(len(kept) - count, 0)]
        else:
            surplus = sum(len(judgements) for _, judgements in kept) - count
            while surplus > 0:
                judgements = kept[0][1]
                surplus, gone = surplus - len(judgements), min(surplus, len(judgements))
                del judgements[:gone]
                if not judgements:
                    del kept[0]


def _begin(kept: tuple[Run, list[_Entry]]) -> int:
    return kept[0].begin


_END: Final = itemgetter(2)
