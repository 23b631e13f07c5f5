"""Timelines of the runs with the worst violation of each clause.

One invariant: it keeps the activations of the open run, at most a thousand, and one run for each clause, with at most
a thousand points of each signal.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.signal_lines import signal_lines
from btq_lang.evidence.verdicts import Bar, Timeline
from btq_lang.evidence.wording import took

if TYPE_CHECKING:
    from btq_lang.evidence.clause_findings import ClauseFindings
    from btq_lang.evidence.model import Activation, LoggedTree
    from btq_lang.evidence.signal_lines import Bounds
    from btq_lang.evidence.signals import Signals
    from btq_lang.evidence.tally import Run
    from btq_lang.requirements.model import ResolvedSignal


class OpenRun:
    """The activations of the open run."""

    def __init__(self, read: Mapping[ResolvedSignal, Bounds]) -> None:
        """See nothing yet; `read`: the signals to be drawn, with the numbers that they are compared with."""
        self._read: Final = read
        self._seen: Final[list[Activation]] = []
        self._left_out = 0

    def see(self, activation: Activation) -> None:
        """Record an activation that has ended."""
        if len(self._seen) < _MOST_BARS:
            self._seen.append(activation)
        else:
            self._left_out += 1

    def end(self, run: Run, tree: LoggedTree, clauses: Sequence[ClauseFindings], signals: Signals) -> None:
        """Close the run, and keep it as the timeline of the clauses of which it has the worst violation so far."""
        if broken := [each for each in clauses if each.tally.is_worst_in(run)]:
            timeline = self._timeline(run, tree, signals)
            for each in broken:
                each.timeline = timeline
        self._seen.clear()
        self._left_out = 0

    def _timeline(self, run: Run, tree: LoggedTree, signals: Signals) -> Timeline:
        bars = sorted(self._seen, key=lambda each: (each.uid, each.begin))
        return Timeline(
            run.number,
            run.source,
            run.begin,
            (run.end - run.begin) / 1e6,
            tuple(
                Bar(
                    tree.nodes[each.uid].path,
                    sum(1 for _ in tree.above(each.uid)),
                    (each.begin - run.begin) / 1e6,
                    (each.end - run.begin) / 1e6,
                    each.outcome,
                    took(each),
                )
                for each in bars
            ),
            self._left_out,
            signal_lines(self._read, signals, run.begin, run.end),
        )


_MOST_BARS: Final = 1000
