"""How many judgements of a clause are kept, violated or unknown, for every bound that it may have.

A judgement changes at one value of the bound, that of its measure; so the counts are a sum of steps.  Values are given
as `Edge.across`: a bound that is smaller than a step's value is broken there.

One invariant: counts are exact for every bound that is not inside a step, and the number of steps is limited: when
there are too many, neighbours become one, which then begins and ends at different values.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from operator import itemgetter
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from btq_lang.evidence.edges import Edge
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.verbs import Judgement

    # The kind of a judgement with a bound that it keeps, and the values at which it changes, the largest first.
    _Judged: TypeAlias = tuple[int, tuple[tuple[float, int], ...]]


class Counts(NamedTuple):
    """How many judgements there are of each kind."""

    kept: int
    violated: int
    unknown: int
    cut_off: int


class CountStep(NamedTuple):
    """A step of the counts.

    Attributes:
        low, high: the values between which they change.
        change: what is added to the counts if the bound is smaller.
    """

    low: float
    high: float
    change: Counts


class Margins:
    """The counts of a clause by its bound.

    Attributes:
        is_exact: otherwise they are unknown: a judgement did not depend on one measure.
    """

    def __init__(self, of_runs: bool) -> None:
        """Count nothing yet; `of_runs`: runs are counted, each as its judgements together."""
        self.is_exact = True
        self._of_runs: Final = of_runs
        self._base = Counts(0, 0, 0, 0)  # with a bound that all keep
        self._steps: list[CountStep] = []
        self._open: Final[list[_Judged]] = []  # of the open run
        self._worst: tuple[float, int] | None = None  # of those that keep some bound, with its run
        self._furthest: tuple[float, int] | None = None  # of those that break some bound

    def add(self, within: int, beyond: int, values: Sequence[float]) -> None:
        """Count a judgement in the open run.

        Args:
            within, beyond: what it is with a bound that it keeps, and with one that it breaks: KEPT to NOTHING.
            values: where it changes; between two values it is unknown; none: it is unknown where.
        """
        if within == beyond and not (beyond == VIOLATED and values):
            self._open.append((within, ()))
        elif values:
            kinds = (beyond,) if len(values) == 1 else (UNKNOWN, beyond)
            self._open.append((within, tuple(zip(sorted(values, reverse=True), kinds, strict=True))))
        else:
            self.is_exact = False

    def end_run(self, run: int) -> None:
        """Close the open run, which has this number."""
        for within, changes in self._open:
            if within == KEPT and len(changes) == 1:
                value = changes[0][0]
                self._worst = max(self._worst or (value, run), (value, run), key=itemgetter(0))
            if changes and changes[-1][1] == VIOLATED:
                value = changes[-1][0]
                self._furthest = max(self._furthest or (value, run), (value, run), key=itemgetter(0))
        if self._of_runs and self._open:
            self._end_whole_run()
        else:
            for within, changes in self._open:
                self._base = _sum(self._base, _UNITS[within])
                before = within
                for value, kind in changes:
                    self._steps.append(CountStep(value, value, _difference(_UNITS[kind], _UNITS[before])))
                    before = kind
        self._open.clear()
        if len(self._steps) > 4 * MOST_STEPS:
            self._steps = _compacted(self._steps)

    def _end_whole_run(self) -> None:
        """Count the run once, by all its judgements; those that are cut off count by themselves."""
        now = [0] * (len(_UNITS))
        moves: list[tuple[float, int, int]] = []
        for within, changes in self._open:
            now[within] += 1
            kinds = [within, *(kind for _, kind in changes)]
            moves += [(value, kinds[index], kind) for index, (value, kind) in enumerate(changes)]
        before = _of_run(now)
        self._base = _sum(self._base, before)
        for value, earlier, later in sorted(moves, key=itemgetter(0), reverse=True):
            now[earlier] -= 1
            now[later] += 1
            after = _of_run(now)
            if after != before:
                self._steps.append(CountStep(value, value, _difference(after, before)))
                before = after

    def add_all(self, other: Margins, runs: int) -> None:
        """Add those of later logs; `runs`: how many runs were before them."""
        self.is_exact = self.is_exact and other.is_exact
        self._base = _sum(self._base, other._base)
        self._steps = _compacted([*self._steps, *other._steps])
        for name in ("_worst", "_furthest"):
            mine, theirs = getattr(self, name), getattr(other, name)
            moved = (theirs[0], theirs[1] + runs) if theirs is not None else None
            if moved is not None and (mine is None or moved[0] > mine[0]):
                setattr(self, name, moved)

    def counts(self, bound: float, edge: Edge) -> tuple[Counts, Counts]:
        """The counts with another bound: if what is inside of a step is kept, and if it is not."""
        least = most = self._base
        edge_value = edge.across(bound)
        for step in self._steps:
            if step.low > edge_value or (edge.is_strict and step.low == edge_value):
                least, most = _sum(least, step.change), _sum(most, step.change)
            elif step.high > edge_value or (edge.is_strict and step.high == edge_value):
                most = _sum(most, step.change)
        return least, most

    def worst(self, bound: float, edge: Edge) -> tuple[float, int] | None:
        """The measure furthest on the wrong side with another bound, in SI, and its run."""
        edge_value = edge.across(bound)
        candidates = [self._worst] if self._worst is not None else []
        furthest = self._furthest
        if furthest is not None and (furthest[0] > edge_value or (edge.is_strict and furthest[0] == edge_value)):
            candidates.append(furthest)
        value, run = max(candidates, key=itemgetter(0), default=(None, 0))
        return (edge.across(value), run) if value is not None else None

    # ---- as JSON ----

    def written(self) -> dict[str, Any]:
        """The margins for a document: `base`: the counts with a bound that all keep; `steps`: low, high and change."""
        steps = [[step.low, step.high, *step.change] for step in _compacted(self._steps)]
        return {"base": list(self._base), "steps": steps, "worst": self._worst, "furthest": self._furthest}

    @classmethod
    def read(cls, written: dict[str, Any]) -> Margins:
        """The margins that `written` gave."""
        margins = cls(of_runs=False)
        margins._base = Counts(*written["base"])
        margins._steps = [CountStep(low, high, Counts(*change)) for low, high, *change in written["steps"]]
        margins._worst, margins._furthest = (tuple(written[name]) if written[name] else None for name in _EXTREMES)
        return margins


def kind_of(judgement: Judgement | None, activation: Activation) -> int:
    """What a judgement is for margins."""
    if judgement is None:
        return CUT_OFF if activation.outcome == "O" else NOTHING
    return UNKNOWN if judgement.holds is None else KEPT if judgement.holds else VIOLATED


def _of_run(counts: list[int]) -> Counts:
    """The kind of a run that has so many judgements of each kind."""
    of_run = next((kind for kind in (VIOLATED, UNKNOWN, KEPT) if counts[kind]), NOTHING)
    return _sum(_UNITS[of_run], Counts(0, 0, 0, counts[CUT_OFF]))


def _compacted(steps: Iterable[CountStep]) -> list[CountStep]:
    """The same in order of the values, equal values as one step, and no more steps than are kept."""
    joint: list[CountStep] = []
    for step in sorted(steps):
        if joint and step.low <= joint[-1].high:
            last = joint[-1]
            joint[-1] = CountStep(last.low, max(last.high, step.high), _sum(last.change, step.change))
        else:
            joint.append(step)
    if len(joint) <= MOST_STEPS:
        return joint
    heaviest = 2 * sum(map(_weight, joint)) / MOST_STEPS  # any two neighbours that are left weigh more
    merged = joint[:1]
    for step in joint[1:]:
        last = merged[-1]
        if _weight(last) + _weight(step) <= heaviest:
            merged[-1] = CountStep(last.low, step.high, _sum(last.change, step.change))
        else:
            merged.append(step)
    return merged


def _weight(step: CountStep) -> int:
    return max(sum(map(abs, step.change)), 1)


def _sum(first: Counts, second: Counts) -> Counts:
    return Counts(first[0] + second[0], first[1] + second[1], first[2] + second[2], first[3] + second[3])


def _difference(first: Counts, second: Counts) -> Counts:
    return Counts(first[0] - second[0], first[1] - second[1], first[2] - second[2], first[3] - second[3])


MOST_STEPS: Final = 1000
_EXTREMES: Final = ("worst", "furthest")
KEPT, VIOLATED, UNKNOWN, CUT_OFF, NOTHING = range(5)  # what judgements are: indices of `Counts`, or not counted
_UNITS: Final = (Counts(1, 0, 0, 0), Counts(0, 1, 0, 0), Counts(0, 0, 1, 0), Counts(0, 0, 0, 1), Counts(0, 0, 0, 0))
