"""What the nodes did in one run, for the run that broke a clause worst.

One invariant: the activations of the open run alone are kept, at most a thousand of them, and one run for each clause.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.evidence.verdicts import Bar, Timeline

if TYPE_CHECKING:
    from btq_lang.evidence.clause import JudgedClause
    from btq_lang.evidence.model import Activation, LoggedTree
    from btq_lang.evidence.tally import Run


class Timelines:
    """The runs that broke clauses worst."""

    def __init__(self) -> None:
        self._kept: Final[dict[JudgedClause, Timeline]] = {}
        self._now: Final[list[Activation]] = []
        self._left_out = 0

    def see(self, activation: Activation) -> None:
        """An activation of the run that is open has ended."""
        if len(self._now) < _MOST_BARS:
            self._now.append(activation)
        else:
            self._left_out += 1

    def end_run(self, run: Run, tree: LoggedTree, broken: list[JudgedClause]) -> None:
        """The run that was open has ended.

        Args:
            broken: the clauses that it broke worse than all runs before.
        """
        if broken:
            self._kept.update(dict.fromkeys(broken, self._timeline(run, tree)))
        self._now.clear()
        self._left_out = 0

    def of(self, clause: JudgedClause) -> Timeline | None:
        """The run that broke a clause worst; None where none did."""
        return self._kept.get(clause)

    def _timeline(self, run: Run, tree: LoggedTree) -> Timeline:
        bars = sorted(self._now, key=lambda each: (each.uid, each.begin))
        return Timeline(
            run.number,
            run.source,
            run.begin,
            tuple(
                Bar(
                    tree.nodes[each.uid].path,
                    _depth(tree, each.uid),
                    (each.begin - run.begin) / 1e6,
                    (each.end - run.begin) / 1e6,
                    each.outcome,
                )
                for each in bars
            ),
            self._left_out,
        )


def _depth(tree: LoggedTree, uid: int) -> int:
    depth = 0
    while uid := tree.parent[uid]:
        depth += 1
    return depth


_MOST_BARS: Final = 1000
