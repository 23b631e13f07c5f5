"""What was found of a clause in logs, counted, and the verdict that it comes to.

One invariant: a verdict depends on counts alone, so those of several logs can be added, and judged by another process.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, Final

from btq_lang.evidence.margins import Margins
from btq_lang.evidence.recent import Recent
from btq_lang.evidence.tally import Tally
from btq_lang.evidence.verdicts import NEVER, SATISFIED, UNDECIDED, UNKNOWN, VIOLATED
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.evidence.odds import Limits
    from btq_lang.evidence.verdicts import Timeline, Verdict
    from btq_lang.requirements.model import ResolvedRequirement


class ClauseFindings:
    """What was found of a clause in some logs; it refers to no text, so it may go to another process.

    Attributes:
        paths: of its nodes, as an ordered set.
        missing: why it cannot be judged at all its nodes; empty if it can.
        has_run: whether one of its nodes has.
        missed: how many events happened while its node was not active.
        timeline: the run with the worst violation; None if none is kept.
        left_out: as `failed`, `halted` and `idle` of `ClauseVerdict`.
    """

    def __init__(self, requirement: ResolvedRequirement, limits: Limits) -> None:
        odds, confidence, window = requirement.odds, requirement.confidence, requirement.window
        self.tally: Final = Tally(odds, confidence, limits) if window is None else Recent(window, odds, confidence)
        self.margins: Final = Margins(odds is not None and odds.experiments == "runs")
        self.paths: Final[dict[str, None]] = {}
        self.missing = ""
        self.has_run = False
        self.missed = 0
        self.timeline: Timeline | None = None
        self.left_out: Final[Counter[str]] = Counter()

    def add(self, other: ClauseFindings, runs: int) -> None:
        """Add what was found in later logs; `runs`: how many runs were before them."""
        theirs: Any = other.tally  # one clause has tallies of one class
        if other.timeline is not None and theirs.is_worse_than(self.tally, other.timeline.run):
            self.timeline = replace(other.timeline, run=other.timeline.run + runs)
        self.tally.add_all(theirs, runs)
        self.margins.add_all(other.margins, runs)
        self.paths.update(other.paths)
        self.missing = self.missing or other.missing
        self.has_run = self.has_run or other.has_run
        self.missed += other.missed
        self.left_out.update(other.left_out)


def verdict_of(tally: Tally, missing: str, has_run: bool) -> tuple[Verdict, str]:
    """The verdict on a clause, and why it is unknown, undecided or never exercised; else empty.

    Args:
        missing, has_run: as of `ClauseFindings`.
    """
    verdict = tally.verdict()
    if missing and verdict != VIOLATED:
        return UNKNOWN, missing
    if verdict == NEVER or (verdict == SATISFIED and not has_run):
        if tally.cut_off:
            return NEVER, "the log ends before it does"
        return NEVER, "nothing that it is about happened in any run" if has_run else "it did not start in any run"
    return verdict, tally.why if verdict in (UNKNOWN, UNDECIDED) else ""
