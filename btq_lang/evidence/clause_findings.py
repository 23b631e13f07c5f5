"""The counts of a clause in logs, and the verdict that they give.

One invariant: a verdict depends on counts alone, so those of several logs can be added, and judged by another process.
In a sliding window, `over last N runs` or `over last 8 h`, only the judgements in it, the latest ones, are kept,
whatever the order in which logs are read.
"""

from __future__ import annotations

from bisect import insort
from collections import Counter
from collections.abc import Iterable
from operator import itemgetter
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

from btq_lang.catalog.verbs import POOLED, VERBS
from btq_lang.evidence.margins import Margins
from btq_lang.evidence.tally import Run, Tally
from btq_lang.evidence.verdicts import NEVER, SATISFIED, UNDECIDED, UNKNOWN, VIOLATED, ClauseVerdict
from btq_lang.requirements.model import DurationSum, Interval, Quantity, ResolvedEachEvent
from btq_lang.util.record import replace
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.odds import Limits
    from btq_lang.evidence.outline import Demand
    from btq_lang.evidence.pools import Pool
    from btq_lang.evidence.verbs import Judgement
    from btq_lang.evidence.verdicts import CauseLink, Measures, Timeline, Verdict
    from btq_lang.requirements.model import ResolvedOdds, ResolvedRequirement, ResolvedWindow

    _Entry: TypeAlias = tuple[Judgement, str, int, tuple[CauseLink, ...]]


class ClauseFindings:
    """The counts of a clause in some logs; they refer to no text, so they may go to another process.

    Attributes:
        pool: of a clause about all runs together; else None.
        paths: of its nodes, as an ordered set.
        missing: why it cannot be judged at all its nodes; empty if it can.
        has_run: whether one of its nodes has.
        missed: how many events happened while its node was not active.
        timeline: the run with the worst violation; None if none is kept.
        left_out: as `failed`, `halted`, `idle` and `not_applicable` of `ClauseVerdict`.
    """

    def __init__(self, requirement: ResolvedRequirement, limits: Limits, pool: Pool | None = None) -> None:
        """Count nothing yet; `pool`: as of `Tally`."""
        self.pool: Final = pool
        odds, confidence, window = requirement.odds, requirement.confidence, requirement.window
        self.tally: Final = (
            Tally(odds, confidence, limits, pool=pool) if window is None else Recent(window, odds, confidence, pool)
        )
        self.margins: Final = Margins(odds is not None and odds.experiments == "runs")
        self.paths: Final[dict[str, None]] = {}
        self.missing = ""
        self.has_run = False
        self.missed = 0
        self.timeline: Timeline | None = None
        self.left_out: Final[Counter[str]] = Counter()

    def add(self, other: ClauseFindings, runs: int) -> None:
        """Add the findings of later logs; `runs`: how many runs were before them."""
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
        missing, has_run: as in `ClauseFindings`.
    """
    verdict = tally.verdict()
    if missing and verdict != VIOLATED:
        return UNKNOWN, missing
    if verdict == NEVER or (verdict == SATISFIED and not has_run):
        if tally.cut_off:
            return NEVER, "the log ends before it does"
        return NEVER, "nothing that it is about happened in any run" if has_run else "it did not start in any run"
    why = tally.why if verdict in (UNKNOWN, UNDECIDED) else ""
    return verdict, why or (tally.pool.shown().text if tally.pool is not None and verdict == UNKNOWN else "")


def verdict_on(
    demand: Demand, findings: ClauseFindings, tally: Tally, is_over_run: bool, measures: Measures | None
) -> ClauseVerdict:
    """The verdict on a clause, with all that the report says about it.

    Args:
        tally: of its judgements, perhaps with those of an open run.
        is_over_run: whether it is judged at the end of a run.
        measures: as of `ClauseVerdict`.
    """
    claim, requirement, left_out = demand.claim, demand.requirement, findings.left_out
    verdict, why = verdict_of(tally, findings.missing, findings.has_run)
    if verdict == NEVER and left_out["not_applicable"]:
        why = f"its assumption did not hold ({counted(left_out['not_applicable'], 'time')})"
    if verdict == NEVER and findings.missed and claim.event is not None:
        event = claim.text.partition(" after ")[2].removeprefix("when ")
        why = f"it was not running when {event} ({counted(findings.missed, 'time')})"
    verb = VERBS[claim.verb]
    is_share = verb.operand == "condition" and verb.judged == "over the run"
    is_of_run = is_share or (verb.operand == "count" and claim.per is None)
    is_pooled = claim.verb in POOLED and is_over_run
    is_once_a_run = isinstance(demand.subject, DurationSum) or (is_of_run and len(findings.paths) == 1)
    of_each: Literal["activations", "occurrences"] = "activations"
    if isinstance(demand.subject, ResolvedEachEvent):
        of_each = "occurrences"
    return ClauseVerdict(
        text=demand.text,
        path=", ".join(findings.paths),
        of=claim.subject_text if isinstance(demand.subject, Interval | DurationSum | ResolvedEachEvent) else "",
        verdict=verdict,
        why=why,
        unit="runs" if tally.counts_runs or is_once_a_run or is_pooled else of_each,
        confidence=requirement.confidence,
        histogram=tally.distribution.histogram(marks_of(demand)),
        timeline=findings.timeline if verdict == VIOLATED else None,
        measures=measures,
        failed=left_out["failed"],
        halted=left_out["halted"],
        idle=left_out["idle"],
        not_applicable=left_out["not_applicable"],
        **tally.fields(),
    )


def marks_of(demand: Demand) -> dict[str, Quantity]:
    """What measured values are compared with, as in `Histogram`, as far as it does not vary."""
    limit, goal = demand.claim.limit, demand.requirement.goal
    marks = {"lower bound": limit.value, "upper bound": limit.upper} if limit is not None and limit.upper else {}
    return {kind: value for kind, value in {**marks, "goal": goal}.items() if isinstance(value, Quantity)}


class Recent:
    """Counts the last activations, the last runs with a judgement, or a last period; what is cut off counts in all
    logs.
    """

    def __init__(
        self,
        window: ResolvedWindow,
        odds: ResolvedOdds | None,
        confidence: float | None,
        pool: Pool | None = None,
    ) -> None:
        self.cut_off = 0
        self._pool: Final = pool
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
            judgements = sorted(self._now, key=_END)
            insort(self._kept, (run, judgements), key=_begin_of_run)
            self._now.clear()
        self._leave_out()

    def add_all(self, other: Recent, runs: int) -> None:
        """Add the judgements of other logs, judged by themselves; `runs`: how many runs were before theirs."""
        self.cut_off += other.cut_off
        self._end = max(self._end, other._end)
        for run, judgements in other._kept:
            insort(self._kept, (replace(run, number=run.number + runs), judgements), key=_begin_of_run)
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
        pool = self._pool.emptied() if self._pool is not None else None
        tally = Tally(self._odds, self._confidence, "window", self._window.count if is_of_odds else None, pool)
        tally.cut_off = self.cut_off
        for run, judgements in self._kept:
            for entry in judgements:
                tally.add(*entry)
            tally.end_run(run)
        return tally

    def _leave_out(self) -> None:
        """Drop what is no longer in the window."""
        kept, count = self._kept, self._window.count
        if count is None:
            assert self._window.seconds is not None, "a window is a number or a time"
            begin = self._end - round(self._window.seconds * 1e6)
            for _, judgements in kept:
                judgements[:] = [entry for entry in judgements if _END(entry) >= begin]
            kept[:] = [of_run for of_run in kept if of_run[1]]
        elif self._window.experiments == "runs":
            del kept[: max(len(kept) - count, 0)]
        else:
            surplus = sum(len(judgements) for _, judgements in kept) - count
            while surplus > 0:
                judgements = kept[0][1]
                surplus, dropped = surplus - len(judgements), min(surplus, len(judgements))
                del judgements[:dropped]
                if not judgements:
                    del kept[0]


def _begin_of_run(kept: tuple[Run, list[_Entry]]) -> int:
    return kept[0].begin


_END: Final = itemgetter(2)
