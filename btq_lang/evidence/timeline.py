"""Timelines of the runs with the worst violation of each clause.

One invariant: it keeps the activations of the open run, at most a thousand, and one run for each clause.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.evidence.verdicts import Bar, Timeline

if TYPE_CHECKING:
    from btq_lang.evidence.clause import JudgedClause
    from btq_lang.evidence.model import Activation, LoggedTree
    from btq_lang.evidence.tally import Run


class Timelines:
    """Records the run with the worst violation of each clause."""

    def __init__(self) -> None:
        self.kept: Final[dict[JudgedClause, Timeline]] = {}
        self._now: Final[list[Activation]] = []
        self._left_out = 0

    def see(self, activation: Activation) -> None:
        """Record an activation that has ended."""
        if len(self._now) < _MOST_BARS:
            self._now.append(activation)
        else:
            self._left_out += 1

    def end_run(self, run: Run, tree: LoggedTree, broken: list[JudgedClause]) -> None:
        """Close the open run, which has the worst violation so far of some clauses."""
        if broken:
            self.kept.update(dict.fromkeys(broken, self._timeline(run, tree)))
        self._now.clear()
        self._left_out = 0

    def _timeline(self, run: Run, tree: LoggedTree) -> Timeline:
        bars = sorted(self._now, key=lambda each: (each.uid, each.begin))
        return Timeline(
            run.number,
            run.source,
            run.begin,
            tuple(
                Bar(
                    tree.nodes[each.uid].path,
                    sum(1 for _ in tree.above(each.uid)),
                    (each.begin - run.begin) / 1e6,
                    (each.end - run.begin) / 1e6,
                    each.outcome,
                )
                for each in bars
            ),
            self._left_out,
        )


_MOST_BARS: Final = 1000
