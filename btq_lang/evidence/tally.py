"""Counts the judgements of a clause at a written node, and derives the verdict.

One invariant: counts are enough for the verdict, so the only judgements kept are the violations that are shown.
"""

from __future__ import annotations

from collections.abc import Iterable
from copy import copy
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final

from btq_lang.evidence.distribution import Distribution
from btq_lang.evidence.odds import Limits, lower_limit, runs_to_decide, upper_limit
from btq_lang.evidence.verdicts import (
    NEVER,
    SATISFIED,
    UNDECIDED,
    UNKNOWN,
    VIOLATED,
    Bounded,
    CauseLink,
    RunValue,
    Verdict,
    Violation,
    Worst,
)
from btq_lang.evidence.wording import measured
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from btq_lang.evidence.conditions import Measure
    from btq_lang.evidence.pools import Pool
    from btq_lang.evidence.verbs import Judgement
    from btq_lang.requirements.model import ResolvedOdds


class Run(Record):
    """A run that has ended: its number, its file, when it began and when it ended."""

    number: int
    source: str
    begin: int
    end: int


class Tally:
    """The counts so far.

    Attributes:
        counted, violated, unknown, cut_off, why, violations, worst, bounded: as in `ClauseVerdict`.
        by_run: the values of the last runs, and of some before them.
        distribution: of the measures.
        limits: which limits of the probability decide.
    """

    def __init__(
        self,
        odds: ResolvedOdds | None,
        confidence: float | None,
        limits: Limits = "one look",
        most: int | None = None,
        pool: Pool | None = None,
    ) -> None:
        """Count nothing yet.

        Args:
            most: the maximum that count; None: all.
            pool: decides instead of the counts.
        """
        self.pool: Final = pool
        self.counted = 0
        self.violated = 0
        self.unknown = 0
        self.cut_off = 0
        self.why = ""
        self.violations: Final[list[Violation]] = []
        self.worst: Worst | None = None
        self.bounded: Bounded | None = None
        self.by_run: list[RunValue] = []
        self.distribution: Final = Distribution()
        self.counts_runs: Final = odds is not None and odds.experiments == "runs"
        self.limits: Final = limits
        self._odds: Final = odds
        self._confidence: Final = confidence
        self._most: Final = most
        self._worst_excess = float("-inf")
        self._broken: Final[list[tuple[Judgement, str, tuple[CauseLink, ...]]]] = []  # of the open run
        self._kept = self._unclear = 0  # likewise
        self._worst_now: Measure | None = None  # likewise

    def add(self, judgement: Judgement, path: str, end: int, chain: tuple[CauseLink, ...]) -> None:
        """Count the judgement of an activation in the open run, or of the run.

        Args:
            end: of the activation, or of the run.
            chain: what led to it.
        """
        if judgement.holds is None:
            self._unclear += 1
            self.why = self.why or judgement.sentence
            return
        if self.pool is not None:
            self.pool.see(judgement)
        if judgement.holds:
            self._kept += 1
        else:
            self._broken.append((judgement, path, chain))
        if judgement.most is not None:
            self._bound(judgement.most)
        if judgement.measure is not None and (judgement.most is None or not judgement.holds):
            self.distribution.add(judgement.measure)
            self._note_worst(judgement)

    def _note_worst(self, judgement: Judgement) -> None:
        measure = judgement.measure
        if measure is not None and (self._worst_now is None or measure.excess > self._worst_now.excess):
            self._worst_now = measure

    def _bound(self, most: Measure) -> None:
        before = self.bounded
        if before is not None and before.si >= most.si:
            self.bounded = Bounded(before.number + 1, before.si, before.text)
        else:
            number = before.number + 1 if before is not None else 1
            self.bounded = Bounded(number, most.si, measured(most.si, most.unit, most.bound.si))

    def end_run(self, run: Run) -> None:
        """Close the open run."""
        broken, kept, unclear = len(self._broken), self._kept, self._unclear
        if not (broken or kept or unclear):
            return
        shown = self._broken
        if self.counts_runs:  # a run holds if it has judgements and all of them hold
            broken, kept, unclear = int(broken > 0), int(kept > 0), int(unclear > 0)
            shown = self._broken[:1]
            unclear = int(unclear and not broken)
            kept = int(kept and not broken and not unclear)
        self.counted += broken + kept
        self.violated += broken
        self.unknown += unclear
        if broken:
            room = max(_MOST_VIOLATIONS - len(self.violations), 0)
            self.violations.extend(_violation(*entry, run) for entry in shown[:room])
            self._broken.clear()
        self._kept = self._unclear = 0
        self._end_worst(run, VIOLATED if broken else UNKNOWN if unclear else SATISFIED)

    def _end_worst(self, run: Run, verdict: Verdict) -> None:
        """Keep the worst measure of a run, which has this verdict."""
        worst, self._worst_now = self._worst_now, None
        if worst is not None and worst.excess > self._worst_excess:
            self._worst_excess = worst.excess
            self.worst = Worst(worst.si, measured(worst.si, worst.unit, worst.bound.si), run.number)
        self.by_run.append(RunValue(run.number, run.begin, verdict, worst.si if worst is not None else None))
        if len(self.by_run) > _CROWDED:
            self.by_run[:] = self._last_runs()

    def _last_runs(self) -> tuple[RunValue, ...]:
        """The values of the last runs, whatever the order in which logs were read."""
        return tuple(sorted(self.by_run, key=attrgetter("start"))[-MOST_RUNS:])

    def is_worst_in(self, run: Run) -> bool:
        """Whether the worst violation, the one furthest beyond the bound or else the first, is in a run already
        counted.
        """
        if not self.violations or self.violations[-1].run != run.number:
            return False
        return self.violations[0].run == run.number or (self.worst is not None and self.worst.run == run.number)

    def add_all(self, other: Tally, runs: int) -> None:
        """Add the counts of later logs, which were judged by themselves; `runs`: how many runs were before them."""
        self.counted += other.counted
        self.violated += other.violated
        self.unknown += other.unknown
        self.cut_off += other.cut_off
        theirs: Any = other.pool  # one clause has pools of one class
        if self.pool is not None and theirs is not None:
            self.pool.add_all(theirs)
        self.why = self.why or other.why
        room = max(_MOST_VIOLATIONS - len(self.violations), 0)
        self.violations.extend(replace(violation, run=violation.run + runs) for violation in other.violations[:room])
        if other.worst is not None and other._worst_excess > self._worst_excess:
            self._worst_excess = other._worst_excess
            self.worst = replace(other.worst, run=(other.worst.run or 0) + runs)
        self.distribution.add_all(other.distribution)
        self.by_run.extend(replace(value, run=value.run + runs) for value in other._last_runs())
        self.by_run[:] = self._last_runs()
        if other.bounded is not None:
            number = other.bounded.number + (self.bounded.number if self.bounded is not None else 0)
            largest = max(other.bounded, self.bounded or other.bounded, key=lambda bounded: bounded.si)
            self.bounded = replace(largest, number=number)

    def is_worse_than(self, other: Tally, run: int) -> bool:
        """Whether the worst violation of both is the one in a run of this tally; the other's logs were earlier."""
        is_worst = self.worst is not None and self.worst.run == run and self._worst_excess > other._worst_excess
        return not other.violations or is_worst

    def __getstate__(self) -> dict[str, object]:
        """The counts, for another process; the requirement's odds refer to its text, which that process has."""
        return {**self.__dict__, "_odds": None}

    def result(self) -> Tally:
        """The tally itself; `Recent` computes one."""
        return self

    def so_far(self, run: Run, broken: Iterable[tuple[Judgement, str]] = ()) -> Tally:
        """The tally as if the open run ended now; where runs are counted, only if it is violated already.

        Args:
            broken: the violations of activations that are still open, with their paths.
        """
        tally = copy(self)
        open_violations = [(judgement, path, ()) for judgement, path in broken]
        vars(tally).update(
            violations=[*self.violations], by_run=[*self.by_run], _broken=[*self._broken, *open_violations]
        )
        for judgement, _, _ in open_violations:
            tally._note_worst(judgement)
        if self.counts_runs and not tally._broken:
            tally._kept = tally._unclear = 0
        tally.end_run(run)
        return tally

    def fields(self) -> dict[str, Any]:
        """The fields of `ClauseVerdict` that come from the tally, by name."""
        same = ("counted", "violated", "unknown", "cut_off", "worst", "limits", "bounded")
        fields = {name: getattr(self, name) for name in same}
        lists = {"violations": tuple(self.violations), "by_run": self._last_runs()}
        pooled = self.pool.shown() if self.pool is not None and self.counted else None
        return {**fields, "interval": self.interval(), "more": self.more(), "pooled": pooled, **lists}

    def verdict(self) -> Verdict:
        """Without odds one violation decides; with odds the unknown ones are taken as false and as true, and a verdict
        needs both to agree.
        """
        n, k, unknown = self.counted, self.counted - self.violated, self.unknown
        if n + unknown == 0:
            return NEVER
        if self.pool is not None:
            return UNKNOWN if unknown else self.pool.verdict()
        if self._odds is None:
            return VIOLATED if self.violated else UNKNOWN if unknown else SATISFIED
        low, high = self._by_odds(k, n + unknown), self._by_odds(k + unknown, n + unknown)
        return low if low == high else UNKNOWN

    def interval(self) -> tuple[float, float] | None:
        """The limits of the probability; None without odds or judgements."""
        if self._odds is None or not self.counted + self.unknown:
            return None
        confidence = self._confidence if self._confidence is not None else USUAL_CONFIDENCE
        n, k = self.counted, self.counted - self.violated
        return lower_limit(k, n, confidence, self.limits), upper_limit(k, n, confidence, self.limits)

    def more(self) -> int | None:
        """How many more judgements that hold would decide an undecided verdict."""
        if self._odds is None or self._confidence is None or self.verdict() != UNDECIDED:
            return None
        n, most, wanted = self.counted + self.unknown, self._most, self._odds.probability
        further = runs_to_decide(self.counted - self.violated, n, self._confidence, wanted, self.limits)
        if most is None or (further is not None and n + further <= most):
            return further
        return most if lower_limit(most, most, self._confidence) >= wanted else None  # they push out all others

    def _by_odds(self, k: int, n: int) -> Verdict:
        assert self._odds is not None, "there are odds"
        wanted = self._odds.probability
        if self._confidence is None:
            share = k / n
            return SATISFIED if share > wanted or (share == wanted and self._odds.relation == ">=") else VIOLATED
        if lower_limit(k, n, self._confidence, self.limits) >= wanted:
            return SATISFIED
        return VIOLATED if upper_limit(k, n, self._confidence, self.limits) < wanted else UNDECIDED


def _violation(judgement: Judgement, path: str, chain: tuple[CauseLink, ...], run: Run) -> Violation:
    measure = judgement.measure
    value = measured(measure.si, measure.unit, measure.bound.si) if measure is not None else ""
    bound = measure.bound.text if measure is not None else ""
    seconds = (judgement.at - run.begin) / 1e6
    why = judgement.sentence.replace("{}", value)
    passed = (judgement.passed - run.begin) / 1e6 if judgement.passed is not None else None
    return Violation(run.number, run.source, path, run.begin, seconds, value, bound, why, chain, passed)


MOST_RUNS: Final = 60  # whose values are kept: as many as a small drawing can show
_CROWDED: Final = 4 * MOST_RUNS
USUAL_CONFIDENCE: Final = 0.95  # of the limits shown, if the requirement names none
_MOST_VIOLATIONS: Final = 1000
