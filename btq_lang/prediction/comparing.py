"""A prediction beside others with a change each, all with the same random numbers: what the change alone does.

One invariant: both sides of a difference have the same runs, so what they have in common does not blur it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import sqrt
from typing import Final, TypeAlias

from btq_lang.evidence.odds import beta_cdf, root
from btq_lang.prediction.changed import SkillChange
from btq_lang.prediction.judging import JudgedBlock
from btq_lang.prediction.predicting import Predictor, Recipe, predicted
from btq_lang.prediction.report import Alternative, DemandChange, PredictedClause, Prediction
from btq_lang.scenarios.mission import NotRunnable
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.util.record import Record, replace

Shares: TypeAlias = Sequence[tuple[int, int]]  # of each block, what holds, and of what was counted
Place: TypeAlias = tuple[str, str, int]  # of a clause: the requirement, its text, and which of several


class Options(Record):
    """How predictions are made; as of `predicted`."""

    runs: int
    jobs: int
    label: str


class Unpredictable(Exception):
    """After a change there is no prediction; the message says after which, and why."""


class _Blocks:
    """The blocks of a prediction, those with other skills apart."""

    def __init__(self, predictor: Predictor) -> None:
        self._predictor: Final = predictor
        self._shares: Final[tuple[list[list[tuple[int, int]]], ...]] = [], []

    def add(self, is_other: bool, block: JudgedBlock) -> None:
        self._shares[is_other].append(self._predictor.shares(block))

    def of(self, clause: int) -> tuple[Shares, Shares]:
        """The shares of a clause, by its place."""
        own, others = ([block[clause] for block in blocks] for blocks in self._shares)
        return own, others


def compared(
    predictor: Predictor,
    changes: Sequence[tuple[str, Recipe]],
    options: Options,
    reached: Callable[[int], None] = lambda runs: None,
    improves: bool = False,
) -> Prediction:
    """What is predicted of a mission, and after each of some changes.

    Args:
        changes: in words, and what the prediction follows from after it.
        reached: called with the number of runs so far, of all predictions.
        improves: order the changes by what they do.

    A KeyboardInterrupt ends all, and what is whole by then counts.

    Raises:
        Unanswerable: what some conditions answer is not given.
        Unpredictable: after a change there is no prediction.
    """
    before = _Blocks(predictor)
    first = predicted(predictor, options.runs, options.jobs, False, options.label, reached, before.add)
    alternatives: list[Alternative] = []
    for number, (what, recipe) in enumerate(changes, 1):
        if first.is_stopped:
            break
        try:
            other = Predictor(recipe)
        except (NotRunnable, EngineError, NotModelled) as error:
            raise Unpredictable(f"{what}: {error}") from None
        after = _Blocks(other)

        def ran(runs: int, earlier: int = number * options.runs) -> None:
            reached(earlier + runs)

        second = predicted(other, options.runs, options.jobs, False, options.label, ran, after.add)
        if second.is_stopped:
            first = replace(first, is_stopped=True)
            break
        alternatives.append(Alternative(what, second, tuple(_differences(first, before, second, after))))
    if improves:
        alternatives.sort(key=lambda each: -each.best)
    return replace(first, alternatives=tuple(alternatives), improves=improves)


def improvements(predictor: Predictor) -> Iterator[tuple[str, SkillChange]]:
    """Half the failures, half the time and no variance of each skill, as far as it has these."""
    for name, skill in predictor.skills().items():
        if skill.success() < 1:
            yield f"{name}: half its failures", SkillChange(name, spares=0.5)
        if skill.average() > 0:
            yield f"{name}: half its time", SkillChange(name, factor=0.5)
            yield f"{name}: always its average time", SkillChange(name, is_even=True)


def _differences(first: Prediction, before: _Blocks, second: Prediction, after: _Blocks) -> Iterator[DemandChange]:
    places = {place: (number, clause) for number, (place, clause) in enumerate(_clauses(first))}
    for number, (place, clause) in enumerate(_clauses(second)):
        if place not in places:
            continue
        earlier, old = places[place]
        share = interval = None
        if clause.share is not None and old.share is not None:
            share = clause.share - old.share
            interval = interval_of(before.of(earlier), after.of(number))
        shares = clause.share, old.share
        yield DemandChange(place[0], clause.text, clause.path, clause.word, old.word, *shares, share, interval)


def _clauses(prediction: Prediction) -> Iterator[tuple[Place, PredictedClause]]:
    seen: dict[tuple[str, str], int] = {}
    for requirement in prediction.requirements:
        for clause in requirement.clauses:
            key = requirement.id, clause.text
            seen[key] = seen.get(key, -1) + 1
            yield (*key, seen[key]), clause


def interval_of(before: tuple[Shares, Shares], after: tuple[Shares, Shares]) -> tuple[float, float] | None:
    """The limits of the difference of two shares, with 95 %; None: there are too few blocks.

    The variance is that between blocks of what a block adds to the difference of the ratios (W. G. Cochran, Sampling
    techniques, 3rd ed. 1977, 6.3), and that between differences with skills that might have been measured as well, of
    which what drawing explains is taken away.  It is never narrower than what as many activations or runs, none of
    which differs, leave open.

    Args:
        before, after: of the same blocks, and of the same blocks with other skills.
    """
    residuals, difference = _residuals(before[0], after[0])
    if len(residuals) < _FEWEST:
        return None
    counted = min(sum(n for _, n in shares) for shares in (before[0], after[0]))
    drawn = _variance(residuals)
    variance = drawn / len(residuals)
    others = [k / n - old_k / old_n for (old_k, old_n), (k, n) in zip(before[1], after[1], strict=False) if old_n and n]
    if len(others) > 1:
        variance += max(_variance(others) - drawn, 0.0)
    half = max(_t(len(residuals) - 1) * variance**0.5, 1 - _TAIL ** (1 / counted))
    return max(difference - half, -1.0), min(difference + half, 1.0)


def _residuals(before: Shares, after: Shares) -> tuple[list[float], float]:
    """What each block adds to the difference of the shares, and the difference."""
    sums = [(sum(k for k, _ in shares), sum(n for _, n in shares)) for shares in (before, after)]
    (old_held, old_counted), (held, counted) = sums
    if not old_counted or not counted:
        return [], 0.0
    old_share, share = old_held / old_counted, held / counted
    blocks = len(before)
    residuals = [
        blocks * ((k - share * n) / counted - (old_k - old_share * old_n) / old_counted)
        for (old_k, old_n), (k, n) in zip(before, after, strict=True)
    ]
    return residuals, share - old_share


def _variance(values: Sequence[float]) -> float:
    mean = sum(values) / len(values)
    return sum((each - mean) ** 2 for each in values) / (len(values) - 1)


def _t(freedom: int) -> float:
    """The quantile of Student's distribution that one of forty exceeds."""
    share = root(lambda x: beta_cdf(x, 0.5, freedom / 2) - (1 - 2 * _TAIL))  # of t² / (freedom + t²)
    return sqrt(freedom * share / (1 - share))


_TAIL: Final = 0.025
_FEWEST: Final = 2  # blocks
